//! The canvas of a pane, drawn when it changes and copied to the window in each frame. The window
//! is drawn far more often than there is a new picture, and a software driver feels every pixel
//! that is exposed and curved.

use egui::Rect;
use egui::epaint::ViewportInPixels;
use glam::{IVec2, UVec2};

use super::gpu::{bind, texture};

/// The pixels of the framebuffer that a part of the window covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PixelRect {
    /// Upper left pixel of the canvas.
    pub corner: [i32; 2],
    /// Width and height of the canvas in pixels.
    pub size: UVec2,
}

impl PixelRect {
    /// The pixels of `rect`, given in points, on a screen of that size and as many pixels a point.
    pub fn of(rect: &Rect, screen: &egui_wgpu::ScreenDescriptor) -> Self {
        let place =
            ViewportInPixels::from_points(rect, screen.pixels_per_point, screen.size_in_pixels);
        let size = [place.width_px, place.height_px].map(|side| side.max(1) as u32);
        Self { corner: [place.left_px, place.top_px], size: size.into() }
    }

    /// The part of the canvas that lies in `other`, from the corner of that.
    pub fn within(&self, other: &Self) -> Self {
        let corner = IVec2::from(self.corner) - IVec2::from(other.corner);
        let first = corner.max(IVec2::ZERO).as_uvec2().min(other.size);
        let last = (corner + self.size.as_ivec2()).max(IVec2::ZERO).as_uvec2().min(other.size);
        Self { corner: first.as_ivec2().into(), size: last.saturating_sub(first) }
    }
}

/// The texture that a pane is drawn on.
pub(super) struct GpuCanvas {
    size: UVec2,
    target: wgpu::TextureView,
    bindings: wgpu::BindGroup,
}

impl GpuCanvas {
    /// An empty canvas. `view` holds its place in the window.
    pub fn new(
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        (size, format): (UVec2, wgpu::TextureFormat),
        view: &wgpu::Buffer,
    ) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let texture = texture(device, "canvas", (size, format), usage);
        let target = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let bindings = bind(device, layout, view, &target);
        Self { size, target, bindings }
    }

    /// Whether the canvas has that size.
    pub fn is_of(&self, size: UVec2) -> bool {
        self.size == size
    }

    /// Bindings that copy the canvas to the window.
    pub fn bindings(&self) -> &wgpu::BindGroup {
        &self.bindings
    }

    /// Draws the `seen` part of the canvas, with a pipeline and its bindings.
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::RenderPipeline,
        bindings: &wgpu::BindGroup,
        seen: &PixelRect,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("canvas"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, bindings, &[]);
        let [x, y] = seen.corner.map(|corner| corner.max(0) as u32);
        pass.set_scissor_rect(x, y, seen.size.x, seen.size.y);
        pass.draw(0..3, 0..1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(x: i32, y: i32, width: u32, height: u32) -> PixelRect {
        PixelRect { corner: [x, y], size: UVec2::new(width, height) }
    }

    #[test]
    fn what_is_seen_lies_on_the_canvas() {
        let canvas = place(10, 20, 100, 50);
        assert_eq!(canvas.within(&canvas), place(0, 0, 100, 50));
        assert_eq!(place(60, 20, 50, 50).within(&canvas), place(50, 0, 50, 50));
        assert_eq!(place(0, 0, 40, 30).within(&canvas), place(0, 0, 30, 10));
        assert_eq!(place(90, 60, 90, 90).within(&canvas), place(80, 40, 20, 10));
        for beside in [place(0, 0, 10, 90), place(200, 0, 10, 90)] {
            assert_eq!(beside.within(&canvas).size.x, 0);
        }
    }
}
