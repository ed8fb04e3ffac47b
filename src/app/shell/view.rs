//! The view as it is, with its figures in words and tables, to be saved.

use egui::Context;

use super::App;
use crate::app::compare::figures::{names, of_errors, of_part, of_sides, rectangle_title, table};
use crate::app::compare::panel::{disagreement, side_title};
use crate::app::diagnostics::Legend;
use crate::app::document::Side;
use crate::app::picture::viewport::Shown;
use crate::app::shell::export::SavedView;
use crate::image::export::FigureTable;

impl App {
    /// The view as it is.
    pub(super) fn saved_view(&self, ctx: &Context) -> SavedView {
        let shown = self.shown(ctx);
        let names = match shown {
            Shown::Wipe(..) | Shown::Beside(..) => self.side_titles(),
            Shown::One(..) | Shown::Nothing => Vec::new(),
        };
        let legend = self.legend(&shown);
        SavedView {
            shown,
            names,
            legend,
            area: self.second_side.part().map(|part| part.area),
            words: self.words(),
            tables: self.tables(),
        }
    }

    /// What the colors of what is shown mean, where they are not those of the picture.
    pub(super) fn legend(&self, shown: &Shown) -> Option<Legend> {
        let map = self.map().map(|map| Legend::of_map(map.kind, map.key));
        map.or_else(|| shown.is_false_color().then(Legend::of_stops))
            .or_else(|| self.diagnostics.legend(shown.look()))
    }

    /// What A and B are; nothing where there is one picture.
    fn side_titles(&self) -> Vec<String> {
        let document = &self.editor.document;
        let sides = self.second_side.is_on().then_some([Side::A, Side::B]);
        sides
            .into_iter()
            .flatten()
            .map(|side| side_title(side, document, &self.second_side))
            .collect()
    }

    /// What A and B say about each other, in all of the picture and in the rectangle.
    fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        let titles = self.side_titles();
        if !titles.is_empty() {
            words.push(format!("{}.", titles.join(". ")));
        }
        if let Some(comparison) = self.second_side.comparison() {
            words.push(format!("{}.", comparison.sentence()));
            words.extend(disagreement(comparison, self.biased()));
        }
        if let Some(part) = self.second_side.part() {
            let told = part.comparison.as_ref().map(|both| format!(": {}", both.sentence()));
            let title = rectangle_title(&part.area);
            words.push(format!("{title}{}.", told.unwrap_or_default()));
        }
        words
    }

    /// The figures of all of the picture and of the rectangle.
    fn tables(&self) -> Vec<FigureTable> {
        let names = names(self.looked_at().len());
        let errors = self.reference.errors();
        let sides = self.second_side.comparison().map(|both| of_sides(&both.sides));
        let mut columns = sides.unwrap_or_default();
        columns.extend(errors.iter().flat_map(|errors| of_errors(errors, None)));
        let mut tables = Vec::new();
        if !columns.is_empty() {
            tables.push(table("", names, &columns));
        }
        if let Some(part) = self.second_side.part() {
            tables.push(table("region", names, &of_part(part, errors)));
        }
        tables
    }
}
