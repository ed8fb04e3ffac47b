//! Commands of camera and surroundings.

use glam::{UVec2, Vec2};

use super::app::App;
use crate::scene::settings::CameraKey;
use crate::scene::{self, Setup};
use crate::transport::profile::depth_seen;

impl App {
    /// Moves the camera so that everything finite that fills space is in the picture.
    pub(super) fn frame_volume(&mut self) {
        let Some(built) = self.live_render.built() else { return };
        let Some(bounds) = built.scene.world.finite_bounds() else { return };
        let size = self.film_size().unwrap_or(UVec2::ONE).as_vec2();
        let settings = &mut self.editor.document.settings;
        let fitted = scene::fit_camera(&settings.present_camera(), &bounds, size.x / size.y);
        settings.set_present_camera(fitted);
        self.editor.name_edit("frame the volumes");
    }

    /// Puts the volumes in the next surroundings.
    pub(super) fn next_setup(&mut self) {
        let bounds = self.subject_bounds();
        let settings = &mut self.editor.document.settings;
        let next = Setup::of(settings).map_or(Setup::default(), Setup::next);
        next.apply(settings, &bounds);
        self.editor.name_edit("surroundings");
    }

    /// Sets a key of the camera in the present frame, or removes the one that is there.
    pub(super) fn set_or_remove_camera_key(&mut self) {
        let settings = &mut self.editor.document.settings;
        let frame = settings.time.frame;
        if settings.camera.key_of(frame).is_some() {
            settings.camera.remove_key(frame);
            self.editor.name_edit("remove the camera key");
        } else {
            let key = CameraKey::of(&settings.present_camera(), frame);
            settings.camera.put_key(key);
            self.editor.name_edit("camera key");
        }
    }

    /// Lets the next click on the picture choose the focus.
    pub(super) fn pick_focus(&mut self) {
        self.viewport.picks_focus = true;
        self.notices.done("Click on the picture to focus there. Escape cancels.");
    }

    /// Focuses on what is seen in a pixel of the picture.
    pub(super) fn focus_on(&mut self, pixel: UVec2) {
        self.viewport.picks_focus = false;
        let size = self.live_render.picture().map(|picture| picture.size);
        let Some((built, size)) = self.live_render.built().zip(size) else { return };
        let ray = built.scene.camera.ray(size, pixel, Vec2::splat(0.5));
        let Some(depth) = depth_seen(&built.scene, &ray) else {
            self.notices.done("Nothing is seen there to focus on.");
            return;
        };
        let camera = &mut self.editor.document.settings.camera;
        camera.focus_distance = Some(built.scene.camera.view_from_world(ray.at(depth)).z);
        if camera.f_stop == 0.0 {
            self.notices.done("A pinhole has everything in focus. Set an f-stop for a lens.");
        }
        self.editor.name_edit("focus distance");
    }
}
