//! The menu bar: every command that has no better place, and the name of the scene.

use egui::{Button, MenuBar, RectAlign, RichText, Tooltip, Ui};

use crate::app::command::Command;
use crate::app::panels::Panel;
use crate::app::ui::theme::color;

const OPEN: [Command; 2] = [Command::Open, Command::OpenPath];
const FILE: [&[Command]; 2] =
    [&[Command::SaveExr, Command::SavePng, Command::SaveScene], &[Command::Quit]];
const RENDER: [&[Command]; 1] = [&[Command::PauseResume, Command::Restart]];
const VIEW: [&[Command]; 5] = [
    &[Command::FrameVolume, Command::FitPicture, Command::ZoomToPixels, Command::GoToPicture],
    &[Command::AutoExposure, Command::ExposureUp, Command::ExposureDown],
    &[Command::NextToneCurve, Command::FalseColor],
    &[Command::FoldPanels, Command::FullScreen, Command::ResetWindow],
    &[Command::Larger, Command::Smaller, Command::NormalSize],
];
const COMPARE: [&[Command]; 5] = [
    &[Command::Compare, Command::NextLayout, Command::SaveComparison],
    &[Command::SwitchSide, Command::SwapSides, Command::CopySide],
    &[Command::Rectangle, Command::SamplesHere],
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

/// Shows the bar. `title` names what is open.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>, title: &str) {
    MenuBar::new().ui(ui, |ui| {
        file_menu(ui, panel);
        edit_menu(ui, panel);
        menu(ui, panel, "Render", &RENDER);
        menu(ui, panel, "View", &VIEW);
        menu(ui, panel, "Compare", &COMPARE);
        menu(ui, panel, "Snapshots", &SNAPSHOTS);
        menu(ui, panel, "Help", &HELP);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add_space(4.0);
            let title = RichText::new(title).color(color::TEXT_DIM);
            ui.add(egui::Label::new(title).truncate());
        });
    });
}

fn file_menu(ui: &mut Ui, panel: &mut Panel<'_>) {
    ui.menu_button("File", |ui| {
        OPEN.into_iter().for_each(|command| item(ui, panel, command, command.text(), true));
        recent_menu(ui, panel);
        ui.separator();
        groups(ui, panel, &FILE);
    });
}

/// The files that were open before.
fn recent_menu(ui: &mut Ui, panel: &mut Panel<'_>) {
    let recent = panel.recent;
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            for path in recent {
                let name = std::path::Path::new(path).file_name().unwrap_or_default();
                let button = Button::new(name.to_string_lossy()).min_size(egui::vec2(190.0, 0.0));
                if ui.add(button).on_hover_text(path).clicked() {
                    *panel.reopened = Some(path.clone());
                    ui.close();
                }
            }
        });
    });
}

fn menu(ui: &mut Ui, panel: &mut Panel<'_>, title: &str, groups: &[&[Command]]) {
    ui.menu_button(title, |ui| self::groups(ui, panel, groups));
}

fn groups(ui: &mut Ui, panel: &mut Panel<'_>, groups: &[&[Command]]) {
    for (index, group) in groups.iter().enumerate() {
        if index > 0 {
            ui.separator();
        }
        for command in *group {
            item(ui, panel, *command, command.text(), true);
        }
    }
}

fn edit_menu(ui: &mut Ui, panel: &mut Panel<'_>) {
    let undo = panel.editor.undo_name().map(|name| format!("Undo {}", name.to_lowercase()));
    let redo = panel.editor.redo_name().map(|name| format!("Redo {}", name.to_lowercase()));
    ui.menu_button("Edit", |ui| {
        let names = [(Command::Undo, undo), (Command::Redo, redo)];
        for (command, name) in names {
            let enabled = name.is_some();
            let text = name.unwrap_or_else(|| command.text().to_owned());
            item(ui, panel, command, &text, enabled);
        }
    });
}

fn item(ui: &mut Ui, panel: &mut Panel<'_>, command: Command, text: &str, enabled: bool) {
    let key = RichText::new(ui.ctx().format_shortcut(&command.shortcut())).color(color::TEXT_DIM);
    let button = Button::new(text).shortcut_text(key).min_size(egui::vec2(190.0, 0.0));
    let response = ui.add_enabled(enabled, button);
    // Beside the item, so that it does not hide the next one.
    let mut tooltip = Tooltip::for_enabled(&response);
    tooltip.popup = tooltip.popup.align(RectAlign::RIGHT);
    tooltip.show(|ui| ui.label(command.tooltip()));
    if response.clicked() {
        panel.commands.push(command);
        ui.close();
    }
}
