//! The names of files in scenes: relative in the file, absolute in the settings.

use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};

use super::keys;
use crate::error::{Error, Result};
use crate::files::{name_of, path_of};
use crate::volume::file::EXTENSIONS;

/// Prefix of the names of embedded scenes and volumes.
pub(super) const BUILTIN: &str = "builtin:";

/// Whether the key at `path` names a file.
pub(super) fn is_file_key(path: &str) -> bool {
    ["volume.N.file", "environment.file"].contains(&keys::general(path).as_str())
}

/// The folder that a scene file's relative names start from.
pub(super) fn folder_of(scene_file: &Path) -> Result<PathBuf> {
    let folder = match scene_file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    folder.canonicalize().map_err(|e| Error::io(scene_file, e))
}

/// The absolute name of `file` as written in a scene in `folder`; embedded ones stay as they are.
pub(super) fn resolve(file: &str, folder: &Path) -> Result<String> {
    if file.starts_with(BUILTIN) || file.is_empty() {
        return Ok(file.to_owned());
    }
    let path = folder.join(path_of(file));
    let absolute = std::path::absolute(&path).map_err(|e| Error::io(path, e))?;
    Ok(name_of(&without_dots(&absolute)))
}

/// `file` as it is written into a scene in `folder`: relative if they share more than the root.
pub(super) fn relative(file: &str, folder: &Path) -> String {
    let path = &*path_of(file);
    if file.starts_with(BUILTIN) || !path.is_absolute() {
        return file.to_owned();
    }
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), path.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let named = |component: &&Component| matches!(component, Component::Normal(_));
    if from.iter().take(shared).filter(named).count() == 0 {
        return file.to_owned();
    }
    let up = std::iter::repeat_n(Component::ParentDir, from.len() - shared);
    let relative: PathBuf = up.chain(to.into_iter().skip(shared)).collect();
    // A relative name that would read as an embedded one needs a folder in front.
    let name = name_of(&relative);
    if name.starts_with(BUILTIN) { format!("./{name}") } else { name }
}

/// Whether the name ends in `.extension`, in any case.
pub(super) fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().and_then(OsStr::to_str).is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

/// Whether the name ends as those of volume files do. Which file is one, its content tells.
pub(super) fn is_named_volume(path: &Path) -> bool {
    EXTENSIONS.iter().any(|extension| has_extension(path, extension))
}

/// The path with `.` and `..` carried out on its text. The folder it starts from has no symbolic
/// links (see [`folder_of`]), so this names the same file.
fn without_dots(path: &Path) -> PathBuf {
    let mut clean = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                clean.pop();
            }
            other => clean.push(other),
        }
    }
    clean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_names_come_back() {
        let folder = Path::new("/home/ann/scenes");
        for (file, written) in [
            ("/home/ann/scenes/torch.vdb", "torch.vdb"),
            ("/home/ann/assets/torch.vdb", "../assets/torch.vdb"),
            ("/mnt/farm/torch.vdb", "/mnt/farm/torch.vdb"),
            ("/home/ann/scenes/builtin:x.vdb", "./builtin:x.vdb"),
            ("builtin:torch_hd", "builtin:torch_hd"),
        ] {
            assert_eq!(relative(file, folder), written);
            assert_eq!(resolve(written, folder).unwrap(), file);
        }
    }
}
