//! Every command of the window: that it has an effect, and that its key is taken in whatever state
//! it comes.

use egui::ViewportCommand;
use egui_kittest::kittest::Queryable;
use flambeau::app::Command;
use flambeau::image::tone::Channel;

use super::*;

const PALETTE: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

/// What is compared, or looked at, while a command comes.
#[derive(Clone, Copy, Debug)]
enum State {
    Strategies,
    Snapshot,
    Rectangle,
}

impl Window {
    fn is_in(&self, state: State) -> bool {
        match state {
            State::Strategies => self.document().compared.is_some(),
            State::Snapshot => self.app().second_side().stored.is_some(),
            State::Rectangle => self.app().region().is_set(),
        }
    }

    /// Brings it about, where the last command ended it.
    fn bring_about(&mut self, state: State) {
        if self.is_in(state) {
            return;
        }
        self.close_what_is_open();
        match state {
            State::Strategies => self.press(Modifiers::NONE, Key::C),
            State::Snapshot => {
                self.press(Modifiers::NONE, Key::ArrowLeft);
                self.press(Modifiers::SHIFT, Key::A);
            }
            State::Rectangle => {
                self.press(Modifiers::NONE, Key::M);
                self.click(Role::Button, "Place it");
            }
        }
        assert!(self.is_in(state), "{state:?}");
    }

    /// Closes what a command may have opened in front.
    fn close_what_is_open(&mut self) {
        for _ in 0..3 {
            self.harness.key_press(Key::Escape);
            self.harness.step();
        }
        self.settle();
    }
}

/// The state that a command is meant for, on a finished picture with a snapshot of it.
#[derive(Clone, Copy, Debug)]
enum MeantFor {
    /// Nothing open or compared, nothing edited.
    Plain,
    /// An edit that can be undone.
    Edited,
    /// An edit that was undone.
    Undone,
    /// The picture zoomed to pixels.
    Zoomed,
    /// Text larger than normal.
    LargeText,
    /// Two strategies compared.
    Compared,
    /// A snapshot in place of the live picture.
    SnapshotShown,
    /// A snapshot just deleted.
    SnapshotDeleted,
    /// A region of the picture measured.
    Region,
    /// A reference measured against.
    Referenced,
}

/// A new command has to be listed here, in no group that fits by default.
fn meant_for(command: Command) -> MeantFor {
    match command {
        Command::Open
        | Command::OpenPath
        | Command::LoadEnvironment
        | Command::SaveExr
        | Command::SavePng
        | Command::SaveScene
        | Command::Quit
        | Command::PauseResume
        | Command::Restart
        | Command::Toggle(_)
        | Command::Play
        | Command::PreviousFrame
        | Command::NextFrame
        | Command::SaveFlipbook
        | Command::CameraKey
        | Command::NextSetup
        | Command::FrameVolume
        | Command::FocusByClick
        | Command::ZoomToPixels
        | Command::ExposureUp
        | Command::ExposureDown
        | Command::AutoExposure
        | Command::NextToneCurve
        | Command::FalseColor
        | Command::GoToPicture
        | Command::FoldPanels
        | Command::FullScreen
        | Command::Larger
        | Command::Smaller
        | Command::Palette
        | Command::Start
        | Command::Shortcuts
        | Command::Compare
        | Command::MeasureRegion
        | Command::LoadReference
        | Command::PictureAsReference
        | Command::Sweep
        | Command::KeepSnapshot
        | Command::PreviousSnapshot
        | Command::FoldStrip => MeantFor::Plain,
        Command::Undo => MeantFor::Edited,
        Command::Redo => MeantFor::Undone,
        Command::FitPicture => MeantFor::Zoomed,
        Command::NormalSize | Command::ResetWindow => MeantFor::LargeText,
        Command::SwitchSide
        | Command::SwapSides
        | Command::CopySide
        | Command::NextLayout
        | Command::SaveComparison => MeantFor::Compared,
        Command::CompareAsA
        | Command::CompareAsB
        | Command::NextSnapshot
        | Command::LivePicture
        | Command::ContinueSnapshot
        | Command::DeleteSnapshot => MeantFor::SnapshotShown,
        Command::UndoDelete => MeantFor::SnapshotDeleted,
        Command::RenderRegionOnly => MeantFor::Region,
        Command::RemoveReference => MeantFor::Referenced,
    }
}

/// What can be seen of a command's effect: everything on the screen by name, value and focus, the
/// size of text, the document, which render it is, and what the window asked of the desktop.
#[derive(Clone, Debug, PartialEq)]
struct Seen {
    screen: String,
    text_size: f32,
    document: Document,
    generation: Option<u64>,
    asked: Vec<ViewportCommand>,
}

impl Window {
    fn see(&self, asked: &[ViewportCommand]) -> Seen {
        let picture = self.app().live_render().picture();
        Seen {
            screen: format!("{:?}", self.harness.root()),
            text_size: self.harness.ctx.zoom_factor(),
            document: self.document().clone(),
            generation: picture.map(|picture| picture.generation),
            asked: asked.to_vec(),
        }
    }

    /// What is seen once nothing changes any more by itself.
    fn see_still(&mut self) -> Seen {
        let start = Instant::now();
        let mut before = self.see(&[]);
        loop {
            std::thread::sleep(Duration::from_millis(20));
            self.settle();
            let now = self.see(&[]);
            if now == before {
                return now;
            }
            assert!(start.elapsed() < PATIENCE, "the window never comes to rest");
            before = now;
        }
    }

    /// Presses a key for a frame, and gives what the window asked of the desktop in it.
    fn press_and_listen(&mut self, command: Command) -> Vec<ViewportCommand> {
        let shortcut = command.shortcut();
        let (key, modifiers) = (shortcut.logical_key, shortcut.modifiers);
        let event = |pressed| egui::Event::Key {
            key,
            pressed,
            modifiers,
            repeat: false,
            physical_key: None,
        };
        self.harness.event(egui::Event::ModifiersChanged(modifiers));
        self.harness.step();
        self.harness.event(event(true));
        self.harness.step();
        let output = &self.harness.output().viewport_output;
        let asked = output.values().flat_map(|viewport| viewport.commands.clone());
        let asked = asked.filter(|command| !matches!(command, ViewportCommand::Title(_)));
        let asked = asked.collect();
        self.harness.event(event(false));
        self.harness.step();
        self.harness.event(egui::Event::ModifiersChanged(Modifiers::NONE));
        self.harness.step();
        asked
    }

    /// Takes back whatever a command did.
    fn be_plain(&mut self) {
        if self.app().sweep().is_running() {
            self.click(Role::Button, "Cancel");
            self.until("the sweep has ended", |app| !app.sweep().is_running());
        }
        self.until("everything asked for has arrived", |app| {
            app.live_render().opening().is_none() && !app.reference().is_loading()
        });
        while self.has("Keeping…") {
            self.settle();
        }
        self.close_what_is_open();
        if self.app().live_render().paused() {
            self.press(Modifiers::NONE, Key::Space);
        }
        if self.app().reference().loaded().is_some() {
            self.press(PALETTE, Key::K);
        }
        while self.app().editor().undo_name().is_some() {
            self.press(Modifiers::COMMAND, Key::Z);
        }
        // A snapshot that is resumed goes on without a limit.
        if self.document().settings.film.spp == 0 {
            let scene = self.folder.path().join("scene.toml");
            self.press(Modifiers::COMMAND, Key::L);
            self.type_path(scene.to_str().unwrap());
            self.until("the scene is open", |app| app.editor().document.settings.film.spp > 0);
        }
        self.press(PALETTE, Key::Num0);
        while self.harness.query_all_by_label("Dismiss").next().is_some() {
            self.click(Role::Button, "Dismiss");
        }
        self.until_finished();
    }

    fn be_in(&mut self, state: MeantFor) {
        self.be_plain();
        match state {
            MeantFor::Plain => {}
            MeantFor::Edited => self.press(Modifiers::NONE, Key::Num3),
            MeantFor::Undone => {
                self.press(Modifiers::NONE, Key::Num3);
                self.press(Modifiers::COMMAND, Key::Z);
            }
            MeantFor::Zoomed => self.press(Modifiers::NONE, Key::Z),
            MeantFor::LargeText => self.press(Modifiers::COMMAND, Key::Plus),
            MeantFor::Compared => {
                self.press(Modifiers::NONE, Key::C);
                self.until_compared();
            }
            MeantFor::SnapshotShown => self.press(Modifiers::NONE, Key::ArrowLeft),
            MeantFor::SnapshotDeleted => {
                self.press(Modifiers::NONE, Key::ArrowLeft);
                self.press(Modifiers::NONE, Key::Delete);
                self.press(Modifiers::NONE, Key::Escape);
            }
            MeantFor::Region => {
                self.press(Modifiers::NONE, Key::M);
                self.click(Role::Button, "Place it");
            }
            MeantFor::Referenced => {
                self.press(Modifiers::COMMAND, Key::K);
                self.until("there is a reference", |app| app.reference().loaded().is_some());
            }
        }
    }
}

/// How long the effect of a command may take to show.
const PROMPTLY: Duration = Duration::from_secs(20);

#[test]
fn every_command_has_an_effect() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    window.keep("scene full");
    for command in Command::all() {
        window.be_in(meant_for(command));
        let before = window.see_still();
        let asked = window.press_and_listen(command);
        let start = Instant::now();
        while window.see(&asked) == before {
            assert!(start.elapsed() < PROMPTLY, "{command:?} changes nothing that can be seen");
            std::thread::sleep(Duration::from_millis(5));
            window.settle();
        }
    }
}

#[test]
fn the_palette_runs_what_it_finds() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.until_finished();
    for command in [Command::FalseColor, Command::Compare, Command::Shortcuts, Command::Palette] {
        window.press(PALETTE, Key::P);
        let field = window.harness.get_by_role_and_label(Role::TextInput, "Command");
        field.type_text(command.text());
        window.settle();
        window.press(Modifiers::NONE, Key::Enter);
        let field = window.harness.query_by_role_and_label(Role::TextInput, "Command");
        let opens_itself = command == Command::Palette;
        assert_eq!(field.is_some(), opens_itself, "{}", command.text());
    }
    assert_eq!(window.document().tone.channel, Channel::FalseColor);
    assert!(window.document().compared.is_some());
    assert!(window.has("Orbit around the target"));
}

#[test]
fn every_key_is_taken_while_strategies_and_snapshots_are_compared() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    window.keep("scene full");
    for state in [State::Strategies, State::Snapshot, State::Rectangle] {
        for command in Command::all() {
            // Right behind the command that deletes it.
            if command != Command::UndoDelete {
                window.bring_about(state);
            }
            let shortcut = command.shortcut();
            window.press(shortcut.modifiers, shortcut.logical_key);
            if window.harness.query_by_role_and_label(Role::TextInput, "Path").is_some() {
                window.close_what_is_open();
            }
            assert!(
                window.app().live_render().picture().is_some(),
                "{state:?}, {}",
                command.text()
            );
        }
    }
}
