//! The bar chart of a sweep.

use std::path::Path;

use crate::error::Result;
use crate::image::bars::{self, Bar, Bars};
use crate::render::sweep::words::{headline, relative_time};
use crate::render::sweep::{RankedTrial, Ranking, TrialSource};

/// Draws how many times as fast as the baseline each strategy is, the fastest first.
///
/// # Errors
/// When the system refuses to write.
pub fn write(path: &Path, ranking: &Ranking) -> Result<()> {
    let texts: Vec<[String; 2]> =
        ranking.entries.iter().map(|entry| [entry.trial.kind.title(), label(entry)]).collect();
    let bar = |(number, entry): (usize, &RankedTrial)| Bar {
        name: &texts[number][0],
        value: entry.over_baseline.map(|speed_up| (speed_up.ratio, speed_up.interval())),
        label: &texts[number][1],
        stands_out: ranking.leave_on == Some(number),
    };
    let bars: Vec<Bar<'_>> = ranking.entries.iter().enumerate().map(bar).collect();
    let title = headline(ranking);
    let axis = "Times as fast as baseline, with 95 % intervals; right: time for the same noise";
    bars::write(path, &Bars { title: &title, axis, bars: &bars })
}

fn label(entry: &RankedTrial) -> String {
    match (entry.trial.source, &entry.over_baseline) {
        (TrialSource::Refused(_), _) => "not rendered".to_owned(),
        (TrialSource::SameAs { twin, .. }, _) => format!("as {}", twin.name()),
        (TrialSource::Rendered, Some(speed_up)) => relative_time(speed_up),
        (TrialSource::Rendered, None) => "not known".to_owned(),
    }
}
