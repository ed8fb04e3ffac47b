//! Exposure as color: each stop from middle gray has its own.

/// Linear light of middle gray.
pub const MIDDLE_GRAY: f32 = 0.18;
/// Stops below and above middle gray that have a color.
pub const STOPS: i32 = 8;

/// sRGB codes of the stops from -[`STOPS`] to [`STOPS`]: violet and blue where nothing much shows,
/// green at middle gray between two grays, yellow to red where the curve rolls off, white beyond.
pub const COLORS: [[u8; 3]; 17] = [
    [0x12, 0x06, 0x1f],
    [0x2a, 0x0f, 0x45],
    [0x45, 0x1a, 0x78],
    [0x3b, 0x2f, 0xa8],
    [0x1f, 0x55, 0xc4],
    [0x12, 0x82, 0xb8],
    [0x17, 0x8f, 0x86],
    [0x55, 0x55, 0x55],
    [0x4f, 0xa8, 0x4a],
    [0xa8, 0xa8, 0xa8],
    [0xe3, 0xd2, 0x4b],
    [0xf2, 0xa8, 0x3a],
    [0xf0, 0x76, 0x3c],
    [0xe2, 0x43, 0x3c],
    [0xc8, 0x1e, 0x5a],
    [0xff, 0x7a, 0xc8],
    [0xff, 0xff, 0xff],
];

/// The color of an exposed `luminance`.
pub fn code(luminance: f32) -> [u8; 3] {
    let stop = (luminance.max(f32::MIN_POSITIVE) / MIDDLE_GRAY).log2().round();
    let index = (stop + STOPS as f32).clamp(0.0, (COLORS.len() - 1) as f32);
    COLORS[index as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stop_has_a_color_and_what_is_beyond_the_last_ones() {
        assert_eq!(code(MIDDLE_GRAY), COLORS[8]);
        assert_eq!(code(4.0 * MIDDLE_GRAY), COLORS[10]);
        assert_eq!(code(MIDDLE_GRAY / 8.0), COLORS[5]);
        for dark in [0.0, -1.0, f32::NAN] {
            assert_eq!(code(dark), COLORS[0]);
        }
        assert_eq!(code(f32::INFINITY), COLORS[16]);
        let mut distinct = COLORS;
        distinct.sort_unstable();
        assert!(distinct.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
