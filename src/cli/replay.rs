//! `flambeau replay`: one path, printed vertex by vertex.

use std::fmt::Write;
use std::sync::Arc;

use clap::Args;
use glam::{UVec2, Vec3A};

use super::console::print;
use super::exit::{Exit, Refusal};
use super::scene_source::SceneArguments;
use super::values::parse_pixel;
use crate::error::{Error, NO_PROGRESS};
use crate::scene::VolumeCache;
use crate::transport::observer::{Observer, PathStep};
use crate::transport::vertex::Vertex;
use crate::transport::{PathSample, PreparedFrame};

#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// The pixel, counted from the upper left corner.
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pixel: UVec2,
    /// The sample of that pixel, counted from 0.
    #[arg(long, value_name = "N")]
    sample: u32,
}

pub fn run(arguments: &Arguments) -> Result<Exit, Refusal> {
    let cache = VolumeCache::default();
    let settings = arguments.scene.settings(&cache, NO_PROGRESS)?;
    let size = UVec2::from_array(settings.film.size);
    let pixel = arguments.pixel;
    if pixel.x >= size.x || pixel.y >= size.y {
        let reason = format!("{},{} is off the film of {} x {}", pixel.x, pixel.y, size.x, size.y);
        return Err(Refusal::usage(Error::invalid("", "--pixel", reason)));
    }
    let scene = arguments.scene.assemble(&settings, &cache, NO_PROGRESS)?;
    let frame = PreparedFrame::new(Arc::new(scene), size, settings.picture_seed(), NO_PROGRESS)?;
    let mut log = Log::default();
    let sample = frame.trace(pixel, arguments.sample, &mut log);
    print(&format!("{}{}", log.text, summary(&sample)))?;
    Ok(Exit::Done)
}

/// Writes down every step of a path.
#[derive(Default)]
struct Log {
    text: String,
    rays: u32,
}

impl Observer for Log {
    fn step(&mut self, step: PathStep) {
        let line = match step {
            PathStep::Ray { ray, t_max, throughput } => {
                self.rays += 1;
                let time = match ray.time {
                    0.0 => String::new(),
                    seconds => format!(", {seconds} s after the frame"),
                };
                format!(
                    "ray {} from {} towards {}, length {t_max}, throughput {}{time}",
                    self.rays,
                    triple(ray.origin),
                    triple(ray.direction),
                    triple(throughput)
                )
            }
            PathStep::Emission { contribution, .. } if contribution == Vec3A::ZERO => return,
            PathStep::Emission { contribution, .. } => {
                format!("    volume emission, adds {}", triple(contribution))
            }
            PathStep::End { contribution, .. } => {
                format!("    end of the ray, adds {}", triple(contribution))
            }
            PathStep::Absorbed { point } => format!("    absorbed at {}", triple(point)),
            PathStep::Vertex { vertex, throughput, .. } => {
                format!("    {}, throughput {}", describe(vertex), triple(throughput))
            }
            PathStep::Light { contribution, .. } => {
                format!("    sampled light, adds {}", triple(contribution))
            }
        };
        self.text.push_str(&line);
        self.text.push('\n');
    }
}

fn describe(vertex: &Vertex) -> String {
    let what = if vertex.is_surface() { "reflected" } else { "scattered" };
    format!("{what} at {}", triple(vertex.position))
}

/// Formats three numbers with all digits, each of which counts when a fault is hunted.
fn triple(value: Vec3A) -> String {
    format!("({}, {}, {})", value.x, value.y, value.z)
}

/// Contributions of the path to its pixel.
fn summary(sample: &PathSample) -> String {
    let mut text = String::new();
    let rows = [
        ("emission", sample.emission),
        ("background", sample.background),
        ("direct", sample.direct),
        ("indirect", sample.indirect),
        ("beauty", sample.beauty()),
    ];
    for (name, value) in rows {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:>11} {}", triple(value));
    }
    let depth = sample.depth.map_or("nothing met".to_owned(), |depth| depth.to_string());
    let _ = writeln!(text, "{:>11} {}", "alpha", sample.alpha);
    let _ = writeln!(text, "{:>11} {depth}", "depth");
    let _ = writeln!(text, "{:>11} {}", "steps", sample.tracking_steps);
    if sample.was_cut {
        let _ = writeln!(text, "            the path was cut by the guard");
    }
    text
}
