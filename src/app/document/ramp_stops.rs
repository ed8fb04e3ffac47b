//! Editing the stops of a color ramp as pure functions. Stops are [value, r, g, b] in ascending
//! order of value, at least one.

use std::ops::RangeInclusive;

use crate::math::Rgb;
use crate::volume::emission::color_at;

/// Neighbors stay this far apart, as a share of what the ramp spans.
const LEAST_GAP: f32 = 1e-3;

/// A stop.
pub type Stop = [f32; 4];

/// The color of the ramp at `value`.
pub fn color(stops: &[Stop], value: f32) -> Rgb {
    let pairs: Vec<(f32, Rgb)> =
        stops.iter().map(|&[value, r, g, b]| (value, Rgb::new(r, g, b))).collect();
    color_at(&pairs, value)
}

/// Adds a stop at `value` with the color that the ramp has there, so that nothing changes; the
/// index of the stop that is there now.
pub fn add(stops: &mut Vec<Stop>, value: f32) -> usize {
    let index = stops.partition_point(|stop| stop[0] < value);
    if stops.get(index).is_none_or(|stop| stop[0] > value) {
        let color = color(stops, value).to_array();
        stops.insert(index, [value, color[0], color[1], color[2]]);
    }
    index
}

/// Adds a stop where there is most room for one; its index.
pub fn add_anywhere(stops: &mut Vec<Stop>, span: &RangeInclusive<f32>) -> usize {
    let values = stops.iter().map(|stop| stop[0]);
    let edges: Vec<f32> =
        std::iter::once(*span.start()).chain(values).chain([*span.end()]).collect();
    let gaps = edges.iter().zip(edges.iter().skip(1));
    let widest = gaps.max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)));
    let middle = widest.map_or(*span.start(), |(low, high)| 0.5 * (low + high));
    add(stops, middle)
}

/// Moves a stop to `value`, as far as its neighbors and `within` let it.
pub fn shift(stops: &mut [Stop], index: usize, value: f32, within: &RangeInclusive<f32>) {
    let gap = LEAST_GAP * (within.end() - within.start()).clamp(f32::MIN_POSITIVE, f32::MAX);
    let before = index.checked_sub(1).and_then(|at| stops.get(at)).map(|stop| stop[0] + gap);
    let after = stops.get(index + 1).map(|stop| stop[0] - gap);
    let low = before.unwrap_or(*within.start());
    let high = after.unwrap_or(*within.end());
    if let Some(stop) = stops.get_mut(index)
        && low <= high
        && value.is_finite()
    {
        stop[0] = value.clamp(low, high);
    }
}

/// Takes a stop out, unless it is the last one; the index to go on with.
pub fn remove(stops: &mut Vec<Stop>, index: usize) -> usize {
    if stops.len() > 1 && index < stops.len() {
        stops.remove(index);
    }
    index.min(stops.len().saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const STOPS: [Stop; 3] = [[0.0; 4], [0.5, 1.0, 0.5, 0.0], [1.0, 3.0, 2.0, 1.0]];

    fn ascending(stops: &[Stop]) -> bool {
        stops.iter().zip(stops.iter().skip(1)).all(|(a, b)| a[0] < b[0])
    }

    #[test]
    fn a_stop_added_changes_no_color() {
        let mut stops = STOPS.to_vec();
        assert_eq!(add(&mut stops, 0.75), 2);
        assert_eq!(stops[2], [0.75, 2.0, 1.25, 0.5]);
        assert_eq!(add(&mut stops, 0.75), 2, "none twice");
        assert_eq!((add(&mut stops, 2.0), stops.len()), (4, 5));
        for value in [-1.0, 0.1, 0.5, 0.6, 0.9, 1.5, 3.0] {
            let off = color(&stops, value) - color(&STOPS, value);
            assert!(off.abs().max_element() < 1e-6, "at {value}");
        }
        assert_eq!(add_anywhere(&mut vec![[0.0; 4], [4.0; 4]], &(0.0..=5.0)), 1);
        assert_eq!(add_anywhere(&mut vec![[1.0; 4]], &(0.0..=5.0)), 1, "after the only one");
    }

    #[test]
    fn a_stop_never_passes_its_neighbors() {
        for value in [-9.0, 0.0, 0.2, 0.999_99, 1.0, 7.0, f32::NAN] {
            for index in 0..3 {
                let mut stops = STOPS.to_vec();
                shift(&mut stops, index, value, &(0.0..=2.0));
                assert!(ascending(&stops), "{index} to {value}: {stops:?}");
                assert!(stops[0][0] >= 0.0 && stops[2][0] <= 2.0);
            }
        }
        let mut stops = STOPS.to_vec();
        shift(&mut stops, 1, 0.7, &(0.0..=1.0));
        assert_eq!(stops[1], [0.7, 1.0, 0.5, 0.0]);
    }

    #[test]
    fn one_stop_always_stays() {
        let mut stops = STOPS.to_vec();
        assert_eq!(remove(&mut stops, 2), 1);
        assert_eq!(remove(&mut stops, 0), 0);
        assert_eq!(remove(&mut stops, 0), 0);
        assert_eq!(stops, [STOPS[1]]);
    }
}
