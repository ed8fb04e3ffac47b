//! The picture on the graphics card: upload when there is a new one, the draw call that exposes,
//! curves and codes it, or colors its numbers (`display.wgsl`), and the copy to the window. Coarse
//! pictures are coded before their upload.

mod canvas;
mod gpu;
mod pipelines;

use std::borrow::Cow;
use std::num::NonZeroU64;
use std::sync::Arc;

use egui_wgpu::{CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};
use glam::{UVec2, Vec2};

use super::look::{Look, TextureData};
use super::zoom::Placement;
use crate::app::ui::theme::color;
use crate::image::ramp::{STOPS, Scale, stops};
use crate::image::tone::{Channel, Tone, false_color};
use crate::math::Rgb;
use crate::render::Picture;
use canvas::{GpuCanvas, PixelRect};
use gpu::{bind, texture};
use pipelines::{Pipelines, Variant};

/// `ViewUniform` of the shader.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct ViewUniform {
    origin: [f32; 2],
    step: f32,
    block_log2: u32,
    size: [u32; 2],
    canvas: [i32; 2],
    surround: [f32; 4],
    scale: [f32; 4],
    exposed_from_linear: [[f32; 4]; 3],
    ramp: [[f32; 4]; STOPS],
}

/// Pictures that can be shown at once.
pub const PANES: usize = 2;

/// The data of a picture on the graphics card, and its coding.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Upload {
    source: TextureData,
    /// The tone that its light is coded with, if that is done here: of a coarse picture this is
    /// worked out for its few texels, not for every pixel of the window.
    coded: Option<Tone>,
}

impl Upload {
    /// Texels of `picture`, one per block, row by row.
    fn texels(self, picture: &Picture) -> Cow<'_, [u8]> {
        let Some(tone) = self.coded else {
            return match self.source {
                TextureData::Numbers => blocks(picture, &picture.layer.numbers),
                light => blocks(picture, light.light(picture)),
            };
        };
        let encoder = tone.encoder();
        let codes = corners(picture, self.source.light(picture)).flat_map(|[r, g, b, _]| {
            let [r, g, b] =
                encoder.encode(Rgb::new(*r, *g, *b)).map(|code| f32::from(code) / 255.0);
            [r, g, b, 1.0]
        });
        Cow::Owned(codes.flat_map(f32::to_ne_bytes).collect())
    }
}

/// The value of each block among the `values` of all pixels.
fn blocks<'a, T: bytemuck::NoUninit>(picture: &Picture, values: &'a [T]) -> Cow<'a, [u8]> {
    if picture.block_log2 == 0 {
        return Cow::Borrowed(bytemuck::cast_slice(values));
    }
    Cow::Owned(corners(picture, values).flat_map(bytemuck::bytes_of).copied().collect())
}

/// The first of the `values` of each block, row by row.
fn corners<'a, T>(picture: &Picture, values: &'a [T]) -> impl Iterator<Item = &'a T> {
    let side = 1 << picture.block_log2;
    let lines = values.chunks(picture.size.x.max(1) as usize).step_by(side);
    lines.flat_map(move |line| line.iter().step_by(side))
}

/// The resources of the draw call on the graphics card; lives among egui's callback resources.
struct Display {
    pipelines: Pipelines,
    layout: wgpu::BindGroupLayout,
    panes: [GpuPane; PANES],
}

/// A picture on the graphics card and its view.
struct GpuPane {
    view: wgpu::Buffer,
    shown: Option<UploadedPicture>,
    canvas: Option<GpuCanvas>,
    /// The state drawn on the canvas, if anything is.
    drawn: Option<DrawnState>,
}

/// The state drawn on a canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DrawnState {
    view: ViewUniform,
    variant: Variant,
    /// The part of the canvas that is seen; nothing is drawn beside it.
    seen: PixelRect,
}

/// The uploaded picture.
struct UploadedPicture {
    picture: Arc<Picture>,
    upload: Upload,
    texture: wgpu::Texture,
    bindings: wgpu::BindGroup,
}

/// Prepares the graphics card of `state` for [`paint`].
pub fn install(state: &RenderState) {
    let display = Display::new(&state.device, state.target_format);
    state.renderer.write().callback_resources.insert(display);
}

/// The widest and highest picture that the graphics card can show.
pub fn largest_size(state: &RenderState) -> u32 {
    state.device.limits().max_texture_dimension_2d
}

/// A picture and its place in the window.
pub struct Shot {
    /// The picture.
    pub picture: Arc<Picture>,
    /// Look of the picture.
    pub look: Look,
    /// Placement of the picture, from the corner of `area`.
    pub placement: Placement,
    /// Part of the window that the picture is laid out in, in points.
    pub area: egui::Rect,
    /// The part of that which is seen.
    pub clip: egui::Rect,
    /// Index of the pane among the pictures shown at once, below [`PANES`].
    pub pane: usize,
}

/// Shows a picture where it is seen.
pub fn paint(painter: &egui::Painter, shot: Shot) {
    painter.add(egui_wgpu::Callback::new_paint_callback(shot.clip, shot));
}

impl CallbackTrait for Shot {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        let Some(display) = resources.get_mut::<Display>() else { return Vec::new() };
        let Display { layout, panes, pipelines } = display;
        let Some(pane) = panes.get_mut(self.pane) else { return Vec::new() };
        let place = PixelRect::of(&self.area, screen);
        let coded = self.coded(pipelines.canvas_format());
        let view = self.view(&place, screen.pixels_per_point, coded.is_some());
        let variant = Variant::new(self.look, view.step, coded.is_some());
        let upload = Upload { source: self.look.source(), coded };
        let is_new = pane.upload(device, queue, layout, &self.picture, upload);
        let drawn =
            DrawnState { view, variant, seen: PixelRect::of(&self.clip, screen).within(&place) };
        if is_new || !pane.shows(&drawn, place.size) {
            queue.write_buffer(&pane.view, 0, bytemuck::bytes_of(&view));
            let format = pipelines.canvas_format();
            let pipeline = pipelines.of(device, variant);
            pane.draw(device, encoder, (layout, pipeline), (place.size, format), &drawn.seen);
            pane.drawn = Some(drawn);
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        let Some(display) = resources.get::<Display>() else { return };
        let canvas = display.panes.get(self.pane).and_then(|pane| pane.canvas.as_ref());
        let Some(canvas) = canvas else { return };
        pass.set_pipeline(display.pipelines.copy());
        pass.set_bind_group(0, canvas.bindings(), &[]);
        pass.draw(0..3, 0..1);
    }
}

impl Shot {
    /// Tone that codes the picture before it is drawn, if one does. Codes are not for canvases that
    /// code by themselves, nor for drawing lines on.
    fn coded(&self, canvas: wgpu::TextureFormat) -> Option<Tone> {
        let (Look::Picture(tone) | Look::Light(tone)) = self.look else { return None };
        let is_plain = !canvas.is_srgb() && !pipelines::has_grid(1.0 / self.placement.scale);
        // Smaller blocks are many, and blocks smaller than a pixel of the window have to be
        // averaged.
        let side = 1 << self.picture.block_log2;
        let are_large = side > 2 && 1.0 / self.placement.scale <= side as f32;
        (are_large && is_plain).then_some(tone)
    }

    fn view(&self, place: &PixelRect, pixels_per_point: f32, is_coded: bool) -> ViewUniform {
        let area = Vec2::new(self.area.min.x, self.area.min.y) * pixels_per_point;
        let corner = area + self.placement.corner;
        let surround = match is_coded {
            true => color::SURROUND.to_normalized_gamma_f32(),
            false => egui::Rgba::from(color::SURROUND).to_array(),
        };
        let (tone, scale) = match self.look {
            Look::Picture(tone) | Look::Light(tone) => (tone, [0.0; 4]),
            Look::Numbers(scale) => (Tone::default(), scale_and_span(scale)),
        };
        let padded_columns =
            tone.exposed_from_linear().to_cols_array_2d().map(|[x, y, z]| [x, y, z, 0.0]);
        let ramp = match (self.look, tone.channel) {
            (Look::Picture(_) | Look::Light(_), Channel::FalseColor) => stop_colors(),
            _ => *stops(),
        };
        ViewUniform {
            origin: (-corner / self.placement.scale).into(),
            step: 1.0 / self.placement.scale,
            block_log2: self.picture.block_log2,
            size: self.picture.size.into(),
            canvas: place.corner,
            surround,
            scale,
            exposed_from_linear: padded_columns,
            ramp: ramp.map(|[r, g, b]| [r, g, b, 1.0]),
        }
    }
}

fn scale_and_span(Scale { low, high }: Scale) -> [f32; 4] {
    let span = (high / low).ln();
    [low.ln(), if span > 0.0 { 1.0 / span } else { 0.0 }, 0.0, 0.0]
}

/// The colors of false color, linear.
fn stop_colors() -> [[f32; 3]; STOPS] {
    false_color::COLORS.map(|code| {
        let [r, g, b, _] = egui::Rgba::from(color::of(code)).to_array();
        [r, g, b]
    })
}

impl Display {
    fn new(device: &wgpu::Device, target: wgpu::TextureFormat) -> Self {
        let layout = bind_group_layout(device);
        let pipelines = Pipelines::new(device, &layout, target);
        let panes = std::array::from_fn(|_| GpuPane::new(device));
        Self { pipelines, layout, panes }
    }
}

impl GpuPane {
    fn new(device: &wgpu::Device) -> Self {
        let view = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("display view"),
            size: size_of::<ViewUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { view, shown: None, canvas: None, drawn: None }
    }

    /// Whether the canvas shows just that already.
    fn shows(&self, wanted: &DrawnState, size: UVec2) -> bool {
        self.drawn.as_ref() == Some(wanted)
            && self.canvas.as_ref().is_some_and(|canvas| canvas.is_of(size))
    }

    /// Draws the uploaded picture on the canvas, which has that size and format.
    fn draw(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        (layout, pipeline): (&wgpu::BindGroupLayout, &wgpu::RenderPipeline),
        (size, format): (UVec2, wgpu::TextureFormat),
        seen: &PixelRect,
    ) {
        let Some(shown) = &self.shown else { return };
        let old = self.canvas.take().filter(|canvas| canvas.is_of(size));
        let canvas =
            old.unwrap_or_else(|| GpuCanvas::new(device, layout, (size, format), &self.view));
        canvas.draw(encoder, pipeline, &shown.bindings, seen);
        self.canvas = Some(canvas);
    }

    /// Brings what is shown of `picture` onto the graphics card; false where it is there already.
    fn upload(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layout: &wgpu::BindGroupLayout,
        picture: &Arc<Picture>,
        upload: Upload,
    ) -> bool {
        let format = upload.source.format();
        let is_there = |shown: &UploadedPicture| {
            Arc::ptr_eq(&shown.picture, picture) && shown.upload == upload
        };
        if self.shown.as_ref().is_some_and(is_there) {
            return false;
        }
        let fits = |shown: &UploadedPicture| {
            shown.picture.size == picture.size && shown.upload.source.format() == format
        };
        let (texture, bindings) = match self.shown.take().filter(fits) {
            Some(shown) => (shown.texture, shown.bindings),
            None => self.allocate(device, layout, picture.size, format),
        };
        // A coarse picture takes a corner of the texture, and no time.
        let size = picture.size.map(|side| side.div_ceil(1 << picture.block_log2));
        let UVec2 { x: width, y: height } = size;
        queue.write_texture(
            texture.as_image_copy(),
            &upload.texels(picture),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: format.block_copy_size(None).map(|bytes| bytes * width),
                rows_per_image: Some(height),
            },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
        self.shown = Some(UploadedPicture { picture: picture.clone(), upload, texture, bindings });
        true
    }

    fn allocate(
        &self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        size: UVec2,
        format: wgpu::TextureFormat,
    ) -> (wgpu::Texture, wgpu::BindGroup) {
        let usage = wgpu::TextureUsages::COPY_DST;
        let texture = texture(device, "picture", (size, format), usage);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let bindings = bind(device, layout, &self.view, &view);
        (texture, bindings)
    }
}

fn bind_group_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("display"),
        entries: &[
            wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: NonZeroU64::new(size_of::<ViewUniform>() as u64),
                },
                count: None,
            },
            wgpu::BindGroupLayoutEntry {
                binding: 1,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            },
        ],
    })
}
