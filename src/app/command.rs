//! Every command of the window: its text, its tooltip and its shortcut. Menus, buttons, keys and
//! the help page all read this list.

use egui::{Context, Key, KeyboardShortcut, Modifiers};

use crate::transport::toggle::Toggle;

/// Something that the user can ask for without a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "`text` and `tooltip` say what each is")]
pub enum Command {
    Open,
    OpenPath,
    SaveExr,
    SavePng,
    SaveScene,
    Quit,
    Undo,
    Redo,
    PauseResume,
    Restart,
    EmissionDecoupling,
    EmissionRatioTracking,
    MajorantBoost,
    FireAsLight,
    /// Switch the strategy `probe_mis`.
    Probes,
    FrameVolume,
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
    /// Show what to begin with.
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
    Rectangle,
    /// Give the rectangle all samples.
    SamplesHere,
    LoadReference,
    PictureAsReference,
    RemoveReference,
    /// Try every strategy on the shot.
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

impl Command {
    /// All of them, in the order of the help page.
    pub const ALL: [Self; 55] = [
        C::Open,
        C::OpenPath,
        C::SaveExr,
        C::SavePng,
        C::SaveScene,
        C::Quit,
        C::Undo,
        C::Redo,
        C::PauseResume,
        C::Restart,
        C::EmissionDecoupling,
        C::EmissionRatioTracking,
        C::MajorantBoost,
        C::FireAsLight,
        C::Probes,
        C::FrameVolume,
        C::FitPicture,
        C::ZoomToPixels,
        C::ExposureUp,
        C::ExposureDown,
        C::AutoExposure,
        C::NextToneCurve,
        C::FalseColor,
        C::GoToPicture,
        C::FoldPanels,
        C::FullScreen,
        C::Larger,
        C::Smaller,
        C::NormalSize,
        C::ResetWindow,
        C::Palette,
        C::Start,
        C::Shortcuts,
        C::Compare,
        C::SwitchSide,
        C::SwapSides,
        C::CopySide,
        C::NextLayout,
        C::CompareAsA,
        C::CompareAsB,
        C::SaveComparison,
        C::Rectangle,
        C::SamplesHere,
        C::LoadReference,
        C::PictureAsReference,
        C::RemoveReference,
        C::Sweep,
        C::KeepSnapshot,
        C::PreviousSnapshot,
        C::NextSnapshot,
        C::LivePicture,
        C::ContinueSnapshot,
        C::DeleteSnapshot,
        C::UndoDelete,
        C::FoldStrip,
    ];

    /// What menus and buttons call it.
    pub fn text(self) -> &'static str {
        match self {
            C::Open => "Open…",
            C::OpenPath => "Open path…",
            C::SaveExr => "Save EXR…",
            C::SavePng => "Save PNG…",
            C::SaveScene => "Save scene as…",
            C::Quit => "Quit",
            C::Undo => "Undo",
            C::Redo => "Redo",
            C::PauseResume => "Pause or resume",
            C::Restart => "Restart",
            C::EmissionDecoupling => Toggle::EmissionDecoupling.name(),
            C::EmissionRatioTracking => Toggle::EmissionRatioTracking.name(),
            C::MajorantBoost => Toggle::MajorantBoost.name(),
            C::FireAsLight => Toggle::FireAsLight.name(),
            C::Probes => Toggle::Probes.name(),
            C::FrameVolume => "Frame the volume",
            C::FitPicture => "Fit the picture",
            C::ZoomToPixels => "Zoom to pixels",
            C::ExposureUp => "Exposure up",
            C::ExposureDown => "Exposure down",
            C::AutoExposure => "Expose for the picture",
            C::NextToneCurve => "Next tone curve",
            C::FalseColor => "False color",
            C::GoToPicture => "Go to the picture",
            C::FoldPanels => "Fold the panels",
            C::FullScreen => "Picture on the full screen",
            C::Larger => "Larger text",
            C::Smaller => "Smaller text",
            C::NormalSize => "Text of normal size",
            C::ResetWindow => "Reset the window",
            C::Palette => "All commands…",
            C::Start => "Start with a scene",
            C::Shortcuts => "Keys and mouse",
            C::Compare => "Compare two strategies",
            C::SwitchSide => "Edit the other side",
            C::SwapSides => "Swap A and B",
            C::CopySide => "Copy to the other side",
            C::NextLayout => "Next view of A and B",
            C::CompareAsA => "Compare snapshot as A",
            C::CompareAsB => "Compare snapshot as B",
            C::SaveComparison => "Save comparison as PNG…",
            C::Rectangle => "Figures of a rectangle",
            C::SamplesHere => "Samples only in the rectangle",
            C::LoadReference => "Load reference…",
            C::PictureAsReference => "Use picture as reference",
            C::RemoveReference => "Remove the reference",
            C::Sweep => "Try all strategies",
            C::KeepSnapshot => "Keep snapshot",
            C::PreviousSnapshot => "Previous snapshot",
            C::NextSnapshot => "Next snapshot",
            C::LivePicture => "Back to the live picture",
            C::ContinueSnapshot => "Go on from the snapshot",
            C::DeleteSnapshot => "Delete snapshot",
            C::UndoDelete => "Undo delete",
            C::FoldStrip => "Show or fold the strip",
        }
    }

    /// What it does.
    pub fn tooltip(self) -> &'static str {
        match self {
            C::Open => {
                "Open a scene (.toml) or a volume (.vdb), or go on from a snapshot (.exr). Files can \
                 also be dropped on the window."
            }
            C::OpenPath => "Type the path of a scene, a volume or a snapshot, or builtin:NAME.",
            C::SaveExr => "Save the picture as it is, linear and with its layers, as an EXR.",
            C::SavePng => {
                "Save the picture as you see it, with exposure, white balance and tone curve, as a PNG."
            }
            C::SaveScene => "Save every setting as a scene file that renders to the same picture.",
            C::Quit => "Close the window.",
            C::Undo => "Take the last edit back.",
            C::Redo => "Make the edit that was taken back again.",
            C::PauseResume => "Stop sampling and keep the picture, or go on where it stopped.",
            C::Restart => "Throw the samples away and start again.",
            C::EmissionDecoupling
            | C::EmissionRatioTracking
            | C::MajorantBoost
            | C::FireAsLight
            | C::Probes => {
                "Switch this strategy on or off; the picture stays the same, its noise does not."
            }
            C::FrameVolume => "Move the camera so that all volumes are in the picture.",
            C::FitPicture => "Show the whole picture.",
            C::ZoomToPixels => "Zoom in until single pixels show, and back.",
            C::ExposureUp => "Brighten the display by half a stop.",
            C::ExposureDown => "Darken the display by half a stop.",
            C::AutoExposure => "Expose so that the brightest parts just keep their color.",
            C::NextToneCurve => "Go from one tone curve to the next: filmic, AgX, linear.",
            C::FalseColor => "Show how many stops each pixel is from middle gray, or the picture.",
            C::GoToPicture => "Give the picture the keyboard: arrows orbit, with Shift they pan.",
            C::FoldPanels => "Hide the panels and give the picture the room, or bring them back.",
            C::FullScreen => "Give the picture the whole screen, or bring menus and panels back.",
            C::Larger => "Make text and controls larger; the picture keeps its pixels.",
            C::Smaller => "Make text and controls smaller; the picture keeps its pixels.",
            C::NormalSize => "Give text and controls the size that the screen asks for.",
            C::ResetWindow => {
                "Bring panels, text size and display back to the first start; all else stays."
            }
            C::Start => "Show the scenes that Flambeau brings along and the files of before.",
            C::Palette => "Find a command by a few letters of its name and carry it out.",
            C::Shortcuts => "Show every key and every move of the mouse.",
            C::Compare => {
                "Render the scene under two strategies, A and B, that share the machine fairly, or go \
                 back to one."
            }
            C::SwitchSide => "Toggles and advanced choices act on the other side from now on.",
            C::SwapSides => "Exchange A and B.",
            C::CopySide => "Give the other side the strategy of the side that is edited.",
            C::NextLayout => {
                "Wipe, side by side, difference, noise, and the error where there is a reference."
            }
            C::CompareAsA => {
                "Set the snapshot shown as A against the live picture as B. Nothing is rendered on \
                 its side; the arrow keys go on to others."
            }
            C::CompareAsB => {
                "Set the snapshot shown as B against the live picture as A. Nothing is rendered on \
                 its side; the arrow keys go on to others."
            }
            C::SaveComparison => {
                "Save the view of A and B as you see it, with names, legend and figures, as a PNG."
            }
            C::Rectangle => {
                "Drag a rectangle over the picture: noise, errors and the comparison are told of it \
                 alone too. Escape or a click on the picture takes it away."
            }
            C::SamplesHere => {
                "Give the rectangle all the samples, so that it gets clean sooner, or all pixels \
                 again, which catch up."
            }
            C::LoadReference => {
                "Measure the picture, or A and B, against a picture without noise (.exr or .npy): \
                 how far off, and where. Files can also be dropped on the window."
            }
            C::PictureAsReference => {
                "Measure what is rendered from now on against the picture shown. Its own noise sets \
                 the limit, so let it refine for long."
            }
            C::RemoveReference => "Measure against nothing any more.",
            C::Sweep => {
                "Try every strategy on this shot for a few seconds each and rank them: which to \
                 leave on, what each toggle brings. The picture waits meanwhile."
            }
            C::KeepSnapshot => {
                "Keep the picture as it is in the strip, with all that is needed to go on from it."
            }
            C::PreviousSnapshot => "Show the snapshot before, in place of the live picture.",
            C::NextSnapshot => "Show the snapshot after, or the live picture behind the last.",
            C::LivePicture => "Close what is in front, or show the picture being rendered again.",
            C::ContinueSnapshot => "Open the scene of the snapshot shown and add samples to it.",
            C::DeleteSnapshot => {
                "Delete the snapshot shown. It can be undone until the program ends."
            }
            C::UndoDelete => "Bring the snapshot deleted last back.",
            C::FoldStrip => "Show the strip of snapshots under the picture, or hide it.",
        }
    }

    /// The key that asks for it.
    pub fn shortcut(self) -> KeyboardShortcut {
        let (modifiers, key) = match self {
            C::Open => (Modifiers::COMMAND, Key::O),
            C::OpenPath => (Modifiers::COMMAND, Key::L),
            C::SaveExr => (Modifiers::COMMAND, Key::S),
            C::SavePng => (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S),
            C::SaveScene => (Modifiers::COMMAND.plus(Modifiers::ALT), Key::S),
            C::Quit => (Modifiers::COMMAND, Key::Q),
            C::Undo => (Modifiers::COMMAND, Key::Z),
            C::Redo => (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z),
            C::PauseResume => (Modifiers::NONE, Key::Space),
            C::Restart => (Modifiers::NONE, Key::R),
            C::EmissionDecoupling => (Modifiers::NONE, Key::Num1),
            C::EmissionRatioTracking => (Modifiers::NONE, Key::Num2),
            C::MajorantBoost => (Modifiers::NONE, Key::Num3),
            C::FireAsLight => (Modifiers::NONE, Key::Num4),
            C::Probes => (Modifiers::NONE, Key::Num5),
            C::FrameVolume => (Modifiers::NONE, Key::F),
            C::FitPicture => (Modifiers::NONE, Key::Home),
            C::ZoomToPixels => (Modifiers::NONE, Key::Z),
            C::ExposureUp => (Modifiers::NONE, Key::E),
            C::ExposureDown => (Modifiers::SHIFT, Key::E),
            C::AutoExposure => (Modifiers::NONE, Key::A),
            C::NextToneCurve => (Modifiers::NONE, Key::T),
            C::FalseColor => (Modifiers::SHIFT, Key::T),
            C::GoToPicture => (Modifiers::NONE, Key::F6),
            C::FoldPanels => (Modifiers::NONE, Key::N),
            C::FullScreen => (Modifiers::NONE, Key::F11),
            C::Larger => (Modifiers::COMMAND, Key::Plus),
            C::Smaller => (Modifiers::COMMAND, Key::Minus),
            C::NormalSize => (Modifiers::COMMAND, Key::Num0),
            C::ResetWindow => (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Num0),
            C::Palette => (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::P),
            C::Start => (Modifiers::SHIFT, Key::F1),
            C::Shortcuts => (Modifiers::NONE, Key::F1),
            C::Compare => (Modifiers::NONE, Key::C),
            C::SwitchSide => (Modifiers::NONE, Key::B),
            C::SwapSides => (Modifiers::NONE, Key::X),
            C::CopySide => (Modifiers::SHIFT, Key::X),
            C::NextLayout => (Modifiers::NONE, Key::V),
            C::CompareAsA => (Modifiers::SHIFT, Key::A),
            C::CompareAsB => (Modifiers::SHIFT, Key::B),
            C::SaveComparison => (Modifiers::COMMAND, Key::P),
            C::Rectangle => (Modifiers::NONE, Key::M),
            C::SamplesHere => (Modifiers::SHIFT, Key::M),
            C::LoadReference => (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::O),
            C::PictureAsReference => (Modifiers::COMMAND, Key::K),
            C::RemoveReference => (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::K),
            C::Sweep => (Modifiers::SHIFT, Key::C),
            C::KeepSnapshot => (Modifiers::NONE, Key::K),
            C::PreviousSnapshot => (Modifiers::NONE, Key::ArrowLeft),
            C::NextSnapshot => (Modifiers::NONE, Key::ArrowRight),
            C::LivePicture => (Modifiers::NONE, Key::Escape),
            C::ContinueSnapshot => (Modifiers::COMMAND, Key::Enter),
            C::DeleteSnapshot => (Modifiers::NONE, Key::Delete),
            C::UndoDelete => (Modifiers::COMMAND.plus(Modifiers::ALT), Key::Z),
            C::FoldStrip => (Modifiers::SHIFT, Key::N),
        };
        KeyboardShortcut::new(modifiers, key)
    }

    /// The commands whose keys were pressed since the last frame. Plain keys belong to a text
    /// field while one is edited, and to any focused control where they would press it.
    pub fn pressed(ctx: &Context) -> Vec<Self> {
        let typing = ctx.text_edit_focused();
        let focused = ctx.egui_wants_keyboard_input();
        let mut commands = Self::ALL;
        // Keys match with superfluous modifiers too, so the most specific come first.
        commands.sort_by_key(|command| {
            let modifiers = command.shortcut().modifiers;
            std::cmp::Reverse(
                u8::from(modifiers.command) + u8::from(modifiers.shift) + u8::from(modifiers.alt),
            )
        });
        ctx.input_mut(|input| {
            commands
                .into_iter()
                .filter(|command| {
                    let shortcut = command.shortcut();
                    let taken = match shortcut.logical_key {
                        // No text has these.
                        Key::F1 | Key::F6 | Key::F11 => false,
                        Key::Space | Key::ArrowLeft | Key::ArrowRight | Key::Delete => focused,
                        _ => typing,
                    };
                    let plain = !shortcut.modifiers.command;
                    !(plain && taken) && is_pressed(input, &shortcut)
                })
                .collect()
        })
    }
}

/// Whether a shortcut was pressed, which then is nobody else's; Escape also closes what is open.
fn is_pressed(input: &mut egui::InputState, shortcut: &KeyboardShortcut) -> bool {
    match shortcut.logical_key {
        Key::Escape => input.key_pressed(Key::Escape),
        _ => input.consume_shortcut(shortcut),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_command_has_a_key_of_its_own() {
        let keys: HashSet<_> = C::ALL
            .iter()
            .map(|command| {
                let shortcut = command.shortcut();
                let modifiers = shortcut.modifiers;
                (shortcut.logical_key, modifiers.command, modifiers.shift, modifiers.alt)
            })
            .collect();
        assert_eq!(keys.len(), C::ALL.len());
        assert_eq!(C::ALL.iter().collect::<HashSet<_>>().len(), C::ALL.len());
    }
}
