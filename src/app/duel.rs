//! Two strategies on one scene: the engine of the second one, the machine shared fairly between
//! both, and what is shown of them.

pub mod maps;

use std::sync::Arc;

use egui::{Context, Key};
use glam::UVec2;

use super::background::Background;
use super::display::Look;
use super::engine::{Engine, News};
use super::state::{Compared, Document, Side};
use super::viewport::Shown;
use crate::error::Result;
use crate::image::tone::Tone;
use crate::render::compare::{Comparison, NoiseHistory};
use crate::render::session::{Seat, Sharing};
use crate::render::{Picture, RenderStats};
use maps::{Difference, Map, MapKind, Noise};

/// The key that shows the other side while it is held.
pub const FLIP: Key = Key::H;

/// How A and B are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Layout {
    /// One over the other, with a divider.
    #[default]
    Wipe,
    /// Beside each other.
    Beside,
    /// How they differ.
    Difference(Difference),
    /// How noisy they are.
    Noise(Noise),
}

impl Layout {
    /// One of each kind.
    pub const ALL: [Self; 4] = [
        Self::Wipe,
        Self::Beside,
        Self::Difference(Difference::Signed),
        Self::Noise(Noise::Of(Side::A)),
    ];

    /// The next kind.
    pub fn next(self) -> Self {
        Self::ALL[(self.kind() + 1) % Self::ALL.len()]
    }

    /// Its place among the kinds.
    pub fn kind(self) -> usize {
        match self {
            Self::Wipe => 0,
            Self::Beside => 1,
            Self::Difference(_) => 2,
            Self::Noise(_) => 3,
        }
    }

    /// What is computed for it.
    fn map(self) -> Option<MapKind> {
        match self {
            Self::Wipe | Self::Beside => None,
            Self::Difference(difference) => Some(MapKind::Difference(difference)),
            Self::Noise(noise) => Some(MapKind::Noise(noise)),
        }
    }
}

/// The second side and what is shown of both.
pub struct Duel {
    rival: Option<Engine>,
    /// The comparison of the last frame.
    last: Option<Compared>,
    /// Of the two sessions while there are two.
    seats: [Seat; 2],
    threads: Option<usize>,
    /// How both are shown.
    pub layout: Layout,
    /// Where B begins, as a share of the picture area's width.
    pub divider: f32,
    map: Background<Pair, Option<Map>>,
    figures: Background<[Arc<Picture>; 2], Comparison>,
    /// How the noise of A and of B went down.
    histories: [NoiseHistory; 2],
}

/// Both pictures, and what is to be made of them.
#[derive(Clone)]
struct Pair {
    pictures: [Arc<Picture>; 2],
    kind: MapKind,
}

impl Pair {
    fn same(&self, other: &Self) -> bool {
        let same = |i: usize| Arc::ptr_eq(&self.pictures[i], &other.pictures[i]);
        self.kind == other.kind && same(0) && same(1)
    }
}

impl Duel {
    /// None yet; the second side will have `threads` workers.
    pub fn new(threads: Option<usize>) -> Self {
        Self {
            rival: None,
            last: None,
            seats: Sharing::seats(),
            threads,
            layout: Layout::default(),
            divider: 0.5,
            map: Background::default(),
            figures: Background::default(),
            histories: Default::default(),
        }
    }

    /// The engine of the side that the main one does not render, while there is one.
    pub fn rival(&self) -> Option<&Engine> {
        self.rival.as_ref()
    }

    /// The engine of the side that is edited, `main` being that of the main side.
    pub fn edited<'e>(&'e self, main: &'e Engine) -> &'e Engine {
        match (&self.rival, self.last) {
            (Some(rival), Some(last)) if last.active != last.main => rival,
            _ => main,
        }
    }

    /// Lets it wait for something else, or go on.
    pub fn set_held(&mut self, held: bool) {
        if let Some(rival) = &mut self.rival {
            rival.set_held(held);
        }
    }

    /// Throws its samples away.
    pub fn restart(&mut self) {
        if let Some(rival) = &mut self.rival {
            rival.restart();
        }
    }

    /// Takes in what its threads have done.
    pub fn poll(&mut self) -> Vec<News> {
        self.rival.as_mut().map_or_else(Vec::new, Engine::poll)
    }

    /// Brings the other side in line with the document on a film of `size`, and both sides' turns at
    /// the machine. Where a comparison has ended, the side that was edited goes on in `engine`.
    ///
    /// # Errors
    /// When the system refuses to start threads.
    pub fn update(
        &mut self,
        ctx: &Context,
        document: &Document,
        engine: &mut Engine,
        size: UVec2,
    ) -> Result<Vec<News>> {
        let mut news = Vec::new();
        let Some(compared) = document.compared else {
            self.end(document, engine);
            return Ok(news);
        };
        self.last = Some(compared);
        if self.rival.is_none() {
            if engine.built().is_none() {
                return Ok(news);
            }
            let wake = ctx.clone();
            let rival = engine.rival(self.threads, move || wake.request_repaint())?;
            rival.session().take_seat(Some(self.seats[1].clone()));
            engine.session().take_seat(Some(self.seats[0].clone()));
            self.rival = Some(rival);
        }
        self.seats[0].set_share(compared.share);
        engine.set_shows_variance(true);
        let settings = document.settings_of(compared.main.other());
        if let Some(rival) = &mut self.rival {
            rival.set_shows_variance(true);
            if rival.paused() != engine.paused() {
                rival.set_paused(engine.paused());
            }
            if let Some(wait) = rival.update(&settings, size, &mut news) {
                ctx.request_repaint_after(wait);
            }
        }
        self.update_map(ctx, engine);
        self.update_figures(ctx, engine);
        Ok(news)
    }

    /// Ends a comparison. Not where another scene was opened: that goes on where it was.
    fn end(&mut self, document: &Document, engine: &mut Engine) {
        let Some(mut rival) = self.rival.take() else { return };
        let edited = self.last.take().is_some_and(|last| last.active != last.main);
        if edited && rival.renders(&document.settings) {
            std::mem::swap(engine, &mut rival);
        }
        engine.session().take_seat(None);
        engine.set_shows_variance(false);
        self.map = Background::default();
        self.figures = Background::default();
        self.histories = Default::default();
    }

    fn update_map(&mut self, ctx: &Context, engine: &Engine) {
        let pictures = self.pictures(engine);
        let pair = self.layout.map().zip(pictures).map(|(kind, pictures)| Pair { pictures, kind });
        let wake = ctx.clone();
        let make = |pair: &Pair| Map::new(pair.kind, &pair.pictures);
        self.map.update(pair, Pair::same, make, move || wake.request_repaint());
    }

    fn update_figures(&mut self, ctx: &Context, engine: &Engine) {
        let pictures =
            self.pictures(engine).filter(|pictures| pictures[0].size == pictures[1].size);
        if let Some(pictures) = &pictures {
            for (history, picture) in self.histories.iter_mut().zip(pictures) {
                note(history, &picture.stats);
            }
        }
        let same = |a: &[Arc<Picture>; 2], b: &[Arc<Picture>; 2]| {
            Arc::ptr_eq(&a[0], &b[0]) && Arc::ptr_eq(&a[1], &b[1])
        };
        let make = |[a, b]: &[Arc<Picture>; 2]| Comparison::of_pictures([a, b], None);
        let wake = ctx.clone();
        self.figures.update(pictures, same, make, move || wake.request_repaint());
    }

    /// What is known of both sides, once both have a picture.
    pub fn comparison(&self) -> Option<&Comparison> {
        self.figures.done().map(|(_, comparison)| comparison)
    }

    /// How the noise of A and of B went down.
    pub fn histories(&self) -> &[NoiseHistory; 2] {
        &self.histories
    }

    /// The pictures of A and B, once both have one.
    pub fn pictures(&self, engine: &Engine) -> Option<[Arc<Picture>; 2]> {
        let (main, rival) = (engine.picture()?.clone(), self.rival.as_ref()?.picture()?.clone());
        let a_is_main = self.last.is_some_and(|compared| compared.main == Side::A);
        Some(if a_is_main { [main, rival] } else { [rival, main] })
    }

    /// The map that is shown, while one is.
    pub fn map(&self) -> Option<&Map> {
        let wanted = self.layout.map()?;
        let (pair, map) = self.map.done()?;
        map.as_ref().filter(|_| pair.kind == wanted)
    }

    /// What the viewport shows of both sides; `None` where there is only one.
    pub fn shown(&self, ctx: &Context, engine: &Engine, tone: Tone, active: Side) -> Option<Shown> {
        let pictures = self.pictures(engine)?;
        let look = Look::Picture(tone);
        if ctx.input(|input| input.key_down(FLIP)) && !ctx.text_edit_focused() {
            let [a, b] = pictures;
            let other = if active == Side::A { b } else { a };
            return Some(Shown::One(other, look));
        }
        Some(match (self.layout, self.map()) {
            (Layout::Wipe, _) => Shown::Wipe(pictures, look, self.divider),
            (Layout::Beside, _) => Shown::Beside(pictures, look),
            (_, Some(map)) => Shown::One(map.picture.clone(), map.look),
            (_, None) => {
                let [_, b] = pictures;
                Shown::One(b, look)
            }
        })
    }
}

/// Adds what a picture says to a history, which begins anew where the render did.
fn note(history: &mut NoiseHistory, stats: &RenderStats) {
    let seconds = stats.cpu_seconds;
    match history.points().last() {
        Some(last) if seconds < last[0] => *history = NoiseHistory::default(),
        Some(last) if seconds == last[0] => return,
        _ => {}
    }
    if let Some(noise) = stats.noise {
        history.push(seconds, noise);
    }
}
