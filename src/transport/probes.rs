//! Probes: spheres spread over the medium that estimate the light around them and guide scattering
//! along rays to where the light is (Huang et al. 2021, section 3).
//!
//! Probes fill the leaves of an octree that is finer where more light is scattered, so that each
//! probe stands for about the same amount of scattered light. A probe keeps the directions that its
//! light comes from instead of the talk's score for one camera: the score towards any ray is
//! computed from them, μ_s ∫ L ρ dω, and weighted by the transmittance along the ray. So probes
//! serve every vertex, and stay valid when the camera moves.
//!
//! Probes see the volumes at the time of the frame, however they move while the shutter is open.
//!
//! Probes only guide: whatever they estimate, the picture's mean is unchanged, as long as no sample
//! changes the density that guides it.

mod airlight;
mod brightness;
mod caustic_lobes;
mod caustics;
mod distance_pdf;
mod light_scores;
mod octree;
mod place;
mod probe;
#[allow(clippy::module_inception, reason = "the folder is named after its main type")]
mod probes;
pub(super) mod stages;
mod view;

pub use brightness::Brightness;
pub(super) use caustic_lobes::CausticLobe;
pub use distance_pdf::DistancePdf;
pub(super) use probe::{Indirect, PathSums};
pub use probes::Probes;
pub(super) use probes::Surroundings;
pub use view::ProbeView;
