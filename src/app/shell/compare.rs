//! Commands that begin, change and end a comparison.

use super::app::App;

impl App {
    /// Compares two strategies, or ends a comparison, be it of strategies or with a snapshot.
    pub(super) fn compare_or_end(&mut self) {
        if self.compare.versus.is_some() {
            self.snapshots.strip.show(None);
            return;
        }
        let document = &mut self.editor.document;
        match document.compared {
            None => document.compare(),
            Some(_) => document.compared = None,
        }
        self.editor.name_edit("comparison");
    }

    /// Edits the other side from now on.
    pub(super) fn switch_side(&mut self) {
        self.editor.document.switch_side();
        self.editor.name_edit("edited side");
    }

    /// Exchanges A and B.
    pub(super) fn swap_sides(&mut self) {
        if let Some(side) = self.compare.versus {
            self.compare.versus = Some(side.other());
            return;
        }
        self.editor.document.swap_sides();
        self.editor.name_edit("swap of A and B");
    }

    /// Gives the other side the strategy of the edited one.
    pub(super) fn copy_side(&mut self) {
        self.editor.document.copy_to_other_side();
        self.editor.name_edit("copy to the other side");
    }
}
