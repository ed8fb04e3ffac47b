//! The exposure that suits a picture.

use crate::math::{Rgb, luminance};

/// Share of the pixels that are not brighter than what is shown as 1.
const SHARE: f32 = 0.98;
/// Stops that an exposure may have.
const STOPS: [f32; 2] = [-20.0, 20.0];

/// Stops of exposure, in tenths, under which 98 % of the pixels are not brighter than 1: rare
/// bright samples don't count, and a flame is bright without being white all over. `None` for a
/// black picture.
pub fn auto_exposure(pixels: &[[f32; 4]]) -> Option<f32> {
    let mut values: Vec<f32> = pixels
        .iter()
        .map(|&[r, g, b, _]| luminance(Rgb::new(r, g, b)))
        .filter(|value| value.is_finite())
        .collect();
    let last = values.len().checked_sub(1)?;
    let (_, &mut bright, _) =
        values.select_nth_unstable_by((last as f32 * SHARE) as usize, f32::total_cmp);
    // Where that much is black, what is not black counts.
    let bright = if bright > 0.0 { bright } else { values.iter().copied().fold(0.0, f32::max) };
    (bright > 0.0).then(|| (-bright.log2()).clamp(STOPS[0], STOPS[1])).map(tenths)
}

fn tenths(stops: f32) -> f32 {
    (10.0 * stops).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray(value: f32) -> [f32; 4] {
        [value, value, value, 1.0]
    }

    #[test]
    fn bright_pixels_are_shown_as_one_and_fireflies_do_not_count() {
        let mut pixels = vec![gray(0.25); 990];
        pixels.extend([gray(1.0e6); 10]);
        assert_eq!(auto_exposure(&pixels), Some(2.0));
        pixels.extend([gray(4.0); 100]);
        assert_eq!(auto_exposure(&pixels), Some(-2.0));
    }

    #[test]
    fn a_spark_in_the_dark_is_exposed_and_the_dark_is_not() {
        let mut pixels = vec![gray(0.0); 999];
        assert_eq!(auto_exposure(&pixels), None);
        pixels.push(gray(0.5));
        assert_eq!(auto_exposure(&pixels), Some(1.0));
        assert_eq!(auto_exposure(&[]), None);
        assert_eq!(auto_exposure(&[[f32::NAN; 4]]), None);
    }
}
