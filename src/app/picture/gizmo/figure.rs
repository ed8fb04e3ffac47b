//! The lines and handles of a light, in the world.

use egui::Pos2;
use glam::Vec3A;

use super::lens::Lens;
use crate::scene::settings::{LightKind, LightSettings};

/// Length of the arms along the axes, and of a sun's arrow, in points of the window.
const ARM: f32 = 62.0;
const ARROW: f32 = 110.0;
/// Lines that a circle is drawn by.
const CIRCLE: usize = 48;
/// The number of these lines from the tip of a cone to its rim.
const RIBS: usize = 4;
/// The widest cone that is drawn as one, in degrees.
const WIDEST: f32 = 160.0;

/// A part that can be taken hold of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Handle {
    /// The light itself, moved in the plane of the picture.
    Center,
    /// The light along x, y or z.
    Axis(usize),
    /// The point that a spot is aimed at.
    Target,
    /// Direction that a sun's light comes from.
    Direction,
}

/// The part that a line belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandlePart {
    /// An axis of the world.
    Axis(usize),
    /// The light's own shape.
    Body,
}

impl Handle {
    /// Name of the handle for screen readers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Center => "Move light",
            Self::Axis(0) => "Move light along x",
            Self::Axis(1) => "Move light along y",
            Self::Axis(_) => "Move light along z",
            Self::Target => "Aim light",
            Self::Direction => "Turn sun",
        }
    }

    /// Effect of dragging the handle.
    pub fn help(self) -> &'static str {
        match self {
            Self::Center => "Drag to move the light parallel to the picture.",
            Self::Axis(_) => "Drag to move the light along this axis.",
            Self::Target => "Drag to aim the light.",
            Self::Direction => "Drag to turn the sun around the scene.",
        }
    }

    /// The name of the edit.
    pub fn edit(self) -> &'static str {
        match self {
            Self::Center | Self::Axis(_) => "move the light",
            Self::Target | Self::Direction => "aim the light",
        }
    }

    /// Shape that the handle is drawn as.
    pub fn part(self) -> HandlePart {
        match self {
            Self::Axis(axis) => HandlePart::Axis(axis),
            _ => HandlePart::Body,
        }
    }
}

/// Lines and handles of a light.
pub struct Figure {
    /// Lines of the world.
    pub lines: Vec<([Vec3A; 2], HandlePart)>,
    /// Handles and where they are; where they lie above one another the first one counts.
    pub handles: Vec<(Handle, Vec3A)>,
}

/// Position of a light; `pivot` for a sun, which has none.
pub fn anchor(light: &LightSettings, pivot: Vec3A) -> Vec3A {
    match light.kind {
        LightKind::Sun => pivot,
        LightKind::Point | LightKind::Spot => light.position().into(),
        LightKind::Sphere | LightKind::Quad => light.center().into(),
    }
}

/// The direction in which the light of a sun travels.
pub fn travel(light: &LightSettings) -> Vec3A {
    Vec3A::from(light.direction()).normalize_or(Vec3A::NEG_Z)
}

/// Distance from its pivot at which the arrow of a sun begins, in lengths of the world.
pub fn arrow_length(lens: &Lens, pivot: Vec3A) -> f32 {
    lens.length(ARROW, pivot)
}

impl Figure {
    /// The figure of a light as large as it has to be seen through `lens`.
    pub fn of(light: &LightSettings, lens: &Lens, pivot: Vec3A) -> Self {
        let mut figure = Self { lines: Vec::new(), handles: Vec::new() };
        let at = anchor(light, pivot);
        match light.kind {
            LightKind::Sun => figure.arrow(light, lens, pivot),
            LightKind::Point => {}
            LightKind::Spot => figure.cone(light, at),
            LightKind::Sphere => {
                let edges = lens.across().map(|axis| axis * light.radius());
                figure.circle(at, edges);
            }
            LightKind::Quad => figure.quad(light, at),
        }
        if light.kind != LightKind::Sun {
            let arm = lens.length(ARM, at);
            figure.handles.push((Handle::Center, at));
            for (axis, direction) in Vec3A::AXES.into_iter().enumerate() {
                let end = at + arm * direction;
                figure.lines.push(([at, end], HandlePart::Axis(axis)));
                figure.handles.push((Handle::Axis(axis), end));
            }
        }
        figure
    }

    /// The handles that are in sight, and where they are seen.
    pub fn handles_on(&self, lens: &Lens) -> Vec<(Handle, Pos2)> {
        let seen = |(handle, at): &(Handle, Vec3A)| {
            let at = lens.window(*at).filter(|at| lens.view.rect.contains(*at))?;
            Some((*handle, at))
        };
        self.handles.iter().filter_map(seen).collect()
    }

    fn line(&mut self, a: Vec3A, b: Vec3A) {
        self.lines.push(([a, b], HandlePart::Body));
    }

    fn circle(&mut self, center: Vec3A, [u, v]: [Vec3A; 2]) {
        let at = |index: usize| {
            let (sin, cos) = (std::f32::consts::TAU * index as f32 / CIRCLE as f32).sin_cos();
            center + cos * u + sin * v
        };
        (0..CIRCLE).for_each(|index| self.line(at(index), at(index + 1)));
    }

    fn arrow(&mut self, light: &LightSettings, lens: &Lens, pivot: Vec3A) {
        let (length, travel) = (arrow_length(lens, pivot), travel(light));
        let tail = pivot - length * travel;
        self.line(tail, pivot);
        let u = travel.any_orthonormal_vector();
        let head = pivot - 0.15 * length * travel;
        for side in [u, -u, travel.cross(u), -travel.cross(u)] {
            self.line(pivot, head + 0.06 * length * side);
        }
        self.handles.push((Handle::Direction, tail));
    }

    fn cone(&mut self, light: &LightSettings, at: Vec3A) {
        let target = Vec3A::from(light.target());
        self.line(at, target);
        self.handles.push((Handle::Target, target));
        let axis = target - at;
        let radius = axis.length() * (0.5 * light.cone().min(WIDEST)).to_radians().tan();
        let u = axis.normalize_or(Vec3A::NEG_Z).any_orthonormal_vector();
        let edges = [u, axis.normalize_or(Vec3A::NEG_Z).cross(u)].map(|edge| radius * edge);
        self.circle(target, edges);
        for rib in 0..RIBS {
            let side = if rib % 2 == 0 { edges[0] } else { edges[1] };
            let side = if rib < 2 { side } else { -side };
            self.line(at, target + side);
        }
    }

    fn quad(&mut self, light: &LightSettings, at: Vec3A) {
        let (u, v) = (Vec3A::from(light.half_u()), Vec3A::from(light.half_v()));
        let corners = [at + u + v, at - u + v, at - u - v, at + u - v];
        (0..4).for_each(|index| self.line(corners[index], corners[(index + 1) % 4]));
    }
}

/// The handle nearest to `at` within `reach` points, the first of those equally near.
pub fn nearest(handles: &[(Handle, Pos2)], at: Pos2, reach: f32) -> Option<Handle> {
    let distance = |(_, place): &&(Handle, Pos2)| place.distance(at);
    let near = handles.iter().filter(|handle| distance(handle) <= reach);
    near.min_by(|a, b| distance(a).total_cmp(&distance(b))).map(|(handle, _)| *handle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::picture::gizmo::lens::tests::lens;
    use crate::scene::new_light;
    use crate::scene::settings::CameraSettings;

    #[test]
    fn every_kind_has_its_handles_in_sight() {
        let lens = lens();
        let camera = CameraSettings { position: [0.0, -5.0, 0.0], ..CameraSettings::default() };
        for (kind, expected) in [
            (LightKind::Sun, &[Handle::Direction][..]),
            (LightKind::Point, &[Handle::Center]),
            (LightKind::Spot, &[Handle::Target, Handle::Center]),
            (LightKind::Sphere, &[Handle::Center]),
            (LightKind::Quad, &[Handle::Center]),
        ] {
            let figure = Figure::of(&new_light(kind, &camera), &lens, Vec3A::ZERO);
            let handles = figure.handles_on(&lens);
            for handle in expected {
                assert!(handles.iter().any(|(one, _)| one == handle), "{kind:?}: {handles:?}");
            }
            let axes = handles.iter().filter(|(one, _)| matches!(one, Handle::Axis(_))).count();
            assert_eq!(axes > 0, kind != LightKind::Sun, "{kind:?}");
            assert!(figure.lines.iter().flat_map(|(line, _)| line).all(|at| at.is_finite()));
        }
    }

    #[test]
    fn the_nearest_handle_within_reach_is_hit() {
        let at = |x: f32, y: f32| egui::pos2(x, y);
        let handles = [
            (Handle::Center, at(100.0, 100.0)),
            (Handle::Axis(0), at(110.0, 100.0)),
            (Handle::Axis(1), at(100.0, 100.0)),
        ];
        assert_eq!(nearest(&handles, at(101.0, 99.0), 9.0), Some(Handle::Center));
        assert_eq!(nearest(&handles, at(106.0, 100.0), 9.0), Some(Handle::Axis(0)));
        assert_eq!(nearest(&handles, at(120.0, 100.0), 9.0), None);
        assert_eq!(nearest(&[], at(0.0, 0.0), 9.0), None);
    }
}
