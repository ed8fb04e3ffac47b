//! The up axis of a volume's file, as one click. A file with y up is turned so that its y becomes
//! the world's z, which is up everywhere else.

use glam::{EulerRot, Quat, Vec3};

use crate::scene::settings::{Axis, VolumeSettings};
use crate::scene::{Settings, upright};

/// The axis of the file that points up in the world; `None` where it is turned otherwise.
pub fn of(volume: &VolumeSettings) -> Option<Axis> {
    if volume.matrix.is_some() {
        return None;
    }
    [Axis::Y, Axis::Z].into_iter().find(|axis| volume.rotate == upright(*axis))
}

/// Makes `up` of the volume `index` point up. The camera follows a volume that stands alone.
pub fn set(settings: &mut Settings, index: usize, up: Axis) {
    let alone = settings.volume.len() == 1;
    let Some(volume) = settings.volume.get_mut(index) else { return };
    let before = turn(volume.rotate);
    volume.rotate = upright(up);
    if alone {
        let origin = Vec3::from(volume.translate);
        let turned = turn(volume.rotate) * before.inverse();
        let follow = |target: &mut [f32; 3], position: &mut [f32; 3]| {
            let offset = Vec3::from(*position) - Vec3::from(*target);
            let moved = origin + turned * (Vec3::from(*target) - origin);
            *target = moved.to_array();
            *position = (moved + offset).to_array();
        };
        let camera = &mut settings.camera;
        let own = (camera.target, camera.position);
        follow(&mut camera.target, &mut camera.position);
        for key in &mut camera.key {
            follow(key.target.get_or_insert(own.0), key.position.get_or_insert(own.1));
        }
    }
}

fn turn(degrees: [f32; 3]) -> Quat {
    let [x, y, z] = degrees.map(f32::to_radians);
    Quat::from_euler(EulerRot::ZYX, z, y, x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_keeps_looking_at_the_volume() {
        let mut settings =
            Settings { volume: vec![VolumeSettings::default()], ..Settings::default() };
        settings.camera.target = [0.0, 0.0, 2.0];
        settings.camera.position = [0.0, -6.0, 3.0];
        let z_up = settings.clone();
        assert_eq!(of(&settings.volume[0]), Some(Axis::Z));
        // What the file calls z is now along the world's -y.
        set(&mut settings, 0, Axis::Y);
        assert_eq!(of(&settings.volume[0]), Some(Axis::Y));
        assert!(Vec3::from(settings.camera.target).distance(Vec3::new(0.0, -2.0, 0.0)) < 1e-5);
        assert!(Vec3::from(settings.camera.position).distance(Vec3::new(0.0, -8.0, 1.0)) < 1e-5);
        set(&mut settings, 0, Axis::Z);
        assert!(Vec3::from(settings.camera.position).distance(z_up.camera.position.into()) < 1e-5);
    }
}
