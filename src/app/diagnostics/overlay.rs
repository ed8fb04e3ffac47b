//! Cells drawn over the picture: boxes where there are few, dots where there are many. What is in
//! front hides nothing, so that the inside shows.

use egui::{Color32, Mesh, Painter, Rect, Shape, Stroke, Ui};
use glam::{UVec2, Vec3A};

use super::cells::{Cell, Cells};
use crate::app::picture::ramp_color;
use crate::app::picture::view::View;
use crate::image::ramp::{STOPS, Scale};
use crate::transport::camera::Camera;

/// Largest number of cells that are drawn as boxes.
const MOST_BOXES: usize = 128;
/// Width of the edges of boxes in points.
const LINE: f32 = 1.2;
/// Share of a cell's width that its dot takes.
const DOT: f32 = 0.22;
/// Sides of the smallest and the largest dot in points.
const DOT_SIDES: [f32; 2] = [1.5, 10.0];
/// Opacity of dots over the picture.
const DOT_OPACITY: f32 = 0.8;
/// Lines nearer to the camera than this share of a cell's edge are cut off.
const NEAR: f32 = 1e-4;

/// The edges of a box as pairs of corners that differ in one bit.
const EDGES: [(usize, usize); 12] = [
    (0, 1),
    (2, 3),
    (4, 5),
    (6, 7),
    (0, 2),
    (1, 3),
    (4, 6),
    (5, 7),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
];

/// Draws `cells` as `camera` sees them over the picture in `view`.
pub fn paint(ui: &Ui, view: View, camera: &Camera, cells: &Cells, scale: Scale) {
    let rect = view.picture_rect();
    let painter = ui.painter_at(rect);
    let canvas = OverlayCanvas { view, camera, size: view.size };
    if cells.strongest.len() <= MOST_BOXES {
        cells.strongest.iter().for_each(|cell| canvas.draw_box(&painter, cell, scale));
    } else {
        let mut mesh = Mesh::default();
        mesh.reserve_vertices(4 * cells.strongest.len());
        mesh.reserve_triangles(2 * cells.strongest.len());
        cells.strongest.iter().for_each(|cell| canvas.add_dot(&mut mesh, rect, cell, scale));
        painter.add(Shape::mesh(mesh));
    }
}

struct OverlayCanvas<'a> {
    view: View,
    camera: &'a Camera,
    /// Width and height of the picture in pixels.
    size: UVec2,
}

impl OverlayCanvas<'_> {
    fn draw_box(&self, painter: &Painter, cell: &Cell, scale: Scale) {
        let corners = cell.corners.map(|corner| self.camera.view_from_world(corner));
        let stroke = Stroke::new(LINE, ramp_color::color(scale.place(cell.value)));
        let near = NEAR * cell.edge;
        for (a, b) in EDGES {
            if let Some([a, b]) = in_front([corners[a], corners[b]], near) {
                painter.line_segment([self.window(a), self.window(b)], stroke);
            }
        }
    }

    fn add_dot(&self, mesh: &mut Mesh, visible: Rect, cell: &Cell, scale: Scale) {
        let center = self.camera.view_from_world(cell.center());
        if center.z <= NEAR * cell.edge {
            return;
        }
        let points_per_pixel = self.view.placement.scale / self.view.factor;
        let pixels = cell.edge * self.camera.pixels_per_length(self.size.x as f32, center.z);
        let side = (DOT * pixels * points_per_pixel).clamp(DOT_SIDES[0], DOT_SIDES[1]);
        let dot = Rect::from_center_size(self.window(center), egui::Vec2::splat(side));
        if dot.is_finite() && visible.intersects(dot) {
            let color = ramp_color::color(scale.place(cell.value));
            mesh.add_colored_rect(dot, color.gamma_multiply(DOT_OPACITY));
        }
    }

    /// Position in the window of a point in front of the camera, in its view.
    fn window(&self, point: Vec3A) -> egui::Pos2 {
        self.view.window_at(self.camera.film_from_view(self.size, point))
    }
}

/// The part of a line, given in the camera's view, that is farther away than `near`.
fn in_front(line: [Vec3A; 2], near: f32) -> Option<[Vec3A; 2]> {
    let [a, b] = line;
    let cut =
        |hidden: Vec3A, seen: Vec3A| hidden.lerp(seen, (near - hidden.z) / (seen.z - hidden.z));
    match (a.z > near, b.z > near) {
        (true, true) => Some([a, b]),
        (true, false) => Some([a, cut(b, a)]),
        (false, true) => Some([cut(a, b), b]),
        (false, false) => None,
    }
}

/// The colors of a scale as a bar, from left to right; `color` gives that of a place in 0..=1.
pub fn bar(rect: Rect, color: impl Fn(f32) -> Color32) -> Mesh {
    let mut mesh = Mesh::default();
    for index in 0..=STOPS as u32 - 1 {
        let place = index as f32 / (STOPS - 1) as f32;
        let color = color(place);
        let x = egui::lerp(rect.x_range(), place);
        mesh.colored_vertex(egui::pos2(x, rect.top()), color);
        mesh.colored_vertex(egui::pos2(x, rect.bottom()), color);
        if index > 0 {
            let at = 2 * index;
            mesh.add_triangle(at - 2, at - 1, at);
            mesh.add_triangle(at - 1, at, at + 1);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_in_front_of_the_camera() {
        let (behind, ahead) = (Vec3A::new(0.0, 0.0, -1.0), Vec3A::new(2.0, 0.0, 3.0));
        let [a, b] = in_front([behind, ahead], 1.0).unwrap();
        assert_eq!((a, b), (Vec3A::new(1.0, 0.0, 1.0), ahead));
        let [b, a] = in_front([ahead, behind], 1.0).unwrap();
        assert_eq!((a, b), (Vec3A::new(1.0, 0.0, 1.0), ahead));
        assert_eq!(in_front([ahead, ahead], 1.0), Some([ahead, ahead]));
        assert_eq!(in_front([behind, behind], 1.0), None);
    }

    #[test]
    fn every_edge_joins_neighbors() {
        let unique: std::collections::HashSet<_> = EDGES.iter().collect();
        assert_eq!(unique.len(), 12);
        assert!(EDGES.iter().all(|(a, b)| (a ^ b).is_power_of_two()));
    }
}
