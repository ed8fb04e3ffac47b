//! Channels of a snapshot, in one list for writing and reading.

use glam::UVec2;

use crate::math::ACCUMULATORS;
use crate::render::coarse::shown_pixel;
use crate::render::estimate::PixelEstimate;
use crate::render::film::{Film, MAX_SAMPLES, Sums};

/// Floats in the state of a pixel.
const STATE_WORDS: usize = size_of::<Sums>() / size_of::<f32>();

/// `depth.Z` where no sample met anything: far behind everything, and harmless in sums.
pub const NO_DEPTH: f32 = 1.0e10;

/// Number of channels for looking at.
const VIEW_CHANNELS: usize = 22;

/// The channel of a pixel's own sample count.
pub const SAMPLES: &str = "samples";

/// All channel names: first those for viewing, then those needed to resume.
pub fn channel_names() -> Vec<String> {
    let view = view_channels(None, 0).map(|(name, _)| name.to_owned());
    view.into_iter().chain(state_names()).collect()
}

/// Names of the channels that hold the running sums, in the order of the words of [`Sums`]: each
/// sum with its remainder, and the count of depths. Whoever moves a field of [`Sums`] moves its
/// name here.
pub fn state_names() -> Vec<String> {
    let mut names = Vec::with_capacity(STATE_WORDS);
    let mut pair = |layer: &str, channel: &str| {
        names.push(format!("state.{layer}.{channel}"));
        names.push(format!("state.{layer}_rest.{channel}"));
    };
    for accumulator in 0..ACCUMULATORS {
        for channel in ["R", "G", "B"] {
            pair(&format!("beauty{accumulator}"), channel);
        }
    }
    for layer in ["emission", "background", "direct", "indirect"] {
        for channel in ["R", "G", "B"] {
            pair(layer, channel);
        }
    }
    pair("alpha", "A");
    pair("depth", "Z");
    pair("steps", "Y");
    names.push("state.depth_count.Z".to_owned());
    names
}

/// Appends the value of every channel at `pixel` to its plane.
pub fn push_pixel(film: &Film, pixel: UVec2, planes: &mut [Vec<f32>]) {
    let (view, state) = planes.split_at_mut(VIEW_CHANNELS);
    // A pixel without samples shows its block, as on the screen; its count tells.
    let shown = PixelEstimate::of(film, shown_pixel(film, pixel));
    let values = view_channels(shown.as_ref(), film.samples(pixel));
    std::iter::zip(view, values).for_each(|(plane, (_, value))| plane.push(value));
    let zero = bytemuck::Zeroable::zeroed();
    let sums = film.sums(pixel).unwrap_or(&zero);
    let words: &[f32] = bytemuck::cast_slice(std::slice::from_ref(sums));
    let (floats, _) = words.split_at(STATE_WORDS - 1);
    let words = floats.iter().copied().chain([sums.depth_count as f32]);
    std::iter::zip(state, words).for_each(|(plane, value)| plane.push(value));
}

/// The channels for looking at, by name, each with its value in a pixel that has these `samples`
/// and shows this estimate; 0 without one.
fn view_channels(
    shown: Option<&PixelEstimate<'_>>,
    samples: u32,
) -> [(&'static str, f32); VIEW_CHANNELS] {
    let rgb = |read: &dyn Fn(&PixelEstimate<'_>) -> [f64; 3]| {
        shown.map_or([0.0; 3], |estimate| read(estimate).map(|value| value as f32))
    };
    let value = |read: &dyn Fn(&PixelEstimate<'_>) -> f32| shown.map_or(0.0, read);
    let beauty = rgb(&|estimate| estimate.mean());
    let emission = rgb(&|estimate| estimate.part(|sums| &sums.emission));
    let background = rgb(&|estimate| estimate.part(|sums| &sums.background));
    let direct = rgb(&|estimate| estimate.part(|sums| &sums.direct));
    let indirect = rgb(&|estimate| estimate.part(|sums| &sums.indirect));
    // Unknown below two samples, which is not the same as none.
    let variance = rgb(&|estimate| estimate.variance().unwrap_or([f64::INFINITY; 3]));
    [
        ("R", beauty[0]),
        ("G", beauty[1]),
        ("B", beauty[2]),
        ("A", value(&|estimate| estimate.alpha() as f32)),
        ("emission.R", emission[0]),
        ("emission.G", emission[1]),
        ("emission.B", emission[2]),
        ("background.R", background[0]),
        ("background.G", background[1]),
        ("background.B", background[2]),
        ("direct.R", direct[0]),
        ("direct.G", direct[1]),
        ("direct.B", direct[2]),
        ("indirect.R", indirect[0]),
        ("indirect.G", indirect[1]),
        ("indirect.B", indirect[2]),
        ("variance.R", variance[0]),
        ("variance.G", variance[1]),
        ("variance.B", variance[2]),
        (SAMPLES, samples as f32),
        ("depth.Z", value(&|estimate| estimate.depth().map_or(NO_DEPTH, |depth| depth as f32))),
        ("steps", value(&|estimate| estimate.steps() as f32)),
    ]
}

/// The count and the sums of a pixel from its `samples` and `state.*` channels; none if they
/// cannot have been written by [`push_pixel`].
pub fn state_from(samples: f32, mut words: [f32; STATE_WORDS]) -> Option<(u32, Sums)> {
    let count = whole(samples)?;
    let depth_count = whole(words[STATE_WORDS - 1])?;
    words[STATE_WORDS - 1] = 0.0;
    if depth_count > count || !words.iter().all(|word| word.is_finite()) {
        return None;
    }
    let mut sums: Sums = *bytemuck::from_bytes(bytemuck::cast_slice(&words));
    sums.depth_count = depth_count;
    Some((count, sums))
}

/// Reads the words of one pixel out of the planes.
pub fn words_at(planes: &[Vec<f32>], index: usize) -> [f32; STATE_WORDS] {
    let mut words = [0.0; STATE_WORDS];
    std::iter::zip(&mut words, planes).for_each(|(word, plane)| *word = plane[index]);
    words
}

fn whole(value: f32) -> Option<u32> {
    let in_range = (0.0..=MAX_SAMPLES as f32).contains(&value) && value.fract() == 0.0;
    in_range.then_some(value as u32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::two_float::TwoFloat;

    #[test]
    fn names_follow_the_fields() {
        let names = state_names();
        assert_eq!(names.len(), STATE_WORDS);
        let mut sums: Sums = bytemuck::Zeroable::zeroed();
        sums.beauty[5][2] = TwoFloat { sum: 1.0, rest: 2.0 };
        sums.emission[0].sum = 3.0;
        sums.indirect[1].rest = 4.0;
        sums.alpha.sum = 5.0;
        sums.depth.rest = 6.0;
        sums.steps.sum = 7.0;
        let words: &[f32] = bytemuck::cast_slice(std::slice::from_ref(&sums));
        let at = |name: &str| words[names.iter().position(|n| n == name).unwrap()];
        assert_eq!((at("state.beauty5.B"), at("state.beauty5_rest.B")), (1.0, 2.0));
        assert_eq!((at("state.emission.R"), at("state.indirect_rest.G")), (3.0, 4.0));
        assert_eq!((at("state.alpha.A"), at("state.depth_rest.Z")), (5.0, 6.0));
        assert_eq!(at("state.steps.Y"), 7.0);
        assert_eq!(names[STATE_WORDS - 1], "state.depth_count.Z");
    }

    #[test]
    fn channel_names_are_unique() {
        let names = channel_names();
        let unique: std::collections::HashSet<_> = names.iter().collect();
        assert_eq!(unique.len(), names.len());
    }

    #[test]
    fn impossible_states_are_refused() {
        assert!(state_from(2.0, [0.0; STATE_WORDS]).is_some());
        for samples in [-1.0, 0.5, f32::NAN, f32::INFINITY, 3.0e7] {
            assert!(state_from(samples, [0.0; STATE_WORDS]).is_none(), "{samples}");
        }
        let mut words = [0.0; STATE_WORDS];
        words[STATE_WORDS - 1] = 3.0;
        assert!(state_from(2.0, words).is_none());
        words = [f32::NAN; STATE_WORDS];
        assert!(state_from(2.0, words).is_none());
    }
}
