//! From a scene file to a picture: parse, assemble, render, save.
//!
//! `cargo run --release --example render -- [SCENE] [PNG]` renders a small picture of a scene file, a
//! volume or one of the scenes that Flambeau brings along, `builtin:torch` unless another is named.

use std::path::Path;
use std::sync::{Arc, atomic::AtomicBool};

use flambeau::error::{NO_PROGRESS, Result};
use flambeau::image::{png, tone::Tone};
use flambeau::render::{RenderJob, picture, render_headless, schedule::Limits};
use flambeau::scene::{self, VolumeCache};
use flambeau::transport::Frame;
use glam::UVec2;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let source = arguments.next().unwrap_or_else(|| scene::DEFAULT_SCENE.to_owned());
    let file = arguments.next().unwrap_or_else(|| "render.png".to_owned());

    let settings = scene::load(&source)?;
    let scene = scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS)?;
    let (size, limits) = (UVec2::new(96, 54), Limits { spp: 16, seconds: None });
    let sampler = Arc::new(Frame::new(Arc::new(scene), size, settings.film.seed, NO_PROGRESS)?);
    let job = RenderJob { sampler, size, limits, resume: None, threads: None };
    let film = render_headless(job, &AtomicBool::new(false), &mut |_, _| {})?.film;

    let mut pixels = Vec::new();
    picture::resolve(&film, &mut pixels);
    png::write(Path::new(&file), size, &pixels, Tone::default())
}
