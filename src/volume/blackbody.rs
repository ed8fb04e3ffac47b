//! The color of a black body.

use std::sync::LazyLock;

use crate::math::{Rgb, luminance};

/// Spacing of the table in kelvin. Between its entries the color is linear by definition, so that
/// it is the same for every strategy.
const STEP: f32 = 10.0;
/// Entries of the table; it ends at 40 950 K, where the color no longer changes.
const ENTRIES: usize = 4096;

/// Linear Rec.709 color of a black body at `kelvin`, its spectrum scaled to a peak of 1, so that a
/// spectrum of constant 1 would have luminance 1. Negative channels (deep reds lie outside the
/// gamut) are cut to zero. Black at 0 K and below.
#[inline]
pub fn peak_normalized(kelvin: f32) -> Rgb {
    let place = (kelvin / STEP).clamp(0.0, (ENTRIES - 1) as f32 - 1e-3);
    let table = &TABLE.colors;
    let index = place as usize;
    table[index].lerp(table[index + 1], place - index as f32)
}

/// The largest luminance of [`peak_normalized`] between two temperatures.
pub fn peak_normalized_bound(kelvin_min: f32, kelvin_max: f32) -> f32 {
    let entry = |kelvin: f32| (kelvin / STEP).clamp(0.0, (ENTRIES - 1) as f32);
    let first = entry(kelvin_min).floor() as usize;
    let last = entry(kelvin_max).ceil() as usize;
    TABLE.range_max(first.min(last), last)
}

struct BlackbodyTable {
    colors: Vec<Rgb>,
    /// `maxima[level][i]`: largest luminance of the entries i .. i + 2^level.
    maxima: Vec<Vec<f32>>,
}

impl BlackbodyTable {
    fn new() -> Self {
        let colors: Vec<Rgb> = (0..ENTRIES).map(|i| color_of(i as f64 * f64::from(STEP))).collect();
        let mut maxima = vec![colors.iter().map(|&c| luminance(c)).collect::<Vec<f32>>()];
        let mut width = 1;
        while 2 * width <= ENTRIES {
            let finer = &maxima[maxima.len() - 1];
            let row = (0..=ENTRIES - 2 * width).map(|i| finer[i].max(finer[i + width])).collect();
            maxima.push(row);
            width *= 2;
        }
        Self { colors, maxima }
    }

    fn range_max(&self, first: usize, last: usize) -> f32 {
        let level = (last - first + 1).ilog2() as usize;
        let row = &self.maxima[level];
        row[first].max(row[last + 1 - (1 << level)])
    }
}

static TABLE: LazyLock<BlackbodyTable> = LazyLock::new(BlackbodyTable::new);

fn color_of(kelvin: f64) -> Rgb {
    filtered(kelvin, |_| 1.0)
}

/// Linear Rec.709 color of a black body behind a filter that lets `through` the share of the light
/// of each wavelength in nanometers; otherwise as [`peak_normalized`].
pub fn filtered(kelvin: f64, through: impl Fn(f64) -> f64) -> Rgb {
    if kelvin <= 0.0 {
        return Rgb::ZERO;
    }
    let (mut xyz, mut white) = ([0.0; 3], 0.0);
    for nanometers in (360..=830).step_by(5) {
        let matching = color_matching(f64::from(nanometers));
        let power = relative_planck(f64::from(nanometers) * 1e-9, kelvin);
        let power = power * through(f64::from(nanometers));
        for channel in 0..3 {
            xyz[channel] += power * matching[channel];
        }
        white += matching[1];
    }
    let [x, y, z] = xyz.map(|v| v / white);
    Rgb::new(
        (3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z) as f32,
        (-0.969_266_0 * x + 1.876_010_8 * y + 0.041_556_0 * z) as f32,
        (0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z) as f32,
    )
    .max(Rgb::ZERO)
}

/// Planck's law divided by its peak over wavelength (Wien: λ_max · T = 2.897 772 mm K).
fn relative_planck(wavelength: f64, kelvin: f64) -> f64 {
    /// h c / k in m K.
    const SECOND_RADIATION: f64 = 1.438_776_877e-2;
    const WIEN: f64 = 2.897_771_955e-3;
    let radiance =
        |lambda: f64| 1.0 / (lambda.powi(5) * ((SECOND_RADIATION / (lambda * kelvin)).exp() - 1.0));
    radiance(wavelength) / radiance(WIEN / kelvin)
}

/// CIE 1931 color matching functions, as the sums of lobes fitted by Wyman, Sloan and Shirley 2013
/// (*Simple Analytic Approximations to the CIE XYZ Color Matching Functions*).
fn color_matching(nanometers: f64) -> [f64; 3] {
    let lobe = |height: f64, center: f64, below: f64, above: f64| {
        let distance = nanometers - center;
        let t = distance * if distance < 0.0 { below } else { above };
        height * (-0.5 * t * t).exp()
    };
    [
        lobe(0.362, 442.0, 0.0624, 0.0374)
            + lobe(1.056, 599.8, 0.0264, 0.0323)
            + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn daylight_is_nearly_white_and_embers_are_red() {
        let white = peak_normalized(6504.0);
        assert!((white / luminance(white) - Rgb::ONE).abs().max_element() < 0.06, "{white}");
        let ember = peak_normalized(1500.0);
        assert!(ember.x > 2.0 * ember.y && ember.y > 5.0 * ember.z, "{ember}");
        assert_eq!(peak_normalized(-5.0), Rgb::ZERO);
        assert!(peak_normalized(1e9).is_finite());
    }

    #[test]
    fn the_bound_holds_over_its_interval() {
        for (low, high) in [(0.0, 900.0), (1500.0, 1504.0), (3000.0, 9000.0), (2e4, 1e6)] {
            let bound = peak_normalized_bound(low, high);
            for i in 0..=100 {
                let kelvin = low + (high - low) * i as f32 / 100.0;
                assert!(luminance(peak_normalized(kelvin)) <= bound * 1.000_01);
            }
        }
    }
}
