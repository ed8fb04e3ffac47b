//! Moving a camera so that a box just fits its picture.

use glam::{Vec3, Vec3A};

use super::settings::CameraSettings;
use crate::math::Aabb;

/// The share of the picture that the box may take.
const FILL: f32 = 0.95;

/// A camera with the view direction and field of view of `view`, aimed at the middle of `bounds`
/// and moved so far off that the box fills a picture of `aspect` (width / height).
pub fn fit_camera(view: &CameraSettings, bounds: &Aabb, aspect: f32) -> CameraSettings {
    let center = bounds.center();
    let forward = Vec3A::from(Vec3::from(view.target) - Vec3::from(view.position));
    let forward = forward.try_normalize().unwrap_or(Vec3A::Y);
    let right = forward.cross(Vec3A::from(view.up)).try_normalize();
    let right = right.unwrap_or_else(|| forward.any_orthonormal_vector());
    let up = right.cross(forward);
    let across = FILL * (0.5 * view.fov_x.to_radians()).tan();
    let distance_for = |corner: Vec3A| {
        let corner = corner - center;
        let sideways =
            (corner.dot(right).abs() / across).max(corner.dot(up).abs() * aspect / across);
        sideways - corner.dot(forward)
    };
    let distance = bounds.corners().into_iter().map(distance_for).fold(0.0, f32::max);
    let distance = if distance > 0.0 { distance } else { 1.0 };
    CameraSettings {
        position: (center - distance * forward).to_array(),
        target: center.to_array(),
        ..view.clone()
    }
}

#[cfg(test)]
mod tests {
    use glam::{UVec2, Vec2};

    use super::*;
    use crate::transport::camera::Camera;

    #[test]
    fn the_box_fits_the_picture_and_nearly_fills_it() {
        let bounds = Aabb::new(Vec3A::new(-1.0, 2.0, 0.0), Vec3A::new(3.0, 5.0, 9.0));
        let size = UVec2::new(160, 90);
        let view = CameraSettings { position: [1.0, -4.0, 3.0], ..CameraSettings::default() };
        let fitted = fit_camera(&view, &bounds, 160.0 / 90.0);
        let [position, target, up] = [fitted.position, fitted.target, fitted.up].map(Vec3A::from);
        let camera = Camera::look_at(position, target, up, fitted.fov_x).unwrap();
        let sees = |pixel: UVec2| {
            let ray = camera.ray(size, pixel, Vec2::splat(0.5));
            bounds.intersect(&ray, 0.0, f32::INFINITY).is_some()
        };
        let columns = 0..size.x;
        assert!(
            columns.clone().all(|x| !sees(UVec2::new(x, 0)) && !sees(UVec2::new(x, size.y - 1)))
        );
        assert!(columns.clone().any(|x| sees(UVec2::new(x, size.y / 8))));
        assert!((0..size.y).all(|y| !sees(UVec2::new(0, y)) && !sees(UVec2::new(size.x - 1, y))));
    }
}
