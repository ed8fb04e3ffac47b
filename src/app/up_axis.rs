//! The up axis, as one click: turns the camera so that another axis of the world points up in the
//! picture, and keeps the view otherwise.

use glam::{Quat, Vec3};

use super::viewport::pose;
use crate::scene::Settings;
use crate::scene::settings::Axis;

/// The axis that points up in the picture; `None` where it is none of them.
pub fn of(settings: &Settings) -> Option<Axis> {
    let up = Vec3::from(settings.camera.up).try_normalize()?;
    let close = |axis: Vec3| up.dot(axis) > 0.999;
    match () {
        () if close(Vec3::X) => Some(Axis::X),
        () if close(Vec3::Y) => Some(Axis::Y),
        () if close(Vec3::Z) => Some(Axis::Z),
        () => None,
    }
}

/// Makes `axis` point up, turning the camera around its target with it.
pub fn set(settings: &mut Settings, axis: Axis) {
    let before = pose(&settings.camera);
    let up = [Vec3::X, Vec3::Y, Vec3::Z][axis.index()];
    let Some(old) = before.up.try_normalize() else { return };
    let turn = Quat::from_rotation_arc(old, up);
    let position = before.target + turn * (before.position - before.target);
    settings.camera.position = position.to_array();
    settings.camera.up = up.to_array();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn switching_there_and_back_is_where_it_was() {
        let mut settings = Settings::default();
        settings.camera.position = [1.0, -6.0, 2.0];
        set(&mut settings, Axis::Y);
        assert_eq!(of(&settings), Some(Axis::Y));
        // What was above the target is above it still.
        assert!((settings.camera.position[1] - 2.0).abs() < 1e-5);
        set(&mut settings, Axis::Z);
        let back = Vec3::from(settings.camera.position);
        assert!(back.distance(Vec3::new(1.0, -6.0, 2.0)) < 1e-5);
    }
}
