//! The menu bar: every command that has no better place, and the name of the scene.

use egui::{Button, MenuBar, RectAlign, RichText, Tooltip, Ui};

use crate::app::command::Command;
use crate::app::document::Editor;
use crate::app::ui::theme::color;

const OPEN: [Command; 3] = [Command::Open, Command::OpenPath, Command::LoadEnvironment];
const FILE: [&[Command]; 2] =
    [&[Command::SaveExr, Command::SavePng, Command::SaveScene], &[Command::Quit]];
const RENDER: [&[Command]; 2] = [
    &[Command::PauseResume, Command::Restart],
    &[Command::Play, Command::PreviousFrame, Command::NextFrame, Command::SaveFlipbook],
];
const VIEW: [&[Command]; 6] = [
    &[Command::CameraKey, Command::FocusByClick, Command::NextSetup],
    &[Command::FrameVolume, Command::FitPicture, Command::ZoomToPixels, Command::GoToPicture],
    &[Command::AutoExposure, Command::ExposureUp, Command::ExposureDown],
    &[Command::NextToneCurve, Command::FalseColor],
    &[Command::FoldPanels, Command::FullScreen, Command::ResetWindow],
    &[Command::Larger, Command::Smaller, Command::NormalSize],
];
const COMPARE: [&[Command]; 5] = [
    &[Command::Compare, Command::NextLayout, Command::SaveComparison],
    &[Command::SwitchSide, Command::SwapSides, Command::CopySide],
    &[Command::MeasureRegion, Command::RenderRegionOnly],
    &[Command::LoadReference, Command::PictureAsReference, Command::RemoveReference],
    &[Command::Sweep],
];
const SNAPSHOTS: [&[Command]; 4] = [
    &[Command::KeepSnapshot, Command::FoldStrip],
    &[Command::PreviousSnapshot, Command::NextSnapshot, Command::LivePicture],
    &[Command::CompareAsA, Command::CompareAsB],
    &[Command::ContinueSnapshot, Command::DeleteSnapshot, Command::UndoDelete],
];
const HELP: [&[Command]; 2] = [&[Command::Start], &[Command::Palette, Command::Shortcuts]];

/// The contents of the menus, and where their requests go.
pub struct MenuItems<'a> {
    /// The document, for the names of the edits that undo and redo are about.
    pub editor: &'a Editor,
    /// Files that were open before, the last one first.
    pub recent: &'a [String],
    /// The recent file that is to be opened, once one is chosen.
    pub reopened: &'a mut Option<String>,
    /// Commands that are asked for.
    pub commands: &'a mut Vec<Command>,
}

/// Shows the bar. `title` names what is open.
pub fn show(ui: &mut Ui, items: &mut MenuItems<'_>, title: &str) {
    MenuBar::new().ui(ui, |ui| {
        file_menu(ui, items);
        edit_menu(ui, items);
        menu(ui, items, "Render", &RENDER);
        menu(ui, items, "View", &VIEW);
        menu(ui, items, "Compare", &COMPARE);
        menu(ui, items, "Snapshots", &SNAPSHOTS);
        menu(ui, items, "Help", &HELP);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add_space(4.0);
            let title = RichText::new(title).color(color::TEXT_DIM);
            ui.add(egui::Label::new(title).truncate());
        });
    });
}

fn file_menu(ui: &mut Ui, items: &mut MenuItems<'_>) {
    ui.menu_button("File", |ui| {
        OPEN.into_iter().for_each(|command| item(ui, items, command, command.text(), true));
        recent_menu(ui, items);
        ui.separator();
        groups(ui, items, &FILE);
    });
}

/// The files that were open before.
fn recent_menu(ui: &mut Ui, items: &mut MenuItems<'_>) {
    let recent = items.recent;
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            for path in recent {
                let name = std::path::Path::new(path).file_name().unwrap_or_default();
                let button = Button::new(name.to_string_lossy()).min_size(egui::vec2(190.0, 0.0));
                if ui.add(button).on_hover_text(path).clicked() {
                    *items.reopened = Some(path.clone());
                    ui.close();
                }
            }
        });
    });
}

fn menu(ui: &mut Ui, items: &mut MenuItems<'_>, title: &str, groups: &[&[Command]]) {
    ui.menu_button(title, |ui| self::groups(ui, items, groups));
}

fn groups(ui: &mut Ui, items: &mut MenuItems<'_>, groups: &[&[Command]]) {
    for (index, group) in groups.iter().enumerate() {
        if index > 0 {
            ui.separator();
        }
        for command in *group {
            item(ui, items, *command, command.text(), true);
        }
    }
}

fn edit_menu(ui: &mut Ui, items: &mut MenuItems<'_>) {
    let undo = items.editor.undo_name().map(|name| format!("Undo {}", name.to_lowercase()));
    let redo = items.editor.redo_name().map(|name| format!("Redo {}", name.to_lowercase()));
    ui.menu_button("Edit", |ui| {
        let names = [(Command::Undo, undo), (Command::Redo, redo)];
        for (command, name) in names {
            let enabled = name.is_some();
            let text = name.unwrap_or_else(|| command.text().to_owned());
            item(ui, items, command, &text, enabled);
        }
    });
}

fn item(ui: &mut Ui, items: &mut MenuItems<'_>, command: Command, text: &str, enabled: bool) {
    let key = RichText::new(ui.ctx().format_shortcut(&command.shortcut())).color(color::TEXT_DIM);
    let button = Button::new(text).shortcut_text(key).min_size(egui::vec2(190.0, 0.0));
    let response = ui.add_enabled(enabled, button);
    // Beside the item, so that it does not hide the next one.
    let mut tooltip = Tooltip::for_enabled(&response);
    tooltip.popup = tooltip.popup.align(RectAlign::RIGHT);
    tooltip.show(|ui| ui.label(command.tooltip()));
    if response.clicked() {
        items.commands.push(command);
        ui.close();
    }
}
