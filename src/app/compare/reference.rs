//! A reference that pictures are measured against, the errors of what is shown, and how they went
//! down.

mod load;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::Context;
use glam::UVec2;

pub use load::{LoadedReference, ReferenceOrigin};

use super::maps::{Map, MapKind};
use super::measure::{Measure, Plotted};
use crate::app::document::Side;
use crate::app::jobs::background::{Background, BackgroundPool};
use crate::error::Result;
use crate::image::metrics::{Errors, Viewing};
use crate::image::tone::Tone;
use crate::render::Picture;
use crate::render::compare::NoiseHistory;
use load::Loading;

/// Measuring rests so many times as long as it took, for the machine is there to render.
const REST: u32 = 9;

/// A measurement: of one picture, or of those of A and B.
#[derive(Clone)]
struct MeasureTask {
    reference: Arc<LoadedReference>,
    pictures: Vec<Arc<Picture>>,
    tone: Tone,
}

impl MeasureTask {
    fn same(&self, other: &Self) -> bool {
        let pairs = || std::iter::zip(&self.pictures, &other.pictures);
        self.is_like(other) && pairs().all(|(a, b)| Arc::ptr_eq(a, b))
    }

    /// Whether only time has passed between the two.
    fn is_like(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.reference, &other.reference)
            && self.tone == other.tone
            && self.pictures.len() == other.pictures.len()
    }

    fn measure(&self) -> MeasureResult {
        let begun = Instant::now();
        let pixels: Vec<&[[f32; 4]]> =
            self.pictures.iter().map(|picture| picture.pixels.as_slice()).collect();
        let viewing = Viewing { tone: self.tone, ..Viewing::default() };
        let errors = Errors::of(&pixels, &self.reference.reference, viewing).unwrap_or_default();
        MeasureResult { errors: Arc::new(errors), took: begun.elapsed(), ended: Instant::now() }
    }
}

/// View of the measured pictures: their tone, and which of them are snapshots.
#[derive(Clone, Copy, Debug)]
pub struct MeasureView {
    /// Tone mapping of the pictures.
    pub tone: Tone,
    /// The side of the main render, where there are two.
    pub main: Option<Side>,
    /// The side that is a snapshot, where one is.
    pub stored: Option<Side>,
    /// Whether the one picture is a snapshot.
    pub is_snapshot: bool,
}

/// The result of a measurement; no errors where pictures and reference do not fit together.
struct MeasureResult {
    errors: Arc<Vec<Errors>>,
    took: Duration,
    ended: Instant,
}

impl MeasureResult {
    /// Pause until the next measurement.
    fn rest(&self) -> Duration {
        (REST * self.took).saturating_sub(self.ended.elapsed())
    }
}

/// Request for a map of the errors: the measure and the picture.
#[derive(Clone)]
struct MapTask {
    errors: Arc<Vec<Errors>>,
    measure: Measure,
    index: usize,
    /// Side that the map is of, where there are two.
    side: Option<Side>,
}

/// The reference and what is measured against it.
pub struct MeasuredReference {
    loaded: Option<Arc<LoadedReference>>,
    loading: Option<Loading>,
    /// The scene that is open, and the files of the references of it and of others, the one that
    /// was loaded last first.
    scene: String,
    files: Vec<(String, PathBuf)>,
    errors: Background<MeasureTask, MeasureResult>,
    map: Background<MapTask, Option<Map>>,
    /// Histories of relMSE and FLIP of both sides.
    histories: [[NoiseHistory; 2]; 2],
    noted: Option<Instant>,
    /// The quantity that the panel plots over time.
    pub plotted: Plotted,
    /// The tone that FLIP's histories are of, and the side in the first of them.
    tone: Tone,
    main: Option<Side>,
}

impl MeasuredReference {
    /// A state without a reference, but with the reference files of some scenes; `pool` will
    /// measure.
    pub fn new(pool: &BackgroundPool, files: Vec<(String, PathBuf)>) -> Self {
        Self {
            loaded: None,
            loading: None,
            scene: String::new(),
            files,
            errors: Background::new(pool),
            map: Background::new(pool),
            histories: Default::default(),
            noted: None,
            plotted: Plotted::default(),
            tone: Tone::default(),
            main: None,
        }
    }

    /// The reference.
    pub fn loaded(&self) -> Option<&Arc<LoadedReference>> {
        self.loaded.as_ref()
    }

    /// Whether a reference is on its way.
    pub fn is_loading(&self) -> bool {
        self.loading.is_some()
    }

    /// Takes a reference from there, in place of the one there is once that has come to its end.
    ///
    /// # Errors
    /// When the system refuses to start a thread.
    pub fn load(&mut self, ctx: &Context, origin: ReferenceOrigin) -> Result<()> {
        let wake = ctx.clone();
        self.loading = Some(Loading::start(origin, move || wake.request_repaint())?);
        Ok(())
    }

    /// Takes the reference away.
    pub fn remove(&mut self) {
        self.forget();
        self.note_file(None);
    }

    /// The files of the references of scenes, the one that was loaded last first.
    pub fn files(&self) -> &[(String, PathBuf)] {
        &self.files
    }

    fn note_file(&mut self, file: Option<&Path>) {
        self.files.retain(|(scene, _)| *scene != self.scene);
        if let Some(file) = file {
            let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
            self.files.insert(0, (self.scene.clone(), file));
        }
    }

    fn forget(&mut self) {
        self.loaded = None;
        self.loading = None;
        self.histories = Default::default();
    }

    /// Notes that another scene is open, which brings the reference along that was loaded for it
    /// when it was open before.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn open(&mut self, ctx: &Context, scene: &str) -> Result<()> {
        if self.scene == scene {
            return Ok(());
        }
        self.forget();
        scene.clone_into(&mut self.scene);
        match self.files.iter().find(|(other, _)| other == scene) {
            Some((_, path)) => self.load(ctx, ReferenceOrigin::file(path.clone())),
            None => Ok(()),
        }
    }

    /// Takes in a reference that has come; says where that failed.
    pub fn poll(&mut self) -> Result<()> {
        let Some(result) = self.loading.as_ref().and_then(Loading::poll) else { return Ok(()) };
        self.loading = None;
        let loaded = result.inspect_err(|_| self.note_file(None))?;
        self.note_file(loaded.path.as_deref());
        self.loaded = Some(Arc::new(loaded));
        self.histories = Default::default();
        Ok(())
    }

    /// Whether the reference is of another size than pictures of `size`.
    pub fn is_of_another_size(&self, size: UVec2) -> bool {
        self.loaded.as_ref().is_some_and(|loaded| loaded.reference.matches(size).is_err())
    }

    /// Brings the errors in line with what is looked at, one picture or those of A and B.
    pub fn update(&mut self, ctx: &Context, pictures: Vec<Arc<Picture>>, seen: MeasureView) {
        match (std::mem::replace(&mut self.main, seen.main), seen.main) {
            (then, now) if then == now => {}
            (Some(_), Some(_)) => self.histories.swap(0, 1),
            _ => self.histories = Default::default(),
        }
        let tone = seen.tone;
        if std::mem::replace(&mut self.tone, tone) != tone {
            self.histories.iter_mut().for_each(|side| side[1] = NoiseHistory::default());
        }
        let fits = |picture: &Arc<Picture>| !self.is_of_another_size(picture.size);
        let has_all = !pictures.is_empty() && pictures.iter().all(fits);
        let task = self.loaded.clone().filter(|_| has_all);
        let task = task.map(|reference| MeasureTask { reference, pictures, tone });
        let task = task.and_then(|task| self.in_time(ctx, task));
        let wake = ctx.clone();
        let measure = MeasureTask::measure;
        self.errors.update(task, MeasureTask::same, measure, move || wake.request_repaint());
        self.note(seen);
    }

    /// The task to measure now: `task`, or the one measured last while measuring rests.
    fn in_time(&self, ctx: &Context, task: MeasureTask) -> Option<MeasureTask> {
        let done = self.errors.done().filter(|(done, _)| done.is_like(&task));
        let is_rough = task.pictures.iter().any(|picture| !picture.complete);
        match done {
            Some((done, _)) if is_rough => Some(done.clone()),
            None if is_rough => None,
            Some((done, measured)) if !done.same(&task) && !measured.rest().is_zero() => {
                ctx.request_repaint_after(measured.rest());
                Some(done.clone())
            }
            _ => Some(task),
        }
    }

    /// Adds new errors to the histories. A snapshot has no past: one that is a side is a point.
    fn note(&mut self, seen: MeasureView) {
        let Some((task, measured)) = self.errors.done() else { return };
        if self.noted.replace(measured.ended) == Some(measured.ended) || seen.is_snapshot {
            return;
        }
        let sides = std::iter::zip(&task.pictures, measured.errors.iter());
        let sides = std::iter::zip([Side::A, Side::B], sides);
        for (history, (side, (picture, errors))) in self.histories.iter_mut().zip(sides) {
            if seen.stored == Some(side) {
                *history = Default::default();
            }
            for (history, measure) in history.iter_mut().zip(Measure::ALL) {
                history.follow(picture.stats.cpu_seconds, measure.mean(errors, None));
            }
        }
    }

    /// The errors of what is looked at, one or two, once they are there.
    pub fn errors(&self) -> Option<&[Errors]> {
        let (_, measured) = self.errors.done()?;
        Some(measured.errors.as_slice()).filter(|errors| !errors.is_empty())
    }

    /// Histories of the errors of A and of B.
    pub fn histories(&self, measure: Measure) -> [&NoiseHistory; 2] {
        let index = usize::from(measure == Measure::Flip);
        self.histories.each_ref().map(|side| &side[index])
    }

    /// Brings the map in line with what is wanted: how measured, of which side where there are two.
    pub fn update_map(&mut self, ctx: &Context, wanted: Option<(Measure, Option<Side>)>) {
        let measured = self.errors.done().map(|(_, measured)| measured.errors.clone());
        let task = wanted.zip(measured).and_then(|((measure, side), errors)| {
            let index = usize::from(side == Some(Side::B));
            (index < errors.len()).then_some(MapTask { errors, measure, index, side })
        });
        let same = |a: &MapTask, b: &MapTask| {
            let same_map = Arc::ptr_eq(&a.errors, &b.errors) && a.measure == b.measure;
            same_map && a.index == b.index && a.side == b.side
        };
        let make = |task: &MapTask| {
            let errors = task.errors.get(task.index)?;
            let kind = MapKind::Error(task.measure, task.side);
            Map::of_errors(kind, task.measure.of(errors))
        };
        let wake = ctx.clone();
        self.map.update(task, same, make, move || wake.request_repaint());
    }

    /// Map of a measure and a side, once it is made.
    pub fn map(&self, measure: Measure, side: Option<Side>) -> Option<&Map> {
        let (task, map) = self.map.done()?;
        map.as_ref().filter(|_| task.measure == measure && task.side == side)
    }
}
