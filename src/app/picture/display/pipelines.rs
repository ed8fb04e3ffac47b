//! The shader of the picture, specialized for the view. A software driver works out both sides of
//! every branch for every pixel, so that a curve that is not shown would cost as much as the one
//! that is: choices that hold for a whole picture are made with its pipeline.

use crate::app::picture::look::Look;
use crate::image::tone::{Channel, ToneCurve};

/// The choices settled for a whole picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Variant {
    /// Curve from numbers to light, as the shader numbers it.
    curve: u32,
    channel: u32,
    /// Whether a framebuffer pixel covers more than one of the picture.
    is_shrunk: bool,
    /// Whether lines are drawn between pixels.
    has_grid: bool,
}

/// Picture pixels per framebuffer pixel from which on a grid is drawn.
const GRID_FROM: f32 = 0.0626;
/// The most that rounding puts into the size of a pixel that is shown as it is.
const ROUNDING: f32 = 0.001;

impl Variant {
    /// Variant for `look` on a picture that has `step` pixels per one of the framebuffer, and whose
    /// light may be coded already.
    pub fn new(look: Look, step: f32, is_coded: bool) -> Self {
        if is_coded {
            return Self { curve: CODED, channel: 0, is_shrunk: false, has_grid: false };
        }
        let (curve, channel) = match look {
            Look::Picture(tone) | Look::Light(tone) => {
                (curve_index(tone.curve), channel_index(tone.channel))
            }
            Look::Numbers(_) => (RAMP, 0),
        };
        Self { curve, channel, is_shrunk: step > 1.0 + ROUNDING, has_grid: has_grid(step) }
    }
}

/// Whether lines are drawn between pixels, `step` of which are one of the framebuffer.
pub(super) fn has_grid(step: f32) -> bool {
    step <= GRID_FROM
}

/// The shader's number of the ramp.
const RAMP: u32 = 2;
/// The shader's number of light that is coded already.
const CODED: u32 = 4;

/// The shader's number of a curve.
fn curve_index(curve: ToneCurve) -> u32 {
    match curve {
        ToneCurve::Linear => 0,
        ToneCurve::Filmic => 1,
        ToneCurve::Agx => 3,
    }
}

/// The shader's number of a channel.
fn channel_index(channel: Channel) -> u32 {
    match channel {
        Channel::Color => 0,
        Channel::Red => 1,
        Channel::Green => 2,
        Channel::Blue => 3,
        Channel::Luminance => 4,
        Channel::FalseColor => 5,
    }
}

/// The pipelines made so far.
pub(super) struct Pipelines {
    shader: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    canvas_format: wgpu::TextureFormat,
    copy: wgpu::RenderPipeline,
    made: Vec<(Variant, wgpu::RenderPipeline)>,
}

impl Pipelines {
    /// The one that copies a canvas to a window of the format `target`, and none of the others yet.
    pub fn new(
        device: &wgpu::Device,
        bindings: &wgpu::BindGroupLayout,
        target: wgpu::TextureFormat,
    ) -> Self {
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("display"),
            bind_group_layouts: &[Some(bindings)],
            immediate_size: 0,
        });
        let shader = device.create_shader_module(wgpu::include_wgsl!("display.wgsl"));
        // Codes go through as they are; a framebuffer that codes by itself gets light.
        let canvas_format = match target.is_srgb() {
            true => wgpu::TextureFormat::Rgba8UnormSrgb,
            false => wgpu::TextureFormat::Rgba8Unorm,
        };
        let copy = pipeline(device, (&shader, "copy", &[]), &layout, target);
        Self { shader, layout, canvas_format, copy, made: Vec::new() }
    }

    /// The format of canvases.
    pub fn canvas_format(&self) -> wgpu::TextureFormat {
        self.canvas_format
    }

    /// Pipeline that copies a canvas to the window.
    pub fn copy(&self) -> &wgpu::RenderPipeline {
        &self.copy
    }

    /// Pipeline that draws `variant` on a canvas.
    pub fn of(&mut self, device: &wgpu::Device, variant: Variant) -> &wgpu::RenderPipeline {
        let known = self.made.iter().position(|(made, _)| *made == variant);
        let index = known.unwrap_or_else(|| {
            self.made.push((variant, self.draw(device, variant)));
            self.made.len() - 1
        });
        &self.made[index].1
    }

    fn draw(&self, device: &wgpu::Device, variant: Variant) -> wgpu::RenderPipeline {
        let Variant { curve, channel, is_shrunk, has_grid } = variant;
        let flag = |flag: bool| f64::from(u8::from(flag));
        let constants = [
            ("CURVE", f64::from(curve)),
            ("CHANNEL", f64::from(channel)),
            ("IS_SHRUNK", flag(is_shrunk)),
            ("HAS_GRID", flag(has_grid)),
            ("ENCODES", flag(!self.canvas_format.is_srgb())),
        ];
        let fragment = (&self.shader, "fragment", constants.as_slice());
        pipeline(device, fragment, &self.layout, self.canvas_format)
    }
}

/// A pipeline of a fragment shader with its constants, over the whole viewport.
fn pipeline(
    device: &wgpu::Device,
    (shader, fragment, constants): (&wgpu::ShaderModule, &str, &[(&str, f64)]),
    layout: &wgpu::PipelineLayout,
    target: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let plain = wgpu::PipelineCompilationOptions::default;
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("display"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some("vertex"),
            compilation_options: plain(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: shader,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..plain() },
            targets: &[Some(target.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
