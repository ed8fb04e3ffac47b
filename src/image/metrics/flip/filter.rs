//! Separable filters; beyond its edge a picture goes on as at the edge.

use rayon::prelude::*;

/// `plane` in lines of `width`, filtered along them with an odd number of taps.
pub fn across(plane: &[f32], width: usize, taps: &[f32]) -> Vec<f32> {
    let radius = taps.len() / 2;
    let mut out = vec![0.0; plane.len()];
    out.par_chunks_mut(width).zip(plane.par_chunks(width)).for_each_init(
        Vec::new,
        |padded: &mut Vec<f32>, (out, line)| {
            padded.clear();
            padded.resize(radius, line[0]);
            padded.extend_from_slice(line);
            padded.resize(line.len() + 2 * radius, line[line.len() - 1]);
            for (tap, shifted) in std::iter::zip(taps, padded.windows(line.len())) {
                add(out, *tap, shifted);
            }
        },
    );
    out
}

/// Adds `weight` times `plane`, filtered from line to line, to `sum`.
pub fn down(plane: &[f32], width: usize, taps: &[f32], weight: f32, sum: &mut [f32]) {
    let (radius, lines) = (taps.len() / 2, plane.len() / width);
    sum.par_chunks_mut(width).enumerate().for_each(|(y, sum)| {
        for (index, tap) in taps.iter().enumerate() {
            let line = (y + index).saturating_sub(radius).min(lines - 1);
            add(sum, weight * tap, &plane[line * width..][..width]);
        }
    });
}

fn add(sum: &mut [f32], factor: f32, values: &[f32]) {
    std::iter::zip(sum, values).for_each(|(sum, value)| *sum += factor * value);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filters_weigh_neighbors_and_repeat_the_edge() {
        let plane = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
        let taps = [100.0, 10.0, 1.0];
        // A tap of 100 for the neighbor before, 1 for the one after.
        assert_eq!(across(&plane, 3, &taps), [112.0, 124.0, 244.0, 896.0, 992.0, 1952.0]);
        let mut sum = vec![1.0; 6];
        down(&plane, 3, &taps, 2.0, &mut sum);
        assert_eq!(sum, [237.0, 473.0, 945.0, 377.0, 753.0, 1505.0]);
        // Wider than the picture: all of it lies beyond an edge.
        assert_eq!(across(&[1.0, 2.0], 2, &[1.0; 7]), [10.0, 11.0]);
    }
}
