//! The name that the files of a numbered set share, with a place for the number: `fire_####.vdb` or
//! `fire_%04d.vdb`.

use std::path::{Path, PathBuf};

use crate::files::path_of;

/// Most digits of a number.
const MOST_DIGITS: usize = 7;

/// A file name with a place for the number of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    folder: PathBuf,
    before: String,
    /// Least number of digits; shorter numbers have zeros in front.
    width: usize,
    after: String,
}

impl Pattern {
    /// The pattern that `name` spells out, by `####` or `%04d` in the name of the file; the last of
    /// several. `None` for a name without a place for a number, and for files of that very name.
    pub fn spelled(name: &str) -> Option<Self> {
        let path = &*path_of(name);
        let file = path.file_name()?.to_str()?;
        let (before, width, after) = hashes(file).or_else(|| percent(file))?;
        if path.exists() {
            return None;
        }
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Some(Self { folder, before: before.to_owned(), width, after: after.to_owned() })
    }

    /// The pattern of a numbered file, as wide as its number, and the number, which is the last one
    /// in the name: the pattern of `fire_v2.0017.vdb` is `fire_v2.####.vdb`.
    pub fn of_file(path: &Path) -> Option<(Self, i32)> {
        let file = path.file_name()?.to_str()?;
        let stem = path.file_stem()?.to_str()?;
        let end = stem.rfind(|letter: char| letter.is_ascii_digit())? + 1;
        let digits = |letter: &char| letter.is_ascii_digit();
        let count = stem[..end].chars().rev().take_while(digits).count();
        let (start, folder) = (end - count, path.parent()?.to_owned());
        let number = number(&stem[start..end])?;
        let (before, after) = (file[..start].to_owned(), file[end..].to_owned());
        Some((Self { folder, before, width: count, after }, number))
    }

    /// The folder of the files.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The number of the file of that name in the folder, if it belongs to the set.
    pub fn number_of(&self, file: &str) -> Option<i32> {
        let digits = file.strip_prefix(&self.before)?.strip_suffix(&self.after)?;
        let is_padded = digits.len() == self.width;
        let is_longer = digits.len() > self.width && !digits.starts_with('0');
        if is_padded || is_longer { number(digits) } else { None }
    }

    /// The number of the file at `path`, if it belongs to the set.
    pub fn number_of_path(&self, path: &Path) -> Option<i32> {
        self.number_of(path.file_name()?.to_str()?)
    }

    /// Path of the file with that number.
    pub fn file(&self, number: i32) -> PathBuf {
        let (before, width, after) = (&self.before, self.width, &self.after);
        self.folder.join(format!("{before}{number:0width$}{after}"))
    }

    /// A copy of the pattern with another least number of digits.
    pub fn with_width(&self, width: usize) -> Self {
        Self { width, ..self.clone() }
    }

    /// Name of the set: that of its files without the number and the ending.
    pub fn short_name(&self) -> String {
        let stem = self.after.rsplit_once('.').map_or(self.after.as_str(), |(stem, _)| stem);
        let is_filler = |letter: char| matches!(letter, '_' | '.' | '-' | ' ');
        let name = format!("{}{stem}", self.before.trim_end_matches(is_filler));
        name.trim_matches(is_filler).to_owned()
    }

    /// Least number of digits.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The path with `#` for each digit of the least width.
    pub fn spelling(&self) -> PathBuf {
        let (before, after) = (&self.before, &self.after);
        self.folder.join(format!("{before}{}{after}", "#".repeat(self.width)))
    }
}

fn number(digits: &str) -> Option<i32> {
    let is_number = !digits.is_empty()
        && digits.len() <= MOST_DIGITS
        && digits.bytes().all(|byte| byte.is_ascii_digit());
    if is_number { digits.parse().ok() } else { None }
}

/// The parts of a name around its last row of `#`.
fn hashes(file: &str) -> Option<(&str, usize, &str)> {
    let end = file.rfind('#')? + 1;
    let count = file[..end].bytes().rev().take_while(|&byte| byte == b'#').count();
    (count <= MOST_DIGITS).then(|| (&file[..end - count], count, &file[end..]))
}

/// The parts of a name around its last `%d` or `%04d`.
fn percent(file: &str) -> Option<(&str, usize, &str)> {
    let start = file.rfind('%')?;
    let (width, after) = file[start + 1..].split_once('d')?;
    let width = if width.is_empty() { 1 } else { width.parse().ok()? };
    (1..=MOST_DIGITS).contains(&width).then(|| (&file[..start], width, after))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_are_spelled_in_two_ways() {
        for (name, width, third) in [
            ("a/fire_####.vdb", 4, "a/fire_0003.vdb"),
            ("fire.#.vdb", 1, "fire.3.vdb"),
            ("fire_%04d.vdb", 4, "fire_0003.vdb"),
            ("fire_%d.vdb", 1, "fire_3.vdb"),
            ("v##/fire_##.vdb", 2, "v##/fire_03.vdb"),
        ] {
            let pattern = Pattern::spelled(name).unwrap();
            assert_eq!(pattern.width(), width, "{name}");
            assert_eq!(pattern.file(3), Path::new(third), "{name}");
        }
        for name in ["fire_0001.vdb", "v##/fire.vdb", "50%.vdb", "a%99d.vdb", "########.vdb", ""] {
            assert_eq!(Pattern::spelled(name), None, "{name}");
        }
    }

    #[test]
    fn the_number_of_a_file_is_the_last_one_in_its_name() {
        for (file, spelling, number) in [
            ("a/fire_0017.vdb", "a/fire_####.vdb", 17),
            ("fire_v2.0017.vdb", "fire_v2.####.vdb", 17),
            ("fluid_12_noise.vdb", "fluid_##_noise.vdb", 12),
            ("0001.vdb", "####.vdb", 1),
        ] {
            let (pattern, found) = Pattern::of_file(Path::new(file)).unwrap();
            assert_eq!((pattern.spelling().to_str().unwrap(), found), (spelling, number));
        }
        for file in ["fire.vdb", "fire_123456789012.vdb", ""] {
            assert_eq!(Pattern::of_file(Path::new(file)), None, "{file}");
        }
    }

    #[test]
    fn files_of_other_widths_are_of_other_sets() {
        let pattern = Pattern::spelled("fire_####.vdb").unwrap();
        assert_eq!(pattern.number_of("fire_0012.vdb"), Some(12));
        assert_eq!(pattern.number_of("fire_12345.vdb"), Some(12345));
        for file in
            ["fire_012.vdb", "fire_00012.vdb", "fire_+012.vdb", "fire_0012.vdb~", "fire_.vdb"]
        {
            assert_eq!(pattern.number_of(file), None, "{file}");
        }
    }
}
