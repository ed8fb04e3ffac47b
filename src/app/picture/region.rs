//! A region of the picture with figures of its own: drawn by hand, or typed.

use egui::{CursorIcon, PointerButton, Rect, Response, Stroke, StrokeKind, Ui};
use glam::{UVec2, Vec2};

use super::view::View;
use crate::app::ui::theme::color;
use crate::render::Area;

/// The region and the drag that draws it. No edit of the scene, so that undo leaves it alone.
#[derive(Debug, Default)]
pub struct PictureRegion {
    /// Whether the next drag draws the region.
    armed: bool,
    /// The area that the region covers of a picture of this size.
    chosen: Option<(Area, UVec2)>,
    /// Whether the region gets all samples, and the rest of the picture none.
    pub is_alone: bool,
    /// Start of the drag under way, in pixels of the picture that lies there.
    from: Option<(Vec2, View)>,
}

impl PictureRegion {
    /// Lets the next drag on the picture draw the region.
    pub fn arm(&mut self) {
        self.armed = true;
    }

    /// Whether the next drag draws the region.
    pub fn is_armed(&self) -> bool {
        self.armed
    }

    /// Removes the region, or cancels drawing one. Whether there was anything to remove or cancel.
    pub fn remove(&mut self) -> bool {
        let was = self.armed || self.chosen.is_some();
        *self = Self::default();
        was
    }

    /// Whether there is a region.
    pub fn is_set(&self) -> bool {
        self.chosen.is_some()
    }

    /// Sets the region on a picture of `size`.
    pub fn set(&mut self, area: Area, size: UVec2) {
        let first = area.first.min(size.saturating_sub(UVec2::ONE));
        let area = Area { first, size: area.size.max(UVec2::ONE) }.within(size);
        self.chosen = Some((area, size));
        self.armed = false;
    }

    /// The area that the region covers of a picture of `size`: the same part of every picture.
    pub fn area(&self, size: UVec2) -> Option<Area> {
        let (area, of) = self.chosen?;
        if of == size {
            return Some(area);
        }
        let scale = size.as_vec2() / of.max(UVec2::ONE).as_vec2();
        let corner = |at: UVec2| (at.as_vec2() * scale).round().as_uvec2();
        let (first, end) = (corner(area.first), corner(area.first + area.size));
        Some(Area { first, size: (end - first).max(UVec2::ONE) }.within(size))
    }

    /// The pixels of a film of `size` that get all samples; `None`: all do.
    pub fn alone(&self, size: UVec2) -> Option<Area> {
        // While the hand draws it, its size says nothing yet.
        self.area(size).filter(|_| self.is_alone && self.from.is_none())
    }

    /// Lets a drag draw the region in the picture of `view`, which is under the pointer. Whether it
    /// takes the drag, so that nobody else should.
    pub fn draw(&mut self, ui: &Ui, response: &Response, view: Option<&View>) -> bool {
        if self.armed && response.hovered() {
            ui.set_cursor_icon(CursorIcon::Crosshair);
        }
        let pressed = ui.input(|input| input.pointer.press_origin());
        if self.armed
            && response.drag_started_by(PointerButton::Primary)
            && let (Some(at), Some(view)) = (pressed, view)
        {
            self.from = Some((view.picture_at(at), *view));
        }
        let Some((from, view)) = self.from else { return self.armed };
        if let Some(at) = response.interact_pointer_pos() {
            self.chosen =
                between(from, view.picture_at(at), view.size).map(|area| (area, view.size));
        }
        if !response.dragged_by(PointerButton::Primary) {
            self.armed = false;
            self.from = None;
        }
        true
    }

    /// Draws the region over the picture that lies in `view`.
    pub fn paint(&self, ui: &Ui, view: &View) {
        let Some(area) = self.area(view.size) else { return };
        let corners = [area.first, area.first + area.size];
        let rect = Rect::from_points(&corners.map(|corner| view.window_at(corner.as_vec2())));
        let painter = ui.painter_at(view.rect);
        let dark = Stroke::new(1.0, color::WELL);
        painter.rect_stroke(rect.expand(1.0), 0.0, dark, StrokeKind::Outside);
        let light = if self.is_alone { color::ACCENT } else { color::TEXT_STRONG };
        painter.rect_stroke(rect, 0.0, Stroke::new(1.0, light), StrokeKind::Outside);
    }
}

/// The pixels of a picture of `size` between two places on it; none where all of them are off it.
fn between(a: Vec2, b: Vec2, size: UVec2) -> Option<Area> {
    let low = a.min(b).floor().max(Vec2::ZERO);
    let high = (a.max(b).floor() + Vec2::ONE).min(size.as_vec2());
    let is_on = low.cmplt(high).all();
    is_on.then(|| Area { first: low.as_uvec2(), size: (high - low).as_uvec2() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(x: u32, y: u32, width: u32, height: u32) -> Area {
        Area { first: UVec2::new(x, y), size: UVec2::new(width, height) }
    }

    #[test]
    fn places_of_either_order_span_whole_pixels_of_the_picture() {
        let size = UVec2::new(20, 10);
        let span = |a: [f32; 2], b: [f32; 2]| between(a.into(), b.into(), size);
        assert_eq!(span([2.5, 3.5], [4.2, 5.9]), Some(area(2, 3, 3, 3)));
        assert_eq!(span([4.2, 3.5], [2.5, 5.9]), Some(area(2, 3, 3, 3)));
        assert_eq!(span([-7.0, 8.0], [99.0, 99.0]), Some(area(0, 8, 20, 2)));
        assert_eq!(span([2.0, -9.0], [5.0, -3.0]), None);
    }

    #[test]
    fn it_covers_the_same_part_of_another_size() {
        let mut region = PictureRegion::default();
        assert!(!region.remove() && region.area(UVec2::ONE).is_none());
        region.arm();
        region.set(area(10, 5, 20, 10), UVec2::new(40, 20));
        assert!(!region.is_armed());
        assert_eq!(region.area(UVec2::new(40, 20)), Some(area(10, 5, 20, 10)));
        assert_eq!(region.area(UVec2::new(80, 20)), Some(area(20, 5, 40, 10)));
        assert_eq!(region.area(UVec2::new(1, 1)).unwrap().pixels(), 1);
        region.set(area(90, 90, 0, 7), UVec2::new(40, 20));
        assert_eq!(region.area(UVec2::new(40, 20)), Some(area(39, 19, 1, 1)));
        assert!(region.remove() && region.area(UVec2::ONE).is_none());
    }
}
