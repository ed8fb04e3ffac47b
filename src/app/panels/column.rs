//! The column of panels. It stays where the hand is, whatever comes and goes above, and follows the
//! keyboard.

use egui::{Frame, Margin, Rect, ScrollArea, Ui, UiBuilder};
use glam::UVec2;

use super::{Panel, camera, display, film, lights, strategy, surfaces, volume};
use crate::app::diagnostics::panel;
use crate::app::ui::sections::{Sections, Tops};
use crate::app::ui::theme::space;

/// Shows it in `frame`; `size` of the film as the window has it, and the largest side that one may
/// have.
pub fn show(
    ui: &mut Ui,
    panel: &mut Panel<'_>,
    frame: Frame,
    (size, largest): (Option<UVec2>, u32),
    sections: &Sections,
) {
    let place = egui::Panel::right("column").exact_size(space::COLUMN).resizable(false);
    place.frame(frame).show(ui, |ui| {
        // A child of its own: contents that are too wide are cut off and push nothing aside.
        let room = ui.max_rect();
        let mut ui = ui.new_child(UiBuilder::new().max_rect(room));
        ui.shrink_clip_rect(room);
        let (before, was) = (sections.tops(), sections.top());
        let mut area = ScrollArea::vertical().auto_shrink(false);
        let held_at = sections.take_offset();
        if let Some(offset) = held_at {
            area = area.vertical_scroll_offset(offset);
        }
        let output = area.show(&mut ui, |ui| {
            sections.begin(ui.min_rect().top());
            let inner = Frame::new().inner_margin(Margin::same(space::PANEL));
            inner.show(ui, |ui| {
                strategy::show(ui, panel);
                volume::show(ui, panel);
                lights::show(ui, panel);
                surfaces::show(ui, panel);
                camera::show(ui, panel);
                film::show(ui, panel, size, largest);
                display::show(ui, panel);
                panel::show(ui, panel.wanted, panel.spending.as_ref());
            });
            follow_keyboard(ui);
        });
        let offset = output.inner_rect.top() - sections.top();
        // What somebody is scrolling goes where it is scrolled to.
        let is_still = held_at.is_some() || (sections.top() - was).abs() < 0.5;
        if let Some(offset) = held(&ui, (output.inner_rect, offset), &before, &sections.tops())
            && is_still
        {
            sections.scroll(offset);
            ui.ctx().request_discard("the column stays where the hand is");
        }
    });
}

/// Scrolls to the control that the keyboard has just moved to.
fn follow_keyboard(ui: &mut Ui) {
    let moved = ui.input(|input| input.key_pressed(egui::Key::Tab));
    let focused = ui.memory(|memory| memory.focused()).filter(|_| moved);
    if let Some(control) = focused.and_then(|id| ui.ctx().read_response(id))
        && ui.min_rect().x_range().contains(control.rect.center().x)
    {
        ui.scroll_to_rect(control.rect.expand2(egui::vec2(0.0, 2.0 * space::ROW_HEIGHT)), None);
    }
}

/// The offset that keeps what is under the pointer, or else at the top of the `view`, where it was,
/// after what is above it has grown or shrunk; none where it has not. `offset` is what was drawn
/// with.
fn held(ui: &Ui, (view, offset): (Rect, f32), before: &Tops, after: &Tops) -> Option<f32> {
    let pointer = ui.input(|input| input.pointer.latest_pos());
    let at = pointer.filter(|at| view.contains(*at)).map_or(0.0, |at| at.y - view.top());
    let (title, was) = before.iter().rfind(|(_, top)| *top <= at + offset)?;
    let (_, is) = after.iter().find(|(other, _)| other == title)?;
    let held = (offset + is - was).max(0.0);
    ((held - offset).abs() > 0.5).then_some(held)
}
