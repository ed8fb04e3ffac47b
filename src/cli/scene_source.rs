//! The scene that a command works on: loaded, with what the command line lays over it.

use clap::Args;
use glam::UVec2;

use super::console::warn;
use super::exit::Refusal;
use super::values::{file_name, parse_frame, parse_size, quoted};
use crate::error::{Error, Progress, Result};
use crate::scene::sequence::{Gap, Listings, volume_frame};
use crate::scene::settings::{MAX_SEED, TimeSettings};
use crate::scene::{self, Overrides, Settings, Setup, VolumeCache};
use crate::transport::Scene;
use crate::transport::strategy::Preset;

/// Arguments that name a scene and change it.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// A scene file (.toml), a volume (.vdb, .nvdb), a folder or pattern (fire_####.vdb) of
    /// numbered ones, or `builtin:NAME`.
    #[arg(value_name = "SCENE|VOLUME", value_parser = file_name())]
    scene: String,
    /// Sampling strategies: baseline, emission or full.
    #[arg(long, value_name = "NAME")]
    preset: Option<Preset>,
    /// Change a key of the scene, such as volume.0.density.scale=0.35 (see `flambeau keys`).
    #[arg(long, value_name = "KEY=VALUE", value_parser = file_name())]
    set: Vec<String>,
    /// Surroundings of a volume that is opened alone: studio, night or black.
    #[arg(long, value_name = "NAME")]
    setup: Option<Setup>,
    /// Another seed gives the same picture with other noise.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=MAX_SEED))]
    seed: Option<u64>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<UVec2>,
    /// The frame of a sequence.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_frame)]
    frame: Option<f64>,
    /// Where the file of a frame is missing, take the frame before instead of failing.
    #[arg(long)]
    allow_missing: bool,
}

impl SceneArguments {
    /// The settings as the commands see them. What was guessed for a bare volume is said on
    /// standard error. Mistakes on the command line are wrong usage, mistakes in files failures.
    pub fn settings(&self, cache: &VolumeCache, progress: Progress) -> Result<Settings, Refusal> {
        let mut opened = scene::open(&self.scene, &Overrides::default(), cache, progress)?;
        if let Some(setup) = self.setup {
            let Some(bounds) = opened.bounds else {
                let reason = "it is for a volume that is opened alone; leave it out";
                return Err(Refusal::usage(Error::invalid("--setup", "", reason)));
            };
            setup.apply(&mut opened.settings, &bounds);
        }
        for note in &opened.notes {
            warn(&note.to_string());
        }
        let overrides = Overrides { preset: self.preset, set: self.set.clone() };
        let mut settings = scene::apply(&opened.settings, &overrides).map_err(Refusal::usage)?;
        if let Some(size) = self.size {
            settings.film.size = size.to_array();
        }
        if let Some(seed) = self.seed {
            settings.film.seed = seed;
        }
        if let Some(frame) = self.frame {
            settings.time.frame = frame;
        }
        Ok(settings)
    }

    /// Refuses a frame whose files are missing, unless the command line allows it.
    ///
    /// # Errors
    /// Names the file that is missing.
    pub fn refuse_missing(&self, settings: &Settings) -> Result<()> {
        if self.allow_missing {
            return Ok(());
        }
        let mut listings = Listings::default();
        for volume in &settings.volume {
            let frame = volume_frame(volume, &settings.time, &mut listings)?;
            let Some(Gap::Frame { file, frame, held }) = frame.gap else { continue };
            let instead = match held {
                Some(held) => format!("renders frame {held}"),
                None => "renders nothing".to_owned(),
            };
            let reason =
                format!("frame {frame} is missing; --allow-missing {instead} in its place");
            return Err(Error::invalid(file, "", reason));
        }
        Ok(())
    }

    /// The scene of the settings. What its frame lacks is said on standard error, or refused.
    ///
    /// # Errors
    /// As [`scene::assemble`] and [`SceneArguments::refuse_missing`].
    pub fn assemble(
        &self,
        settings: &Settings,
        cache: &VolumeCache,
        progress: Progress,
    ) -> Result<Scene> {
        self.refuse_missing(settings)?;
        let assembled = scene::assemble_frame(settings, cache, progress)?;
        for gap in &assembled.gaps {
            warn(&format!("{}: {gap}", gap.file()));
        }
        Ok(assembled.scene)
    }

    /// The size that the command line asks for.
    pub fn size(&self) -> Option<UVec2> {
        self.size
    }

    /// The name of the scene on the command line.
    pub fn name(&self) -> &str {
        &self.scene
    }

    /// The arguments that lead another command to these `settings`, ready for a shell.
    pub fn in_words(&self, settings: &Settings) -> String {
        let mut words = vec![quoted(&self.scene)];
        if let Some(preset) = self.preset {
            words.push(format!("--preset {}", preset.name()));
        }
        words.extend(self.set.iter().map(|assignment| format!("--set {}", quoted(assignment))));
        let [width, height] = settings.film.size;
        words.push(format!("--size {width}x{height} --seed {}", settings.film.seed));
        if settings.time.frame != TimeSettings::default().frame {
            words.push(format!("--frame {}", settings.time.frame));
        }
        if self.allow_missing {
            words.push("--allow-missing".to_owned());
        }
        words.join(" ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(clap::Parser)]
    struct Line {
        #[command(flatten)]
        scene: SceneArguments,
    }

    /// Splits a line that a shell would split, without running one.
    fn split(line: &str) -> Vec<String> {
        let mut words = vec![String::new()];
        let (mut is_quoted, mut letters) = (false, line.chars());
        while let Some(letter) = letters.next() {
            match letter {
                '\'' => is_quoted = !is_quoted,
                '\\' if !is_quoted => words.last_mut().unwrap().extend(letters.next()),
                ' ' if !is_quoted => words.push(String::new()),
                other => words.last_mut().unwrap().push(other),
            }
        }
        words
    }

    #[test]
    fn arguments_in_words_lead_to_the_same_settings() {
        let given = [
            "x",
            "builtin:torch",
            "--preset",
            "baseline",
            "--set",
            "film.size=[31, 17]",
            "--set",
            "volume.0.name=\"it's a fire\"",
            "--seed",
            "77",
        ];
        let settings = |line: &Line| {
            let cache = VolumeCache::default();
            line.scene.settings(&cache, crate::error::NO_PROGRESS).map_err(|e| e.error).unwrap()
        };
        let line = <Line as clap::Parser>::parse_from(given);
        let expected = settings(&line);
        let words = line.scene.in_words(&expected);
        assert!(words.ends_with("--size 31x17 --seed 77"), "{words}");
        let again = std::iter::once("x".to_owned()).chain(split(&words));
        assert_eq!(settings(&<Line as clap::Parser>::parse_from(again)), expected);
    }
}
