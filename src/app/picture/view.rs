//! Place of the picture in the window.

use egui::Rect;
use glam::{UVec2, Vec2};

use super::zoom::Placement;

/// Place of the picture in the window.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// The viewport, in points.
    pub rect: Rect,
    /// Placement of the picture in the viewport, in framebuffer pixels.
    pub placement: Placement,
    /// Framebuffer pixels per point.
    pub factor: f32,
    /// Width and height of the picture.
    pub size: UVec2,
    /// Whether the pointer is on the picture, and nothing in front.
    pub hovered: bool,
    /// The pixel that was clicked in this frame.
    pub clicked: Option<UVec2>,
}

impl View {
    /// The picture position, in its pixels, under a place in the window.
    pub fn picture_at(&self, at: egui::Pos2) -> Vec2 {
        self.placement.picture_from_viewport(from_egui(at - self.rect.min) * self.factor)
    }

    /// Position in the window of a point of the picture, given in its pixels.
    pub fn window_at(&self, at: Vec2) -> egui::Pos2 {
        let at = (self.placement.corner + at * self.placement.scale) / self.factor;
        self.rect.min + egui::vec2(at.x, at.y)
    }

    /// The part of the window that the picture covers.
    pub fn picture_rect(&self) -> Rect {
        let corners = [Vec2::ZERO, self.size.as_vec2()].map(|corner| self.window_at(corner));
        Rect::from_min_max(corners[0], corners[1]).intersect(self.rect)
    }
}

/// A vector of egui as one of glam.
pub fn from_egui(vector: egui::Vec2) -> Vec2 {
    Vec2::new(vector.x, vector.y)
}
