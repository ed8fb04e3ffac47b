//! Measures of the error against a reference, and the quantity that is plotted over time.

use crate::app::ui::widgets::significant;
use crate::image::metrics::{ErrorMap, Errors};
use crate::render::Area;

/// Measure of the error against a reference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Measure {
    /// Squared errors in linear light, relative to the reference.
    #[default]
    RelMse,
    /// FLIP: the difference seen when flipping between the displayed pictures.
    Flip,
}

impl Measure {
    /// Both measures.
    pub const ALL: [Self; 2] = [Self::RelMse, Self::Flip];

    /// Name of the measure.
    pub fn name(self) -> &'static str {
        match self {
            Self::RelMse => "relMSE",
            Self::Flip => "FLIP",
        }
    }

    /// The errors of this kind.
    pub fn of(self, errors: &Errors) -> &ErrorMap {
        match self {
            Self::RelMse => &errors.rel_mse,
            Self::Flip => &errors.flip,
        }
    }

    /// Mean error over an area, or over the whole picture.
    pub fn mean(self, errors: &Errors, area: Option<Area>) -> f64 {
        let map = self.of(errors);
        area.map_or(map.mean, |area| map.mean_of(area.first, area.size))
    }
}

/// The quantity that is plotted over time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Plotted {
    /// The noise.
    #[default]
    Noise,
    /// An error against the reference.
    Error(Measure),
}

impl Plotted {
    /// Name of the quantity.
    pub fn name(self) -> &'static str {
        match self {
            Self::Noise => "Noise",
            Self::Error(measure) => measure.name(),
        }
    }

    /// An explanation of the plot.
    pub fn help(self) -> &'static str {
        match self {
            Self::Noise => {
                "Noise (relative standard error) over CPU time. It falls along the dotted slope: \
                 half the noise takes four times the time. The lower line is the better strategy."
            }
            Self::Error(Measure::RelMse) => {
                "Relative squared error over CPU time. Noise falls along the dotted slope: half \
                 the error takes twice the time. A line that levels off is biased, or has reached \
                 the noise of the reference."
            }
            Self::Error(Measure::Flip) => {
                "FLIP over CPU time: the difference one perceives when flipping between the \
                 displayed picture and the reference."
            }
        }
    }

    /// Exponent of time with which the quantity falls while all of it is noise, if there is one.
    pub fn power(self) -> Option<f64> {
        match self {
            Self::Noise => Some(0.5),
            Self::Error(Measure::RelMse) => Some(1.0),
            Self::Error(Measure::Flip) => None,
        }
    }

    /// `value` with its unit, as the axis writes it.
    pub fn label(self, value: f64) -> String {
        match self {
            Self::Noise => format!("{} %", significant(100.0 * value)),
            Self::Error(_) => significant(value),
        }
    }
}
