//! Where the window meets a comparison: the commands that begin, change and end it, and the divider
//! and the names of the sides over the pictures.

use egui::{Align2, CursorIcon, FontId, Rect, Sense, Stroke, TextStyle, Ui, pos2, vec2};

use super::App;
use crate::app::compare::panel;
use crate::app::compare::second_side::{CompareLayout, FLIP};
use crate::app::document::Side;
use crate::app::ui::theme::{color, space};

/// Reach of the hand on the divider to either side, in points.
const GRIP: f32 = 5.0;

impl App {
    /// The side that is edited, where there are two.
    pub(super) fn active_side(&self) -> Option<Side> {
        let versus = self.versus.map(Side::other);
        versus.or(self.editor.document.compared.map(|compared| compared.active))
    }

    /// Compares two strategies, or ends a comparison, be it of strategies or with a snapshot.
    pub(super) fn compare_or_end(&mut self) {
        if self.versus.is_some() {
            self.snapshots.strip.show(None);
            return;
        }
        let document = &mut self.editor.document;
        match document.compared {
            None => document.compare(),
            Some(_) => document.compared = None,
        }
        self.editor.name_edit("comparison");
    }

    /// Edits the other side from now on.
    pub(super) fn switch_side(&mut self) {
        self.editor.document.switch_side();
        self.editor.name_edit("edited side");
    }

    /// Exchanges A and B.
    pub(super) fn swap_sides(&mut self) {
        if let Some(side) = self.versus {
            self.versus = Some(side.other());
            return;
        }
        self.editor.document.swap_sides();
        self.editor.name_edit("swap of A and B");
    }

    /// Gives the other side the strategy of the edited one.
    pub(super) fn copy_side(&mut self) {
        self.editor.document.copy_to_other_side();
        self.editor.name_edit("copy to the other side");
    }

    /// Draws the divider and the names of the sides over the pictures in `rect`.
    pub(super) fn compare_marks(&mut self, ui: &mut Ui, rect: Rect) {
        let document = &self.editor.document;
        let Some(active) = self.active_side().filter(|_| self.second_side.is_on()) else { return };
        let name = |side| panel::side_title(side, document, &self.second_side);
        let (a, b) = (name(Side::A), name(Side::B));
        if ui.input(|input| input.key_down(FLIP)) && self.map().is_none() {
            let other = if active == Side::A { &b } else { &a };
            chip(ui, rect, rect.center_top(), Align2::CENTER_TOP, other);
            return;
        }
        let middle = match self.second_side.layout {
            CompareLayout::Wipe => self.divider(ui, rect),
            CompareLayout::Beside => rect.center().x,
            CompareLayout::Difference(_) | CompareLayout::Noise(_) | CompareLayout::Error(..) => {
                return;
            }
        };
        let gap = vec2(space::ROW, 0.0);
        chip(ui, rect, pos2(middle, rect.top()) - gap, Align2::RIGHT_TOP, &a);
        chip(ui, rect, pos2(middle, rect.top()) + gap, Align2::LEFT_TOP, &b);
    }

    /// The divider of the wipe, which can be dragged; where it is.
    fn divider(&mut self, ui: &mut Ui, rect: Rect) -> f32 {
        let x = rect.left() + self.second_side.divider * rect.width();
        let grip = Rect::from_x_y_ranges(x - GRIP..=x + GRIP, rect.y_range());
        let response = ui.interact(grip, ui.scope_id().with("divider"), Sense::drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Splitter, true, "Divider"));
        if response.hovered() || response.dragged() {
            ui.set_cursor_icon(CursorIcon::ResizeHorizontal);
        }
        if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            self.second_side.divider = ((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
        }
        let x = (rect.left() + self.second_side.divider * rect.width()).round();
        let painter = ui.painter_at(rect);
        for (width, color) in [(3.0, color::WELL), (1.0, color::TEXT_STRONG)] {
            painter.vline(x, rect.y_range(), Stroke::new(width, color));
        }
        x
    }
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
