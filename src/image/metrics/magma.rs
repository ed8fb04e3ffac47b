//! The colors that FLIP's authors give to errors.

/// Every sixteenth color of magma, a ramp from black through violet and orange to pale yellow whose
/// lightness rises evenly, as 8-bit sRGB (Smith and van der Walt for matplotlib, 2015, CC0).
const STOPS: [[u8; 3]; 17] = [
    [0, 0, 4],
    [10, 8, 34],
    [29, 17, 70],
    [54, 16, 106],
    [80, 18, 124],
    [105, 28, 129],
    [130, 38, 129],
    [156, 46, 127],
    [182, 55, 121],
    [207, 65, 112],
    [230, 81, 99],
    [245, 105, 92],
    [251, 135, 97],
    [254, 165, 113],
    [254, 195, 135],
    [253, 224, 162],
    [252, 253, 191],
];

/// The 8-bit sRGB color of a value in 0..=1; within 3 codes of matplotlib's table.
pub fn magma(value: f32) -> [u8; 3] {
    let last = STOPS.len() - 1;
    let place = value.clamp(0.0, 1.0) * last as f32;
    let index = (place as usize).min(last - 1);
    let part = place - index as f32;
    std::array::from_fn(|channel| {
        let [low, high] = [index, index + 1].map(|stop| f32::from(STOPS[stop][channel]));
        (low + part * (high - low)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values and colors of maps by the authors' `flip-evaluator` 1.7.
    #[test]
    fn colors_are_those_of_the_authors_maps() {
        let theirs = [
            (0.0, [0, 0, 4]),
            (0.402_743, [142, 42, 129]),
            (0.737_474, [250, 129, 95]),
            (0.960_280, [253, 235, 172]),
            (0.967_388, [252, 238, 176]),
            (1.0, [252, 253, 191]),
        ];
        for (value, color) in theirs {
            let ours = magma(value);
            let near = std::iter::zip(ours, color).all(|(a, b): (u8, u8)| a.abs_diff(b) <= 3);
            assert!(near, "{value}: {ours:?} and {color:?}");
        }
        assert_eq!((magma(-1.0), magma(2.0)), (magma(0.0), magma(1.0)));
        assert_eq!(magma(f32::NAN)[0], 0);
    }
}
