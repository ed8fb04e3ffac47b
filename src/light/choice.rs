//! How one light is chosen among many.

use super::kinds::Light;
use super::scores::LightProbabilities;

/// Which lights take part, and how one is chosen among them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightChoice {
    /// Emissive volumes are among them.
    pub volumes: bool,
    /// How one is chosen.
    pub by: By,
}

/// How a light is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum By {
    /// By what the hierarchy thinks it may bring.
    Hierarchy,
    /// Each has the same probability, wherever it is.
    Uniform,
    /// By what is known of the place. They hold for one receiver.
    Shares(LightProbabilities),
}

/// A light that was chosen.
#[derive(Clone, Copy, Debug)]
pub struct ChosenLight<'s> {
    /// Its index in the scene.
    pub index: u32,
    /// The light.
    pub light: &'s Light,
    /// With which probability.
    pub probability: f32,
}
