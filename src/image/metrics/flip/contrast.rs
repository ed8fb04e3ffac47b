//! Contrast sensitivity of the eye as blurs of the three opponent channels.

use std::f64::consts::PI;

use super::filter::{across, down};

/// A Gaussian a √(π/b) exp(−π² x² / b) of x degrees.
#[derive(Clone, Copy)]
struct GaussianTerm {
    a: f64,
    b: f64,
}

/// The paper's fits of measured contrast sensitivity: lightness, red against green, and yellow
/// against blue, which is a sum of two.
const LOBES: [&[GaussianTerm]; 3] = [
    &[GaussianTerm { a: 1.0, b: 0.0047 }],
    &[GaussianTerm { a: 1.0, b: 0.0053 }],
    &[GaussianTerm { a: 34.1, b: 0.04 }, GaussianTerm { a: 13.5, b: 0.025 }],
];

/// The widest b of all lobes, which decides where all kernels end.
const WIDEST: f64 = 0.04;

/// The blurs of the opponent channels at one distance.
#[derive(Clone, Debug)]
pub struct Contrast {
    /// The kernels whose blurs a channel is the sum of, each the same across and down.
    kernels: [Vec<Kernel>; 3],
}

#[derive(Clone, Debug)]
struct Kernel {
    taps: Vec<f32>,
    /// Weight of this Gaussian in the sum.
    weight: f32,
}

impl Contrast {
    /// The blurs at so many pixels per degree.
    pub fn new(pixels_per_degree: f64) -> Self {
        // Three standard deviations of the widest lobe.
        let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
        Self { kernels: LOBES.map(|lobes| kernels(lobes, radius, pixels_per_degree)) }
    }

    /// The blur of `plane` in lines of `width`, as of `channel`.
    pub fn blur(&self, channel: usize, plane: &[f32], width: usize) -> Vec<f32> {
        let mut sum = vec![0.0; plane.len()];
        for kernel in &self.kernels[channel] {
            let lines = across(plane, width, &kernel.taps);
            down(&lines, width, &kernel.taps, kernel.weight, &mut sum);
        }
        sum
    }
}

/// Kernels that together leave a constant as it is.
fn kernels(lobes: &[GaussianTerm], radius: i32, pixels_per_degree: f64) -> Vec<Kernel> {
    let kernel = |lobe: &GaussianTerm| {
        let taps: Vec<f64> = (-radius..=radius)
            .map(|x| (-(PI * f64::from(x) / pixels_per_degree).powi(2) / lobe.b).exp())
            .collect();
        let sum: f64 = taps.iter().sum();
        let taps = taps.iter().map(|tap| (tap / sum) as f32).collect();
        (taps, lobe.a * (PI / lobe.b).sqrt() * sum * sum)
    };
    let kernels: Vec<(Vec<f32>, f64)> = lobes.iter().map(kernel).collect();
    let all: f64 = kernels.iter().map(|(_, weight)| weight).sum();
    let share = |(taps, weight)| Kernel { taps, weight: (weight / all) as f32 };
    kernels.into_iter().map(share).collect()
}
