//! The curves along a ray: names, colors and values.

use egui::Color32;

use crate::app::ui::theme::color;
use crate::transport::profile::ProfileRow;

/// A curve as the legend explains it.
pub struct RayCurve {
    /// Name of the curve.
    pub name: &'static str,
    /// Unit of the values.
    pub unit: &'static str,
    /// Meaning of the curve.
    pub help: &'static str,
    /// Color of the curve.
    pub color: Color32,
    /// Value of the curve in a row.
    pub value: fn(&ProfileRow) -> f32,
}

/// The curves over 1/length.
pub const DENSITIES: [RayCurve; 3] = [
    RayCurve {
        name: "Extinction",
        unit: "1/length",
        help: "μ_t: absorption plus scattering coefficient of the medium.",
        color: color::CURVE,
        value: |row| row.mu_t,
    },
    RayCurve {
        name: "Null-collision pdf",
        unit: "1/length",
        help: "p_null = μ_t T: the pdf of scattering here by null-collision sampling.",
        color: color::CURVE_CHANCE,
        value: |row| row.p_null,
    },
    RayCurve {
        name: "Probe pdf",
        unit: "1/length",
        help: "p_select: the pdf of scattering here by probes and equiangular sampling.",
        color: color::CURVE_PROBES,
        value: |row| row.p_select,
    },
];

/// The curves from 0 to 1; the emission as a share of its peak.
pub const SHARES: [RayCurve; 4] = [
    RayCurve {
        name: "Transmittance",
        unit: "",
        help: "T: the fraction of light transmitted from here to the camera.",
        color: color::CURVE,
        value: |row| row.transmittance,
    },
    RayCurve {
        name: "Emission",
        unit: "radiance/length",
        help: "ε: the radiance that the medium emits per unit length. The curve is relative to its \
               peak.",
        color: color::CURVE_EMISSION,
        value: |row| row.emission,
    },
    RayCurve {
        name: "Null-collision weight",
        unit: "",
        help: "The MIS weight of scattering here by null-collision sampling.",
        color: color::CURVE_CHANCE,
        value: |row| row.weight_null,
    },
    RayCurve {
        name: "Probe weight",
        unit: "",
        help: "The MIS weight of scattering here by probes and equiangular sampling.",
        color: color::CURVE_PROBES,
        value: |row| row.weight_guided,
    },
];
