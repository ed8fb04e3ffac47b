//! Display of a picture: its light or one of its layers, with a tone or a scale.

use crate::image::ramp::Scale;
use crate::image::tone::Tone;
use crate::render::Picture;

/// The data of a picture that is shown, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Look {
    /// The light of the picture, exposed and curved.
    Picture(Tone),
    /// A layer of light in place of the picture.
    Light(Tone),
    /// A layer of numbers, on this scale.
    Numbers(Scale),
}

/// Data of a picture on the graphics card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureData {
    /// The linear light of the picture itself.
    Pixels,
    /// The linear light of the picture's layer.
    Light,
    /// The numbers of the picture's layer.
    Numbers,
}

impl Look {
    /// The data that this look needs on the graphics card.
    pub fn source(self) -> TextureData {
        match self {
            Self::Picture(_) => TextureData::Pixels,
            Self::Light(_) => TextureData::Light,
            Self::Numbers(_) => TextureData::Numbers,
        }
    }
}

impl TextureData {
    /// The texture format that holds one pixel.
    pub fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Pixels | Self::Light => wgpu::TextureFormat::Rgba32Float,
            Self::Numbers => wgpu::TextureFormat::R32Float,
        }
    }

    /// The linear RGBA of all pixels of `picture`; empty for numbers.
    pub fn light(self, picture: &Picture) -> &[[f32; 4]] {
        match self {
            Self::Pixels => &picture.pixels,
            Self::Light => &picture.layer.light,
            Self::Numbers => &[],
        }
    }
}
