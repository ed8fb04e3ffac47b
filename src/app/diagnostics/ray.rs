//! The ray inspector: the medium along the ray of a pixel, and the pdfs of distances there.

use std::sync::Arc;

use egui::{Context, CursorIcon, Grid, Label, RichText, Sense, Stroke, Ui, pos2, vec2};
use glam::{UVec2, Vec2};

use super::curves::{DENSITIES, RayCurve, SHARES};
use super::plots;
use crate::app::jobs::background::{Background, BackgroundPool};
use crate::app::jobs::live_render::LiveRender;
use crate::app::picture::view::View;
use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::significant;
use crate::error::NO_PROGRESS;
use crate::transport::prepare::SceneProbes;
use crate::transport::profile::{Profile, ProfileRow};
use crate::transport::{Frame, PreparedFrame, Scene};

/// Rows of the table behind the curves.
const ROWS: u32 = 300;
/// Radius of the mark around the pixel in points, at least.
const MARK: f32 = 6.0;
/// Room for the name of a curve and for its value.
const COLUMNS: [f32; 2] = [110.0, 50.0];
/// Height of a row of the legend.
const ROW: f32 = 15.0;

/// The scene and the pixel whose ray is looked into.
#[derive(Clone)]
struct RayScene {
    scene: Arc<Scene>,
    probes: Option<Arc<SceneProbes>>,
    pixel: UVec2,
    /// Width and height of the picture in pixels.
    size: UVec2,
}

impl RayScene {
    fn same(&self, other: &Self) -> bool {
        self.same_picture(other) && self.pixel == other.pixel
    }

    fn same_picture(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.probes.as_ref().map(Arc::as_ptr) == other.probes.as_ref().map(Arc::as_ptr)
            && self.size == other.size
    }

    /// Profile of the ray; `known` is the frame of the same picture, if there is one.
    fn found(&self, known: Option<Arc<PreparedFrame>>) -> Option<Found> {
        let Self { scene, probes, size, .. } = self;
        let make = || {
            let frame = Frame::with_probes(scene.clone(), *size, 0, probes.clone());
            frame.prepared(NO_PROGRESS)
        };
        let frame = match known {
            Some(frame) => frame,
            None => Arc::new(make().ok()?),
        };
        let ray = scene.camera.ray(*size, self.pixel, Vec2::splat(0.5));
        let profile = Profile::along(&frame, &ray, ROWS);
        Some(Found { frame, profile })
    }
}

/// The findings along a ray.
struct Found {
    /// Frame for the next ray of the same picture, since its pilot takes a while.
    frame: Arc<PreparedFrame>,
    /// Profile of the ray; `None` where it meets no medium.
    profile: Option<Profile>,
}

/// The ray inspector: the picked pixel and the profile of its ray.
pub struct Inspector {
    /// Picked position in the picture, in shares of its sides.
    picked: Option<Vec2>,
    profile: Background<RayScene, Option<Found>>,
    /// The distance whose values are read.
    at: Option<f32>,
}

impl Inspector {
    /// An inspector without a pixel; `pool` will compute profiles.
    pub fn new(pool: &BackgroundPool) -> Self {
        Self { picked: None, profile: Background::new(pool), at: None }
    }

    /// Brings the table in line with pixel and scene; forgets both unless `wanted`.
    pub fn update(&mut self, ctx: &Context, wanted: bool, live_render: &LiveRender) {
        if !wanted {
            (self.picked, self.at) = (None, None);
            self.profile.clear();
            return;
        }
        let size = live_render.picture().map(|picture| picture.size);
        let built = live_render.built().map(|built| built.scene.clone());
        let source = self.picked.zip(size).zip(built).map(|((picked, size), scene)| {
            let pixel = (picked * size.as_vec2()).as_uvec2().min(size - UVec2::ONE);
            RayScene { scene, probes: live_render.probes(), pixel, size }
        });
        let known =
            source.as_ref().zip(self.profile.done()).and_then(|(source, (other, found))| {
                found
                    .as_ref()
                    .filter(|_| source.same_picture(other))
                    .map(|found| found.frame.clone())
            });
        let (make, wake) = (move |source: &RayScene| source.found(known), ctx.clone());
        self.profile.update(source, RayScene::same, make, move || wake.request_repaint());
    }

    /// Picks the pixel that is clicked, marks it and shows what lies along its ray; whether to go
    /// on.
    pub fn show(&mut self, ui: &mut Ui, view: &View) -> bool {
        if view.hovered {
            ui.set_cursor_icon(CursorIcon::Crosshair);
        }
        if let Some(pixel) = view.clicked {
            self.picked = Some((pixel.as_vec2() + 0.5) / view.size.as_vec2());
            self.at = None;
            ui.ctx().request_repaint();
        }
        let Some(picked) = self.picked else { return true };
        mark(ui, view, picked * view.size.as_vec2());
        let mut open = true;
        let room = view.rect.shrink(f32::from(space::PANEL));
        egui::Window::new("Ray")
            .open(&mut open)
            .resizable(false)
            .collapsible(false)
            .constrain_to(view.rect)
            .pivot(egui::Align2::RIGHT_BOTTOM)
            .default_pos(room.right_bottom())
            .show(ui.ctx(), |ui| self.contents(ui));
        open
    }

    fn contents(&mut self, ui: &mut Ui) {
        let Some((source, Some(Found { profile, .. }))) = self.profile.done() else {
            ui.label("Measuring the ray…");
            return;
        };
        let UVec2 { x, y } = source.pixel;
        let Some(profile) = profile else {
            ui.label(format!("Pixel {x}, {y}: no medium along this ray."));
            return;
        };
        let depth = significant(f64::from(profile.optical_depth));
        let guided = match profile {
            Profile { flights_scale: 0.0, .. } => ", probes switched off automatically",
            Profile { guided: false, .. } => ", no probes",
            _ => "",
        };
        ui.label(format!("Pixel {x}, {y}: optical depth {depth}{guided}"));
        let at = self.at.unwrap_or_else(|| most_telling(&profile.rows));
        let read = ui
            .horizontal_top(|ui| {
                let read = ui.vertical(|ui| plots::show(ui, &profile.rows, at)).inner;
                ui.vertical(|ui| row_values(ui, row_at(&profile.rows, read.unwrap_or(at))));
                read
            })
            .inner;
        self.at = read.or(self.at);
    }
}

/// Distance at which the pdf of distances is largest, or else the emission.
fn most_telling(rows: &[ProfileRow]) -> f32 {
    let by = |value: fn(&ProfileRow) -> f32| {
        let most = rows.iter().max_by(|a, b| value(a).total_cmp(&value(b)));
        most.filter(|row| value(row) > 0.0).map(|row| row.t)
    };
    by(|row| row.p_null)
        .or_else(|| by(|row| row.emission))
        .or_else(|| rows.first().map(|row| row.t))
        .unwrap_or_default()
}

/// The row nearest to a distance.
fn row_at(rows: &[ProfileRow], t: f32) -> ProfileRow {
    let nearest = rows.iter().min_by(|a, b| (a.t - t).abs().total_cmp(&(b.t - t).abs()));
    nearest.copied().unwrap_or_default()
}

/// The legend, with the values of one row.
fn row_values(ui: &mut Ui, row: ProfileRow) {
    ui.spacing_mut().item_spacing = vec2(space::ROW, 2.0);
    let distance = format!("At distance {}", significant(f64::from(row.t)));
    ui.label(RichText::new(distance).color(color::TEXT_STRONG));
    ui.add_space(space::TIGHT);
    for (id, curves) in [DENSITIES.as_slice(), SHARES.as_slice()].into_iter().enumerate() {
        Grid::new(("ray", id)).num_columns(3).min_row_height(ROW).show(ui, |ui| {
            for curve in curves {
                entry(ui, curve, (curve.value)(&row));
                ui.end_row();
            }
        });
        ui.add_space(space::ROW);
    }
}

fn entry(ui: &mut Ui, curve: &RayCurve, value: f32) {
    ui.horizontal(|ui| {
        ui.set_min_width(COLUMNS[0]);
        let (swatch, _) = ui.allocate_exact_size(vec2(12.0, 14.0), Sense::empty());
        let line = [swatch.left_center(), swatch.right_center()];
        ui.painter().line_segment(line, Stroke::new(2.0, curve.color));
        let name = RichText::new(curve.name).small().color(color::TEXT_DIM);
        ui.add(Label::new(name)).on_hover_text(curve.help);
    });
    let value = significant(f64::from(value));
    let text = RichText::new(&value).small().color(color::TEXT_STRONG);
    ui.scope(|ui| {
        ui.set_min_width(COLUMNS[1]);
        let spoken = format!("{} {value}", curve.name);
        let label = ui.label(text);
        label.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &spoken));
    });
    ui.add(Label::new(RichText::new(curve.unit).small().color(color::TEXT_DIM)).extend());
}

/// Marks a place of the picture, given in its pixels.
fn mark(ui: &Ui, view: &View, at: Vec2) {
    let center = view.window_at(at);
    let radius = MARK.max(0.75 * view.placement.scale / view.factor);
    let painter = ui.painter_at(view.rect);
    for (width, color) in [(3.0, color::WELL), (1.2, color::TEXT_STRONG)] {
        painter.circle_stroke(pos2(center.x, center.y), radius, Stroke::new(width, color));
    }
}
