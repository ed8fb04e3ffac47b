//! Edges and points: what strikes the eye first.

use std::f64::consts::FRAC_1_SQRT_2;

use rayon::prelude::*;

use super::filter::{across, down};

/// Width of the detectors in degrees, between the edges of the negative and the positive part (w of
/// the paper).
const WIDTH_IN_DEGREES: f64 = 0.082;

/// Kernels that find features at one distance; each works along one axis while the Gaussian smooths
/// along the other.
#[derive(Clone, Debug)]
pub struct Detectors {
    smooth: Vec<f32>,
    /// First derivative of the Gaussian.
    edge: Vec<f32>,
    /// Second derivative of the Gaussian, which detects points.
    point: Vec<f32>,
}

/// Strength of edges and points in every pixel.
#[derive(Clone, Debug)]
pub struct Features {
    edges: Vec<f32>,
    points: Vec<f32>,
}

impl Detectors {
    /// The detectors at so many pixels per degree.
    pub fn new(pixels_per_degree: f64) -> Self {
        let deviation = 0.5 * WIDTH_IN_DEGREES * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as i32;
        let kernel = |shape: fn(f64) -> f64| {
            let tap = |x: i32| {
                let x = f64::from(x) / deviation;
                shape(x) * (-0.5 * x * x).exp()
            };
            normalized((-radius..=radius).map(tap).collect())
        };
        Self { smooth: kernel(|_| 1.0), edge: kernel(|x| -x), point: kernel(|x| x * x - 1.0) }
    }

    /// The features of lightness in 0..=1, in lines of `width`.
    pub fn detect(&self, lightness: &[f32], width: usize) -> Features {
        let smooth = across(lightness, width, &self.smooth);
        let strength = |kernel: &[f32]| {
            let [mut along_x, mut along_y] = [vec![0.0; smooth.len()], vec![0.0; smooth.len()]];
            down(&across(lightness, width, kernel), width, &self.smooth, 1.0, &mut along_x);
            down(&smooth, width, kernel, 1.0, &mut along_y);
            along_x.par_iter_mut().zip(along_y).for_each(|(x, y)| *x = x.hypot(y));
            along_x
        };
        Features { edges: strength(&self.edge), points: strength(&self.point) }
    }
}

impl Features {
    /// Difference of the features of every pixel, in 0..=1: the larger of edges and points.
    pub fn difference(&self, other: &Self) -> Vec<f32> {
        (&self.edges, &other.edges, &self.points, &other.points)
            .into_par_iter()
            .map(|(edge_a, edge_b, point_a, point_b)| {
                let difference = (edge_a - edge_b).abs().max((point_a - point_b).abs());
                (FRAC_1_SQRT_2 as f32 * difference).min(1.0)
            })
            .collect()
    }
}

/// Scales the positive taps to a sum of 1, and the negative ones to a sum of -1.
fn normalized(taps: Vec<f64>) -> Vec<f32> {
    let positive: f64 = taps.iter().filter(|tap| **tap > 0.0).sum();
    let negative: f64 = taps.iter().filter(|tap| **tap < 0.0).sum();
    let scale = |tap: f64| if tap > 0.0 { tap / positive } else { -tap / negative };
    taps.into_iter().map(|tap| if tap == 0.0 { 0.0 } else { scale(tap) as f32 }).collect()
}
