//! Two strategies on one scene: the second render, the machine shared fairly between both renders,
//! and the view of both pictures.

use std::sync::Arc;

use egui::{Context, Key};
use glam::UVec2;

use super::maps::{Difference, Map, MapKind, Noise};
use super::measure::Measure;
use super::region_figures::{RegionFigures, RegionTask};
use crate::app::document::{Compared, Document, Side};
use crate::app::jobs::background::{Background, BackgroundPool};
use crate::app::jobs::live_render::{LiveRender, News};
use crate::app::picture::look::Look;
use crate::app::picture::viewport::Shown;
use crate::error::Result;
use crate::render::compare::{Comparison, NoiseHistory};
use crate::render::session::{Sharing, TurnToken};
use crate::render::{Area, Layer, Picture};

/// The key that shows the other side while it is held.
pub const FLIP_KEY: Key = Key::H;

/// Layout of A and B in the viewport.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CompareLayout {
    /// Wipe: one over the other, with a divider.
    #[default]
    Wipe,
    /// Side by side.
    Beside,
    /// Map of the differences of A and B.
    Difference(Difference),
    /// Map of the noise of A or B, or of the ratio of both.
    Noise(Noise),
    /// Map of the errors of one side against the reference.
    Error(Measure, Side),
}

impl CompareLayout {
    /// One layout of each kind; the last one needs a reference.
    pub const ALL: [Self; 5] = [
        Self::Wipe,
        Self::Beside,
        Self::Difference(Difference::Signed),
        Self::Noise(Noise::Of(Side::A)),
        Self::Error(Measure::RelMse, Side::A),
    ];

    /// The kinds that there are, of two pictures or of one, with a reference or without.
    pub fn kinds(of_two: bool, with_reference: bool) -> Vec<Self> {
        let mut kinds = Self::ALL.to_vec();
        kinds.retain(|kind| match kind {
            Self::Wipe => true,
            Self::Error(..) => with_reference,
            _ => of_two,
        });
        kinds
    }

    /// The next of some kinds.
    pub fn next(self, kinds: &[Self]) -> Self {
        let place = kinds.iter().position(|kind| kind.kind() == self.kind());
        let next = place.map_or(0, |place| place + 1);
        kinds.get(next).or(kinds.first()).copied().unwrap_or_default()
    }

    /// Index of the layout among the kinds.
    pub fn kind(self) -> usize {
        match self {
            Self::Wipe => 0,
            Self::Beside => 1,
            Self::Difference(_) => 2,
            Self::Noise(_) => 3,
            Self::Error(..) => 4,
        }
    }

    /// Map that the layout needs of two pictures.
    fn map(self) -> Option<MapKind> {
        match self {
            Self::Wipe | Self::Beside | Self::Error(..) => None,
            Self::Difference(difference) => Some(MapKind::Difference(difference)),
            Self::Noise(noise) => Some(MapKind::Noise(noise)),
        }
    }
}

/// A snapshot as one side against the live picture.
#[derive(Clone, Debug)]
pub struct StoredSide {
    /// The side.
    pub side: Side,
    /// Name of the snapshot.
    pub name: String,
    /// The picture with its variance, once it is read.
    pub picture: Option<Arc<Picture>>,
    /// Whether the strategy of the snapshot was biased.
    pub is_biased: bool,
}

/// The second side of a comparison and the view of both.
pub struct SecondSide {
    second_render: Option<LiveRender>,
    /// Snapshot in place of the second side.
    pub stored: Option<StoredSide>,
    /// The comparison of the last frame.
    last: Option<Compared>,
    /// The tokens of the two sessions while there are two.
    tokens: [TurnToken; 2],
    threads: Option<usize>,
    /// Layout of both sides.
    pub layout: CompareLayout,
    /// Left edge of B, as a share of the picture area's width.
    pub divider: f32,
    map: Background<BothPictures, Option<Map>>,
    figures: Background<[Arc<Picture>; 2], Comparison>,
    region_figures: Background<RegionTask, RegionFigures>,
    /// Histories of the noise of A and of B.
    histories: [NoiseHistory; 2],
    /// The side of the main render when they were last added to.
    noted: Option<Side>,
}

/// Request for a map: both pictures and its kind.
#[derive(Clone)]
struct BothPictures {
    pictures: [Arc<Picture>; 2],
    kind: MapKind,
}

impl BothPictures {
    fn same(&self, other: &Self) -> bool {
        let same = |i: usize| Arc::ptr_eq(&self.pictures[i], &other.pictures[i]);
        self.kind == other.kind && same(0) && same(1)
    }
}

impl SecondSide {
    /// No second side yet; it will have `threads` workers, and `pool` makes maps and figures.
    pub fn new(threads: Option<usize>, pool: &BackgroundPool) -> Self {
        Self {
            second_render: None,
            stored: None,
            last: None,
            tokens: Sharing::tokens(),
            threads,
            layout: CompareLayout::default(),
            divider: 0.5,
            map: Background::new(pool),
            figures: Background::new(pool),
            region_figures: Background::new(pool),
            histories: Default::default(),
            noted: None,
        }
    }

    /// The side of the main render, where there are two.
    pub fn main_side(&self) -> Option<Side> {
        let stored = self.stored.as_ref().map(|stored| stored.side.other());
        stored.or(self.last.map(|compared| compared.main))
    }

    /// Whether there is a second side.
    pub fn is_on(&self) -> bool {
        self.second_render.is_some() || self.stored.is_some()
    }

    /// The second render, of the side that the main render does not show, while there is one.
    pub fn second_render(&self) -> Option<&LiveRender> {
        self.second_render.as_ref()
    }

    /// The render of the side that is edited, where `main` is the main render.
    pub fn edited<'e>(&'e self, main: &'e LiveRender) -> &'e LiveRender {
        match (&self.second_render, self.last) {
            (Some(second_render), Some(last)) if last.active != last.main => second_render,
            _ => main,
        }
    }

    /// Number of sides that share time slices, where `main` is the main render.
    pub fn turns(&self, main: &LiveRender) -> usize {
        let is_at_work = |live_render: &&LiveRender| {
            live_render.picture().is_none_or(|picture| !picture.stats.finished)
        };
        std::iter::once(main).chain(self.second_render()).filter(is_at_work).count()
    }

    /// Lets the second side wait for something else, or go on.
    pub fn set_held(&mut self, held: bool) {
        if let Some(second_render) = &mut self.second_render {
            second_render.set_held(held);
        }
    }

    /// Gives all samples of the second side to the pixels of `area`, or to all pixels.
    pub fn render_region_only(&mut self, area: Option<Area>) {
        if let Some(second_render) = &mut self.second_render {
            second_render.render_region_only(area);
        }
    }

    /// Adds a layer to the pictures of the second side.
    pub fn set_layer(&mut self, layer: Option<Layer>) {
        if let Some(second_render) = &mut self.second_render {
            second_render.set_layer(layer);
        }
    }

    /// Builds the scene of the second side anew, whose files have changed.
    pub fn reload(&mut self) {
        if let Some(second_render) = &mut self.second_render {
            second_render.reload();
        }
    }

    /// Discards the samples of the second side.
    pub fn restart(&mut self) {
        if let Some(second_render) = &mut self.second_render {
            second_render.restart();
        }
    }

    /// Takes in what the threads of the second side have done.
    pub fn poll(&mut self) -> Vec<News> {
        self.second_render.as_mut().map_or_else(Vec::new, LiveRender::poll)
    }

    /// Starts or ends the second render as the document asks, brings it in line with the settings
    /// of its side on a film of `size`, and sets both renders' turns at the machine. Where a
    /// comparison has ended, the render of the side that was edited goes on in `live_render`.
    ///
    /// # Errors
    /// When the system refuses to start threads.
    pub fn update(
        &mut self,
        ctx: &Context,
        document: &Document,
        live_render: &mut LiveRender,
        size: UVec2,
    ) -> Result<Vec<News>> {
        let mut news = Vec::new();
        let Some(compared) = document.compared else {
            self.end(document, live_render);
            self.update_told(ctx, live_render);
            return Ok(news);
        };
        self.last = Some(compared);
        if self.second_render.is_none() {
            if live_render.built().is_none() {
                return Ok(news);
            }
            let wake = ctx.clone();
            let second_render =
                live_render.second_render(self.threads, move || wake.request_repaint())?;
            second_render.session().take_turns_by(Some(self.tokens[1].clone()));
            live_render.session().take_turns_by(Some(self.tokens[0].clone()));
            self.second_render = Some(second_render);
        }
        self.tokens[0].set_share(compared.share);
        let settings = document.settings_of(compared.main.other());
        if let Some(second_render) = &mut self.second_render {
            second_render.set_shows_variance(true);
            if second_render.paused() != live_render.paused() {
                second_render.set_paused(live_render.paused());
            }
            if let Some(wait) = second_render.update(&settings, size, &mut news) {
                ctx.request_repaint_after(wait);
            }
        }
        self.update_told(ctx, live_render);
        Ok(news)
    }

    /// Brings map and figures in line with the pictures.
    fn update_told(&mut self, ctx: &Context, live_render: &LiveRender) {
        self.update_map(ctx, live_render);
        self.update_figures(ctx, live_render);
    }

    /// Ends a comparison. Not where another scene was opened: that goes on where it was.
    fn end(&mut self, document: &Document, live_render: &mut LiveRender) {
        let last = self.last.take();
        let Some(mut second_render) = self.second_render.take() else { return };
        let edited = last.is_some_and(|last| last.active != last.main);
        if edited && second_render.renders(&document.settings) {
            std::mem::swap(live_render, &mut second_render);
        }
        live_render.session().take_turns_by(None);
    }

    fn update_map(&mut self, ctx: &Context, live_render: &LiveRender) {
        let pictures = self.pictures(live_render);
        let pair =
            self.layout.map().zip(pictures).map(|(kind, pictures)| BothPictures { pictures, kind });
        let wake = ctx.clone();
        let make = |pair: &BothPictures| Map::new(pair.kind, &pair.pictures);
        self.map.update(pair, BothPictures::same, make, move || wake.request_repaint());
    }

    fn update_figures(&mut self, ctx: &Context, live_render: &LiveRender) {
        let pictures =
            self.pictures(live_render).filter(|pictures| pictures[0].size == pictures[1].size);
        self.note(pictures.as_ref());
        // Before every pixel has a sample there is nothing to say, and trying would take time from
        // getting there.
        let pictures = pictures.filter(|sides| sides.iter().all(|picture| picture.complete));
        let same = |a: &[Arc<Picture>; 2], b: &[Arc<Picture>; 2]| {
            Arc::ptr_eq(&a[0], &b[0]) && Arc::ptr_eq(&a[1], &b[1])
        };
        let make = |[a, b]: &[Arc<Picture>; 2]| Comparison::of_pictures([a, b], None);
        let wake = ctx.clone();
        self.figures.update(pictures, same, make, move || wake.request_repaint());
    }

    /// Adds the noise of the pictures to the histories. A snapshot has no past: it is a point.
    fn note(&mut self, pictures: Option<&[Arc<Picture>; 2]>) {
        let main = self.main_side();
        match (std::mem::replace(&mut self.noted, main), main) {
            (then, now) if then == now => {}
            (Some(_), Some(_)) => self.histories.swap(0, 1),
            _ => self.histories = Default::default(),
        }
        let stored = self.stored.as_ref().map(|stored| stored.side);
        let sides = std::iter::zip([Side::A, Side::B], pictures.into_iter().flatten());
        for (history, (side, picture)) in self.histories.iter_mut().zip(sides) {
            if stored == Some(side) {
                *history = NoiseHistory::default();
            }
            if let Some(noise) = picture.stats.noise {
                history.follow(picture.stats.cpu_seconds, noise);
            }
        }
    }

    /// Brings the figures of a region in line with what is looked at, one picture or both.
    pub fn update_region_figures(
        &mut self,
        ctx: &Context,
        pictures: Vec<Arc<Picture>>,
        area: Option<Area>,
    ) {
        let task = area.map(|area| RegionTask { pictures, area });
        let wake = ctx.clone();
        self.region_figures
            .update(task, RegionTask::same, RegionFigures::of, move || wake.request_repaint());
    }

    /// The figures of the region, once they are known.
    pub fn region_figures(&self) -> Option<&RegionFigures> {
        self.region_figures.done().map(|(_, figures)| figures)
    }

    /// The figures of both sides, once both have a picture.
    pub fn comparison(&self) -> Option<&Comparison> {
        self.figures.done().map(|(_, comparison)| comparison)
    }

    /// Histories of the noise of A and of B.
    pub fn histories(&self) -> &[NoiseHistory; 2] {
        &self.histories
    }

    /// The pictures of A and B, once both have one.
    pub fn pictures(&self, live_render: &LiveRender) -> Option<[Arc<Picture>; 2]> {
        let main = live_render.picture()?.clone();
        let (other, main_is_a) = match &self.stored {
            Some(stored) => (stored.picture.clone()?, stored.side == Side::B),
            None => {
                let second_render = self.second_render.as_ref()?.picture()?.clone();
                (second_render, self.last.is_some_and(|compared| compared.main == Side::A))
            }
        };
        Some(if main_is_a { [main, other] } else { [other, main] })
    }

    /// The map of both that is shown, while one is.
    pub fn map(&self) -> Option<&Map> {
        let wanted = self.layout.map()?;
        let (pair, map) = self.map.done()?;
        map.as_ref().filter(|_| pair.kind == wanted)
    }

    /// The view of the `pictures` of both sides, `map` in their place if there is one.
    pub fn shown(
        &self,
        ctx: &Context,
        pictures: [Arc<Picture>; 2],
        (look, active): (Look, Side),
        map: Option<&Map>,
    ) -> Shown {
        if ctx.input(|input| input.key_down(FLIP_KEY)) && !ctx.text_edit_focused() {
            let [a, b] = pictures;
            let other = if active == Side::A { b } else { a };
            return Shown::One(other, look);
        }
        match (self.layout, map) {
            (CompareLayout::Wipe, _) => Shown::Wipe(pictures, look, self.divider),
            (CompareLayout::Beside, _) => Shown::Beside(pictures, look),
            (_, Some(map)) => Shown::One(map.picture.clone(), map.look),
            (_, None) => {
                let [_, b] = pictures;
                Shown::One(b, look)
            }
        }
    }
}
