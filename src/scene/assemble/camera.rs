//! The camera of the settings.

use glam::{Vec2, Vec3A};

use crate::error::{Error, Result};
use crate::scene::settings::{CameraSettings, Settings};
use crate::transport::camera::{Camera, Lens, Track, View};

/// The camera of the settings in their frame, with its motion while the shutter is open.
///
/// # Errors
/// The camera has no direction; names the key.
pub fn camera(settings: &Settings) -> Result<Camera> {
    let still = settings.present_camera();
    let View { position, target, up, fov_x } = view(&still);
    let camera = Camera::look_at(position, target, up, fov_x).ok_or_else(|| {
        let reason = "position, target and up must differ in direction";
        Error::invalid("", "camera", reason)
    })?;
    let lens = Lens {
        radius: still.lens_radius(),
        focus_distance: still.focus_distance(),
        shift: Vec2::from(still.shift),
    };
    Ok(camera.with_lens(lens).on_track(track(settings)))
}

fn view(still: &CameraSettings) -> View {
    let [position, target, up] = [still.position, still.target, still.up].map(Vec3A::from_array);
    View { position, target, up, fov_x: still.fov_x }
}

/// The views of the camera at the opening of the shutter, at its closing, and at keys in between.
fn track(settings: &Settings) -> Track {
    let time = &settings.time;
    let open = (time.shutter / time.fps) as f32;
    if open == 0.0 || settings.camera.key.is_empty() {
        return Track::default();
    }
    let ends = [-0.5, 0.5].map(|side| time.frame + side * time.shutter);
    let within = |frame: &f64| ends[0] < *frame && *frame < ends[1];
    let keys = settings.camera.key.iter().map(|key| key.frame).filter(within);
    let frames = std::iter::once(ends[0]).chain(keys).chain([ends[1]]);
    let moment =
        |frame: f64| (((frame - time.frame) / time.fps) as f32, view(&settings.camera.at(frame)));
    Track::new(frames.map(moment).collect(), open)
}
