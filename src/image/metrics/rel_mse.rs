//! The relative mean squared error.

use rayon::prelude::*;

use super::ErrorMap;
use crate::error::Result;
use crate::image::reference::Reference;

/// Added to the squared reference, so that dark pixels count for little and black ones don't divide
/// by zero; in squared units of radiance, so that a picture's exposure matters.
pub const REL_MSE_FLOOR: f64 = 0.01;

/// The relative mean squared error of linear `picture`: (x − r)² / (r² + [`REL_MSE_FLOOR`]) of each
/// of R, G and B, averaged over the three in the map, and over all pixels in the mean.
///
/// The mean falls as one over the samples while all that is wrong is noise. A pixel of `picture`
/// that is not finite makes its error so. The measure is that of Rousselle, Knaus and Zwicker,
/// "Adaptive Sampling and Reconstruction using Greedy Error Minimization", 2011. Runs on the
/// threads of the calling pool.
///
/// # Errors
/// When `picture` has another number of pixels than the reference.
pub fn rel_mse(picture: &[[f32; 4]], reference: &Reference) -> Result<ErrorMap> {
    reference.check_pixels(picture)?;
    let map = (picture, reference.pixels()).into_par_iter().map(|(x, r)| error_of(x, r)).collect();
    Ok(ErrorMap::new(reference.size(), map))
}

fn error_of(pixel: &[f32; 4], reference: &[f32; 4]) -> f32 {
    let error = |channel: usize| {
        let (x, r) = (f64::from(pixel[channel]), f64::from(reference[channel]));
        (x - r).powi(2) / (r * r + REL_MSE_FLOOR)
    };
    ((error(0) + error(1) + error(2)) / 3.0) as f32
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    fn reference(pixels: Vec<[f32; 4]>) -> Reference {
        Reference::new("test", UVec2::new(pixels.len() as u32, 1), pixels).unwrap()
    }

    #[test]
    fn constants_are_as_computed_by_hand() {
        // R: 0.1² / (0² + 0.01) = 1; G: 0.2² / (0.3² + 0.01) = 0.4; B: the same, so 0. A is no
        // color.
        let dark = [[0.0, 0.3, 7.0, 1.0], [0.0, 0.0, 0.0, 1.0]];
        let errors = rel_mse(&[[0.1, 0.5, 7.0, 0.0], [0.0; 4]], &reference(dark.to_vec())).unwrap();
        assert!((errors.map[0] - 1.4 / 3.0).abs() < 1e-6, "{:?}", errors.map);
        assert_eq!(errors.map[1], 0.0);
        assert!((errors.mean - 0.7 / 3.0).abs() < 1e-7, "{}", errors.mean);
        assert_eq!(errors.size, UVec2::new(2, 1));
    }

    #[test]
    fn bright_values_keep_their_digits() {
        let reference = reference(vec![[1.0e20, 1.0e20, 1.0e20, 1.0]]);
        let errors = rel_mse(&[[2.0e20, 2.0e20, 2.0e20, 1.0]], &reference).unwrap();
        assert!((errors.mean - 1.0).abs() < 1e-6, "{}", errors.mean);
    }

    #[test]
    fn another_number_of_pixels_is_told() {
        let error = rel_mse(&[[0.0; 4]; 3], &reference(vec![[0.0; 4]; 2])).unwrap_err().to_string();
        assert!(
            error.contains("test") && error.contains("2 x 1") && error.contains('3'),
            "{error}"
        );
    }
}
