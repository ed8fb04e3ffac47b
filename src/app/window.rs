//! The window: owns the state, runs a frame, carries out commands.

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::{Context, Frame, Margin, ScrollArea, Ui};
use glam::UVec2;

use super::commands::Command;
use super::display;
use super::engine::{Engine, News};
use super::files::{Answer, Dialog, Dialogs, Purpose, typed};
use super::frame_stats::FrameStats;
use super::notices::{Level, Notices};
use super::panels::bars::{self, PathBar, Typed};
use super::panels::{self, Panel};
use super::saver::{Content, Saver};
use super::state::Editor;
use super::theme::{self, color, space};
use super::viewport::Viewport;
use crate::error::Result;
use crate::image::tone::ToneCurve;
use crate::scene::{self, DEFAULT_SCENE};

/// How the window is set up.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The scene or volume to open first; `None`: the embedded default scene.
    pub source: Option<String>,
    /// Threads that sample; `None`: as many as fit.
    pub threads: Option<usize>,
    /// How paths are asked for.
    pub dialogs: Dialogs,
}

/// Everything behind the window. It needs a render state but no window, so tests can drive it.
pub struct App {
    editor: Editor,
    engine: Engine,
    viewport: Viewport,
    notices: Notices,
    saver: Saver,
    dialogs: Dialogs,
    dialog: Option<Dialog>,
    path_bar: Option<PathBar>,
    /// What is open, as the user named it.
    source: String,
    /// What was guessed when it was opened.
    notes: Vec<String>,
    folded: bool,
    help: bool,
    largest: u32,
    stats: Option<FrameStats>,
}

impl App {
    /// Sets up the theme, the graphics card and the threads, and starts to open the first scene.
    ///
    /// # Errors
    /// When the system refuses to start threads.
    pub fn new(ctx: &Context, state: &egui_wgpu::RenderState, options: Options) -> Result<Self> {
        let stats = FrameStats::from_env();
        theme::apply(ctx);
        display::install(state);
        let wake = ctx.clone();
        let mut engine = Engine::new(options.threads, move || wake.request_repaint())?;
        let source = options.source.unwrap_or_else(|| DEFAULT_SCENE.to_owned());
        engine.open(&source);
        Ok(Self {
            editor: Editor::default(),
            engine,
            viewport: Viewport::default(),
            notices: Notices::default(),
            saver: Saver::default(),
            dialogs: options.dialogs,
            dialog: None,
            path_bar: None,
            source,
            notes: Vec::new(),
            folded: false,
            help: false,
            largest: display::largest_size(state),
            stats,
        })
    }

    /// The edited document and its record of edits.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// The render behind the picture.
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// The messages shown.
    pub fn notices(&self) -> &Notices {
        &self.notices
    }

    /// Runs one frame in `ui`, which spans the window.
    pub fn frame(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        if let Some(stats) = &mut self.stats {
            stats.frame();
        }
        let mut news = self.engine.poll();
        self.take_in(&ctx, &mut news);
        self.editor.begin_frame(&ctx);
        let mut commands = Command::pressed(&ctx);
        self.layout(ui, &mut commands);
        for command in commands {
            self.execute(&ctx, command);
        }
        if self.editor.end_frame()
            && let Some(stats) = &mut self.stats
        {
            stats.edited();
        }
        self.bring_up_to_date(&ctx);
    }

    /// Finishes what is being saved and writes the diagnostic figures, if they were asked for.
    pub fn close(&mut self) {
        self.saver.finish();
        if let Some(stats) = &self.stats {
            stats.write();
        }
    }

    fn take_in(&mut self, ctx: &Context, news: &mut Vec<News>) {
        for item in news.drain(..) {
            match item {
                News::Opened { source, settings, notes } => {
                    self.notes = notes;
                    self.editor.open(settings);
                    self.viewport.zoom = Default::default();
                    self.notices.clear(Level::Failed);
                    self.source = source;
                    let title = format!("{} – Flambeau", self.title());
                    ctx.send_viewport_cmd(egui::ViewportCommand::Title(title));
                }
                News::Failed(text) => self.notices.failed(text),
                News::Started(generation) => {
                    if let Some(stats) = &mut self.stats {
                        stats.started(generation);
                    }
                }
            }
        }
        if let (Some(stats), Some(picture)) = (&mut self.stats, self.engine.picture()) {
            stats.shown(picture.generation);
        }
        for (path, result) in self.saver.poll() {
            match result {
                Ok(()) => self.notices.done(format!("Saved {}", path.display())),
                Err(error) => self.notices.failed(error.to_string()),
            }
        }
        if let Some(answer) = self.dialog.as_ref().and_then(Dialog::poll) {
            self.dialog = None;
            match answer {
                Answer::Chosen(purpose, path) => self.take_path(ctx, purpose, path),
                Answer::Unavailable(purpose) => self.ask_typed(purpose),
                Answer::Cancelled => {}
            }
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.last().cloned());
        if let Some(file) = dropped {
            self.open(&file.path().to_string_lossy());
        }
    }

    /// A short name of what is open.
    fn title(&self) -> String {
        match self.source.strip_prefix("builtin:") {
            Some(name) => name.to_owned(),
            None => Path::new(&self.source)
                .file_name()
                .map_or_else(|| self.source.clone(), |name| name.to_string_lossy().into_owned()),
        }
    }

    fn layout(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let title = self.title();
        let grids = self.engine.grids().clone();
        let mut panel =
            Panel { editor: &mut self.editor, grids: &grids, notes: &self.notes, commands };
        let bar = Frame::new().fill(color::PANEL).inner_margin(Margin::symmetric(8, 3));
        egui::Panel::top("menu").frame(bar).show(ui, |ui| {
            panels::menu::show(ui, &mut panel, &title);
        });
        let bar = Frame::new().fill(color::PANEL).inner_margin(Margin::symmetric(8, 0));
        egui::Panel::bottom("status").exact_size(space::STATUS).frame(bar).show(ui, |ui| {
            panels::status::show(ui, &mut panel, &self.engine, &self.viewport);
        });
        if !self.folded {
            let film = self.viewport.film_size();
            column(ui, &mut panel, film, self.largest);
        }
        egui::CentralPanel::no_frame().show(ui, |ui| self.picture_area(ui));
        panels::help::show(ui.ctx(), &mut self.help);
    }

    /// The picture with the bars that come and go at its edges. The film takes the whole area, so
    /// that a bar never restarts the render.
    fn picture_area(&mut self, ui: &mut Ui) {
        let area = ui.available_size() * ui.pixels_per_point();
        let area = UVec2::new(area.x.round() as u32, area.y.round() as u32);
        if let Some(wait) = self.viewport.resize(area, self.largest) {
            ui.ctx().request_repaint_after(wait);
        }
        self.path_bar_row(ui);
        self.progress_row(ui);
        if !self.notices.list().is_empty() {
            egui::Panel::bottom("notices")
                .frame(theme::panel_frame())
                .show(ui, |ui| self.notices.show(ui));
        }
        let picture = self.engine.picture().cloned();
        egui::CentralPanel::no_frame().show(ui, |ui| {
            self.viewport.show(ui, &mut self.editor, picture.as_ref());
        });
    }

    fn path_bar_row(&mut self, ui: &mut Ui) {
        let Some(bar) = &mut self.path_bar else { return };
        let purpose = bar.purpose;
        let frame = theme::panel_frame();
        let typing = egui::Panel::top("path").frame(frame).show(ui, |ui| bar.show(ui)).inner;
        match typing {
            Typed::Pending => {}
            Typed::Cancelled => self.path_bar = None,
            Typed::Done(text) => {
                self.path_bar = None;
                self.take_path(ui.ctx(), purpose, PathBuf::from(typed(&text)));
            }
        }
    }

    fn progress_row(&mut self, ui: &mut Ui) {
        let Some(fraction) = self.engine.progress() else { return };
        let what = match self.engine.opening() {
            Some(source) => format!("Loading {source}"),
            None => "Building the scene".to_owned(),
        };
        let frame = theme::panel_frame();
        let row = egui::Panel::bottom("progress").frame(frame);
        if row.show(ui, |ui| bars::progress(ui, &what, fraction)).inner {
            self.engine.cancel();
        }
    }

    fn bring_up_to_date(&mut self, ctx: &Context) {
        let Some(size) = self.film_size() else { return };
        let mut news = Vec::new();
        if let Some(wait) = self.engine.update(&self.editor.document, size, &mut news) {
            ctx.request_repaint_after(wait.max(Duration::from_millis(1)));
        }
        self.take_in_started(&news);
    }

    /// The size of the film: its own or the window's; `None` before the first frame.
    fn film_size(&self) -> Option<UVec2> {
        let document = &self.editor.document;
        if document.keep_size {
            let size = UVec2::from(document.settings.film.size);
            return Some(size.clamp(UVec2::ONE, UVec2::splat(self.largest)));
        }
        self.viewport.film_size()
    }

    fn take_in_started(&mut self, news: &[News]) {
        let Some(stats) = &mut self.stats else { return };
        for item in news {
            if let News::Started(generation) = item {
                stats.started(*generation);
            }
        }
    }

    fn open(&mut self, source: &str) {
        self.path_bar = None;
        self.engine.open(source);
    }

    fn take_path(&mut self, ctx: &Context, purpose: Purpose, path: PathBuf) {
        if purpose == Purpose::Open {
            self.open(&path.to_string_lossy());
            return;
        }
        let Some(content) = self.content(purpose) else {
            self.notices.failed("There is no picture to save yet.");
            return;
        };
        let wake = ctx.clone();
        let path = purpose.complete(path);
        if let Err(error) = self.saver.start(path, content, move || wake.request_repaint()) {
            self.notices.failed(error.to_string());
        }
    }

    /// What saving writes at this moment; `None` where there is nothing yet.
    fn content(&self, purpose: Purpose) -> Option<Content> {
        let document = &self.editor.document;
        let settings = self.engine.rendered()?;
        match purpose {
            Purpose::Open => None,
            Purpose::SaveExr => Some(Content::Exr {
                film: self.engine.session().snapshot(),
                settings: settings.clone(),
                seconds: self.engine.picture().map_or(0.0, |picture| picture.stats.seconds),
            }),
            Purpose::SavePng => {
                Some(Content::Png { film: self.engine.session().snapshot(), tone: document.tone })
            }
            Purpose::SaveScene => {
                // A film of the window's size is written as that size, so the picture is the same.
                let mut saved = document.settings.clone();
                saved.film.size = settings.film.size;
                Some(Content::Scene(saved))
            }
        }
    }

    /// Asks for a path in the way that the options say.
    fn ask(&mut self, ctx: &Context, purpose: Purpose) {
        if self.dialogs == Dialogs::Typed {
            self.ask_typed(purpose);
        } else if self.dialog.is_none() {
            let wake = ctx.clone();
            match Dialog::open(purpose, &self.suggested(purpose), move || wake.request_repaint()) {
                Ok(dialog) => self.dialog = Some(dialog),
                Err(_) => self.ask_typed(purpose),
            }
        }
    }

    fn ask_typed(&mut self, purpose: Purpose) {
        let text = match purpose {
            Purpose::Open => String::new(),
            _ => self.suggested(purpose).to_string_lossy().into_owned(),
        };
        self.path_bar = Some(PathBar::new(purpose, text));
    }

    /// A file beside what is open, or in the present folder.
    fn suggested(&self, purpose: Purpose) -> PathBuf {
        let here = std::env::current_dir().unwrap_or_default();
        let name = Path::new(&self.title()).with_extension(purpose.extension().unwrap_or_default());
        let folder = Path::new(&self.source).parent().filter(|folder| folder.is_dir());
        folder.map_or_else(|| here.clone(), |folder| here.join(folder)).join(name)
    }

    fn execute(&mut self, ctx: &Context, command: Command) {
        match command {
            Command::Open => self.ask(ctx, Purpose::Open),
            Command::OpenPath => self.ask_typed(Purpose::Open),
            Command::SaveExr => self.ask(ctx, Purpose::SaveExr),
            Command::SavePng => self.ask(ctx, Purpose::SavePng),
            Command::SaveScene => self.ask(ctx, Purpose::SaveScene),
            Command::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
            Command::Undo => self.editor.undo(),
            Command::Redo => self.editor.redo(),
            Command::PauseResume => self.engine.set_paused(!self.engine.paused()),
            Command::Restart => self.engine.restart(),
            Command::FrameVolume => self.frame_volume(),
            Command::FitPicture => self.viewport.zoom = Default::default(),
            Command::ZoomToPixels => {
                let size = self.engine.picture().map(|picture| picture.size);
                self.viewport.toggle_pixel_zoom(size);
            }
            Command::FoldPanels => self.folded = !self.folded,
            Command::Shortcuts => self.help = !self.help,
            _ => self.edit(command),
        }
        ctx.request_repaint();
    }

    /// Commands that change the document.
    fn edit(&mut self, command: Command) {
        let document = &mut self.editor.document;
        let name = match command {
            Command::ExposureUp => {
                document.tone.exposure += 0.5;
                "exposure"
            }
            Command::ExposureDown => {
                document.tone.exposure -= 0.5;
                "exposure"
            }
            Command::NextToneCurve => {
                document.tone.curve = match document.tone.curve {
                    ToneCurve::Linear => ToneCurve::Filmic,
                    ToneCurve::Filmic => ToneCurve::Linear,
                };
                "tone curve"
            }
            other => {
                let Some(toggle) = panels::strategy::toggle_of(other) else { return };
                let switch = panels::strategy::switch(&mut document.settings.strategy, toggle);
                *switch = !*switch;
                other.text()
            }
        };
        self.editor.name_edit(name);
    }

    /// Moves the camera so that everything finite that fills space is in the picture.
    fn frame_volume(&mut self) {
        let Some(built) = self.engine.built() else { return };
        let bounds = built.scene.world.instances().iter().map(|instance| *instance.bounds());
        let bounds = bounds.filter(|bounds| bounds.size().is_finite());
        let Some(bounds) = bounds.reduce(|all, bounds| all.union(&bounds)) else { return };
        let size = self.film_size().unwrap_or(UVec2::ONE).as_vec2();
        let camera = &mut self.editor.document.settings.camera;
        *camera = scene::frame(camera, &bounds, size.x / size.y);
        self.editor.name_edit("frame the volume");
    }
}

/// The column of panels.
fn column(ui: &mut Ui, panel: &mut Panel<'_>, film: Option<UVec2>, largest: u32) {
    let frame = Frame::new().fill(color::PANEL);
    egui::Panel::right("column").exact_size(space::COLUMN).frame(frame).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let inner = Frame::new().inner_margin(Margin::same(space::PANEL));
            inner.show(ui, |ui| {
                panels::strategy::show(ui, panel);
                panels::volume::show(ui, panel);
                panels::camera::show(ui, panel);
                panels::film::show(ui, panel, film, largest);
            });
        });
    });
}
