//! Flambeau: interactive, progressive preview of fire, smoke, fog and cloud, in which sampling
//! strategies are switched on and off live while the picture stays the same and only its noise and
//! cost change.
//!
//! # Rooms
//!
//! Arrows point down only; the core knows neither the scene file nor the window.
//!
//! | room | what it holds |
//! |---|---|
//! | `app` | the window (feature `gui`): one file a panel, commands in one enum, one theme |
//! | [`cli`] | the command line: one file a command |
//! | [`scene`] | scene files: the one settings struct, its keys, parsing, saving, building |
//! | [`render`] | film, schedule, the threads that sample, pictures for the window, two renders compared |
//! | [`image`] | EXR, PNG, NPY, tone mapping, maps and plots, references, error metrics |
//! | [`transport`] | how light moves: read [`transport::path`] first, then [`transport::tracking`] |
//! | [`light`], [`surface`], [`volume`] | what emits, what reflects, what fills space |
//! | [`sampling`], [`math`] | samplers with their densities, MIS weights; rays, boxes, random numbers |
//! | [`format`](mod@format) | numbers in words |
//! | [`files`] | writing a file whole or not at all, telling its states apart |
//! | [`error`] | what can go wrong, in words |
//!
//! # Conventions
//!
//! - The world is right-handed; lengths are in any one unit; colors are linear Rec.709.
//! - Coefficients (`mu_t`, `mu_s`, `majorant`) are per unit of world length, emission is radiance
//!   per unit of world length.
//! - Directions point away from the surface or collision they belong to, except the phase
//!   function's, which are directions of propagation before and after.
//! - Transforms carry both ends in their names: `world_from_local` takes local coordinates to the
//!   world. Densities carry their measure: `pdf_solid_angle`.
//! - (scene, strategy, seed, pixel, sample) fixes a path, whatever the number of threads.
//!
//! The estimators follow Huang, Kutz, Li and Chiang, *Unbiased Emission and Scattering Importance
//! Sampling for Heterogeneous Volumes*, SIGGRAPH 2021 Talks, and the papers named where they are
//! used.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

#[cfg(feature = "gui")]
pub mod app;
pub mod cli;
pub mod error;
pub mod files;
pub mod format;
pub mod image;
pub mod light;
pub mod math;
pub mod render;
pub mod sampling;
pub mod scene;
pub mod surface;
pub mod transport;
pub mod volume;
