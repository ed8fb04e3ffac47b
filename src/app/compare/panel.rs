//! The panel of a comparison: which side is edited, how both are shown, and their figures.

use egui::{RichText, Ui};

use super::figures;
use crate::app::command::Command;
use crate::app::compare::maps::{Difference, Noise};
use crate::app::compare::measure::Measure;
use crate::app::compare::reference::MeasuredReference;
use crate::app::compare::second_side::{CompareLayout, FLIP_KEY, SecondSide};
use crate::app::document::{Document, Editor, Side, strategy_name};
use crate::app::ui::theme::color;
use crate::app::ui::widgets::{capitalized, key_of, row, segments};
use crate::render::compare::{Comparison, Verdict};
use crate::render::turns::Share;

/// The state that the panel of a comparison shows and may change.
pub struct ComparePanel<'a> {
    /// The document and its record of edits.
    pub editor: &'a mut Editor,
    /// The second side.
    pub second_side: &'a SecondSide,
    /// The reference and the errors against it.
    pub reference: &'a mut MeasuredReference,
    /// Commands that buttons ask for.
    pub commands: &'a mut Vec<Command>,
}

/// Shows which side is edited, and how to begin or end a comparison.
pub fn sides(ui: &mut Ui, panel: &mut ComparePanel<'_>) {
    if panel.second_side.stored.is_some() {
        return snapshot_sides(ui, panel);
    }
    let Some(compared) = panel.editor.document.compared else {
        button(ui, panel, Command::Compare, "Compare two strategies");
        return figures::show(ui, panel.second_side, panel.reference);
    };
    let names =
        [Side::A, Side::B].map(|side| name(side, &panel.editor.document, panel.second_side));
    let help = "The side that toggles and advanced settings act on.";
    let choices = [(names[0].as_str(), help), (names[1].as_str(), help)];
    let chosen = usize::from(compared.active == Side::B);
    let clicked = row(ui, "Edited side", help, |ui| segments(ui, &choices, Some(chosen))).inner;
    if clicked.is_some_and(|index| index != chosen) {
        panel.commands.push(Command::SwitchSide);
    }
    if let Some(text) = bias(&panel.editor.document, panel.second_side) {
        let help = "Ray marching is on: the picture converges to a slightly different result.";
        ui.label(RichText::new(text).color(color::WARNING)).on_hover_text(help);
    }
    shares(ui, panel);
    ui.horizontal(|ui| {
        for (command, text) in [
            (Command::SwapSides, "Swap"),
            (Command::CopySide, "Copy to other side"),
            (Command::Compare, "End"),
        ] {
            button(ui, panel, command, text);
        }
    });
    figures::show(ui, panel.second_side, panel.reference);
    ui.separator();
}

/// Shows what the live picture is compared with, where that is a snapshot.
fn snapshot_sides(ui: &mut Ui, panel: &mut ComparePanel<'_>) {
    let titles =
        [Side::A, Side::B].map(|side| side_title(side, &panel.editor.document, panel.second_side));
    titles.iter().for_each(|title| {
        ui.add(egui::Label::new(RichText::new(title).color(color::TEXT_STRONG)).truncate());
    });
    ui.horizontal(|ui| {
        for (command, text) in [(Command::SwapSides, "Swap"), (Command::Compare, "End")] {
            button(ui, panel, command, text);
        }
    });
    figures::show(ui, panel.second_side, panel.reference);
    ui.separator();
}

fn button(ui: &mut Ui, panel: &mut ComparePanel<'_>, command: Command, text: &str) {
    let help = format!("{}  [{}]", command.tooltip(), key_of(ui, command));
    if ui.button(text).on_hover_text(help).clicked() {
        panel.commands.push(command);
    }
}

/// A side with the name of its strategy, or of the snapshot that it is.
fn name(side: Side, document: &Document, second_side: &SecondSide) -> String {
    let letter = if side == Side::A { "A" } else { "B" };
    match &second_side.stored {
        Some(stored) if stored.side == side => format!("{letter}  Snapshot {}", stored.name),
        Some(_) => format!("{letter}  Live: {}", strategy_name(&document.settings.strategy)),
        None => format!("{letter}  {}", capitalized(strategy_name(&document.strategy_of(side)))),
    }
}

/// Title of a side: the name of its strategy or snapshot, marked where the side is biased.
pub fn side_title(side: Side, document: &Document, second_side: &SecondSide) -> String {
    let bias = if is_biased(side, document, second_side) { ", biased" } else { "" };
    format!("{}{bias}", name(side, document, second_side))
}

/// Whether a side shows a picture that will never be quite right.
pub fn is_biased(side: Side, document: &Document, second_side: &SecondSide) -> bool {
    match &second_side.stored {
        Some(stored) if stored.side == side => stored.is_biased,
        Some(_) => document.settings.strategy.is_biased(),
        None => document.strategy_of(side).is_biased(),
    }
}

/// Says of pictures that will never be quite right which of two that are.
pub fn bias(document: &Document, second_side: &SecondSide) -> Option<&'static str> {
    match [Side::A, Side::B].map(|side| is_biased(side, document, second_side)) {
        [false, false] => None,
        _ if !second_side.is_on() => Some("biased"),
        [true, false] => Some("A is biased"),
        [false, true] => Some("B is biased"),
        [true, true] => Some("A and B are biased"),
    }
}

/// Shows whether both sides get equal time or equal samples, and their seeds.
fn shares(ui: &mut Ui, panel: &mut ComparePanel<'_>) {
    let Some(compared) = &mut panel.editor.document.compared else { return };
    let choices = [
        ("Time", "Both sides get the same CPU time: which is less noisy after the same time?"),
        ("Samples", "Both sides get the same number of samples: which is less noisy per sample?"),
    ];
    let chosen = usize::from(compared.share == Share::Samples);
    let help = "Whether both sides get equal CPU time or equal samples.";
    let clicked = row(ui, "Equal", help, |ui| segments(ui, &choices, Some(chosen))).inner;
    let mut edit = None;
    if let Some(index) = clicked {
        compared.share = [Share::CpuTime, Share::Samples][index];
        edit = Some("equal shares");
    }
    let help = "B uses other random numbers than A. With the same seed, noise that both sides \
                share cancels in the difference.";
    if ui.checkbox(&mut compared.own_seed, "Different seed for B").on_hover_text(help).changed() {
        edit = Some("seed for B");
    }
    if let Some(name) = edit {
        panel.editor.name_edit(name);
    }
}

/// Chooses among the `kinds` of views that there are of both sides, or of one picture.
pub fn layouts(ui: &mut Ui, layout: &mut CompareLayout, (kinds, of_two): (&[CompareLayout], bool)) {
    let choices: Vec<(&str, String)> = kinds.iter().map(|kind| in_words(*kind, of_two)).collect();
    let choices: Vec<(&str, &str)> =
        choices.iter().map(|(name, help)| (*name, help.as_str())).collect();
    let chosen = kinds.iter().position(|kind| kind.kind() == layout.kind());
    if let Some(index) = segments(ui, &choices, chosen.or(Some(0))) {
        *layout = kinds[index];
    }
    if chosen.is_some() {
        finer(ui, layout, of_two);
    }
}

/// The name of a kind of view, and an explanation.
fn in_words(kind: CompareLayout, of_two: bool) -> (&'static str, String) {
    let flip = format!(" Hold {} to see the other side.", FLIP_KEY.name());
    match kind {
        CompareLayout::Wipe if !of_two => ("Picture", "The picture.".to_owned()),
        CompareLayout::Wipe => {
            ("Wipe", format!("A left of the divider, B right of it. Drag the divider.{flip}"))
        }
        CompareLayout::Beside => (
            "Side by side",
            format!("A and B next to each other. Zoom and camera moves apply to both.{flip}"),
        ),
        CompareLayout::Difference(_) => (
            "Difference",
            "Where and by how much A and B differ. Only noise should remain if neither is biased."
                .to_owned(),
        ),
        CompareLayout::Noise(_) => {
            ("Noise", "The noise of each pixel: the standard error of its luminance.".to_owned())
        }
        CompareLayout::Error(..) => {
            ("Error", "How far each pixel is from the reference.".to_owned())
        }
    }
}

/// The finer choices of a view.
fn finer(ui: &mut Ui, layout: &mut CompareLayout, of_two: bool) {
    match layout {
        CompareLayout::Wipe | CompareLayout::Beside => {}
        CompareLayout::Difference(difference) => {
            let all = [Difference::Signed, Difference::Absolute, Difference::Relative];
            let choices = [
                ("Signed", "B − A: orange where B is brighter, blue where it is darker."),
                ("Absolute", "How much B differs from A."),
                ("Relative", "How much B differs from A, relative to their brightness."),
            ];
            pick(ui, difference, all, choices);
        }
        CompareLayout::Noise(noise) => {
            let all = [Noise::Of(Side::A), Noise::Of(Side::B), Noise::Ratio];
            let choices = [
                ("A", "The noise of A."),
                ("B", "The noise of B."),
                ("B / A", "The noise of B divided by the noise of A: blue where B is less noisy."),
            ];
            pick(ui, noise, all, choices);
        }
        CompareLayout::Error(measure, side) => {
            let choices = [
                (
                    "Squared error",
                    "The squared error in linear light, relative to the reference squared \
                     (relMSE).",
                ),
                (
                    "FLIP map",
                    "The difference one perceives when flipping between the displayed pictures \
                     (FLIP).",
                ),
            ];
            pick(ui, measure, Measure::ALL, choices);
            if of_two {
                let choices = [("A", "The error of A."), ("B", "The error of B.")];
                pick(ui, side, [Side::A, Side::B], choices);
            }
        }
    }
}

fn pick<T: Copy + PartialEq, const N: usize>(
    ui: &mut Ui,
    value: &mut T,
    all: [T; N],
    choices: [(&str, &str); N],
) {
    ui.separator();
    let chosen = all.iter().position(|other| other == value);
    if let Some(index) = segments(ui, &choices, chosen) {
        *value = all[index];
    }
}

/// Says which side is faster, and whether they show the same picture; `biased` says which ones are.
pub fn verdict(ui: &mut Ui, comparison: Option<&Comparison>, biased: [bool; 2]) {
    let Some(comparison) = comparison else {
        ui.label(RichText::new("Waiting for both sides…").color(color::TEXT_DIM));
        return;
    };
    ui.label(RichText::new(comparison.sentence()).color(color::TEXT_STRONG)).on_hover_text(
        "Computed from variance times CPU time of both sides, with as many digits as are certain.",
    );
    if let Some(text) = disagreement(comparison, biased) {
        let help = "A and B differ by more than noise explains; noise alone would do so once in a \
                    thousand comparisons. Only ray marching should cause this.";
        ui.label(RichText::new(text).color(color::WARNING)).on_hover_text(help);
    }
}

/// A sentence that both sides show different pictures, where they do, and which of them is biased.
pub fn disagreement(comparison: &Comparison, biased: [bool; 2]) -> Option<String> {
    let who = match biased {
        [false, false] => "",
        [true, false] => " A is biased.",
        [false, true] => " B is biased.",
        [true, true] => " Both are biased.",
    };
    let differ = comparison.agreement.verdict == Verdict::Differ;
    differ.then(|| format!("A and B show different pictures.{who}"))
}
