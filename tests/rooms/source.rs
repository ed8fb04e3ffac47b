//! The text of the files under test: read from disk, or made up by a test.

use std::collections::BTreeMap;
use std::path::Path;

/// Sources by their path from the root of the package, with `/` between folders.
pub type Sources = BTreeMap<String, String>;

/// The folders in which the targets of the package lie.
pub const FOLDERS: [&str; 3] = ["src", "benches", "examples"];

/// Reads every Rust file below the folders of a package; a folder that is missing has no files.
pub fn read(package: &Path, folders: &[&str]) -> std::io::Result<Sources> {
    let mut sources = Sources::new();
    for folder in folders {
        if package.join(folder).is_dir() {
            read_folder(package, folder, &mut sources)?;
        }
    }
    Ok(sources)
}

fn read_folder(package: &Path, folder: &str, sources: &mut Sources) -> std::io::Result<()> {
    for entry in std::fs::read_dir(package.join(folder))? {
        let entry = entry?;
        let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            read_folder(package, &path, sources)?;
        } else if path.ends_with(".rs") {
            sources.insert(path, std::fs::read_to_string(entry.path())?);
        }
    }
    Ok(())
}

/// Whether cargo takes the file for the root of a crate, by its place alone.
pub fn is_root(path: &str) -> bool {
    let parts: Vec<&str> = path.split('/').collect();
    match parts[..] {
        ["src", file] => file == "lib.rs" || file == "main.rs",
        ["src", "bin", _] | ["benches" | "examples", _] => true,
        ["src", "bin", _, file] | ["benches" | "examples", _, file] => file == "main.rs",
        _ => false,
    }
}
