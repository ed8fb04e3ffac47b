//! Scenes and volumes embedded in the program, so that it shows something from any folder.

use std::path::Path;

use super::files::BUILTIN;
use crate::error::{Error, Result};

/// The scene that opens when none is named.
pub const DEFAULT_SCENE: &str = "builtin:torch";

const SCENES: &[(&str, &str)] = &[
    ("torch", include_str!("../../scenes/torch.toml")),
    ("campfire", include_str!("../../scenes/campfire.toml")),
    ("explosion", include_str!("../../scenes/explosion.toml")),
    ("fog", include_str!("../../scenes/fog.toml")),
    ("cloud", include_str!("../../scenes/cloud.toml")),
    ("plume", include_str!("../../scenes/plume.toml")),
    ("phoenix", include_str!("../../scenes/phoenix.toml")),
    ("tunnel", include_str!("../../scenes/tunnel.toml")),
    ("mist", include_str!("../../scenes/mist.toml")),
    ("hearth", include_str!("../../scenes/hearth.toml")),
    ("blast", include_str!("../../scenes/blast.toml")),
    ("godrays", include_str!("../../scenes/godrays.toml")),
    ("lamps", include_str!("../../scenes/lamps.toml")),
    ("street", include_str!("../../scenes/street.toml")),
];

const VOLUMES: &[(&str, &[u8])] = &[
    ("torch_hd", include_bytes!("../../assets/torch_hd.vdb")),
    ("campfire_hd", include_bytes!("../../assets/campfire_hd.vdb")),
    ("explosion_hd", include_bytes!("../../assets/explosion_hd.vdb")),
    ("fog", include_bytes!("../../assets/fog.vdb")),
    ("cloud", include_bytes!("../../assets/cloud.vdb")),
    ("plume", include_bytes!("../../assets/plume.vdb")),
];

/// The names of the embedded scenes, the default one first; `builtin:NAME` opens them.
pub fn scenes() -> impl Iterator<Item = &'static str> {
    SCENES.iter().map(|(name, _)| *name)
}

/// The text of the embedded scene of that name, `builtin:` included.
pub(super) fn scene(name: &str) -> Option<&'static str> {
    let name = name.strip_prefix(BUILTIN)?;
    let name = name.strip_suffix(".toml").unwrap_or(name);
    SCENES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// The embedded volume that `file` names, or `None` if it names a file of its own.
///
/// # Errors
/// There is no such embedded volume.
pub fn volume(file: &str) -> Result<Option<&'static [u8]>> {
    let Some(name) = file.strip_prefix(BUILTIN) else { return Ok(None) };
    let name = name.strip_suffix(".vdb").unwrap_or(name);
    match VOLUMES.iter().find(|(known, _)| *known == name) {
        Some((_, bytes)) => Ok(Some(bytes)),
        None => {
            let listed = |names: &mut dyn Iterator<Item = &str>| {
                names.map(|name| format!("{BUILTIN}{name}")).collect::<Vec<_>>().join(", ")
            };
            let volumes = listed(&mut VOLUMES.iter().map(|(name, _)| *name));
            let reason = format!(
                "there is no embedded volume of that name; the volumes are {volumes}; the scenes \
                 are {}",
                listed(&mut scenes())
            );
            Err(Error::invalid(file, "", reason))
        }
    }
}

/// Short name of a volume file, without folders and extension.
pub(super) fn short_name(file: &str) -> &str {
    let file = file.strip_prefix(BUILTIN).unwrap_or(file);
    Path::new(file).file_stem().and_then(|stem| stem.to_str()).unwrap_or(file)
}
