//! Layers of a picture: parts of its light, depth, and cost, one number or color per pixel.

use glam::UVec2;
use rayon::prelude::*;

use super::coarse::shown_pixel;
use super::estimate::PixelEstimate;
use super::film::Film;

/// A layer (AOV) of the film beside the beauty pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Emission of volumes that the camera sees directly, radiance.
    Emission,
    /// Light after one scattering event or reflection, radiance.
    Direct,
    /// Light after more than one scattering event or reflection, radiance.
    Indirect,
    /// Environment and lights that the camera sees directly, radiance.
    Background,
    /// Mean distance of the first event or surface, over the samples that met one.
    Depth,
    /// Samples so far.
    Samples,
    /// Standard error of the gray mean, radiance.
    Noise,
    /// Mean tentative collisions of a sample.
    Steps,
}

impl Layer {
    /// All layers, in the order of menus.
    pub const ALL: [Self; 8] = [
        Self::Emission,
        Self::Direct,
        Self::Indirect,
        Self::Background,
        Self::Depth,
        Self::Samples,
        Self::Noise,
        Self::Steps,
    ];

    /// Whether the layer is light, shown as a picture is; else it is a number.
    pub fn is_light(self) -> bool {
        matches!(self, Self::Emission | Self::Direct | Self::Indirect | Self::Background)
    }

    /// Name of the layer in menus.
    pub fn name(self) -> &'static str {
        match self {
            Self::Emission => "Emission",
            Self::Direct => "Direct light",
            Self::Indirect => "Indirect light",
            Self::Background => "Background",
            Self::Depth => "Depth",
            Self::Samples => "Samples",
            Self::Noise => "Noise",
            Self::Steps => "Tracking steps",
        }
    }

    fn light(self, pixel: &PixelEstimate<'_>) -> [f32; 4] {
        let [r, g, b] = pixel.part(|sums| match self {
            Self::Direct => &sums.direct,
            Self::Indirect => &sums.indirect,
            Self::Background => &sums.background,
            _ => &sums.emission,
        });
        [r as f32, g as f32, b as f32, 1.0]
    }

    fn number(self, pixel: &PixelEstimate<'_>, samples: u32) -> f32 {
        match self {
            Self::Depth => pixel.depth().unwrap_or(0.0) as f32,
            Self::Samples => samples as f32,
            Self::Noise => pixel.gray_variance().unwrap_or(0.0).max(0.0).sqrt() as f32,
            _ => pixel.steps() as f32,
        }
    }
}

/// A layer of a picture, row 0 on top; a pixel without samples shows its block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerMap {
    /// The layer, if any is shown.
    pub layer: Option<Layer>,
    /// The pixels of a layer of light, as linear RGB and 1.
    pub light: Vec<[f32; 4]>,
    /// Numbers of a layer that is not light, 0 where there is none.
    pub numbers: Vec<f32>,
    /// Smallest and largest number other than zero, if there are any.
    pub range: Option<[f32; 2]>,
}

impl LayerMap {
    /// Reads `layer` of every pixel of `film`. Runs on the threads of the calling pool.
    pub fn read(&mut self, film: &Film, layer: Option<Layer>) {
        let size = film.size();
        let count = size.x as usize * size.y as usize;
        self.layer = layer;
        self.range = None;
        let is_light = layer.map(Layer::is_light);
        self.light.resize(if is_light == Some(true) { count } else { 0 }, [0.0; 4]);
        self.numbers.resize(if is_light == Some(false) { count } else { 0 }, 0.0);
        let Some(layer) = layer else { return };
        each_pixel(film, &mut self.light, |pixel, _| layer.light(pixel));
        each_pixel(film, &mut self.numbers, |pixel, samples| layer.number(pixel, samples));
        let positive = self.numbers.par_iter().copied().filter(|number| *number > 0.0);
        self.range =
            positive.map(|number| [number; 2]).reduce_with(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    }
}

/// Fills `values`, a row of the film after the other, with what `read` says of the estimate and the
/// samples of the pixel shown at each place.
fn each_pixel<T: Default + Send>(
    film: &Film,
    values: &mut [T],
    read: impl Fn(&PixelEstimate<'_>, u32) -> T + Sync,
) {
    values.par_chunks_mut(film.size().x.max(1) as usize).enumerate().for_each(|(y, line)| {
        for (x, out) in line.iter_mut().enumerate() {
            let shown = shown_pixel(film, UVec2::new(x as u32, y as u32));
            *out = PixelEstimate::of(film, shown)
                .map_or_else(T::default, |pixel| read(&pixel, film.samples(shown)));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::transport::PathSample;

    #[test]
    fn steps_are_means_and_blocks_as_in_the_picture() {
        let mut film = Film::new(UVec2::new(4, 2)).unwrap();
        let steps = |steps| PathSample { tracking_steps: steps, ..Default::default() };
        film.add(UVec2::new(3, 1), &steps(5));
        film.add(UVec2::new(1, 1), &steps(2));
        film.add(UVec2::new(1, 1), &steps(1));
        let mut map = LayerMap { numbers: vec![9.0; 50], ..LayerMap::default() };
        map.read(&film, Some(Layer::Steps));
        assert_eq!(map.numbers, [1.5, 1.5, 5.0, 5.0, 1.5, 1.5, 5.0, 5.0]);
        assert_eq!((map.range, map.layer), (Some([1.5, 5.0]), Some(Layer::Steps)));
        film.clear();
        map.read(&film, Some(Layer::Steps));
        assert_eq!((map.numbers, map.range), (vec![0.0; 8], None));
    }

    #[test]
    fn each_layer_is_what_the_samples_brought() {
        let mut film = Film::new(UVec2::ONE).unwrap();
        let sample = |factor: f32| PathSample {
            emission: Rgb::splat(factor),
            direct: Rgb::splat(2.0 * factor),
            indirect: Rgb::splat(3.0 * factor),
            background: Rgb::splat(4.0 * factor),
            depth: Some(5.0 * factor),
            tracking_steps: 6,
            ..Default::default()
        };
        [1.0, 3.0].iter().for_each(|&factor| film.add(UVec2::ZERO, &sample(factor)));
        let mut map = LayerMap::default();
        for (layer, expected) in [
            (Layer::Emission, 2.0),
            (Layer::Direct, 4.0),
            (Layer::Indirect, 6.0),
            (Layer::Background, 8.0),
            (Layer::Depth, 10.0),
            (Layer::Samples, 2.0),
            // Samples of 10 and 30: their mean has the standard error 10.
            (Layer::Noise, 10.0),
            (Layer::Steps, 6.0),
        ] {
            map.read(&film, Some(layer));
            match layer.is_light() {
                true => assert_eq!(map.light, [[expected, expected, expected, 1.0]], "{layer:?}"),
                false => assert_eq!(map.numbers, [expected], "{layer:?}"),
            }
            assert_eq!(map.light.is_empty(), !layer.is_light());
        }
        map.read(&film, None);
        assert_eq!(map, LayerMap::default());
    }
}
