//! The choice of one light among many.

use super::kinds::Light;
use super::light_scores::LightProbabilities;

/// The lights that take part in the choice, and the method of choosing one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightChoice {
    /// Lights that take part.
    pub among: LightGroup,
    /// Method of the choice.
    pub by: By,
}

/// Some of the lights of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightGroup {
    /// All lights.
    All,
    /// Emissive volumes.
    Fires,
    /// All lights but emissive volumes.
    Lamps,
}

/// Method of choosing a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum By {
    /// In proportion to the irradiance that the hierarchy (a light tree) estimates.
    Hierarchy,
    /// With the same probability for each light, wherever it is.
    Uniform,
    /// By probabilities from the scores of a probe, which hold for one receiver.
    Shares(LightProbabilities),
}

/// A chosen light.
#[derive(Clone, Copy, Debug)]
pub struct ChosenLight<'s> {
    /// Index of the light in the scene.
    pub index: u32,
    /// The light.
    pub light: &'s Light,
    /// Probability of the choice.
    pub probability: f32,
}
