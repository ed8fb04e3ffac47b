//! The scenes that are rendered: the scene files beside this one, those of other renderers, a shipped one.

use std::path::{Path, PathBuf};

use flambeau::{
    error::NO_PROGRESS,
    scene::{self, Overrides, VolumeCache},
    transport::Scene,
};

use super::which::Table;

/// A scene of the tables.
#[derive(Clone, Copy)]
pub struct BenchScene {
    /// Name of the scene in the tables and for filters.
    pub name: &'static str,
    /// Purpose of the scene.
    pub shows: &'static str,
    /// The tables that the scene is in.
    pub tables: &'static [Table],
    /// Whether choosing among lights matters in the scene.
    pub many_lights: bool,
    /// A circle of pixels, center and radius, that is left out of the variance: where a light is
    /// seen directly, hit or miss drowns what the scene is about.
    pub left_out: Option<([f32; 2], f32)>,
    file: &'static str,
    folder: Folder,
    set: &'static [&'static str],
}

/// Folder of a scene's volumes.
#[derive(Clone, Copy, PartialEq)]
enum Folder {
    /// The folder of the scene file.
    Own,
    /// The folder of scenes that other renderers have rendered, outside the repository.
    Peers,
}

const SCENES: &str = "benches/noise/scenes";

/// All scenes of the benchmark.
#[allow(clippy::too_many_lines, reason = "a table with one row for each scene")]
pub fn all() -> Vec<BenchScene> {
    let own = |name, shows, file| BenchScene {
        name,
        shows,
        file,
        folder: Folder::Own,
        tables: &[Table::Toggles],
        many_lights: false,
        left_out: None,
        set: &[],
    };
    let modes = |scene| BenchScene { tables: &[Table::Toggles, Table::Modes], ..scene };
    let lamps = |name, shows, set| BenchScene {
        tables: &[Table::Walks, Table::Distances],
        set,
        ..own(name, shows, "lamps.toml")
    };
    let peers = |name, shows, file| BenchScene { folder: Folder::Peers, ..own(name, shows, file) };
    let embedded = |name, shows, set| BenchScene {
        tables: &[Table::Distances],
        left_out: Some(([68.4, 68.2], 6.0)),
        set,
        ..peers(name, shows, "embedded.toml")
    };
    let shipped =
        |name, shows, file| BenchScene { tables: &[Table::NeverWorse], ..own(name, shows, file) };
    vec![
        shipped("torch", "the torch behind smoke that ships", "../../../scenes/torch.toml"),
        shipped("campfire", "the campfire that ships", "../../../scenes/campfire.toml"),
        shipped("explosion", "the explosion that ships", "../../../scenes/explosion.toml"),
        shipped("shipped_fog", "the fire in fog that ships", "../../../scenes/fog.toml"),
        shipped("shipped_cloud", "the cloud that ships", "../../../scenes/cloud.toml"),
        shipped("plume", "the plume that ships", "../../../scenes/plume.toml"),
        peers("peers_cloud", "a white cloud under an even sky", "peers_cloud.toml"),
        modes(peers("fire_absorb", "a flame that only absorbs", "fire_absorb.toml")),
        peers("fire_on_floor", "a flame, a floor, a glossy sphere", "fire_on_floor.toml"),
        modes(own("thin_fire", "fire with hardly any soot", "thin_fire.toml")),
        modes(own("behind_smoke_4", "fire behind smoke of optical depth 4", "behind_smoke.toml")),
        BenchScene {
            set: &["volume.1.density.scale=20.0"],
            ..own("behind_smoke_10", "fire behind smoke of optical depth 10", "behind_smoke.toml")
        },
        modes(own("floor_glossy", "fire on a floor, a rough glossy sphere", "floor_glossy.toml")),
        own("fog", "fire in thin fog that fills all of space", "fog.toml"),
        BenchScene {
            many_lights: true,
            set: &["film.size=[128, 128]", "environment.radiance=0.0"],
            ..own("street", "200 torches in thin fog", "../../../scenes/street.toml")
        },
        BenchScene {
            many_lights: true,
            ..own("rooms", "200 torches between walls, in thin fog", "rooms.toml")
        },
        embedded("embedded_1", "a lamp inside of a puff", &["volume.0.density.scale=1.0"]),
        embedded("embedded_3", "the same, three times as dense", &["volume.0.density.scale=3.0"]),
        embedded("embedded_10", "the same, ten times", &["volume.0.density.scale=10.0"]),
        embedded("embedded_30", "the same, thirty times", &["volume.0.density.scale=30.0"]),
        BenchScene {
            tables: &[Table::Distances],
            ..own("cloud", "a cloud under an even sky", "cloud.toml")
        },
        BenchScene {
            tables: &[Table::Distances],
            ..own("shafts", "sun and spot through gaps into uneven mist", "shafts.toml")
        },
        BenchScene {
            tables: &[Table::Distances],
            ..own("caustic", "a mirror throws light into mist", "caustic.toml")
        },
        BenchScene {
            tables: &[Table::Distances],
            ..own("caustic_unfolded", "the same light without a mirror", "caustic_unfolded.toml")
        },
        own("no_soot", "fire without extinction, on a floor", "no_soot.toml"),
        own("chromatic_smoke", "smoke that colors what shines through", "chromatic_smoke.toml"),
        lamps("lamps_thin", "lamps around thin smoke", &["volume.0.density.scale=1.0"]),
        lamps("lamps_thick", "lamps around thick smoke", &["volume.0.density.scale=20.0"]),
        lamps(
            "lamps_colored",
            "lamps around colored smoke",
            &["volume.0.density.scale=[3.0, 6.0, 9.0]"],
        ),
    ]
}

impl BenchScene {
    /// Reads and builds the scene; `None`, with a message, where its files are absent.
    pub fn build(&self) -> Option<Scene> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let file = root.join(SCENES).join(self.file);
        let folder = match self.folder {
            Folder::Own => file.parent()?.to_owned(),
            Folder::Peers => shared(root).join("peers"),
        };
        if !folder.exists() {
            println!("\n## {}\n\nskipped: {} is not there", self.name, folder.display());
            return None;
        }
        match self.read(&file, &folder) {
            Ok(scene) => Some(scene),
            Err(error) => {
                println!("\n## {}\n\nskipped: {error}", self.name);
                None
            }
        }
    }

    /// The scene file, and the settings to change in it, as the command line takes both.
    pub fn on_disk(&self) -> Option<(PathBuf, Vec<String>)> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let file = root.join(SCENES).join(self.file);
        let mut sets: Vec<String> = self.set.iter().map(|&set| set.to_owned()).collect();
        if self.folder == Folder::Peers {
            let folder = shared(root).join("peers");
            let settings = self.settings(&file, &folder).ok()?;
            let volumes = settings.volume.iter().enumerate();
            sets.extend(volumes.filter_map(|(index, volume)| {
                let file = volume.file.as_ref()?;
                Some(format!("volume.{index}.file=\"{}\"", folder.join(file).display()))
            }));
        }
        Some((file, sets))
    }

    fn read(&self, file: &Path, folder: &Path) -> flambeau::error::Result<Scene> {
        let settings = self.settings(file, folder)?;
        flambeau::scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS)
    }

    fn settings(&self, file: &Path, folder: &Path) -> flambeau::error::Result<scene::Settings> {
        let text = std::fs::read_to_string(file)
            .map_err(|error| flambeau::error::Error::io(file, error))?;
        let set = self.set.iter().map(|&set| set.to_owned()).collect();
        scene::parse(&text, self.file, folder, &Overrides { preset: None, set })
    }
}

/// The folder of large test data beside the repository.
fn shared(root: &Path) -> PathBuf {
    std::env::var_os("FLAMBEAU_SHARED").map_or_else(|| root.join("../shared"), PathBuf::from)
}
