//! A comparison in sentences and tables, for a file.

use super::figures::{names, of_errors, of_region, of_sides, region_title, table};
use super::panel::{disagreement, side_title};
use super::state::CompareState;
use crate::app::document::{Document, Side};
use crate::image::export::FigureTable;

/// The titles of A and B; none where there is one picture.
pub fn side_titles(compare: &CompareState, document: &Document) -> Vec<String> {
    let sides = compare.second_side.is_on().then_some([Side::A, Side::B]);
    sides
        .into_iter()
        .flatten()
        .map(|side| side_title(side, document, &compare.second_side))
        .collect()
}

/// Sentences about A and B: their agreement and speed, in all of the picture and in the region.
pub fn sentences(compare: &CompareState, document: &Document) -> Vec<String> {
    let mut words = Vec::new();
    let titles = side_titles(compare, document);
    if !titles.is_empty() {
        words.push(format!("{}.", titles.join(". ")));
    }
    if let Some(comparison) = compare.second_side.comparison() {
        words.push(format!("{}.", comparison.sentence()));
        words.extend(disagreement(comparison, compare.biased(document)));
    }
    if let Some(region) = compare.second_side.region_figures() {
        let told = region.comparison.as_ref().map(|both| format!(": {}", both.sentence()));
        let title = region_title(&region.area);
        words.push(format!("{title}{}.", told.unwrap_or_default()));
    }
    words
}

/// The figures of all of the picture and of the region, of so many pictures.
pub fn tables(compare: &CompareState, pictures: usize) -> Vec<FigureTable> {
    let names = names(pictures);
    let errors = compare.reference.errors();
    let sides = compare.second_side.comparison().map(|both| of_sides(&both.sides));
    let mut columns = sides.unwrap_or_default();
    columns.extend(errors.iter().flat_map(|errors| of_errors(errors, None)));
    let mut tables = Vec::new();
    if !columns.is_empty() {
        tables.push(table("", names, &columns));
    }
    if let Some(region) = compare.second_side.region_figures() {
        tables.push(table("region", names, &of_region(region, errors)));
    }
    tables
}
