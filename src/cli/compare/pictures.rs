//! The pictures of a comparison: both snapshots, maps of noise and difference, the plot.

use std::path::Path;

use crate::error::Result;
use crate::format::percent;
use crate::image::exr::{self, SnapshotHeader};
use crate::image::map::{self, Colors, Map};
use crate::image::plot::{self, Plot, PlotAxis, PlotCurve};
use crate::image::ramp::Scale;
use crate::render::Film;
use crate::render::compare::maps;
use crate::render::side_by_side::RenderedPair;

/// Writes all pictures to `folder`; `names` are those of the sides, `sentence` says what they show.
/// One that fails does not keep the others from being written; the first error is returned.
pub fn write_all(
    folder: &Path,
    pair: &RenderedPair,
    headers: &[SnapshotHeader; 2],
    (names, sentence): (&[String; 2], &str),
) -> Result<()> {
    let films = [&pair.sides[0].film, &pair.sides[1].film];
    let mut first = Ok(());
    for (side, name) in ["a.exr", "b.exr"].into_iter().enumerate() {
        first = first.and(exr::write(&folder.join(name), films[side], &headers[side]));
    }
    first = first.and(difference(folder, films));
    first = first.and(noise(folder, films));
    first.and(noise_over_time(folder, pair, names, sentence))
}

fn difference(folder: &Path, films: [&Film; 2]) -> Result<()> {
    let values = maps::difference(films);
    let most = quantile(values.iter().map(|value| value.abs()), 0.99);
    let end = if most > 0.0 { Scale::rounded_up(most) } else { 1.0 };
    let map = Map {
        title: "Difference B − A, relative to the mean of both pictures",
        note: "Blue: B is darker. Orange: B is brighter. Noise of both sides shows as well.",
        size: films[0].size(),
        values: &values,
        colors: Colors::Signed(end),
        label: percent,
    };
    map::write(&folder.join("difference.png"), &map)
}

/// Writes the noise of both films on the same scale, so that their colors can be compared.
fn noise(folder: &Path, films: [&Film; 2]) -> Result<()> {
    let values = films.map(maps::noise);
    let seen = || values.iter().flatten().copied().filter(|&value| value > 0.0);
    let scale = Scale::rounded([quantile(seen(), 0.01), quantile(seen(), 0.999)]);
    let mut first = Ok(());
    for (side, name) in ["a", "b"].into_iter().enumerate() {
        let title = format!("Noise of {}: standard error of each pixel", name.to_uppercase());
        let map = Map {
            title: &title,
            note: "Relative to the mean of the picture. Black: no noise, or fewer than two samples.",
            size: films[side].size(),
            values: &values[side],
            colors: Colors::Logarithmic(scale),
            label: percent,
        };
        first = first.and(map::write(&folder.join(format!("noise_{name}.png")), &map));
    }
    first
}

fn noise_over_time(
    folder: &Path,
    pair: &RenderedPair,
    names: &[String; 2],
    sentence: &str,
) -> Result<()> {
    let curve =
        |side: usize| PlotCurve { name: &names[side], points: pair.sides[side].history.points() };
    let plot = Plot {
        title: sentence,
        axes: [
            PlotAxis { name: "CPU seconds of rendering", label: |seconds| seconds.to_string() },
            PlotAxis { name: "Noise: standard error relative to the mean", label: percent },
        ],
        curves: &[curve(0), curve(1)],
    };
    plot::write(&folder.join("noise_over_time.png"), &plot)
}

/// The number that such a part of `values` lies below; 1 where there are none.
fn quantile(values: impl Iterator<Item = f32>, part: f64) -> f32 {
    let mut values: Vec<f32> = values.filter(|value| value.is_finite()).collect();
    values.sort_by(f32::total_cmp);
    let last = values.len().saturating_sub(1) as f64;
    values.get((part * last).round() as usize).copied().unwrap_or(1.0)
}
