//! The effect of dragging a handle on a light.

use egui::Pos2;
use glam::Vec3A;

use super::figure::{Handle, anchor, arrow_length, travel};
use super::lens::Lens;
use crate::math::Ray;
use crate::scene::settings::{LightKind, LightSettings};

/// An axis that is seen from nearer to its end than this (the sine of the angle) does not move.
const END_ON: f32 = 0.03;

/// The light after `handle` was dragged from the first place of the window to the second. `light`
/// is as it was when the drag began, so that rounding does not add up.
pub fn dragged(
    light: &LightSettings,
    handle: Handle,
    lens: &Lens,
    pivot: Vec3A,
    [from, to]: [Pos2; 2],
) -> LightSettings {
    let mut moved = light.clone();
    let at = anchor(light, pivot);
    match handle {
        Handle::Center => place(&mut moved, at + shift(lens, at, from, to)),
        Handle::Axis(axis) => {
            let direction = Vec3A::AXES.get(axis).copied().unwrap_or(Vec3A::Z);
            if let Some(steps) = along(lens, at, direction, from, to) {
                place(&mut moved, at + steps * direction);
            }
        }
        Handle::Target => {
            let target = Vec3A::from(light.target());
            moved.target = Some((target + shift(lens, target, from, to)).to_array());
        }
        Handle::Direction => {
            if let Some(direction) = turned(light, lens, pivot, from, to) {
                moved.direction = Some(direction.to_array());
            }
        }
    }
    moved
}

fn place(light: &mut LightSettings, at: Vec3A) {
    if !at.is_finite() {
        return;
    }
    match light.kind {
        LightKind::Sun => {}
        LightKind::Point | LightKind::Spot => light.position = Some(at.to_array()),
        LightKind::Sphere | LightKind::Quad => light.center = Some(at.to_array()),
    }
}

/// The way in the plane of the picture through `at`.
fn shift(lens: &Lens, at: Vec3A, from: Pos2, to: Pos2) -> Vec3A {
    let way = lens.beside(to, at) - lens.beside(from, at);
    if way.is_finite() { way } else { Vec3A::ZERO }
}

/// The way along an axis through `at`: between the points of the axis that come nearest to the
/// rays under both places.
fn along(lens: &Lens, at: Vec3A, axis: Vec3A, from: Pos2, to: Pos2) -> Option<f32> {
    let foot = |place: Pos2| {
        let Ray { origin, direction, .. } = lens.ray(place);
        let cosine = direction.dot(axis);
        let sine2 = 1.0 - cosine * cosine;
        let offset = at - origin;
        let foot = (cosine * direction.dot(offset) - axis.dot(offset)) / sine2;
        (sine2 > END_ON * END_ON && foot.is_finite()).then_some(foot)
    };
    Some(foot(to)? - foot(from)?)
}

/// The direction of a sun whose arrow's tail was dragged over the ball around the pivot, on the
/// side of it where it was.
fn turned(light: &LightSettings, lens: &Lens, pivot: Vec3A, from: Pos2, to: Pos2) -> Option<Vec3A> {
    let radius = arrow_length(lens, pivot);
    let tail = pivot - radius * travel(light);
    // The hand keeps the distance to the handle that it had.
    let ray = lens.ray(lens.window(tail)? + (to - from));
    let offset = pivot - ray.origin;
    let nearest = offset.dot(ray.direction);
    let across2 = (offset - nearest * ray.direction).length_squared();
    let half = (radius * radius - across2).max(0.0).sqrt();
    let is_near = (tail - ray.origin).dot(ray.direction) <= nearest;
    let tail = ray.at(if is_near { nearest - half } else { nearest + half });
    (pivot - tail).try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::picture::gizmo::lens::tests::lens;
    use crate::scene::new_light;
    use crate::scene::settings::CameraSettings;
    use egui::vec2;

    fn light(kind: LightKind) -> LightSettings {
        let camera = CameraSettings { position: [0.0, -5.0, 0.0], ..CameraSettings::default() };
        new_light(kind, &camera)
    }

    #[test]
    fn a_light_follows_the_hand_in_the_plane_of_the_picture() {
        let lens = lens();
        for kind in [LightKind::Point, LightKind::Spot, LightKind::Sphere, LightKind::Quad] {
            let light = light(kind);
            let at = anchor(&light, Vec3A::ZERO);
            let from = lens.window(at).unwrap();
            let to = from + vec2(40.0, -25.0);
            let moved = dragged(&light, Handle::Center, &lens, Vec3A::ZERO, [from, to]);
            let after = anchor(&moved, Vec3A::ZERO);
            assert!(lens.window(after).unwrap().distance(to) < 0.01, "{kind:?}");
            assert!((after.y - at.y).abs() < 1e-4, "it stays as deep in the picture");
            let still = dragged(&light, Handle::Center, &lens, Vec3A::ZERO, [from, from]);
            assert!(anchor(&still, Vec3A::ZERO).distance(at) < 1e-6);
        }
    }

    #[test]
    fn an_axis_moves_the_light_along_itself_only() {
        let lens = lens();
        let light = light(LightKind::Point);
        let at = anchor(&light, Vec3A::ZERO);
        let from = lens.window(at).unwrap();
        for (axis, way) in [(0, vec2(30.0, 7.0)), (2, vec2(5.0, -30.0))] {
            let to = from + way;
            let moved = dragged(&light, Handle::Axis(axis), &lens, Vec3A::ZERO, [from, to]);
            let mut off = anchor(&moved, Vec3A::ZERO) - at;
            assert!(off[axis] > 0.01, "{axis}: {off}");
            off[axis] = 0.0;
            assert!(off.length() < 1e-5);
            // As far as the hand went in the direction in which the axis is seen.
            let seen = lens.window(anchor(&moved, Vec3A::ZERO)).unwrap() - from;
            assert!((seen.normalized().dot(way) - seen.length()).abs() < 1.0, "{seen:?}");
        }
        // y points away from the camera, here nearly so: a small drag must not throw the light.
        let ahead = LightSettings { position: Some([0.0; 3]), ..light };
        let from = lens.window(Vec3A::ZERO).unwrap();
        let to = from + vec2(3.0, 0.0);
        assert_eq!(dragged(&ahead, Handle::Axis(1), &lens, Vec3A::ZERO, [from, to]), ahead);
    }

    #[test]
    fn a_spot_is_aimed_and_stays_where_it_is() {
        let lens = lens();
        let light = light(LightKind::Spot);
        let from = lens.window(Vec3A::from(light.target())).unwrap();
        let to = from + vec2(-20.0, 10.0);
        let moved = dragged(&light, Handle::Target, &lens, Vec3A::ZERO, [from, to]);
        assert_eq!(moved.position, light.position);
        assert!(lens.window(Vec3A::from(moved.target())).unwrap().distance(to) < 0.01);
    }

    #[test]
    fn a_sun_turns_around_its_pivot_however_far_the_hand_goes() {
        let lens = lens();
        let light = light(LightKind::Sun);
        let tail = |light: &LightSettings| {
            let length = arrow_length(&lens, Vec3A::ZERO);
            lens.window(-length * travel(light)).unwrap()
        };
        let from = tail(&light);
        let to = from + vec2(12.0, 15.0);
        let moved = dragged(&light, Handle::Direction, &lens, Vec3A::ZERO, [from, to]);
        assert!(tail(&moved).distance(to) < 0.05, "the arrow's tail follows the hand");
        assert!(travel(&moved).y > 0.0, "and stays on this side");
        for way in [vec2(900.0, 0.0), vec2(-900.0, 500.0), vec2(0.0, -2000.0)] {
            let far = dragged(&light, Handle::Direction, &lens, Vec3A::ZERO, [from, from + way]);
            assert!((Vec3A::from(far.direction()).length() - 1.0).abs() < 1e-4);
        }
    }
}
