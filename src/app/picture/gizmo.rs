//! Handles over the picture that move the light that is selected. What they are and what a drag
//! does are pure functions; this draws them and keeps the hand's grip.

mod drag;
mod figure;
mod lens;

use egui::{Color32, CursorIcon, Pos2, Rect, Response, Sense, Stroke, Ui, vec2};
use glam::Vec3A;

use super::view::View;
use crate::app::document::Editor;
use crate::app::ui::theme::color;
use crate::app::ui::widgets::arrow_steps;
use crate::scene;
use crate::scene::settings::LightSettings;
use figure::{Figure, Handle, HandlePart};
use lens::Lens;

/// Radius around a handle in which a press takes it, in points.
const REACH: f32 = 9.0;
/// Step of an arrow key for a handle that has the focus, in points.
const NUDGE: f32 = 8.0;
/// Radius of the dot of a handle, in points.
const DOT: f32 = 4.0;

/// The light that is selected and the grip on one of its handles.
#[derive(Default)]
pub struct Gizmo {
    /// Index of the light that has handles; none are drawn otherwise.
    pub selected: Option<usize>,
    grip: Option<Grip>,
}

/// A handle that is being dragged.
struct Grip {
    handle: Handle,
    /// The light as it was when the drag began.
    light: LightSettings,
    /// Position where the drag began.
    from: Pos2,
}

impl Gizmo {
    /// Draws the handles of the selected light over the picture in `view` and lets the hand move
    /// them. A sun, which is nowhere, is drawn around `pivot`.
    pub fn show(&mut self, ui: &Ui, view: View, editor: &mut Editor, pivot: Vec3A) {
        let Some(light) = self.light(editor) else {
            self.grip = None;
            return;
        };
        self.take_hold(ui, view, editor, &light, pivot);
        let Ok(camera) = scene::camera(&editor.document.settings) else { return };
        let lens = Lens { camera, view };
        let moved = self.pull(ui, &lens, pivot).unwrap_or(light.clone());
        let figure = Figure::of(&moved, &lens, pivot);
        let handles = figure.handles_on(&lens);
        let responses: Vec<(Handle, Pos2, Response)> = handles
            .into_iter()
            .map(|(handle, at)| (handle, at, sense(ui, view, handle, at)))
            .collect();
        let under = responses.iter().find(|(.., response)| response.hovered());
        let focused = responses.iter().find(|(.., response)| response.has_focus());
        let held = self.grip.as_ref().map(|grip| grip.handle);
        if held.is_some() || under.is_some() {
            ui.set_cursor_icon(CursorIcon::Move);
        }
        let lit = held.or(under.or(focused).map(|(handle, ..)| *handle));
        paint(ui, &lens, &figure, lit);
        let (handle, moved) = match focused.filter(|_| held.is_none()) {
            Some((handle, at, response)) => {
                let to = *at + NUDGE * arrow_steps(ui, response.id);
                (Some(*handle), drag::dragged(&moved, *handle, &lens, pivot, [*at, to]))
            }
            None => (held, moved),
        };
        if let (Some(handle), true) = (handle, moved != light) {
            editor.name_edit(handle.edit());
            if let Some(light) =
                self.selected.and_then(|at| editor.document.settings.light.get_mut(at))
            {
                *light = moved;
            }
        }
    }

    fn light(&self, editor: &Editor) -> Option<LightSettings> {
        editor.document.settings.light.get(self.selected?).cloned()
    }

    /// Takes hold of the handle under a press, and lets go of it with the button. Where frames are
    /// long, the hand may have left the handle before the press is seen, and the picture believes
    /// that it is dragged: what counts is where the press was, and the camera stays.
    fn take_hold(
        &mut self,
        ui: &Ui,
        view: View,
        editor: &mut Editor,
        light: &LightSettings,
        pivot: Vec3A,
    ) {
        let start = &editor.frame_start().settings;
        let (pressed, down, from) = ui.input(|input| {
            let pointer = &input.pointer;
            (pointer.primary_pressed(), pointer.primary_down(), pointer.press_origin())
        });
        let from = from.filter(|from| ui.ctx().layer_id_at(*from) == Some(ui.layer_id()));
        if let (true, Some(from), Ok(camera)) = (pressed, from, scene::camera(start)) {
            let lens = Lens { camera, view };
            let handles = Figure::of(light, &lens, pivot).handles_on(&lens);
            let handle = figure::nearest(&handles, from, REACH);
            self.grip = handle.map(|handle| Grip { handle, light: light.clone(), from });
        }
        if !down {
            self.grip = None;
        }
        if self.grip.is_some() {
            editor.document.settings.camera = start.camera.clone();
        }
    }

    /// The light as it has been dragged.
    fn pull(&self, ui: &Ui, lens: &Lens, pivot: Vec3A) -> Option<LightSettings> {
        let Grip { handle, light, from } = self.grip.as_ref()?;
        let to = ui.input(|input| input.pointer.latest_pos())?;
        (to != *from).then(|| drag::dragged(light, *handle, lens, pivot, [*from, to]))
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
    let color_of = |part: HandlePart, is_lit: bool| match part {
        _ if is_lit => color::TEXT_STRONG,
        HandlePart::Axis(axis) => color::AXES.get(axis).copied().unwrap_or(color::TEXT),
        HandlePart::Body => color::ACCENT,
    };
    let segments: Vec<([Pos2; 2], Color32)> = figure
        .lines
        .iter()
        .filter_map(|(line, part)| {
            let is_lit =
                matches!((part, lit), (HandlePart::Axis(a), Some(Handle::Axis(b))) if *a == b);
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
