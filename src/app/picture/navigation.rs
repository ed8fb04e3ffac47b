//! Camera moves as pure functions: orbit, pan, dolly.

use glam::{Quat, Vec2, Vec3};

/// Pose of the camera: its position and target in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The eye.
    pub position: Vec3,
    /// The point that stays in the middle of the picture.
    pub target: Vec3,
    /// The direction that points up in the picture.
    pub up: Vec3,
}

/// Radians of an orbit for a drag across the whole width of the picture.
const ORBIT_PER_WIDTH: f32 = std::f32::consts::PI;
/// The orbit stops this short of the poles, in radians.
const POLE_MARGIN: f32 = 0.02;

impl Pose {
    fn distance(&self) -> f32 {
        self.position.distance(self.target).max(1e-6)
    }

    /// Unit vectors to the right, up in the picture, and forward. Sound for any pose, also
    /// where `up` is zero or along the view.
    fn frame(&self) -> (Vec3, Vec3, Vec3) {
        let forward = (self.target - self.position).try_normalize().unwrap_or(Vec3::Y);
        let right = forward
            .cross(self.up)
            .try_normalize()
            .unwrap_or_else(|| forward.any_orthonormal_vector());
        (right, right.cross(forward), forward)
    }

    /// Turns the camera around its target. `drag` is in widths of the picture, y down: dragging
    /// to the right turns the scene to the right.
    #[must_use]
    pub fn orbit(self, drag: Vec2) -> Self {
        let axis = self.up.try_normalize().unwrap_or(Vec3::Z);
        let (right, _, forward) = self.frame();
        let yaw = Quat::from_axis_angle(axis, -drag.x * ORBIT_PER_WIDTH);
        let elevation = (-forward).dot(axis).clamp(-1.0, 1.0).asin();
        let limit = std::f32::consts::FRAC_PI_2 - POLE_MARGIN;
        let wanted = (elevation + drag.y * ORBIT_PER_WIDTH).clamp(-limit, limit);
        let pitch = Quat::from_axis_angle(right, elevation - wanted);
        let offset = yaw * (pitch * (self.position - self.target));
        Self { position: self.target + offset, ..self }
    }

    /// Moves camera and target sideways so that the target follows the pointer. `drag` is in
    /// widths of the picture, y down; `fov_x` is the full horizontal angle in degrees.
    #[must_use]
    pub fn pan(self, drag: Vec2, fov_x: f32) -> Self {
        let (right, up, _) = self.frame();
        let width = 2.0 * self.distance() * (0.5 * fov_x.to_radians()).tan();
        let shift = (up * drag.y - right * drag.x) * width;
        Self { position: self.position + shift, target: self.target + shift, ..self }
    }

    /// Moves the camera towards its target by `steps` notches of a wheel, each a tenth of the
    /// way; negative steps move away.
    #[must_use]
    pub fn dolly(self, steps: f32) -> Self {
        let factor = 0.9_f32.powf(steps.clamp(-40.0, 40.0));
        let distance = (self.distance() * factor).clamp(1e-4, 1e7);
        let (_, _, forward) = self.frame();
        Self { position: self.target - forward * distance, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSE: Pose = Pose {
        position: Vec3::new(0.0, -6.0, 2.0),
        target: Vec3::new(0.3, 0.0, -0.3),
        up: Vec3::Z,
    };

    #[test]
    fn an_orbit_keeps_the_distance_and_stays_off_the_poles() {
        for drag in [Vec2::new(0.3, 0.1), Vec2::new(-2.0, 5.0), Vec2::new(0.0, -9.0)] {
            let turned = POSE.orbit(drag);
            assert!((turned.distance() - POSE.distance()).abs() < 1e-4);
            let (right, up, _) = turned.frame();
            assert!(right.z.abs() < 1e-4, "the horizon tilts: {right}");
            assert!(up.z > 0.0, "the picture is upside down");
        }
    }

    #[test]
    fn dragging_down_raises_the_camera() {
        assert!(POSE.orbit(Vec2::new(0.0, 0.1)).position.z > POSE.position.z);
    }

    #[test]
    fn a_pan_moves_the_target_with_the_pointer() {
        let drag = Vec2::new(0.25, 0.1);
        let moved = POSE.pan(drag, 40.0);
        // Where the old target appears in the moved camera, in widths from the middle.
        let (right, up, forward) = moved.frame();
        let to = POSE.target - moved.position;
        let width = 2.0 * (20.0_f32).to_radians().tan() * to.dot(forward);
        assert!((to.dot(right) / width - drag.x).abs() < 1e-4);
        assert!((-to.dot(up) / width - drag.y).abs() < 1e-4);
    }

    #[test]
    fn degenerate_poses_stay_finite() {
        let pose = Pose { position: Vec3::ZERO, target: Vec3::ZERO, up: Vec3::ZERO };
        for moved in [pose.orbit(Vec2::ONE), pose.pan(Vec2::ONE, 40.0), pose.dolly(3.0)] {
            assert!(moved.position.is_finite() && moved.target.is_finite());
        }
    }
}
