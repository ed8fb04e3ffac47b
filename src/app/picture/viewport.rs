//! The viewport: camera moves, zoom to pixels, the value under the pointer.

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{CursorIcon, Key, PointerButton, Rect, Response, Sense, Stroke, Ui};
use glam::{UVec2, Vec2, Vec3};

use super::display;
use super::look::Look;
use super::navigation::Pose;
use super::pixel_values;
use super::region::PictureRegion;
use super::view::{View, from_egui};
use super::zoom::{Placement, Zoom};
use crate::app::document::Editor;
use crate::app::ui::theme::color;
use crate::app::ui::widgets::arrow_steps;
use crate::image::tone::Channel;
use crate::render::{Layer, Picture};
use crate::scene::settings::CameraSettings;

/// A new size has to last this long before the film takes it.
const SETTLE: Duration = Duration::from_millis(120);
/// Points of the wheel's travel that count as one notch.
const NOTCH: f32 = 50.0;
/// Zoom from which on the pixel under the pointer is outlined.
const OUTLINE_FROM: f32 = 8.0;
/// Step by which an arrow key drags the picture, in widths of it.
const STEP: f32 = 0.02;
/// The zoom of the zoom-to-pixels command.
const PIXEL_ZOOM: f32 = 8.0;

/// A pixel and its linear value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Column and row, row 0 on top.
    pub pixel: UVec2,
    /// Linear red, green, blue and alpha, before exposure.
    pub value: [f32; 4],
    /// The number of the layer, where one is shown.
    pub number: Option<(f32, Option<Layer>)>,
}

/// The pictures that the viewport shows.
#[derive(Clone, Debug)]
pub enum Shown {
    /// No picture yet.
    Nothing,
    /// One picture.
    One(Arc<Picture>, Look),
    /// Two pictures of the same view, the second from this share of the width on.
    Wipe([Arc<Picture>; 2], Look, f32),
    /// Two beside each other, zoomed and moved as one.
    Beside([Arc<Picture>; 2], Look),
}

/// A part of the viewport with a picture.
struct ViewportPane<'p> {
    picture: &'p Arc<Picture>,
    look: Look,
    /// The area that the picture is laid out in.
    area: Rect,
    /// The part of that area that is seen.
    clip: Rect,
}

impl Shown {
    /// Look of the picture, where there is one.
    pub fn look(&self) -> Option<Look> {
        match self {
            Self::Nothing => None,
            Self::One(_, look) | Self::Wipe(_, look, _) | Self::Beside(_, look) => Some(*look),
        }
    }

    /// Whether colors stand for stops.
    pub fn is_false_color(&self) -> bool {
        matches!(
            self.look(),
            Some(Look::Picture(tone) | Look::Light(tone)) if tone.channel == Channel::FalseColor
        )
    }

    fn panes(&self, rect: Rect) -> Vec<ViewportPane<'_>> {
        let pane = |picture, look, area, clip| ViewportPane { picture, look, area, clip };
        match self {
            Self::Nothing => Vec::new(),
            Self::One(picture, look) => vec![pane(picture, *look, rect, rect)],
            Self::Wipe([a, b], look, share) => {
                let (left, right) = rect.split_left_right_at_fraction(share.clamp(0.0, 1.0));
                vec![pane(a, *look, rect, left), pane(b, *look, rect, right)]
            }
            Self::Beside([a, b], look) => {
                let (left, right) = rect.split_left_right_at_fraction(0.5);
                let halves = [left, right].map(|half| half.shrink2(egui::vec2(1.0, 0.0)));
                vec![pane(a, *look, halves[0], halves[0]), pane(b, *look, halves[1], halves[1])]
            }
        }
    }
}

/// The state of the viewport between frames.
#[derive(Debug, Default)]
pub struct Viewport {
    /// Zoom of the picture.
    pub zoom: Zoom,
    /// The pixel under the pointer and its value.
    pub probe: Option<Probe>,
    /// Whether the next click chooses the focus of the camera.
    pub picks_focus: bool,
    /// Whether the keyboard is to go to the picture.
    pub wants_keyboard: bool,
    /// The area in framebuffer pixels that the film fills, once it has lasted.
    settled: Option<UVec2>,
    /// The area of the last frame and since when it has been so.
    area: Option<(UVec2, Instant)>,
    /// Last position of the pointer, in framebuffer pixels from the viewport's corner.
    pointer: Option<Vec2>,
    /// The viewport's size in framebuffer pixels.
    size: Vec2,
}

impl Viewport {
    /// Notes the area that the film may fill, in framebuffer pixels, at most `largest` a side.
    /// Gives the time until a change counts, while one is on its way.
    pub fn resize(&mut self, area: UVec2, largest: u32) -> Option<Duration> {
        let area = area.clamp(UVec2::ONE, UVec2::splat(largest));
        let since = match self.area {
            Some((same, since)) if same == area => since,
            _ => Instant::now(),
        };
        self.area = Some((area, since));
        let waiting = SETTLE.checked_sub(since.elapsed());
        if self.settled.is_none() || waiting.is_none() {
            self.settled = Some(area);
        }
        waiting.filter(|_| self.settled != Some(area))
    }

    /// The size for a film that follows the window; `None` before the first frame.
    pub fn film_size(&self) -> Option<UVec2> {
        self.settled
    }

    /// Zooms to pixels around the pointer, or back to the whole picture.
    pub fn toggle_pixel_zoom(&mut self, picture: Option<UVec2>) {
        let Some(picture) = picture else { return };
        let at = self.pointer.unwrap_or(0.5 * self.size);
        self.zoom = match self.zoom {
            Zoom::Fit => self.zoom.at_scale(PIXEL_ZOOM, at, picture, self.size),
            Zoom::Pixels { .. } => Zoom::Fit,
        };
    }

    /// Framebuffer pixels per picture pixel.
    pub fn scale(&self, picture: UVec2) -> f32 {
        self.zoom.place(picture, self.size).scale
    }

    /// Shows what there is in the rest of `ui` and lets the hand move camera and zoom, or draw the
    /// region. Gives where the pictures lie, those of a wipe as one.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        editor: &mut Editor,
        shown: &Shown,
        region: &mut PictureRegion,
    ) -> Vec<View> {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Picture"));
        if std::mem::take(&mut self.wants_keyboard) {
            response.request_focus();
        }
        let factor = ui.pixels_per_point();
        let panes = shown.panes(rect);
        let under = response.hover_pos();
        let hovered = panes
            .iter()
            .find(|pane| under.is_some_and(|at| pane.clip.contains(at)))
            .or(panes.first());
        let area = hovered.map_or(rect, |pane| pane.area);
        self.size = from_egui(area.size()) * factor;
        self.pointer = under.map(|at| from_egui(at - area.min) * factor);
        let view = hovered.map(|pane| self.view(pane, factor));
        if self.picks_focus && response.hovered() {
            ui.set_cursor_icon(CursorIcon::Crosshair);
        }
        steer(ui, &response, editor);
        if !region.draw(ui, &response, view.as_ref()) {
            self.navigate(ui, &response, editor, hovered.map(|pane| pane.picture.size));
        }
        self.probe = None;
        if panes.is_empty() {
            ui.painter().rect_filled(rect, 0.0, color::SURROUND);
        }
        for (index, pane) in panes.iter().enumerate() {
            self.paint(ui, pane, index);
        }
        if response.has_focus() {
            let inside = rect.shrink(1.0);
            let stroke = Stroke::new(2.0, color::ACCENT);
            ui.painter().rect_stroke(inside, 0.0, stroke, egui::StrokeKind::Inside);
        }
        let Some(hovered) = hovered else { return Vec::new() };
        let placement = self.zoom.place(hovered.picture.size, self.size);
        self.probe = self.pointer.and_then(|at| probe(hovered.picture, placement, at));
        if let Some(probe) = self.probe
            && placement.scale >= OUTLINE_FROM
        {
            outline(ui, hovered.area, placement, probe.pixel, factor);
        }
        let clicked = response.clicked().then_some(self.probe).flatten().map(|probe| probe.pixel);
        let hovers = response.hovered();
        let view = |pane| View { hovered: hovers, clicked, ..self.view(pane, factor) };
        let mut views: Vec<View> = panes.iter().map(view).collect();
        views.dedup_by_key(|view| view.rect);
        views
    }

    /// Place of the picture of a pane.
    fn view(&self, pane: &ViewportPane<'_>, factor: f32) -> View {
        let size = pane.picture.size;
        let placement = self.zoom.place(size, self.size);
        View { rect: pane.area, placement, factor, size, hovered: false, clicked: None }
    }

    fn paint(&self, ui: &Ui, pane: &ViewportPane<'_>, index: usize) {
        let shot = display::Shot {
            picture: pane.picture.clone(),
            look: pane.look,
            placement: self.zoom.place(pane.picture.size, self.size),
            area: pane.area,
            clip: pane.clip,
            pane: index,
        };
        let placement = shot.placement;
        display::paint(ui.painter(), shot);
        let rects = [pane.area, pane.clip];
        let shown = (pane.picture.as_ref(), pane.look);
        pixel_values::paint(ui.painter(), rects, shown, placement, ui.pixels_per_point());
    }

    fn navigate(
        &mut self,
        ui: &Ui,
        response: &Response,
        editor: &mut Editor,
        picture: Option<UVec2>,
    ) {
        let modifiers = ui.input(|input| input.modifiers);
        let drag = from_egui(response.drag_delta());
        let width = response.rect.width().max(1.0);
        let primary = response.dragged_by(PointerButton::Primary);
        if let Some(picture) = picture {
            if primary && modifiers.command {
                let drag = drag * ui.pixels_per_point();
                self.zoom = self.zoom.panned(drag, picture, self.size);
                ui.set_cursor_icon(CursorIcon::Grabbing);
                return;
            }
            if response.double_clicked() {
                self.zoom = Zoom::Fit;
            }
            let zoom = ui.input(egui::InputState::zoom_delta);
            if let Some(at) = self.pointer
                && zoom != 1.0
            {
                self.zoom = self.zoom.zoomed(zoom, at, picture, self.size);
                return;
            }
        }
        let camera = editor.document.settings.present_camera();
        let pose = pose(&camera);
        let (name, moved) =
            if response.dragged_by(PointerButton::Middle) || primary && modifiers.shift {
                ("pan", pose.pan(drag / width, camera.fov_x))
            } else if primary {
                ("orbit", pose.orbit(drag / width))
            } else if response.dragged_by(PointerButton::Secondary) {
                ("dolly", pose.dolly(-drag.y / 20.0))
            } else if response.contains_pointer() {
                let wheel = ui.input(|input| input.smooth_scroll_delta().y);
                ("dolly", if wheel == 0.0 { pose } else { pose.dolly(wheel / NOTCH) })
            } else {
                return;
            };
        move_camera(editor, camera, moved, name);
    }
}

/// Moves the camera by keys while the picture has the focus.
fn steer(ui: &Ui, response: &Response, editor: &mut Editor) {
    if !response.has_focus() {
        return;
    }
    let steps = from_egui(arrow_steps(ui, response.id));
    let pressed = |key| ui.input(|input| input.num_presses(key)) as f32;
    let closer = pressed(Key::PageUp) - pressed(Key::PageDown);
    let shift = ui.input(|input| input.modifiers.shift);
    let camera = editor.document.settings.present_camera();
    let pose = pose(&camera);
    let (name, moved) = match (steps != Vec2::ZERO, shift) {
        (true, true) => ("pan", pose.pan(-STEP * steps, camera.fov_x)),
        (true, false) => ("orbit", pose.orbit(STEP * steps)),
        (false, _) if closer != 0.0 => ("dolly", pose.dolly(closer)),
        (false, _) => return,
    };
    move_camera(editor, camera, moved, name);
}

/// Moves the camera of the present frame, and names that edit where it is one.
fn move_camera(editor: &mut Editor, mut camera: CameraSettings, moved: Pose, name: &str) {
    let before = camera.clone();
    set_pose(&mut camera, moved);
    if camera != before {
        editor.document.settings.set_present_camera(camera);
        editor.name_edit(name);
    }
}

/// Pose of the camera of these settings.
pub fn pose(camera: &CameraSettings) -> Pose {
    Pose {
        position: Vec3::from_array(camera.position),
        target: Vec3::from_array(camera.target),
        up: Vec3::from_array(camera.up),
    }
}

/// Puts the camera of these settings there; a zero drag leaves it untouched to the last bit.
pub fn set_pose(camera: &mut CameraSettings, moved: Pose) {
    let still = pose(camera);
    let near = |a: Vec3, b: Vec3| a.distance(b) <= 1e-6 * still.position.distance(still.target);
    if near(moved.position, still.position) && near(moved.target, still.target) {
        return;
    }
    camera.position = moved.position.to_array();
    camera.target = moved.target.to_array();
}

fn probe(picture: &Picture, placement: Placement, at: Vec2) -> Option<Probe> {
    let pixel = placement.pixel_at(at, picture.size)?;
    let index = pixel.y as usize * picture.size.x as usize + pixel.x as usize;
    let layer = &picture.layer;
    let number = layer.numbers.get(index).map(|&number| (number, layer.layer));
    let value = layer.light.get(index).or_else(|| picture.pixels.get(index));
    Some(Probe { pixel, value: *value?, number })
}

/// Draws a frame around a pixel.
fn outline(ui: &Ui, rect: Rect, placement: Placement, pixel: UVec2, factor: f32) {
    let low = (placement.corner + pixel.as_vec2() * placement.scale) / factor;
    let min = rect.min + egui::vec2(low.x, low.y);
    let pixel = Rect::from_min_size(min, egui::Vec2::splat(placement.scale / factor));
    let painter = ui.painter_at(rect);
    let dark = Stroke::new(1.0, color::WELL);
    painter.rect_stroke(pixel.expand(1.0), 0.0, dark, egui::StrokeKind::Outside);
    let light = Stroke::new(1.0, color::TEXT_STRONG);
    painter.rect_stroke(pixel, 0.0, light, egui::StrokeKind::Outside);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::LayerMap;

    #[test]
    fn the_film_waits_for_a_size_that_lasts() {
        let mut viewport = Viewport::default();
        assert_eq!(viewport.resize(UVec2::new(800, 600), 8192), None);
        assert_eq!(viewport.film_size(), Some(UVec2::new(800, 600)));
        assert!(viewport.resize(UVec2::new(810, 600), 8192).is_some());
        assert!(viewport.resize(UVec2::new(820, 600), 8192).is_some());
        assert_eq!(viewport.film_size(), Some(UVec2::new(800, 600)));
        std::thread::sleep(SETTLE + Duration::from_millis(20));
        assert_eq!(viewport.resize(UVec2::new(820, 600), 8192), None);
        assert_eq!(viewport.film_size(), Some(UVec2::new(820, 600)));
        assert_eq!(Viewport::default().resize(UVec2::new(0, 9000), 8192), None);
    }

    #[test]
    fn the_probe_reads_the_pixel_under_the_pointer() {
        let picture = Picture {
            generation: 1,
            size: UVec2::new(2, 2),
            pixels: vec![[0.0; 4], [1.0; 4], [2.0; 4], [3.0; 4]],
            layer: LayerMap { numbers: vec![0.0, 1.0, 4.0, 9.0], ..LayerMap::default() },
            complete: true,
            ..Picture::default()
        };
        let placement = Placement { scale: 4.0, corner: Vec2::new(10.0, 10.0) };
        let read = |x, y| probe(&picture, placement, Vec2::new(x, y)).map(|p| p.value[0]);
        assert_eq!(read(15.0, 11.0), Some(1.0));
        let number = probe(&picture, placement, Vec2::new(11.0, 17.9)).and_then(|p| p.number);
        assert_eq!(number, Some((4.0, None)));
        assert_eq!(read(11.0, 17.9), Some(2.0));
        assert_eq!(read(18.1, 11.0), None);
    }
}
