//! Handles over the picture that move the light that is selected. What they are and what a drag
//! does are pure functions; this draws them and keeps the hand's grip.

mod drag;
mod figure;
mod lens;

use egui::{Color32, CursorIcon, Pos2, Rect, Response, Sense, Stroke, Ui, vec2};
use glam::Vec3A;

use super::state::Editor;
use super::theme::color;
use super::viewport::View;
use crate::scene;
use crate::scene::settings::LightSettings;
use figure::{Figure, Handle, Part};
use lens::Lens;

/// Reach of the hand around a handle, in points.
const REACH: f32 = 9.0;
/// Radius of the dot of a handle, in points.
const DOT: f32 = 4.0;

/// The light that is selected and the grip on one of its handles.
#[derive(Default)]
pub struct Gizmo {
    /// Which light has handles; none is drawn otherwise.
    pub selected: Option<usize>,
    grip: Option<Grip>,
}

/// A handle in the hand.
struct Grip {
    handle: Handle,
    /// The light as it was when the drag began.
    light: LightSettings,
    /// Where the drag began.
    from: Pos2,
}

impl Gizmo {
    /// Draws the handles of the selected light over the picture in `view` and lets the hand move
    /// them. A sun, which is nowhere, is drawn around `pivot`.
    pub fn show(&mut self, ui: &Ui, view: View, editor: &mut Editor, pivot: Vec3A) {
        let settings = &mut editor.document.settings;
        let camera = scene::camera(settings).ok();
        let light = self.selected.and_then(|index| settings.light.get_mut(index));
        let (Some(light), Some(camera)) = (light, camera) else {
            self.grip = None;
            return;
        };
        let lens = Lens { camera, view };
        let handles = Figure::of(light, &lens, pivot).handles_on(&lens);
        let responses: Vec<Response> =
            handles.iter().map(|(handle, at)| sense(ui, view, *handle, *at)).collect();
        if responses.iter().any(Response::drag_started) {
            let origin = ui.input(|input| input.pointer.press_origin());
            self.grip = origin.and_then(|from| Grip::at(from, &handles, light));
        }
        let held = responses.iter().find(|response| response.dragged());
        let to = held.and_then(Response::interact_pointer_pos);
        self.grip = self.grip.take().filter(|_| to.is_some());
        let mut edit = None;
        if let (Some(Grip { handle, light: before, from }), Some(to)) = (&self.grip, to) {
            let moved = drag::dragged(before, *handle, &lens, pivot, [*from, to]);
            edit = (*light != moved).then(|| handle.edit());
            *light = moved;
        }
        let hovered = responses.iter().position(Response::hovered);
        let hovered = hovered.and_then(|index| handles.get(index)).map(|(handle, _)| *handle);
        let lit = self.grip.as_ref().map(|grip| grip.handle).or(hovered);
        if lit.is_some() {
            ui.set_cursor_icon(CursorIcon::Move);
        }
        paint(ui, &lens, &Figure::of(light, &lens, pivot), lit);
        if let Some(name) = edit {
            editor.name_edit(name);
        }
    }
}

impl Grip {
    /// Takes hold of the handle that a press at `from` meant.
    fn at(from: Pos2, handles: &[(Handle, Pos2)], light: &LightSettings) -> Option<Self> {
        let handle = figure::nearest(handles, from, 2.0 * REACH)?;
        Some(Self { handle, light: light.clone(), from })
    }
}

/// The place of a handle as something to take hold of. It lies above the picture, which therefore
/// does not orbit.
fn sense(ui: &Ui, view: View, handle: Handle, at: Pos2) -> Response {
    let rect = Rect::from_center_size(at, vec2(2.0 * REACH, 2.0 * REACH)).intersect(view.rect);
    let id = ui.scope_id().with(("light handle", handle));
    let response = ui.interact(rect, id, Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, handle.name()));
    response.on_hover_text(handle.help())
}

/// Draws lines and handles, each on a dark ground, so that they show on any picture.
fn paint(ui: &Ui, lens: &Lens, figure: &Figure, lit: Option<Handle>) {
    let painter = ui.painter_at(lens.view.rect);
    let color_of = |part: Part, is_lit: bool| match part {
        _ if is_lit => color::TEXT_STRONG,
        Part::Axis(axis) => color::AXES.get(axis).copied().unwrap_or(color::TEXT),
        Part::Body => color::ACCENT,
    };
    let segments: Vec<([Pos2; 2], Color32)> = figure
        .lines
        .iter()
        .filter_map(|(line, part)| {
            let is_lit = matches!((part, lit), (Part::Axis(a), Some(Handle::Axis(b))) if *a == b);
            Some((lens.segment(*line)?, color_of(*part, is_lit)))
        })
        .collect();
    for (segment, _) in &segments {
        painter.line_segment(*segment, Stroke::new(3.0, color::WELL.gamma_multiply(0.6)));
    }
    for (segment, color) in &segments {
        painter.line_segment(*segment, Stroke::new(1.2, *color));
    }
    for (handle, at) in figure.handles_on(lens) {
        let fill = color_of(handle.part(), lit == Some(handle));
        painter.circle_filled(at, DOT + 1.0, color::WELL);
        painter.circle_filled(at, DOT, fill);
    }
}
