//! The radiance map of the environment in memory, with its table for sampling: made once, for as
//! long as scenes use the same picture or sky.

use std::sync::{Arc, Mutex, PoisonError};

use glam::UVec2;

use super::stamp::{Stamp, stamp_of};
use crate::error::{Error, Progress, Result};
use crate::files::path_of;
use crate::image::panorama;
use crate::light::{ClearSky, RadianceMap};

/// The map of the scene that was built last.
#[derive(Default)]
pub struct RadianceMaps {
    last: Mutex<Option<(Source, KeptMap)>>,
}

/// The source that a map was made from.
#[derive(Clone, Debug, PartialEq)]
enum Source {
    /// The file of a name in a state.
    File(String, Stamp),
    /// A sky.
    Sky(ClearSky),
}

/// A map, and the number of texels that held negative values or values that are no numbers.
#[derive(Clone, Debug)]
pub struct KeptMap {
    /// The map.
    pub map: Arc<RadianceMap>,
    /// Number of its texels that became 0.
    pub mended: usize,
}

impl RadianceMaps {
    /// The map of the picture of that name, read again if it has changed.
    ///
    /// # Errors
    /// It cannot be read, is no picture of a kind that is known, or does not fit the memory; names
    /// it.
    pub fn of_file(&self, name: &str, progress: Progress) -> Result<KeptMap> {
        self.kept(Source::File(name.to_owned(), stamp_of(name)?), || {
            let picture = panorama::read(&path_of(name), RadianceMap::BYTES_OF_TEXEL, progress)?;
            map_of(name, (picture.size, picture.pixels))
        })
    }

    /// The map of a sky without its sun.
    ///
    /// # Errors
    /// None but what [`RadianceMaps::of_file`] has.
    pub fn of_sky(&self, sky: &ClearSky) -> Result<KeptMap> {
        self.kept(Source::Sky(*sky), || map_of("sky", sky.texels()))
    }

    /// Lets go of the map, which the scene just built does not use.
    pub fn clear(&self) {
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    fn kept(&self, source: Source, make: impl FnOnce() -> Result<KeptMap>) -> Result<KeptMap> {
        let last = || self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((known, map)) = &*last()
            && *known == source
        {
            return Ok(map.clone());
        }
        // Before the next one is made, so that there is room for it.
        self.clear();
        let map = make()?;
        *last() = Some((source, map.clone()));
        Ok(map)
    }
}

/// The map of the texels of `name`.
fn map_of(name: &str, (size, texels): (UVec2, Vec<[f32; 3]>)) -> Result<KeptMap> {
    let empty = || Error::invalid(name, "", "it has no pixels");
    let (map, mended) = RadianceMap::new(size, texels).ok_or_else(empty)?;
    Ok(KeptMap { map: Arc::new(map), mended })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::error::NO_PROGRESS;
    use crate::files::name_of;

    fn write(path: &Path, mantissa: u8, width: usize) {
        let head = format!("#?RADIANCE\n\n-Y 1 +X {width}\n");
        let pixels = [mantissa, 1, 1, 128].repeat(width);
        std::fs::write(path, [head.into_bytes(), pixels].concat()).unwrap();
    }

    /// A picture is read once, until it changes or another one takes its place.
    #[test]
    fn pictures_are_read_again_when_they_change() {
        let folder = tempfile::tempdir().unwrap();
        let [one, other] = ["one.hdr", "other.hdr"].map(|name| folder.path().join(name));
        write(&one, 10, 2);
        write(&other, 20, 2);
        let maps = RadianceMaps::default();
        let map = |path: &Path| maps.of_file(&name_of(path), NO_PROGRESS).unwrap().map;
        let first = map(&one);
        assert!(Arc::ptr_eq(&first, &map(&one)));
        write(&one, 30, 3);
        let second = map(&one);
        assert!(!Arc::ptr_eq(&first, &second));
        assert!(!Arc::ptr_eq(&map(&other), &second));
        maps.clear();
        assert!(maps.last.lock().unwrap().is_none());
        std::fs::remove_file(&one).unwrap();
        let error = maps.of_file(&name_of(&one), NO_PROGRESS).unwrap_err().to_string();
        assert!(error.contains("one.hdr"), "{error}");
    }
}
