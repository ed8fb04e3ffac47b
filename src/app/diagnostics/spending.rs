//! Tables of the time of a render: the share of each kind of work, and the samples that the pilot
//! pass has found to pay at each bounce.

use egui::{Align, Grid, Label, Layout, RichText, Ui, vec2};

use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::explain;
use crate::format::{percent, rounded};
use crate::transport::learned_counts::BounceClass;
use crate::transport::spending::{BounceCounts, Spending, Work};

/// Share of the time below which work has no row.
const LEAST_SHARE: f32 = 0.005;
/// Width of a column of numbers.
const COLUMN: f32 = 54.0;

/// Shows both tables.
pub fn show(ui: &mut Ui, spending: &Spending) {
    ui.add_space(space::TIGHT);
    ui.label("Where the time goes");
    explain(ui, "Shares of the render time in this shot, by counted steps.");
    grid(ui, "time", |ui| {
        for (work, share) in Work::ALL.into_iter().zip(spending.shares) {
            if share >= LEAST_SHARE {
                name(ui, work.name());
                number(ui, &percent(f64::from(share)));
                ui.end_row();
            }
        }
    });
    ui.add_space(space::TIGHT);
    ui.label("Samples at each bounce");
    explain(ui, "Bounces of one camera sample, and the samples found to pay at each.");
    grid(ui, "samples", |ui| {
        name(ui, "");
        for heading in ["bounces", "fires", "lights", "emission"] {
            number(ui, heading);
        }
        ui.end_row();
        for class in BounceClass::ALL {
            let counts = spending.bounces[class as usize];
            if counts.vertices > 0.0 {
                row(ui, class, counts);
            }
        }
    });
}

fn grid(ui: &mut Ui, id: &str, rows: impl FnOnce(&mut Ui)) {
    Grid::new(("spending", id)).spacing(vec2(space::TIGHT, 2.0)).show(ui, rows);
}

fn row(ui: &mut Ui, class: BounceClass, BounceCounts { vertices, samples }: BounceCounts) {
    name(ui, class_name(class));
    number(ui, &rounded(f64::from(vertices), 2));
    for count in samples {
        number(ui, &rounded(f64::from(count), 2));
    }
    ui.end_row();
}

fn class_name(class: BounceClass) -> &'static str {
    match class {
        BounceClass::Camera => "camera",
        BounceClass::FirstInMedium => "first, in smoke",
        BounceClass::FirstOnSurface => "first, on surfaces",
        BounceClass::LaterInMedium => "later, in smoke",
        BounceClass::LaterOnSurface => "later, on surfaces",
    }
}

fn name(ui: &mut Ui, text: &str) {
    ui.add(Label::new(RichText::new(text).small().color(color::TEXT_DIM)).extend());
}

fn number(ui: &mut Ui, text: &str) {
    let layout = Layout::right_to_left(Align::Center);
    ui.allocate_ui_with_layout(vec2(COLUMN, space::ROW_HEIGHT), layout, |ui| {
        ui.add(Label::new(RichText::new(text).small().color(color::TEXT_STRONG)).extend());
    });
}
