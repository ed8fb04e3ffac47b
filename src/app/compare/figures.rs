//! Figures of the picture, or of A and B, in tables: of the whole picture, against the reference,
//! of a region.

use egui::{Grid, RichText, Ui};

use super::measure::{Measure, Plotted};
use super::noise_plot::{self, COLORS};
use crate::app::compare::reference::MeasuredReference;
use crate::app::compare::region_figures::RegionFigures;
use crate::app::compare::second_side::SecondSide;
use crate::app::ui::theme::color;
use crate::app::ui::widgets::{explain, row, segments};
use crate::format::rounded;
use crate::image::export;
use crate::image::metrics::Errors;
use crate::render::Area;
use crate::render::compare::{NoiseHistory, SideFigures};

/// Width of a column of figures.
const FIGURE: f32 = 52.0;

/// A column of a table: its heading, the meaning of its figures, and one cell per picture.
pub struct Column {
    heading: &'static str,
    help: &'static str,
    cells: Vec<String>,
}

impl Column {
    /// Number of cells of the column.
    pub fn count(&self) -> usize {
        self.cells.len()
    }

    /// Explanation of the column for its tooltip.
    pub fn help(&self) -> &'static str {
        self.help
    }

    /// Cell of the picture `index` with the heading of the column.
    pub fn in_words(&self, index: usize) -> String {
        let cell = self.cells.get(index).map_or("–", String::as_str);
        format!("{} {cell}", self.heading)
    }
}

/// Samples, time and noise.
pub fn of_sides(sides: &[SideFigures]) -> Vec<Column> {
    let column = |heading, help, cell: fn(&SideFigures) -> String| Column {
        heading,
        help,
        cells: sides.iter().map(cell).collect(),
    };
    vec![
        column("spp", "Samples per pixel.", |side| rounded(side.samples_per_pixel, 3)),
        column("CPU time", "CPU time of all render threads together.", |side| {
            format!("{} s", rounded(side.cpu_seconds, 3))
        }),
        noise(sides),
    ]
}

fn noise(sides: &[SideFigures]) -> Column {
    let help = "The relative standard error of the picture.";
    Column { heading: "noise", help, cells: sides.iter().map(noise_with_error).collect() }
}

/// Noise in percent with its standard error, which is half the relative one of the variance.
fn noise_with_error(side: &SideFigures) -> String {
    let (Some(noise), Some(variance), Some(error)) =
        (side.noise, side.variance_of_mean, side.variance_error)
    else {
        return "–".to_owned();
    };
    let error = if variance > 0.0 { 0.5 * error / variance } else { 0.0 };
    format!("{} ± {} %", rounded(100.0 * noise, 3), rounded(100.0 * noise * error, 1))
}

/// Errors against the reference, over an area or over all.
pub fn of_errors(errors: &[Errors], area: Option<Area>) -> Vec<Column> {
    let column = |measure: Measure, help| Column {
        heading: measure.name(),
        help,
        cells: errors.iter().map(|errors| rounded(measure.mean(errors, area), 3)).collect(),
    };
    vec![
        column(Measure::RelMse, "The relative mean squared error (relMSE), in linear light."),
        column(
            Measure::Flip,
            "The difference one perceives when flipping between the displayed pictures (FLIP): 0 \
             is none, 1 the largest.",
        ),
    ]
}

/// Columns of a region: the noise, and the errors where there are any.
pub fn of_region(region: &RegionFigures, errors: Option<&[Errors]>) -> Vec<Column> {
    let mut columns = vec![noise(&region.sides)];
    if let Some(errors) = errors {
        columns.extend(of_errors(errors, Some(region.area)));
    }
    columns
}

/// The columns as a table to be drawn, `corner` above the names of its rows.
pub fn table(corner: &str, names: &[&str], columns: &[Column]) -> export::FigureTable {
    let headings = columns.iter().map(|column| column.heading.to_owned());
    let rows = names.iter().enumerate().map(|(index, name)| {
        let cells = columns.iter().filter_map(|column| column.cells.get(index).cloned());
        std::iter::once((*name).to_owned()).chain(cells).collect()
    });
    export::FigureTable {
        headings: std::iter::once(corner.to_owned()).chain(headings).collect(),
        rows: rows.collect(),
    }
}

/// The title of the figures of a region.
pub fn region_title(area: &Area) -> String {
    format!("Region of {} × {} pixels", area.size.x, area.size.y)
}

/// The names of the rows.
pub fn names(count: usize) -> &'static [&'static str] {
    if count > 1 { &["A", "B"] } else { &[""] }
}

/// Shows the figures of A and B, and how noise and errors fell over time. Those of a single picture
/// stand below it instead.
pub fn show(ui: &mut Ui, second_side: &SecondSide, reference: &mut MeasuredReference) {
    let both = second_side.comparison();
    if let Some(both) = both {
        let errors = reference.errors();
        grid(ui, "sides", &of_sides(&both.sides));
        if let Some(errors) = errors {
            grid(ui, "errors", &of_errors(errors, None));
        }
        if let Some(region) = second_side.region_figures() {
            explain(ui, &region_title(&region.area));
            grid(ui, "region", &of_region(region, errors));
        }
    }
    if both.is_some() || reference.loaded().is_some() {
        over_time(ui, reference, both.map(|_| second_side.histories()));
    }
}

fn grid(ui: &mut Ui, id: &str, columns: &[Column]) {
    let count = columns.first().map_or(0, |column| column.cells.len());
    Grid::new(id).num_columns(columns.len() + 1).min_col_width(FIGURE).show(ui, |ui| {
        ui.label("");
        for column in columns {
            let text = RichText::new(column.heading).small().color(color::TEXT_DIM);
            ui.label(text).on_hover_text(column.help);
        }
        ui.end_row();
        for (index, (name, tint)) in std::iter::zip(names(count), COLORS).enumerate() {
            ui.label(RichText::new(*name).color(tint));
            for cell in columns.iter().filter_map(|column| column.cells.get(index)) {
                ui.label(cell);
            }
            ui.end_row();
        }
    });
}

/// Plot of noise and errors over time; `noise` is that of A and B where there are two.
fn over_time(ui: &mut Ui, reference: &mut MeasuredReference, noise: Option<&[NoiseHistory; 2]>) {
    let errors = Measure::ALL.map(Plotted::Error);
    let first = noise.map(|_| Plotted::Noise);
    let mut all: Vec<Plotted> = first.into_iter().collect();
    if reference.loaded().is_some() {
        all.extend(errors);
    }
    let place = all.iter().position(|plotted| *plotted == reference.plotted).unwrap_or(0);
    if all.len() > 1 {
        let choices: Vec<(&str, &str)> =
            all.iter().map(|plotted| (plotted.name(), plotted.help())).collect();
        let help = "The quantity plotted over CPU time.";
        if let Some(index) =
            row(ui, "Over time", help, |ui| segments(ui, &choices, Some(place))).inner
        {
            reference.plotted = all[index];
        }
    }
    let Some(&plotted) = all.get(place) else { return };
    match (plotted, noise) {
        (Plotted::Noise, Some(noise)) => noise_plot::show(ui, noise.each_ref(), plotted),
        (Plotted::Noise, None) => {}
        (Plotted::Error(measure), _) => {
            noise_plot::show(ui, reference.histories(measure), plotted);
        }
    }
}
