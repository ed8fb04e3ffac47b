//! The state behind the window.

use std::path::PathBuf;
use std::time::Duration;

use egui::Context;

use super::changed_scene::ChangedScene;
use super::chrome::Chrome;
use super::file_requests::FileRequests;
use super::frame_stats::FrameStats;
use super::opened::Opened;
use super::pace::FramePace;
use super::preferences::{Preferences, data_folder};
use super::unsaved::UnsavedChanges;
use crate::app::compare::reference::MeasuredReference;
use crate::app::compare::second_side::SecondSide;
use crate::app::compare::state::CompareState;
use crate::app::diagnostics::Diagnostics;
use crate::app::document::Editor;
use crate::app::jobs::background::BackgroundPool;
use crate::app::jobs::dialogs::Dialogs;
use crate::app::jobs::file_watch::FileWatch;
use crate::app::jobs::live_render::LiveRender;
use crate::app::picture::display;
use crate::app::picture::gizmo::Gizmo;
use crate::app::picture::region::PictureRegion;
use crate::app::picture::viewport::Viewport;
use crate::app::snapshots::Snapshots;
use crate::app::sweep::Sweep;
use crate::app::time_line::TimeLine;
use crate::app::ui::notices::Notices;
use crate::app::ui::theme;
use crate::error::Result;
use crate::scene::DEFAULT_SCENE;

/// Options of the window.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The scene, volume or snapshot to open first; `None`: the embedded default scene.
    pub source: Option<String>,
    /// Threads that sample; `None`: as many as fit.
    pub threads: Option<usize>,
    /// Kind of the dialogs that ask for paths.
    pub dialogs: Dialogs,
    /// Whether each frame begins in the color of the panels, so that they need not be painted.
    pub cleared: bool,
    /// The shortest time from frame to frame, where drawing one takes the cores from the render.
    pub pace: Option<Duration>,
    /// The folder that keeps what outlasts a run; `None`: what the environment says
    /// (`FLAMBEAU_DATA`) or the system has for it.
    pub data: Option<PathBuf>,
}

/// Everything behind the window. An `App` needs a render state but no window, so tests can drive
/// it.
pub struct App {
    pub(super) editor: Editor,
    pub(super) live_render: LiveRender,
    pub(super) compare: CompareState,
    pub(super) sweep: Sweep,
    pub(super) time_line: TimeLine,
    pub(super) viewport: Viewport,
    pub(super) diagnostics: Diagnostics,
    pub(super) gizmo: Gizmo,
    pub(super) snapshots: Snapshots,
    pub(super) notices: Notices,
    pub(super) opened: Opened,
    pub(super) unsaved: UnsavedChanges,
    pub(super) changed_scene: ChangedScene,
    pub(super) files: FileRequests,
    pub(super) file_watch: FileWatch,
    pub(super) chrome: Chrome,
    pub(super) preferences: Preferences,
    /// The folder of what outlasts a run.
    pub(super) data_folder: Option<PathBuf>,
    pub(super) pace: FramePace,
    pub(super) stats: Option<FrameStats>,
    /// The widest and highest picture that the graphics card can show, in pixels.
    pub(super) largest: u32,
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
        let (wake, woken) = (ctx.clone(), ctx.clone());
        let mut live_render = LiveRender::new(options.threads, move || wake.request_repaint())?;
        let is_plain = options.source.is_none();
        let source = options.source.unwrap_or_else(|| DEFAULT_SCENE.to_owned());
        live_render.open(&source);
        let data_folder = data_folder(options.data);
        let preferences = data_folder.as_deref().map(Preferences::read).unwrap_or_default();
        let references = preferences.references.clone();
        let pool = BackgroundPool::new(options.threads)?;
        let mut editor = Editor::default();
        editor.document.tone = preferences.tone();
        preferences.scale().inspect(|&scale| ctx.set_zoom_factor(scale));
        Ok(Self {
            editor,
            live_render,
            compare: CompareState {
                second_side: SecondSide::new(options.threads, &pool),
                reference: MeasuredReference::new(&pool, references),
                region: PictureRegion::default(),
                versus: None,
            },
            sweep: Sweep::new(options.threads),
            time_line: TimeLine::default(),
            viewport: Viewport::default(),
            diagnostics: Diagnostics::new(&pool),
            gizmo: Gizmo::default(),
            snapshots: Snapshots::new(ctx, data_folder.clone())?,
            notices: Notices::default(),
            opened: Opened { source, notes: Vec::new() },
            unsaved: UnsavedChanges::default(),
            changed_scene: ChangedScene::default(),
            files: FileRequests::new(options.dialogs),
            file_watch: FileWatch::new(move || woken.request_repaint())?,
            chrome: Chrome::new(ctx, &preferences, is_plain, options.cleared),
            preferences,
            data_folder,
            pace: FramePace::new(options.pace),
            stats,
            largest: display::largest_size(state),
        })
    }

    /// The edited document and its record of edits.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// The render behind the picture.
    pub fn live_render(&self) -> &LiveRender {
        &self.live_render
    }

    /// Second side of the comparison.
    pub fn second_side(&self) -> &SecondSide {
        &self.compare.second_side
    }

    /// Region that the figures are of.
    pub fn region(&self) -> &PictureRegion {
        &self.compare.region
    }

    /// The reference and the errors against it.
    pub fn reference(&self) -> &MeasuredReference {
        &self.compare.reference
    }

    /// Sweep of all strategies on the shot.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// Frames of the scene, and the pictures kept of them.
    pub fn time_line(&self) -> &TimeLine {
        &self.time_line
    }

    /// The messages shown.
    pub fn notices(&self) -> &Notices {
        &self.notices
    }
}
