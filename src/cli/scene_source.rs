//! The scene that a command works on: loaded, with what the command line lays over it.

use clap::Args;
use glam::UVec2;

use super::Refusal;
use crate::error::{Progress, Result};
use crate::scene::{self, Overrides, Settings, VolumeCache};
use crate::transport::strategy::Preset;

/// Arguments that name a scene and change it.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// A scene file, a volume or `builtin:NAME`.
    #[arg(value_name = "SCENE|VOLUME")]
    scene: String,
    /// Sampling strategies: baseline, emission or full.
    #[arg(long, value_name = "NAME")]
    preset: Option<Preset>,
    /// Change a key of the scene, such as volume.0.density.scale=0.35 (see `flambeau keys`).
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Another seed gives the same picture with other noise.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: Option<u64>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<UVec2>,
}

impl SceneArguments {
    /// The settings as the commands see them. What was guessed for a bare volume is said on
    /// standard error. Mistakes on the command line are wrong usage, mistakes in files failures.
    pub fn settings(&self, cache: &VolumeCache, progress: Progress) -> Result<Settings, Refusal> {
        let opened = scene::open(&self.scene, &Overrides::default(), cache, progress)?;
        for note in &opened.notes {
            eprintln!("flambeau: {note}");
        }
        let overrides = Overrides { preset: self.preset, set: self.set.clone() };
        let mut settings = scene::apply(&opened.settings, &overrides).map_err(Refusal::usage)?;
        if let Some(size) = self.size {
            settings.film.size = size.to_array();
        }
        if let Some(seed) = self.seed {
            settings.film.seed = seed;
        }
        Ok(settings)
    }
}

fn parse_size(text: &str) -> Result<UVec2, String> {
    let sides =
        text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match sides {
        Some((width, height)) if (1..=16384).contains(&width) && (1..=16384).contains(&height) => {
            Ok(UVec2::new(width, height))
        }
        _ => Err("expected WIDTHxHEIGHT with sides of 1 to 16384, such as 960x540".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_two_numbers() {
        assert_eq!(parse_size("960x540"), Ok(UVec2::new(960, 540)));
        for wrong in ["960", "0x5", "5x0", "ax5", "5x5x5", "-5x5", "99999x5", ""] {
            assert!(parse_size(wrong).is_err(), "{wrong}");
        }
    }
}
