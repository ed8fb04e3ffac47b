//! A frame of the window: input, changes, layout.

use std::time::Duration;

use egui::{Context, Ui};
use glam::{UVec2, Vec3A};

use super::app::App;
use super::file_requests::FileRequests;
use crate::app::command::Command;
use crate::app::document::Compared;
use crate::error::Result;
use crate::math::Aabb;

impl App {
    /// Runs one frame in `ui`, which spans the window.
    pub fn frame(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.pace.keep();
        if let Some(stats) = &mut self.stats {
            stats.frame();
        }
        let mut news = self.live_render.poll();
        news.extend(self.compare.second_side.poll());
        self.take_in(&ctx, news);
        self.take_in_arrivals(&ctx);
        self.save_waiting(&ctx);
        self.update_snapshots(&ctx);
        self.editor.begin_frame(&ctx);
        self.take_changed_scene();
        self.update_time_line(&ctx);
        let mut commands = Command::pressed(&ctx);
        if self.is_asking() {
            // The key closes what is open in front.
            commands.retain(|command| *command != Command::LivePicture);
        }
        self.layout(ui, &mut commands);
        self.chrome.sections.settle();
        for command in commands {
            self.execute(&ctx, command);
        }
        if self.editor.end_frame()
            && let Some(stats) = &mut self.stats
        {
            stats.edited();
        }
        self.bring_up_to_date(&ctx);
        self.watch_over_changes(&ctx);
        self.preferences.scale = ctx.zoom_factor();
    }

    /// Whether something is open in front that the escape key closes.
    fn is_asking(&self) -> bool {
        let FileRequests { path_bar, dropped, .. } = &self.files;
        path_bar.is_some() || dropped.is_some() || self.chrome.palette.is_some()
    }

    /// Finishes what is being saved and writes the diagnostic figures, if they were asked for.
    pub fn close(&mut self) {
        self.files.saver.finish();
        self.snapshots.close();
        // Nobody is left to report a failure to.
        let _ = self.write_preferences();
        if let Some(stats) = &self.stats {
            stats.write();
        }
    }

    /// Writes what the window keeps between runs.
    pub(super) fn write_preferences(&mut self) -> Result<()> {
        self.preferences.folded = self.chrome.folded;
        self.preferences.sections = self.chrome.sections.chosen();
        self.preferences.note_tone(self.editor.document.tone);
        self.preferences.note_references(self.compare.reference.files());
        match &self.data_folder {
            Some(folder) => self.preferences.write(folder),
            None => Ok(()),
        }
    }

    /// Brings all that shows the document in line with it: layers and region, the second render,
    /// the main render, and the figures measured on their pictures. The renders decide themselves
    /// whether an edit makes them start over.
    fn bring_up_to_date(&mut self, ctx: &Context) {
        self.diagnostics.update(ctx, &mut self.live_render);
        self.compare.second_side.set_layer(self.diagnostics.wanted.layer);
        self.update_versus();
        let Some(size) = self.film_size() else { return };
        let alone = self.compare.region.alone(size);
        self.live_render.render_region_only(alone);
        self.compare.second_side.render_region_only(alone);
        let mut news = Vec::new();
        let document = &self.editor.document;
        match self.compare.second_side.update(ctx, document, &mut self.live_render, size) {
            Ok(more) => news.extend(more),
            Err(error) => {
                self.notices.failed(error.to_string());
                self.editor.document.compared = None;
            }
        }
        let document = &self.editor.document;
        let wait = match document.compared {
            None => self.live_render.update(&document.settings, size, &mut news),
            Some(Compared { main, .. }) => {
                self.live_render.update(&document.settings_of(main), size, &mut news)
            }
        };
        if let Some(wait) = wait {
            ctx.request_repaint_after(wait.max(Duration::from_millis(1)));
        }
        self.take_in(ctx, news);
        self.reload_changed_files(ctx);
        self.update_measures(ctx);
        self.update_sweep(ctx);
    }

    /// The size of the film: its own or the window's; `None` before the first frame.
    pub(super) fn film_size(&self) -> Option<UVec2> {
        let document = &self.editor.document;
        if document.keep_size {
            let size = UVec2::from(document.settings.film.size);
            return Some(size.clamp(UVec2::ONE, UVec2::splat(self.largest)));
        }
        self.viewport.film_size()
    }

    /// The box around all that fills space, or around the camera's target where nothing does.
    pub(super) fn subject_bounds(&self) -> Aabb {
        let camera = self.editor.document.settings.present_camera();
        let target = Vec3A::from(camera.target);
        let around = Vec3A::splat(0.25 * target.distance(camera.position.into()).max(1e-3));
        let filled = self.live_render.built().and_then(|built| built.scene.world.finite_bounds());
        filled.unwrap_or_else(|| Aabb::new(target - around, target + around))
    }
}
