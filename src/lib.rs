//! Flambeau: interactive, progressive preview of fire, smoke, fog and cloud, in which sampling
//! strategies are switched on and off live while the picture stays the same and only its noise and
//! cost change.
//!
//! # Rooms
//!
//! Each room imports from rooms above it in this table only, and `tests/rooms` checks that. The
//! core, which is every room above [`scene`] in the table, depends neither on the scene file nor on
//! the window, but for [`transport::strategy`], which is also the scene file's `[strategy]` table.
//!
//! | room | contents |
//! |---|---|
//! | [`error`] | errors that name file, field and fix; progress and cancellation |
//! | [`format`](mod@format) | numbers in words |
//! | [`math`] | rays, boxes, frames, random numbers |
//! | [`files`] | files written whole or not at all, and changes to them detected |
//! | [`sampling`] | samplers with their densities, MIS weights |
//! | [`surface`], [`volume`] | shapes with their BSDFs; participating media |
//! | [`light`] | lights, and the choice of one among many |
//! | [`transport`] | light transport: [`transport::path`] first, then [`transport::tracking`] |
//! | [`render`] | film, schedule, sampling threads, pictures for the window, renders compared |
//! | [`image`] | EXR, PNG, NPY, tone mapping, maps and plots, references, error metrics |
//! | [`scene`] | scene files: the one settings struct, its keys, parsing, saving, assembling |
//! | `app` | the window (feature `gui`): panels of settings, a folder for each feature, the shell |
//! | [`cli`] | the command line: one file a command |
//!
//! # A picture
//!
//! Text becomes settings, and settings become a scene. A frame is the scene prepared for a size of
//! picture; its samples fill a film:
//!
//! ```
//! use std::{path::Path, sync::{Arc, atomic::AtomicBool}};
//! use flambeau::error::NO_PROGRESS;
//! use flambeau::image::{png, tone::Tone};
//! use flambeau::render::{RenderJob, picture, render_headless, schedule::Limits};
//! use flambeau::scene::{self, Overrides, VolumeCache};
//! use flambeau::transport::Frame;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = "
//!     camera.position = [0, -4, 0]
//!     environment.radiance = 0.2
//!     [[volume]]
//!     shape = 'sphere'
//!     radius = 1.0
//!     density.scale = 2.0
//!     emission = { mode = 'source', le = [3.0, 1.0, 0.2] }
//! ";
//! let settings = scene::parse(text, "fire", Path::new("."), &Overrides::default())?;
//! let scene = scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS)?;
//! let (size, limits) = (glam::UVec2::new(24, 16), Limits { spp: 2, seconds: None });
//! let sampler = Arc::new(Frame::new(Arc::new(scene), size, settings.film.seed, NO_PROGRESS)?);
//! let job = RenderJob { sampler, size, limits, resume: None, threads: None };
//! let film = render_headless(job, &AtomicBool::new(false), &mut |_, _| {})?.film;
//!
//! let mut pixels = Vec::new();
//! picture::resolve(&film, &mut pixels);
//! let folder = tempfile::tempdir()?;
//! png::write(&folder.path().join("fire.png"), size, &pixels, Tone::default())?;
//! assert!(pixels.iter().any(|[red, _, blue, _]| red > blue), "fire is red");
//! # Ok(())
//! # }
//! ```
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
