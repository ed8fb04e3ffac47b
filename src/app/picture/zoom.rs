//! Zoom of the picture in the viewport: fitted, or in pixels. Pure geometry, in framebuffer pixels
//! from the viewport's upper left corner.

use glam::{UVec2, Vec2};

/// The widest zoom in framebuffer pixels per picture pixel.
const MOST: f32 = 64.0;
/// The narrowest.
const LEAST: f32 = 1.0 / 16.0;

/// Zoom of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Zoom {
    /// Fitted: the whole picture, in whole multiples of its pixels where there is room.
    #[default]
    Fit,
    /// Zoomed to pixels.
    Pixels {
        /// Framebuffer pixels per picture pixel.
        scale: f32,
        /// The picture position, in picture pixels, in the middle of the viewport.
        center: Vec2,
    },
}

/// A picture of some size laid out in a viewport of some size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Framebuffer pixels per picture pixel.
    pub scale: f32,
    /// Position of the picture's upper left corner in the viewport.
    pub corner: Vec2,
}

impl Zoom {
    /// Lays out a picture of `picture` pixels in a viewport of `viewport` framebuffer pixels.
    pub fn place(self, picture: UVec2, viewport: Vec2) -> Placement {
        let size = picture.max(UVec2::ONE).as_vec2();
        let (scale, center) = match self {
            Self::Fit => {
                let room = (viewport / size).min_element().max(1e-4);
                (if room >= 1.0 { room.floor() } else { room }, 0.5 * size)
            }
            Self::Pixels { scale, center } => (scale, center),
        };
        // A corner on the framebuffer's grid keeps pixels crisp.
        Placement { scale, corner: (0.5 * viewport - center * scale).round() }
    }

    /// Zooms by `factor` around the viewport position `at`, which keeps showing what it shows.
    #[must_use]
    pub fn zoomed(self, factor: f32, at: Vec2, picture: UVec2, viewport: Vec2) -> Self {
        let place = self.place(picture, viewport);
        let scale = (place.scale * factor).clamp(LEAST, MOST);
        let under = place.picture_from_viewport(at);
        Self::Pixels { scale, center: under - (at - 0.5 * viewport) / scale }
    }

    /// Shows `scale` framebuffer pixels a picture pixel around the viewport position `at`.
    #[must_use]
    pub fn at_scale(self, scale: f32, at: Vec2, picture: UVec2, viewport: Vec2) -> Self {
        self.zoomed(scale / self.place(picture, viewport).scale, at, picture, viewport)
    }

    /// Moves the picture by `drag` framebuffer pixels.
    #[must_use]
    pub fn panned(self, drag: Vec2, picture: UVec2, viewport: Vec2) -> Self {
        let scale = self.place(picture, viewport).scale;
        let center = match self {
            Self::Fit => 0.5 * picture.as_vec2(),
            Self::Pixels { center, .. } => center,
        };
        let center = (center - drag / scale).clamp(Vec2::ZERO, picture.as_vec2());
        Self::Pixels { scale, center }
    }
}

impl Placement {
    /// The picture position under a viewport position.
    pub fn picture_from_viewport(&self, at: Vec2) -> Vec2 {
        (at - self.corner) / self.scale
    }

    /// The pixel of a picture of `size` under a viewport position.
    pub fn pixel_at(&self, at: Vec2, size: UVec2) -> Option<UVec2> {
        let pixel = self.picture_from_viewport(at).floor();
        let inside = pixel.cmpge(Vec2::ZERO).all() && pixel.cmplt(size.as_vec2()).all();
        inside.then(|| pixel.as_uvec2())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEWPORT: Vec2 = Vec2::new(900.0, 700.0);

    #[test]
    fn a_picture_of_the_viewports_size_lies_one_to_one() {
        let place = Zoom::Fit.place(UVec2::new(900, 700), VIEWPORT);
        assert_eq!(place, Placement { scale: 1.0, corner: Vec2::ZERO });
    }

    #[test]
    fn small_pictures_grow_by_whole_factors_and_large_ones_shrink_to_fit() {
        assert_eq!(Zoom::Fit.place(UVec2::splat(128), VIEWPORT).scale, 5.0);
        let place = Zoom::Fit.place(UVec2::new(1800, 700), VIEWPORT);
        assert_eq!(place.scale, 0.5);
        assert_eq!(place.corner, Vec2::new(0.0, 175.0));
    }

    #[test]
    fn zooming_keeps_what_is_under_the_pointer() {
        let (picture, at) = (UVec2::new(900, 700), Vec2::new(123.0, 456.0));
        let mut zoom = Zoom::Fit;
        for factor in [1.3, 2.0, 4.0, 0.5] {
            let before = zoom.place(picture, VIEWPORT).picture_from_viewport(at);
            zoom = zoom.zoomed(factor, at, picture, VIEWPORT);
            let place = zoom.place(picture, VIEWPORT);
            let after = place.picture_from_viewport(at);
            assert!((after - before).length() <= 1.0 / place.scale, "{before} {after}");
        }
    }

    #[test]
    fn the_pixel_under_the_pointer_stops_at_the_border() {
        let size = UVec2::new(10, 10);
        let place = Placement { scale: 8.0, corner: Vec2::new(4.0, 4.0) };
        assert_eq!(place.pixel_at(Vec2::new(4.0, 12.5), size), Some(UVec2::new(0, 1)));
        assert_eq!(place.pixel_at(Vec2::new(3.9, 12.5), size), None);
        assert_eq!(place.pixel_at(Vec2::new(84.0, 12.5), size), None);
    }
}
