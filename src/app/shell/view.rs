//! The view on the screen, with its figures in words and tables, to be saved.

use egui::Context;

use super::app::App;
use crate::app::compare::report;
use crate::app::diagnostics::Legend;
use crate::app::picture::viewport::Shown;
use crate::app::shell::export::SavedView;

impl App {
    /// The view on the screen.
    pub(super) fn saved_view(&self, ctx: &Context) -> SavedView {
        let shown = self.shown(ctx);
        let names = self.names_of(&shown);
        let legend = self.legend(&shown);
        SavedView {
            shown,
            names,
            legend,
            area: self.compare.second_side.region_figures().map(|region| region.area),
            words: report::sentences(&self.compare, &self.editor.document),
            tables: report::tables(&self.compare, self.looked_at().len()),
        }
    }

    /// Names of the pictures that are shown, where there are two.
    pub(super) fn names_of(&self, shown: &Shown) -> Vec<String> {
        match shown {
            Shown::Wipe(..) | Shown::Beside(..) => {
                report::side_titles(&self.compare, &self.editor.document)
            }
            Shown::One(..) | Shown::Nothing => Vec::new(),
        }
    }

    /// The legend of what is shown, where its colors are not those of the picture.
    pub(super) fn legend(&self, shown: &Shown) -> Option<Legend> {
        let map = self.compare.map().map(|map| Legend::of_map(map.kind, map.key));
        map.or_else(|| shown.is_false_color().then(Legend::of_stops))
            .or_else(|| self.diagnostics.legend(shown.look()))
    }
}
