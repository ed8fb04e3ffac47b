//! The results of a sweep: strategies ranked, with bars, times, and a button that uses one.

use std::time::Duration;

use egui::{Button, Context, DragValue, Grid, Label, Rect, RichText, ScrollArea, Ui, Window, vec2};

use super::bar::BarAxis;
use crate::app::command::Command;
use crate::app::document::Editor;
use crate::app::sweep::{Results, Sweep};
use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::{explain, finite, key_of, row_label, significant};
use crate::app::ui::words::time_left;
use crate::format::percent;
use crate::render::sweep::words::{headline, note, relative_time, remarks};
use crate::render::sweep::{Gain, RankedTrial, Ranking, SweepProgress, TrialSource, Worth};

/// Width of the window's contents.
const WIDTH: f32 = 640.0;
/// Height of the window's parts above and below the results, in points.
const AROUND: f32 = 110.0;
/// Width of a column of times.
const TIME: f32 = 92.0;

/// The text of the progress row, and the fraction done.
pub fn progress((progress, left): &(SweepProgress, Option<Duration>)) -> (String, f32) {
    match progress {
        SweepProgress::Preparing(done, all) => {
            ("Sweep: preparing".to_owned(), *done as f32 / (*all).max(1) as f32)
        }
        SweepProgress::Rendering(part) => {
            let left = left.map_or_else(String::new, |left| {
                format!(", {} left", time_left(left.as_secs_f64()))
            });
            (format!("Sweep: trying strategies{left}"), *part as f32)
        }
    }
}

/// Shows the results over `area`, while they are open. What is asked below the picture stays in
/// sight.
pub fn show(
    ctx: &Context,
    area: Rect,
    sweep: &mut Sweep,
    editor: &mut Editor,
    commands: &mut Vec<Command>,
) {
    if sweep.results().is_none() {
        return;
    }
    let mut open = sweep.open;
    Window::new("Sweep of all strategies")
        .open(&mut open)
        .resizable(false)
        .collapsible(false)
        .default_pos(area.left_top() + vec2(24.0, 16.0))
        .constrain_to(area)
        .show(ctx, |ui| {
            ui.set_width(WIDTH.min(area.width() - 60.0));
            let height = (area.height() - AROUND).max(120.0);
            ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
                if let Some(results) = sweep.results() {
                    contents(ui, results, editor);
                }
            });
            ui.separator();
            again(ui, sweep, commands);
        });
    sweep.open = open;
}

fn contents(ui: &mut Ui, results: &Results, editor: &mut Editor) {
    let Results { ranking, .. } = results;
    let text = RichText::new(format!("{}.", headline(ranking))).color(color::TEXT_STRONG);
    ui.add(Label::new(text).wrap());
    for remark in remarks(ranking) {
        explain(ui, &format!("{remark}."));
    }
    let stale = results.is_stale(&editor.document.settings);
    for (is_so, text) in [
        (stale, "The shot or an advanced setting has changed since: sweep again."),
        (results.interrupted, "Cancelled before all strategies had their time."),
    ] {
        if is_so {
            ui.label(RichText::new(text).color(color::WARNING));
        }
    }
    ui.add_space(space::TIGHT);
    entries(ui, ranking, editor);
    ui.add_space(space::ROW);
    worths(ui, ranking);
}

/// The strategies, the fastest first.
fn entries(ui: &mut Ui, ranking: &Ranking, editor: &mut Editor) {
    let axis = BarAxis::over(ranking);
    Grid::new("strategies").num_columns(5).spacing([space::ROW * 2.0, 3.0]).show(ui, |ui| {
        heading(ui, "", "");
        heading(ui, "strategy", "");
        axis.heading(ui);
        heading(
            ui,
            "time",
            "Time to the same noise relative to baseline, with its standard error.",
        );
        heading(ui, "noise", "Relative standard error of the picture at the end of the sweep.");
        ui.end_row();
        for (number, entry) in ranking.entries.iter().enumerate() {
            let is_best = ranking.leave_on == Some(number);
            use_button(ui, entry, editor);
            let name = RichText::new(entry.trial.kind.title());
            let strong = is_best || entry.is_as_good_as_best() && entry.is_rendered();
            ui.label(name.color(if strong { color::TEXT_STRONG } else { color::TEXT }));
            axis.bar(ui, entry, is_best);
            figures(ui, entry);
            ui.end_row();
        }
    });
}

/// Takes the strategy over into the edited side.
fn use_button(ui: &mut Ui, entry: &RankedTrial, editor: &mut Editor) {
    let (trial, name) = (&entry.trial, entry.trial.kind.name());
    let strategy = &mut editor.document.settings.strategy;
    let in_use = *strategy == trial.strategy;
    let refused = matches!(trial.source, TrialSource::Refused(_));
    let text = if in_use { "In use" } else { "Use" };
    let button = Button::new(text).min_size(vec2(52.0, 0.0));
    let response = ui
        .add_enabled(!in_use && !refused, button)
        .accessible_name(format!("{text}: {name}"))
        .on_hover_text(format!("Set the toggles of the edited side to {name}. This can be undone."))
        .on_disabled_hover_text(match in_use {
            true => "The edited side has these toggles.",
            false => "This strategy cannot be rendered with the current advanced settings.",
        });
    if response.clicked() {
        *strategy = trial.strategy;
        editor.name_edit(format!("strategy {name}"));
    }
}

/// Time and noise, or why there are none of its own.
fn figures(ui: &mut Ui, entry: &RankedTrial) {
    if let Some(note) = note(entry) {
        let short = match entry.trial.source {
            TrialSource::SameAs { twin, .. } => format!("as {}", twin.name()),
            _ => "not rendered".to_owned(),
        };
        ui.label(RichText::new(short).color(color::TEXT_DIM)).on_hover_text(note);
        return;
    }
    let time = entry.over_baseline.as_ref().map(relative_time);
    let noise = entry.side.and_then(|side| side.noise).map(percent);
    for figure in [time, noise] {
        ui.label(figure.unwrap_or_else(|| "–".to_owned()));
    }
}

/// Shows the gain of each toggle alone, and the loss without it.
fn worths(ui: &mut Ui, ranking: &Ranking) {
    Grid::new("toggles").num_columns(3).spacing([space::ROW * 4.0, 3.0]).show(ui, |ui| {
        heading(ui, "toggle", "");
        heading(
            ui,
            "alone, relative to baseline",
            "Time to the same noise with this toggle alone, relative to baseline: below 1 it \
             helps.",
        );
        heading(
            ui,
            "left out, relative to full",
            "Time to the same noise without this toggle, relative to full: above 1 it is missed.",
        );
        ui.end_row();
        for Worth { toggle, alone, left_out } in &ranking.worths {
            ui.label(toggle.name());
            gain(ui, alone);
            gain(ui, left_out);
            ui.end_row();
        }
    });
}

fn gain(ui: &mut Ui, gain: &Gain) {
    ui.scope(|ui| {
        ui.set_min_width(TIME);
        match gain {
            Gain::Of(speed_up) => ui.label(relative_time(speed_up)),
            Gain::Nothing(why) => {
                let text = RichText::new("no effect").color(color::TEXT_DIM);
                ui.label(text).on_hover_text(*why)
            }
            Gain::Unknown => ui.label(RichText::new("unknown").color(color::TEXT_DIM)),
        }
    });
}

/// Field for the time per strategy, and the button that runs the sweep again.
fn again(ui: &mut Ui, sweep: &mut Sweep, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let help = "CPU time for each strategy. Four times the time halves the errors.";
        let label = row_label(ui, "Time for each", help);
        let field = DragValue::new(&mut sweep.seconds)
            .range(0.1..=600.0)
            .speed(0.05)
            .suffix(" s")
            .custom_formatter(|value, _| significant(value))
            .custom_parser(finite);
        ui.add_sized([space::NUMBER, space::ROW_HEIGHT], field)
            .labelled_by(label.id)
            .on_hover_text(help);
        let key = key_of(ui, Command::Sweep);
        let help = format!("{}  [{key}]", Command::Sweep.tooltip());
        let button = ui.add_enabled(!sweep.is_running(), Button::new("Sweep again"));
        if button.on_hover_text(help).on_disabled_hover_text("A sweep is running.").clicked() {
            commands.push(Command::Sweep);
        }
    });
}

fn heading(ui: &mut Ui, text: &str, help: &str) {
    let label = ui.label(RichText::new(text).small().color(color::TEXT_DIM));
    if !help.is_empty() {
        label.on_hover_text(help);
    }
}
