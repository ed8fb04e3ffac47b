//! Figures of one side of a comparison.

use crate::transport::spending::Spending;

/// Figures of one side. Colors are linear; gray is (R + G + B) / 3; means run over the pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SideFigures {
    /// Mean number of samples of a pixel.
    pub samples_per_pixel: f64,
    /// Samples of the pixel that has fewest.
    pub fewest_samples: u32,
    /// CPU time of the threads that sampled the whole film, in seconds.
    pub cpu_seconds: f64,
    /// Mean color.
    pub mean_rgb: [f64; 3],
    /// Mean over the pixels of the variance of the gray mean; none where no pixel has two samples.
    pub variance_of_mean: Option<f64>,
    /// Standard error of the variance; `None` where the variance is unknown.
    pub variance_error: Option<f64>,
    /// Relative standard error of the picture, as
    /// [`FilmStats::noise`](crate::render::FilmStats::noise).
    pub noise: Option<f64>,
    /// How the time is spent, where that was counted.
    pub spending: Option<Spending>,
}

impl SideFigures {
    /// Whether no sample differed from another of its pixel.
    pub fn is_noiseless(&self) -> bool {
        self.variance_of_mean == Some(0.0)
    }

    /// Variance of the mean times CPU time, which hardly changes as a render goes on, with its
    /// relative standard error; none where there is no noise or no measured time.
    pub fn variance_times_time(&self) -> Option<(f64, f64)> {
        let variance = self.variance_of_mean.filter(|&variance| variance > 0.0)?;
        let relative_error = self.variance_error? / variance;
        (self.cpu_seconds > 0.0).then_some((variance * self.cpu_seconds, relative_error))
    }
}
