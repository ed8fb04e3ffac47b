//! Every command of the window: its text, its tooltip and its shortcut. Menus, buttons, keys, the
//! palette and the help page all read them here.

mod pressed;

use egui::{Key, KeyboardShortcut, Modifiers};
use strum::{EnumIter, IntoEnumIterator};

use crate::transport::toggle::Toggle;

/// Something that the user can ask for without a value. The help page lists them in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, EnumIter)]
#[allow(missing_docs, reason = "the text and the tooltip of `spec` say what each is")]
pub enum Command {
    Open,
    OpenPath,
    LoadEnvironment,
    SaveExr,
    SavePng,
    SaveScene,
    Quit,
    Undo,
    Redo,
    PauseResume,
    Restart,
    /// Switch a sampling strategy on or off.
    Toggle(Toggle),
    Play,
    PreviousFrame,
    NextFrame,
    SaveFlipbook,
    CameraKey,
    NextSetup,
    FrameVolume,
    FocusByClick,
    FitPicture,
    ZoomToPixels,
    ExposureUp,
    ExposureDown,
    AutoExposure,
    NextToneCurve,
    FalseColor,
    GoToPicture,
    FoldPanels,
    FullScreen,
    Larger,
    Smaller,
    NormalSize,
    ResetWindow,
    Palette,
    Start,
    Shortcuts,
    Compare,
    SwitchSide,
    SwapSides,
    CopySide,
    NextLayout,
    CompareAsA,
    CompareAsB,
    SaveComparison,
    MeasureRegion,
    RenderRegionOnly,
    LoadReference,
    PictureAsReference,
    RemoveReference,
    Sweep,
    KeepSnapshot,
    PreviousSnapshot,
    NextSnapshot,
    LivePicture,
    ContinueSnapshot,
    DeleteSnapshot,
    UndoDelete,
    FoldStrip,
}

use Command as C;

/// Text, tooltip and shortcut of a command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spec {
    /// The name in menus, the palette and the help page.
    pub text: &'static str,
    /// A sentence or two about the effect.
    pub tooltip: &'static str,
    /// The key, which no other command has.
    pub shortcut: KeyboardShortcut,
}

/// Ctrl, or Cmd on a Mac.
const CTRL: Modifiers = Modifiers::COMMAND;
const SHIFT: Modifiers = Modifiers::SHIFT;
const PLAIN: Modifiers = Modifiers::NONE;
const CTRL_SHIFT: Modifiers = Modifiers { shift: true, ..CTRL };
const CTRL_ALT: Modifiers = Modifiers { alt: true, ..CTRL };

impl Command {
    /// All commands, the toggles one by one, in the order of the help page.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::iter().flat_map(|command| match command {
            Self::Toggle(_) => Toggle::all().map(Self::Toggle).collect(),
            other => vec![other],
        })
    }

    /// The name in menus, the palette and the help page.
    pub fn text(self) -> &'static str {
        self.spec().text
    }

    /// A sentence or two about the effect.
    pub fn tooltip(self) -> &'static str {
        self.spec().tooltip
    }

    /// Key of the command.
    pub fn shortcut(self) -> KeyboardShortcut {
        self.spec().shortcut
    }

    /// Text, tooltip and shortcut.
    #[allow(clippy::too_many_lines, reason = "a table with one row for each command")]
    pub fn spec(self) -> Spec {
        let (modifiers, key, text, tooltip) = match self {
            C::Open => (
                CTRL,
                Key::O,
                "Open…",
                "Open a scene (.toml) or a volume (.vdb, .nvdb), or resume a snapshot (.exr). A \
                 file of a numbered set opens the sequence. Files and folders can also be dropped \
                 on the window.",
            ),
            C::OpenPath => (
                CTRL,
                Key::L,
                "Open path…",
                "Type the path of a scene, a volume or a snapshot, or builtin:NAME for a scene \
                 that comes with Flambeau.",
            ),
            C::LoadEnvironment => (
                CTRL_ALT,
                Key::O,
                "Load environment…",
                "Light the scene by a picture of everything around (.hdr or .exr). It can also be \
                 dropped on the window.",
            ),
            C::SaveExr => (
                CTRL,
                Key::S,
                "Save EXR…",
                "Save the current picture, linear and with its layers, as an EXR that can be \
                 resumed.",
            ),
            C::SavePng => (
                CTRL_SHIFT,
                Key::S,
                "Save PNG…",
                "Save the picture as displayed, with exposure, white balance and tone curve, as a \
                 PNG.",
            ),
            C::SaveScene => (
                CTRL_ALT,
                Key::S,
                "Save scene as…",
                "Save all settings as a scene file that renders the same picture.",
            ),
            C::Quit => (CTRL, Key::Q, "Quit", "Close the window."),
            C::Undo => (CTRL, Key::Z, "Undo", "Undo the last edit."),
            C::Redo => (CTRL_SHIFT, Key::Z, "Redo", "Redo the edit that was undone last."),
            C::PauseResume => (
                PLAIN,
                Key::Space,
                "Pause or resume",
                "Stop sampling and keep the picture, or continue where it stopped.",
            ),
            C::Restart => {
                (PLAIN, Key::R, "Restart", "Discard all samples and render from the start.")
            }
            C::Toggle(toggle) => (
                PLAIN,
                key_of(toggle),
                toggle.name(),
                "Switch this strategy on or off. The picture converges to the same result; noise \
                 and render time change.",
            ),
            C::Play => (
                PLAIN,
                Key::P,
                "Play or stop",
                "Play the frames of a sequence. Those without a picture are rendered first, to the \
                 samples of the flipbook.",
            ),
            C::PreviousFrame => {
                (PLAIN, Key::Comma, "Previous frame", "Go back one frame of a sequence.")
            }
            C::SaveFlipbook => (
                CTRL_ALT,
                Key::P,
                "Save flipbook…",
                "Save the frames of the flipbook, each to a file with its number: PNGs as displayed, \
                 or EXRs with linear light.",
            ),
            C::NextFrame => (PLAIN, Key::Period, "Next frame", "Go on one frame of a sequence."),
            C::FrameVolume => (
                PLAIN,
                Key::F,
                "Frame the volumes",
                "Move the camera so that all volumes fit into the picture.",
            ),
            C::CameraKey => (
                PLAIN,
                Key::I,
                "Camera key",
                "Set a key of the camera in this frame, so that it moves to here from the key \
                 before and on to the next, or remove the one that there is. A camera that has \
                 keys gets one where it is moved.",
            ),
            C::NextSetup => (
                PLAIN,
                Key::U,
                "Next surroundings",
                "Put the volumes in other surroundings: a studio, with a floor under a soft sky, \
                 the same at night, or nothing. They take the place of the environment.",
            ),
            C::FocusByClick => (
                SHIFT,
                Key::F,
                "Focus by click",
                "Click on the picture to focus on what is seen there: fire, what hides most of \
                 what is behind it, or a surface.",
            ),
            C::FitPicture => {
                (PLAIN, Key::Home, "Fit the picture", "Zoom so that the whole picture is visible.")
            }
            C::ZoomToPixels => (
                PLAIN,
                Key::Z,
                "Zoom to pixels",
                "Zoom in until each pixel shows its values, or back out.",
            ),
            C::ExposureUp => (PLAIN, Key::E, "Exposure up", "Brighten the display by half a stop."),
            C::ExposureDown => {
                (SHIFT, Key::E, "Exposure down", "Darken the display by half a stop.")
            }
            C::AutoExposure => (
                PLAIN,
                Key::A,
                "Auto exposure",
                "Set the exposure so that the brightest parts just keep their color.",
            ),
            C::NextToneCurve => (
                PLAIN,
                Key::T,
                "Next tone curve",
                "Switch to the next tone curve: filmic, AgX, linear.",
            ),
            C::FalseColor => (
                SHIFT,
                Key::T,
                "False color",
                "Show in false color how many stops each pixel is from middle gray, or go back to \
                 the picture.",
            ),
            C::GoToPicture => (
                PLAIN,
                Key::F6,
                "Go to the picture",
                "Move keyboard focus to the picture: arrow keys orbit, with Shift they pan.",
            ),
            C::FoldPanels => (
                PLAIN,
                Key::N,
                "Show or hide the panels",
                "Hide the panels to leave more room for the picture, or show them again.",
            ),
            C::FullScreen => (
                PLAIN,
                Key::F11,
                "Full screen",
                "Show nothing but the picture on the whole screen, or bring menus and panels back.",
            ),
            C::Larger => (
                CTRL,
                Key::Plus,
                "Larger text",
                "Make text and controls larger; the picture keeps its pixels.",
            ),
            C::Smaller => (
                CTRL,
                Key::Minus,
                "Smaller text",
                "Make text and controls smaller; the picture keeps its pixels.",
            ),
            C::NormalSize => (
                CTRL,
                Key::Num0,
                "Normal text size",
                "Set text and controls to the size that the screen asks for.",
            ),
            C::ResetWindow => (
                CTRL_SHIFT,
                Key::Num0,
                "Reset the window",
                "Set panels, text size and display back to their defaults. The scene stays as it \
                 is.",
            ),
            C::Palette => (
                CTRL_SHIFT,
                Key::P,
                "All commands…",
                "Find a command by a few letters of its name and run it.",
            ),
            C::Start => (
                SHIFT,
                Key::F1,
                "Start with a scene",
                "Show the scenes that come with Flambeau and the recent files.",
            ),
            C::Shortcuts => (
                PLAIN,
                Key::F1,
                "Keys and mouse",
                "List all keyboard shortcuts and mouse gestures.",
            ),
            C::Compare => (
                PLAIN,
                Key::C,
                "Compare two strategies",
                "Render the scene with two strategies, A and B, with equal shares of the machine, \
                 or end the comparison.",
            ),
            C::SwitchSide => (
                PLAIN,
                Key::B,
                "Edit the other side",
                "Let toggles and advanced settings act on the other side from now on.",
            ),
            C::SwapSides => (PLAIN, Key::X, "Swap A and B", "Exchange A and B."),
            C::CopySide => (
                SHIFT,
                Key::X,
                "Copy to the other side",
                "Copy the strategy of the edited side to the other side.",
            ),
            C::NextLayout => (
                PLAIN,
                Key::V,
                "Next view of A and B",
                "Switch to the next view: wipe, side by side, difference, noise, and error where \
                 there is a reference.",
            ),
            C::CompareAsA => (
                SHIFT,
                Key::A,
                "Compare snapshot as A",
                "Compare the snapshot shown, as A, with the live picture, as B. The snapshot is \
                 not rendered any further; the arrow keys step to others.",
            ),
            C::CompareAsB => (
                SHIFT,
                Key::B,
                "Compare snapshot as B",
                "Compare the snapshot shown, as B, with the live picture, as A. The snapshot is \
                 not rendered any further; the arrow keys step to others.",
            ),
            C::SaveComparison => (
                CTRL,
                Key::P,
                "Save comparison as PNG…",
                "Save the view of A and B as displayed, with names, legend and figures, as a PNG.",
            ),
            C::MeasureRegion => (
                PLAIN,
                Key::M,
                "Measure a region",
                "Drag a region over the picture: its noise, errors and comparison are shown as \
                 well. Escape or a click on the picture removes it.",
            ),
            C::RenderRegionOnly => (
                SHIFT,
                Key::M,
                "Render region only",
                "Give all samples to the region, so that it converges sooner, or to all pixels \
                 again; the others then catch up.",
            ),
            C::LoadReference => (
                CTRL_SHIFT,
                Key::O,
                "Load reference…",
                "Measure the picture, or A and B, against a converged picture (.exr or .npy): how \
                 far off, and where. Files can also be dropped on the window.",
            ),
            C::PictureAsReference => (
                CTRL,
                Key::K,
                "Use picture as reference",
                "Measure against the current picture from now on. Its own noise limits what can be \
                 measured, so let it converge first.",
            ),
            C::RemoveReference => (
                CTRL_SHIFT,
                Key::K,
                "Remove the reference",
                "Stop measuring against the reference.",
            ),
            C::Sweep => (
                SHIFT,
                Key::C,
                "Sweep all strategies",
                "Try every strategy on this shot for a few seconds each and rank them: which to \
                 leave on, and what each toggle gains. Rendering pauses meanwhile.",
            ),
            C::KeepSnapshot => (
                PLAIN,
                Key::K,
                "Keep snapshot",
                "Keep the current picture as a snapshot that can be compared and resumed later.",
            ),
            C::PreviousSnapshot => (
                PLAIN,
                Key::ArrowLeft,
                "Previous snapshot",
                "Show the previous snapshot in place of the live picture.",
            ),
            C::NextSnapshot => (
                PLAIN,
                Key::ArrowRight,
                "Next snapshot",
                "Show the next snapshot, or the live picture after the last.",
            ),
            C::LivePicture => (
                PLAIN,
                Key::Escape,
                "Back to the live picture",
                "Close what is open in front, or show the live picture again.",
            ),
            C::ContinueSnapshot => (
                CTRL,
                Key::Enter,
                "Resume from snapshot",
                "Open the scene of the snapshot shown and add samples to it.",
            ),
            C::DeleteSnapshot => (
                PLAIN,
                Key::Delete,
                "Delete snapshot",
                "Delete the snapshot shown. This can be undone until Flambeau is closed.",
            ),
            C::UndoDelete => {
                (CTRL_ALT, Key::Z, "Undo delete", "Restore the snapshot that was deleted last.")
            }
            C::FoldStrip => (
                SHIFT,
                Key::N,
                "Show or hide snapshots",
                "Show the strip of snapshots under the picture, or hide it.",
            ),
        };
        Spec { text, tooltip, shortcut: KeyboardShortcut::new(modifiers, key) }
    }
}

/// The number key of a toggle.
fn key_of(toggle: Toggle) -> Key {
    match toggle {
        Toggle::EmissionDecoupling => Key::Num1,
        Toggle::EmissionRatioTracking => Key::Num2,
        Toggle::MajorantBoost => Key::Num3,
        Toggle::FireAsLight => Key::Num4,
        Toggle::LightProbes => Key::Num5,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_command_has_a_key_and_a_name_of_its_own() {
        let commands: Vec<Command> = C::all().collect();
        let keys: HashSet<_> = commands
            .iter()
            .map(|command| {
                let shortcut = command.shortcut();
                let modifiers = shortcut.modifiers;
                (shortcut.logical_key, modifiers.command, modifiers.shift, modifiers.alt)
            })
            .collect();
        let names: HashSet<_> = commands.iter().map(|command| command.text()).collect();
        assert_eq!((keys.len(), names.len()), (commands.len(), commands.len()));
        assert!(Toggle::all().all(|toggle| commands.contains(&C::Toggle(toggle))));
    }
}
