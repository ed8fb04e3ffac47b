//! The marks of a comparison over the pictures: the divider and the names of the sides.

use egui::{Align2, CursorIcon, FontId, Rect, Sense, Stroke, TextStyle, Ui, pos2, vec2};

use super::panel;
use super::second_side::{CompareLayout, FLIP_KEY, SecondSide};
use super::state::CompareState;
use crate::app::document::{Document, Side};
use crate::app::ui::theme::{color, space};

/// Reach of the hand on the divider to either side, in points.
const GRIP: f32 = 5.0;

/// Draws the divider and the names of the sides over the pictures in `rect`.
pub fn show(ui: &mut Ui, rect: Rect, compare: &mut CompareState, document: &Document) {
    let Some(active) = compare.active_side(document).filter(|_| compare.second_side.is_on()) else {
        return;
    };
    let name = |side| panel::side_title(side, document, &compare.second_side);
    let (a, b) = (name(Side::A), name(Side::B));
    if ui.input(|input| input.key_down(FLIP_KEY)) && compare.map().is_none() {
        let other = if active == Side::A { &b } else { &a };
        chip(ui, rect, rect.center_top(), Align2::CENTER_TOP, other);
        return;
    }
    let middle = match compare.second_side.layout {
        CompareLayout::Wipe => divider(ui, rect, &mut compare.second_side),
        CompareLayout::Beside => rect.center().x,
        CompareLayout::Difference(_) | CompareLayout::Noise(_) | CompareLayout::Error(..) => {
            return;
        }
    };
    let gap = vec2(space::ROW, 0.0);
    chip(ui, rect, pos2(middle, rect.top()) - gap, Align2::RIGHT_TOP, &a);
    chip(ui, rect, pos2(middle, rect.top()) + gap, Align2::LEFT_TOP, &b);
}

/// Shows the divider of the wipe, which can be dragged; returns its x in points.
fn divider(ui: &mut Ui, rect: Rect, second_side: &mut SecondSide) -> f32 {
    let x = rect.left() + second_side.divider * rect.width();
    let grip = Rect::from_x_y_ranges(x - GRIP..=x + GRIP, rect.y_range());
    let response = ui.interact(grip, ui.scope_id().with("divider"), Sense::drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Splitter, true, "Divider"));
    if response.hovered() || response.dragged() {
        ui.set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
    if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        second_side.divider = ((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
    }
    let x = (rect.left() + second_side.divider * rect.width()).round();
    let painter = ui.painter_at(rect);
    for (width, color) in [(3.0, color::WELL), (1.0, color::TEXT_STRONG)] {
        painter.vline(x, rect.y_range(), Stroke::new(width, color));
    }
    x
}

/// A name on a dark ground that moves inwards where `area` ends.
fn chip(ui: &Ui, area: Rect, at: egui::Pos2, anchor: Align2, text: &str) {
    let font: FontId = TextStyle::Body.resolve(ui.style());
    let painter = ui.painter_at(area);
    let galley = painter.layout_no_wrap(text.to_owned(), font, color::TEXT_STRONG);
    let size = galley.size() + vec2(12.0, 6.0);
    let at = at + vec2(0.0, space::ROW);
    let rect = anchor.anchor_size(at, size);
    if rect.left() < area.left() || rect.right() > area.right() {
        return;
    }
    painter.rect_filled(rect, space::RADIUS, color::PANEL.gamma_multiply(0.85));
    painter.galley(rect.min + vec2(6.0, 3.0), galley, color::TEXT_STRONG);
}
