//! Lights: those that a vertex samples directly, those that a scattered ray meets, and the
//! densities of both.

mod choice;
mod emitter;
mod environment;
mod kinds;
mod light_scores;
mod lights;
mod local;
mod sample;
mod selector;
mod sun;
mod tree;

pub use choice::{By, ChosenLight, LightChoice, LightGroup};
pub use emitter::{Emitter, Receiver};
pub use environment::{ClearSky, Environment, Gradient, Orientation, Radiance, RadianceMap, Up};
pub use kinds::Light;
pub use light_scores::{LightProbabilities, LightScores, Visibility};
pub use lights::Lights;
pub use local::{Point, Spot};
pub use sample::LightSample;
pub use sun::Sun;
pub use tree::LightTree;
