//! Projection between the world and the window.

use egui::Pos2;
use glam::{UVec2, Vec2, Vec3A};

use crate::app::picture::view::View;
use crate::math::Ray;
use crate::transport::camera::Camera;

/// Points nearer than this, in lengths of the world, are not seen.
const NEAR: f32 = 1e-4;

/// A camera and where its picture lies in the window.
pub struct Lens {
    /// The camera that takes the picture.
    pub camera: Camera,
    /// Place of the picture in the window.
    pub view: View,
}

impl Lens {
    /// Projection of a point of the world into the window; `None` for one behind the camera.
    pub fn window(&self, point: Vec3A) -> Option<Pos2> {
        let seen = self.camera.view_from_world(point);
        (seen.z > NEAR).then(|| self.place(seen)).filter(|at| at.x.is_finite() && at.y.is_finite())
    }

    /// Projection of a line of the world, without what is behind the camera.
    pub fn segment(&self, line: [Vec3A; 2]) -> Option<[Pos2; 2]> {
        let [a, b] = line.map(|point| self.camera.view_from_world(point));
        if a.z <= NEAR && b.z <= NEAR {
            return None;
        }
        let cut = |hidden: Vec3A, seen: Vec3A| {
            hidden.lerp(seen, (2.0 * NEAR - hidden.z) / (seen.z - hidden.z))
        };
        let a_cut = if a.z > NEAR { a } else { cut(a, b) };
        let b_cut = if b.z > NEAR { b } else { cut(b, a) };
        let ends = [self.place(a_cut), self.place(b_cut)];
        ends.iter().all(|at| at.x.is_finite() && at.y.is_finite()).then_some(ends)
    }

    /// The ray under a place of the window.
    pub fn ray(&self, at: Pos2) -> Ray {
        let corner = self.view.rect.min;
        let offset = Vec2::new(at.x - corner.x, at.y - corner.y) * self.view.factor;
        let film = self.view.placement.picture_from_viewport(offset);
        self.camera.ray(self.view.size, UVec2::ZERO, film)
    }

    /// The point under a place of the window as deep in the picture as `like`.
    pub fn beside(&self, at: Pos2, like: Vec3A) -> Vec3A {
        let ray = self.ray(at);
        let origin = self.camera.view_from_world(like);
        let along = self.camera.view_from_world(ray.at(1.0));
        ray.at(origin.z.max(NEAR) / along.z.max(1e-6))
    }

    /// The length in the world that spans `points` of the window at the depth of `point`.
    pub fn length(&self, points: f32, point: Vec3A) -> f32 {
        let depth = self.camera.view_from_world(point).z.max(NEAR);
        let pixels = points * self.view.factor / self.view.placement.scale.max(1e-6);
        pixels / self.camera.pixels_per_length(self.view.size.x.max(1) as f32, depth)
    }

    /// Unit vectors to the right and upwards in the picture.
    pub fn across(&self) -> [Vec3A; 2] {
        let origin = self.camera.view_from_world(Vec3A::ZERO);
        let rows = Vec3A::AXES.map(|axis| self.camera.view_from_world(axis) - origin);
        [0, 1].map(|row| Vec3A::new(rows[0][row], rows[1][row], rows[2][row]))
    }

    fn place(&self, seen: Vec3A) -> Pos2 {
        self.view.window_at(self.camera.film_from_view(self.view.size, seen))
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::app::picture::zoom::Placement;

    /// A camera 5 in front of the origin whose picture lies somewhere in a window of two pixels a
    /// point.
    pub fn lens() -> Lens {
        let eye = Vec3A::new(0.0, -5.0, 0.0);
        let camera = Camera::look_at(eye, Vec3A::ZERO, Vec3A::Z, 60.0).unwrap();
        let rect = egui::Rect::from_min_size(egui::pos2(30.0, 20.0), egui::vec2(400.0, 300.0));
        let placement = Placement { scale: 2.0, corner: Vec2::new(10.0, 4.0) };
        let size = UVec2::new(390, 280);
        let view = View { rect, placement, factor: 2.0, size, hovered: false, clicked: None };
        Lens { camera, view }
    }

    #[test]
    fn what_is_seen_at_a_place_lies_under_it() {
        let lens = lens();
        for point in [Vec3A::ZERO, Vec3A::new(1.0, 2.0, -0.5), Vec3A::new(-3.0, 1.0, 2.0)] {
            let at = lens.window(point).unwrap();
            assert!(lens.beside(at, point).distance(point) < 1e-4, "{point}");
        }
        assert_eq!(lens.window(Vec3A::new(0.0, -6.0, 0.0)), None);
        let [right, up] = lens.across();
        assert!(right.distance(Vec3A::X) < 1e-5 && up.distance(Vec3A::Z) < 1e-5);
        let length = lens.length(50.0, Vec3A::ZERO);
        let ends = [Vec3A::ZERO, length * right].map(|point| lens.window(point).unwrap());
        assert!((ends[0].distance(ends[1]) - 50.0).abs() < 1e-3);
    }

    #[test]
    fn lines_end_at_the_camera() {
        let lens = lens();
        let (ahead, behind) = (Vec3A::new(1.0, 2.0, 0.0), Vec3A::new(0.5, -9.0, 0.0));
        let [a, b] = lens.segment([ahead, behind]).unwrap();
        assert_eq!(a, lens.window(ahead).unwrap());
        assert!(b.x.is_finite());
        assert_eq!(lens.segment([behind, behind]), None);
    }
}
