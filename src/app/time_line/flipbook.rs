//! The flipbook: pictures of frames that were rendered, to be looked at in motion.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::UVec2;

use crate::app::document::Document;
use crate::render::{Layer, Picture};
use crate::scene::settings::TimeSettings;

/// Most bytes that the pictures may take.
const MOST_BYTES: usize = 2 << 30;

/// The pictures of a frame: one, or those of A and B.
pub type FramePictures = Vec<Arc<Picture>>;

/// All that pictures of different frames have in common, so that they belong to one flipbook.
#[derive(Clone, Debug, PartialEq)]
pub struct Take {
    document: Document,
    size: UVec2,
    layer: Option<Layer>,
}

impl Take {
    /// The take of a document whose film has `size`, with `layer` beside the picture.
    pub fn new(document: &Document, size: UVec2, layer: Option<Layer>) -> Self {
        let mut document = document.clone();
        let time = &mut document.settings.time;
        *time = TimeSettings { shutter: time.shutter, ..TimeSettings::default() };
        document.settings.film.spp = 0;
        document.tone = Default::default();
        Self { document, size, layer }
    }
}

/// Pictures of frames.
#[derive(Debug, Default)]
pub struct Flipbook {
    take: Option<Take>,
    frames: BTreeMap<i32, FramePictures>,
    bytes: usize,
}

impl Flipbook {
    /// Drops all pictures unless they are of `take`.
    pub fn keep_only(&mut self, take: &Take) {
        if self.take.as_ref() != Some(take) {
            *self = Self { take: Some(take.clone()), ..Self::default() };
        }
    }

    /// Drops all pictures.
    pub fn clear(&mut self) {
        *self = Self { take: self.take.take(), ..Self::default() };
    }

    /// Keeps the pictures of a frame, if there is room for them.
    pub fn keep(&mut self, frame: i32, pictures: FramePictures) {
        let bytes: usize = pictures.iter().map(|picture| bytes_of(picture)).sum();
        if self.bytes + bytes <= MOST_BYTES && !self.frames.contains_key(&frame) {
            self.bytes += bytes;
            self.frames.insert(frame, pictures);
        }
    }

    /// The pictures of a frame.
    pub fn get(&self, frame: i32) -> Option<&[Arc<Picture>]> {
        self.frames.get(&frame).map(Vec::as_slice)
    }

    /// The frames that have pictures, in their order.
    pub fn frames(&self) -> impl Iterator<Item = (i32, &FramePictures)> {
        self.frames.iter().map(|(frame, pictures)| (*frame, pictures))
    }

    /// Number of frames that have pictures.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Memory that the pictures take, in bytes.
    pub fn bytes(&self) -> usize {
        self.bytes
    }
}

/// Memory of the parts of a picture that grow with its size.
fn bytes_of(picture: &Picture) -> usize {
    size_of_val(picture.pixels.as_slice())
        + size_of_val(picture.variance.as_slice())
        + size_of_val(picture.layer.numbers.as_slice())
        + size_of_val(picture.layer.light.as_slice())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_of_another_take_are_dropped() {
        let mut document = Document::default();
        let take = |document: &Document| Take::new(document, UVec2::ONE, None);
        let mut flipbook = Flipbook::default();
        flipbook.keep_only(&take(&document));
        let pixels = vec![[0.0; 4]; 3];
        let picture = Arc::new(Picture { pixels, ..Picture::default() });
        flipbook.keep(3, vec![picture]);
        assert_eq!((flipbook.len(), flipbook.bytes()), (1, 48));
        document.settings.time.frame = 5.0;
        document.tone.exposure = 1.0;
        flipbook.keep_only(&take(&document));
        assert!(flipbook.get(3).is_some() && flipbook.get(5).is_none());
        document.settings.environment.radiance = crate::scene::settings::Color::Gray(0.5);
        flipbook.keep_only(&take(&document));
        assert_eq!((flipbook.len(), flipbook.bytes()), (0, 0));
    }

    #[test]
    fn what_does_not_fit_is_not_kept() {
        let mut flipbook = Flipbook { bytes: MOST_BYTES - 20, ..Flipbook::default() };
        let pixels = vec![[0.0; 4]; 3];
        flipbook.keep(3, vec![Arc::new(Picture { pixels, ..Picture::default() })]);
        assert_eq!(flipbook.len(), 0);
    }
}
