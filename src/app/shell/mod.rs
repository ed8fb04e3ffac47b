//! The window: owns the state and runs a frame.

pub mod bars;
mod compare;
pub mod data;
mod execute;
pub mod export;
pub mod frame_stats;
pub mod help;
mod layout;
mod measures;
pub mod menu;
pub mod palette;
mod paths;
pub mod preferences;
pub mod save;
mod snapshots;
pub mod start;
pub mod status;
mod sweep;
mod unsaved;
pub mod unsaved_bar;
mod view;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{Context, Ui};
use glam::{UVec2, Vec3A};

use super::command::Command;

use super::compare::reference::MeasuredReference;
use super::compare::second_side::SecondSide;
use super::diagnostics::Diagnostics;
use super::document::{Compared, Editor, Side};
use super::jobs::dialogs::{Dialog, DialogAnswer, Dialogs, Purpose};
use super::jobs::live_render::{LiveRender, News};
use super::picture::display;
use super::picture::gizmo::Gizmo;
use super::picture::region::PictureRegion;
use super::picture::viewport::Viewport;
use super::snapshots::Snapshots;
use super::sweep::Sweep;
use super::ui::notices::{Level, Notice, Notices};
use super::ui::sections::Sections;
use super::ui::theme;
use crate::error::Result;
use crate::math::Aabb;
use crate::scene::{DEFAULT_SCENE, Note};
use bars::PathBar;
use frame_stats::FrameStats;
use palette::Palette;
use preferences::{Preferences, full_name};
use save::Saver;
use start::StartRow;

/// How the window is set up.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The scene, volume or snapshot to open first; `None`: the embedded default scene.
    pub source: Option<String>,
    /// Threads that sample; `None`: as many as fit.
    pub threads: Option<usize>,
    /// How paths are asked for.
    pub dialogs: Dialogs,
    /// Whether each frame begins in the color of the panels, so that they need not be painted.
    pub cleared: bool,
    /// The shortest time from frame to frame, where drawing one takes the cores from the render.
    pub pace: Option<Duration>,
    /// The folder that keeps what outlasts a run; `None`: what the environment says (`FLAMBEAU_DATA`)
    /// or the system has for it.
    pub data: Option<PathBuf>,
}

/// Everything behind the window. It needs a render state but no window, so tests can drive it.
pub struct App {
    editor: Editor,
    engine: LiveRender,
    second_side: SecondSide,
    sweep: Sweep,
    viewport: Viewport,
    diagnostics: Diagnostics,
    gizmo: Gizmo,
    notices: Notices,
    saver: Saver,
    dialogs: Dialogs,
    cleared: bool,
    pace: Option<Duration>,
    /// When the last frame began.
    last_frame: Option<Instant>,
    dialog: Option<Dialog>,
    path_bar: Option<PathBar>,
    /// What is to be saved once the scene is built.
    waiting: Vec<(Purpose, PathBuf)>,
    /// What is open, as the user named it.
    source: String,
    /// What was guessed when it was opened.
    notes: Vec<Note>,
    folded: bool,
    sections: Sections,
    /// Whether the picture has the whole screen.
    full_screen: bool,
    help: bool,
    /// What to begin with, while it is shown.
    start: Option<StartRow>,
    /// The list of all commands, while it is open.
    palette: Option<Palette>,
    /// The folder of what outlasts a run.
    data: Option<PathBuf>,
    preferences: Preferences,
    unsaved: unsaved::UnsavedChanges,
    largest: u32,
    stats: Option<FrameStats>,
    snapshots: Snapshots,
    /// The snapshot that a path is being asked for, where one was shown.
    subject: Option<String>,
    region: PictureRegion,
    reference: MeasuredReference,
    /// The side of the snapshot shown, while that is compared with the live picture.
    versus: Option<Side>,
    /// A dropped picture, until it is said what it is for.
    dropped: Option<PathBuf>,
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
        let mut engine = LiveRender::new(options.threads, move || wake.request_repaint())?;
        let is_plain = options.source.is_none();
        let source = options.source.unwrap_or_else(|| DEFAULT_SCENE.to_owned());
        engine.open(&source);
        let data = data::folder(options.data);
        let preferences = data.as_deref().map(Preferences::read).unwrap_or_default();
        let references = preferences.references.clone();
        let mut editor = Editor::default();
        editor.document.tone = preferences.tone();
        preferences.scale().inspect(|&scale| ctx.set_zoom_factor(scale));
        Ok(Self {
            editor,
            engine,
            second_side: SecondSide::new(options.threads),
            sweep: Sweep::new(options.threads),
            viewport: Viewport::default(),
            diagnostics: Diagnostics::default(),
            gizmo: Gizmo::default(),
            notices: Notices::default(),
            saver: Saver::default(),
            dialogs: options.dialogs,
            cleared: options.cleared,
            pace: options.pace,
            last_frame: None,
            dialog: None,
            path_bar: None,
            waiting: Vec::new(),
            source,
            notes: Vec::new(),
            folded: preferences.folded,
            sections: Sections::install(ctx, preferences.sections.clone()),
            full_screen: false,
            help: false,
            start: (is_plain && preferences.start).then(StartRow::default),
            palette: None,
            largest: display::largest_size(state),
            stats,
            snapshots: Snapshots::new(ctx, data.clone())?,
            data,
            preferences,
            unsaved: unsaved::UnsavedChanges::default(),
            subject: None,
            region: PictureRegion::default(),
            reference: MeasuredReference::new(options.threads, references)?,
            versus: None,
            dropped: None,
        })
    }

    /// The edited document and its record of edits.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// The render behind the picture.
    pub fn engine(&self) -> &LiveRender {
        &self.engine
    }

    /// The other side of a comparison.
    pub fn second_side(&self) -> &SecondSide {
        &self.second_side
    }

    /// The rectangle that figures are told of.
    pub fn region(&self) -> &PictureRegion {
        &self.region
    }

    /// The reference and the errors against it.
    pub fn reference(&self) -> &MeasuredReference {
        &self.reference
    }

    /// Every strategy tried on the shot.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// The messages shown.
    pub fn notices(&self) -> &Notices {
        &self.notices
    }

    /// Runs one frame in `ui`, which spans the window.
    pub fn frame(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.keep_pace();
        if let Some(stats) = &mut self.stats {
            stats.frame();
        }
        let mut news = self.engine.poll();
        news.extend(self.second_side.poll());
        self.take_in(&ctx, news);
        self.take_in_arrivals(&ctx);
        self.save_waiting(&ctx);
        self.update_snapshots(&ctx);
        self.editor.begin_frame(&ctx);
        let mut commands = Command::pressed(&ctx);
        if self.path_bar.is_some() || self.dropped.is_some() || self.palette.is_some() {
            // The key closes what is open in front.
            commands.retain(|command| *command != Command::LivePicture);
        }
        self.layout(ui, &mut commands);
        self.sections.settle();
        for command in commands {
            self.execute(&ctx, command);
        }
        if self.editor.end_frame()
            && let Some(stats) = &mut self.stats
        {
            stats.edited();
        }
        self.bring_up_to_date(&ctx);
        self.watch_over_changes(&ctx);
        self.preferences.scale = ctx.zoom_factor();
    }

    /// Waits until the next frame may begin, before it takes in what there is.
    fn keep_pace(&mut self) {
        if let (Some(pace), Some(last)) = (self.pace, self.last_frame) {
            std::thread::sleep(pace.saturating_sub(last.elapsed()));
        }
        self.last_frame = Some(Instant::now());
    }

    /// Finishes what is being saved and writes the diagnostic figures, if they were asked for.
    pub fn close(&mut self) {
        self.saver.finish();
        self.snapshots.close();
        // Nobody is there any more to be told.
        let _ = self.write_remembered();
        if let Some(stats) = &self.stats {
            stats.write();
        }
    }

    fn take_in(&mut self, ctx: &Context, news: Vec<News>) {
        for item in news {
            match item {
                News::Opened { source, settings, notes, reopened } => {
                    self.notes = notes;
                    self.unsaved.opened(&source, &settings);
                    self.gizmo = Gizmo::default();
                    self.editor.open(*settings, reopened.is_some());
                    self.viewport.zoom = Default::default();
                    self.sweep.forget();
                    self.notices = Notices::default();
                    self.remember_file(&source);
                    self.source = self.name_of(source);
                    self.versus = None;
                    self.region.remove();
                    if let Err(error) = self.reference.open(ctx, &full_name(&self.source)) {
                        self.notices.failed(error.to_string());
                    }
                    if let Some(Notice { level, text }) = reopened {
                        let text = format!("{}: {text}", self.title());
                        self.notices.push(Notice { level, text });
                    }
                }
                News::Failed(text) => self.notices.failed(text),
                News::Refused(text) => self.notices.refused(text),
                News::Accepted => self.notices.clear(Level::Refused),
                News::Started(generation) => self.note_start(generation),
            }
        }
    }

    /// Takes in what other threads and the desktop have brought since the last frame.
    fn take_in_arrivals(&mut self, ctx: &Context) {
        if let (Some(stats), Some(picture)) = (&mut self.stats, self.engine.picture()) {
            stats.shown(picture.generation);
        }
        for (path, result) in self.saver.poll() {
            self.unsaved.written(&path, result.is_ok());
            match result {
                Ok(()) => self.notices.done(format!("Saved {}", path.display())),
                Err(error) => self.notices.failed(error.to_string()),
            }
        }
        if let Some(answer) = self.dialog.as_ref().and_then(Dialog::poll) {
            self.dialog = None;
            match answer {
                DialogAnswer::Chosen(purpose, path) => self.take_path(ctx, purpose, path),
                DialogAnswer::Unavailable(purpose) => self.ask_typed(purpose),
                DialogAnswer::Cancelled => {}
            }
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.last().cloned());
        if let Some(file) = dropped {
            self.take_dropped(ctx, file.path());
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

    fn bring_up_to_date(&mut self, ctx: &Context) {
        self.diagnostics.update(ctx, &mut self.engine);
        self.second_side.set_layer(self.diagnostics.wanted.layer);
        self.update_versus();
        let Some(size) = self.film_size() else { return };
        let alone = self.region.alone(size);
        self.engine.focus(alone);
        self.second_side.focus(alone);
        let mut news = Vec::new();
        let document = &self.editor.document;
        match self.second_side.update(ctx, document, &mut self.engine, size) {
            Ok(more) => news.extend(more),
            Err(error) => {
                self.notices.failed(error.to_string());
                self.editor.document.compared = None;
            }
        }
        let document = &self.editor.document;
        let wait = match document.compared {
            None => self.engine.update(&document.settings, size, &mut news),
            Some(Compared { main, .. }) => {
                self.engine.update(&document.settings_of(main), size, &mut news)
            }
        };
        if let Some(wait) = wait {
            ctx.request_repaint_after(wait.max(Duration::from_millis(1)));
        }
        self.take_in(ctx, news);
        self.update_measures(ctx);
        self.update_sweep(ctx);
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

    /// The box around all that fills space, or around the camera's target where nothing does.
    fn subject_bounds(&self) -> Aabb {
        let camera = &self.editor.document.settings.camera;
        let target = Vec3A::from(camera.target);
        let around = Vec3A::splat(0.25 * target.distance(camera.position.into()).max(1e-3));
        let filled = self.engine.built().and_then(|built| built.scene.world.finite_bounds());
        filled.unwrap_or_else(|| Aabb::new(target - around, target + around))
    }

    fn note_start(&mut self, generation: u64) {
        if let Some(stats) = &mut self.stats {
            stats.started(generation);
        }
        // Whoever asks for another picture wants to see it; beside a snapshot it is seen already.
        if self.versus.is_none() {
            self.snapshots.strip.show(None);
        }
    }
}
