//! The pinhole camera.

use glam::{UVec2, Vec2, Vec3A};

use crate::math::Ray;

/// A pinhole camera; the film conventions are those of the scene format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    position: Vec3A,
    forward: Vec3A,
    right: Vec3A,
    up: Vec3A,
    tan_half_fov_x: f32,
}

impl Camera {
    /// A camera at `position` looking at `target`. `fov_x` is the full horizontal angle in
    /// degrees. `None` where position and target coincide or `up` is along the view.
    pub fn look_at(position: Vec3A, target: Vec3A, up: Vec3A, fov_x: f32) -> Option<Self> {
        let forward = (target - position).try_normalize()?;
        let right = forward.cross(up.try_normalize()?);
        let right = (right.length() > 1e-6).then(|| right.normalize())?;
        let tan_half_fov_x = (0.5 * fov_x.to_radians()).tan();
        Some(Self { position, forward, right, up: right.cross(forward), tan_half_fov_x })
    }

    /// The ray through the point `offset` in [0, 1)² of a pixel; row 0 is on top.
    pub fn ray(&self, size: UVec2, pixel: UVec2, offset: Vec2) -> Ray {
        let [width, height] = size.as_vec2().to_array();
        let place = pixel.as_vec2() + offset;
        let ndc_x = 2.0 * place.x / width - 1.0;
        let ndc_y = (1.0 - 2.0 * place.y / height) * height / width;
        let across = self.tan_half_fov_x * (ndc_x * self.right + ndc_y * self.up);
        Ray::new(self.position, (self.forward + across).normalize())
    }

    /// Position of the pinhole in the world.
    pub fn position(&self) -> Vec3A {
        self.position
    }

    /// A point of the world as the camera sees it: to the right, up and forward of it.
    pub fn view_from_world(&self, point: Vec3A) -> Vec3A {
        let offset = point - self.position;
        Vec3A::new(offset.dot(self.right), offset.dot(self.up), offset.dot(self.forward))
    }

    /// The place on a film of `size` pixels, row 0 on top, of a point in front of the camera given
    /// in its view; the inverse of [`Camera::ray`].
    pub fn film_from_view(&self, size: UVec2, view: Vec3A) -> Vec2 {
        let size = size.as_vec2();
        let scale = self.pixels_per_length(size.x, view.z);
        0.5 * size + scale * Vec2::new(view.x, -view.y)
    }

    /// Pixels that a unit of length spans across the view, `depth` in front of the camera on a film
    /// of `width` pixels.
    pub fn pixels_per_length(&self, width: f32, depth: f32) -> f32 {
        0.5 * width / (self.tan_half_fov_x * depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_left_edge_is_half_the_field_of_view_away_and_row_zero_is_on_top() {
        let camera = Camera::look_at(Vec3A::ZERO, Vec3A::Y, Vec3A::Z, 90.0).unwrap();
        let size = UVec2::new(200, 100);
        let left = camera.ray(size, UVec2::new(0, 50), Vec2::ZERO).direction;
        assert!((left - Vec3A::new(-1.0, 1.0, 0.0).normalize()).length() < 1e-6, "{left}");
        let top = camera.ray(size, UVec2::new(100, 0), Vec2::ZERO).direction;
        assert!((top - Vec3A::new(0.0, 1.0, 0.5).normalize()).length() < 1e-6, "{top}");
    }

    #[test]
    fn a_point_on_a_ray_is_seen_where_the_ray_left_the_film() {
        let (position, target) = (Vec3A::new(1.0, -5.0, 2.0), Vec3A::new(0.0, 0.5, 0.3));
        let camera = Camera::look_at(position, target, Vec3A::Z, 50.0).unwrap();
        let size = UVec2::new(160, 90);
        for pixel in [UVec2::ZERO, UVec2::new(80, 45), UVec2::new(159, 3)] {
            let ray = camera.ray(size, pixel, Vec2::new(0.25, 0.5));
            let view = camera.view_from_world(ray.at(3.0));
            let seen = camera.film_from_view(size, view);
            let left = pixel.as_vec2() + Vec2::new(0.25, 0.5);
            assert!((seen - left).length() < 1e-3, "{seen} for {left}");
        }
        let depth = camera.view_from_world(target).z;
        assert!(
            (camera.pixels_per_length(2.0, depth) * depth - 1.0 / 25_f32.to_radians().tan()).abs()
                < 1e-4
        );
    }
}
