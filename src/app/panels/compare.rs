//! The two sides of a comparison: which one is edited, how both are shown, what is known of them.

use egui::{Grid, RichText, Ui};

use super::Panel;
use super::noise_plot::{self, COLORS};
use crate::app::commands::Command;
use crate::app::duel::maps::{Difference, Noise};
use crate::app::duel::{FLIP, Layout};
use crate::app::state::{Side, strategy_name};
use crate::app::theme::color;
use crate::app::widgets::{capitalized, key_of, row, segments};
use crate::image::figures::rounded;
use crate::render::compare::{self, Comparison, NoiseHistory, Verdict};
use crate::render::turns::Share;

/// Shows which side is edited, and how to begin or end a comparison.
pub fn sides(ui: &mut Ui, panel: &mut Panel<'_>) {
    let Some(compared) = panel.editor.document.compared else {
        let help = format!("{}  [{}]", Command::Compare.tooltip(), key_of(ui, Command::Compare));
        if ui.button("Compare two strategies").on_hover_text(help).clicked() {
            panel.commands.push(Command::Compare);
        }
        return;
    };
    let names = [Side::A, Side::B].map(|side| title(side, panel));
    let help = "The side that toggles and choices act on.";
    let choices = [(names[0].as_str(), help), (names[1].as_str(), help)];
    let chosen = usize::from(compared.active == Side::B);
    let clicked = row(ui, "Edited side", help, |ui| segments(ui, &choices, Some(chosen))).inner;
    if clicked.is_some_and(|index| index != chosen) {
        panel.commands.push(Command::SwitchSide);
    }
    shares(ui, panel);
    ui.horizontal(|ui| {
        for (command, text) in [
            (Command::SwapSides, "Swap"),
            (Command::CopySide, "Copy to other side"),
            (Command::Compare, "End"),
        ] {
            let help = format!("{}  [{}]", command.tooltip(), key_of(ui, command));
            if ui.button(text).on_hover_text(help).clicked() {
                panel.commands.push(command);
            }
        }
    });
    if let Some(comparison) = panel.duel.comparison() {
        figures(ui, comparison, panel.duel.histories());
    }
    ui.separator();
}

/// What a side is called.
fn title(side: Side, panel: &Panel<'_>) -> String {
    side_title(side, strategy_name(&panel.editor.document.strategy_of(side)))
}

/// A side with the name of its strategy.
pub fn side_title(side: Side, strategy: &str) -> String {
    match side {
        Side::A => format!("A  {}", capitalized(strategy)),
        Side::B => format!("B  {}", capitalized(strategy)),
    }
}

/// What both sides get equal shares of, and their seeds.
fn shares(ui: &mut Ui, panel: &mut Panel<'_>) {
    let Some(compared) = &mut panel.editor.document.compared else { return };
    let choices = [
        ("Time", "Both sides get the same CPU time: what is the picture worth after so long?"),
        ("Samples", "Both sides get the same samples: what is a sample worth?"),
    ];
    let chosen = usize::from(compared.share == Share::Samples);
    let help = "What both sides get equal shares of.";
    let clicked = row(ui, "Equal", help, |ui| segments(ui, &choices, Some(chosen))).inner;
    let mut edit = None;
    if let Some(index) = clicked {
        compared.share = [Share::CpuTime, Share::Samples][index];
        edit = Some("equal shares");
    }
    let help = "B draws other random numbers than A. Without, noise that both share hides in their \
                difference.";
    if ui.checkbox(&mut compared.own_seed, "Own seed for B").on_hover_text(help).changed() {
        edit = Some("own seed");
    }
    if let Some(name) = edit {
        panel.editor.name_edit(name);
    }
}

/// Chooses how both sides are shown.
pub fn layouts(ui: &mut Ui, layout: &mut Layout) {
    let flip = format!(" Hold {} to see the other side.", FLIP.name());
    let helps = [
        format!("A left of the divider, B right of it; drag it.{flip}"),
        format!("A and B beside each other; zoom and moves go to both.{flip}"),
        "Where and how A and B differ: nothing but noise, if both are right.".to_owned(),
        "How noisy each pixel is: the standard error of its gray value.".to_owned(),
    ];
    let kinds = ["Wipe", "Side by side", "Difference", "Noise"];
    let choices: [(&str, &str); 4] = std::array::from_fn(|i| (kinds[i], helps[i].as_str()));
    if let Some(index) = segments(ui, &choices, Some(layout.kind())) {
        *layout = Layout::ALL[index];
    }
    match layout {
        Layout::Wipe | Layout::Beside => {}
        Layout::Difference(difference) => {
            let all = [Difference::Signed, Difference::Absolute, Difference::Relative];
            let choices = [
                ("Signed", "B - A: orange where B is brighter, blue where it is darker."),
                ("Absolute", "How far B is from A."),
                ("Relative", "How far B is from A, relative to how bright they are."),
            ];
            pick(ui, difference, all, choices);
        }
        Layout::Noise(noise) => {
            let all = [Noise::Of(Side::A), Noise::Of(Side::B), Noise::Ratio];
            let choices = [
                ("A", "The noise of A."),
                ("B", "The noise of B."),
                ("B / A", "The noise of B over that of A: blue where B is less noisy."),
            ];
            pick(ui, noise, all, choices);
        }
    }
}

fn pick<T: Copy + PartialEq>(ui: &mut Ui, value: &mut T, all: [T; 3], choices: [(&str, &str); 3]) {
    ui.separator();
    let chosen = all.iter().position(|other| other == value);
    if let Some(index) = segments(ui, &choices, chosen) {
        *value = all[index];
    }
}

/// Says which side is faster, and whether they show the same picture.
pub fn verdict(ui: &mut Ui, comparison: Option<&Comparison>) {
    let Some(comparison) = comparison else {
        ui.label(RichText::new("Waiting for both sides …").color(color::TEXT_DIM));
        return;
    };
    ui.label(RichText::new(comparison.sentence()).color(color::TEXT_STRONG)).on_hover_text(
        "From variance times CPU time of both sides. The less is known, the fewer digits.",
    );
    let agreement = &comparison.agreement;
    if agreement.verdict == Verdict::Differ {
        let text = "A and B show different pictures.";
        let help = "A difference stands out from the noise that chance would bring once in a \
                    thousand comparisons. Only ray marching should do that.";
        ui.label(RichText::new(text).color(color::WARNING)).on_hover_text(help);
    }
}

/// Samples, time and noise of both sides, and how the noise went down.
pub fn figures(ui: &mut Ui, comparison: &Comparison, histories: &[NoiseHistory; 2]) {
    Grid::new("sides").num_columns(4).min_col_width(FIGURE).show(ui, |ui| {
        for (heading, help) in [
            ("", ""),
            ("spp", "Samples per pixel."),
            ("CPU time", "Time of all sampling threads together."),
            ("noise", "The standard error of the picture relative to its brightness."),
        ] {
            let text = RichText::new(heading).small().color(color::TEXT_DIM);
            let label = ui.label(text);
            if !help.is_empty() {
                label.on_hover_text(help);
            }
        }
        ui.end_row();
        let names = ["A", "B"];
        for ((name, side), color) in names.into_iter().zip(&comparison.sides).zip(COLORS) {
            ui.label(RichText::new(name).color(color));
            ui.label(rounded(side.samples_per_pixel, 3));
            ui.label(format!("{} s", rounded(side.cpu_seconds, 3)));
            ui.label(noise_with_error(side));
            ui.end_row();
        }
    });
    noise_plot::show(ui, histories);
}

/// Width of a column of figures.
const FIGURE: f32 = 52.0;

/// Noise in percent with its standard error, which is half the relative one of the variance.
fn noise_with_error(side: &compare::Side) -> String {
    let (Some(noise), Some(variance), Some(error)) =
        (side.noise, side.variance_of_mean, side.variance_error)
    else {
        return "–".to_owned();
    };
    let error = if variance > 0.0 { 0.5 * error / variance } else { 0.0 };
    format!("{} ± {} %", rounded(100.0 * noise, 3), rounded(100.0 * noise * error, 1))
}
