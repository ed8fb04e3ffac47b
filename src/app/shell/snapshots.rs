//! Snapshots in the window: keeping the picture, flipping through the strip, going on from one.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{Context, Ui};

use super::app::App;
use crate::app::compare::second_side::StoredSide;
use crate::app::document::Side;
use crate::app::jobs::dialogs::Purpose;
use crate::app::shell::save::Content;
use crate::app::snapshots::{Keep, StripItem, strategy};
use crate::app::ui::theme;
use crate::render::Picture;

/// Largest number of pictures on their way to the disk, each of which takes the memory of its film.
const MOST_AT_ONCE: usize = 2;

impl App {
    /// Brings the strip in line with the disk, and keeps the picture where that was asked for.
    pub(super) fn update_snapshots(&mut self, ctx: &Context) {
        self.snapshots.update(ctx.text_edit_focused(), &mut self.notices);
        // The film of an edit that is being built is about to become that of another scene.
        let may_keep = !self.live_render.is_building() && self.snapshots.keeping() < MOST_AT_ONCE;
        if self.snapshots.wants_keep && may_keep {
            self.snapshots.wants_keep = false;
            self.keep();
        }
    }

    fn keep(&mut self) {
        let live_render = self.compare.second_side.edited(&self.live_render);
        let (Some(settings), Some(picture)) = (live_render.rendered(), live_render.picture())
        else {
            self.notices.failed("There is no picture to keep yet.");
            return;
        };
        let (title, strategy) = (self.opened.short_title(), strategy(settings));
        let name = match title.ends_with(&strategy) {
            true => title,
            false => format!("{title} {strategy}"),
        };
        let keep = Keep {
            settings: settings.clone(),
            seconds: picture.stats.seconds,
            cpu_seconds: picture.stats.cpu_seconds,
            tone: self.editor.document.tone,
            name: self.snapshots.strip.free_name(&name),
            film: live_render.session().snapshot(),
        };
        self.snapshots.keep(keep);
    }

    /// Name of a source: of a snapshot of the strip its own.
    pub(super) fn name_of(&self, source: String) -> String {
        self.snapshots.name_of(Path::new(&source)).map_or(source.clone(), str::to_owned)
    }

    /// The picture in the viewport: a snapshot, or the live one.
    pub(super) fn shown_picture(&self) -> Option<&Arc<Picture>> {
        self.snapshots.picture().or_else(|| self.live_render.picture())
    }

    /// Shows the snapshot after the one shown. Past the last one comes the live picture, except
    /// where both are compared and the live one is in sight already.
    pub(super) fn show_next_snapshot(&mut self) {
        if self.compare.versus.is_none() || !self.is_last_shown() {
            self.snapshots.strip.show_next();
        }
    }

    fn is_last_shown(&self) -> bool {
        self.snapshots
            .strip
            .shown()
            .is_some_and(|index| index + 1 == self.snapshots.strip.items().len())
    }

    /// Compares the snapshot shown, as that side, with the live picture. What two strategies were
    /// compared before goes on with the one that was edited.
    pub(super) fn set_against_live(&mut self, side: Side) {
        if self.snapshots.strip.shown().is_none() {
            self.notices.failed(
                "No snapshot is shown to compare with. Press K to keep one and the left arrow to \
                 show it.",
            );
            return;
        }
        self.compare.versus = Some(side);
        let document = &mut self.editor.document;
        if document.compared.take().is_some() {
            self.editor.name_edit("comparison");
        }
    }

    /// Brings the second side in line with the snapshot that is compared, if one is.
    pub(super) fn update_versus(&mut self) {
        let shown = self.snapshots.strip.shown_item();
        self.compare.versus = self.compare.versus.filter(|_| shown.is_some());
        if self.editor.document.compared.is_some() {
            // An edit or an undo began a comparison of strategies.
            self.compare.versus = None;
        }
        self.compare.second_side.stored =
            self.compare.versus.zip(shown).map(|(side, item)| StoredSide {
                side,
                name: item.record.name.clone(),
                picture: item.picture().filter(|picture| !picture.variance.is_empty()).cloned(),
                is_biased: item.record.strategy.ends_with("biased"),
            });
        // Noise is shown of both sides, and of a region.
        let measures = self.compare.versus.is_some() || self.compare.region.is_set();
        self.snapshots.strip.wants_variance = measures;
    }

    pub(super) fn go_on_from_shown(&mut self) {
        let shown = self.snapshots.strip.shown_item();
        if let Some(file) = shown.and_then(|item| self.snapshots.file(item)) {
            self.open_or_ask(&crate::files::name_of(&file));
        }
    }

    /// The snapshot that is to be saved, where that is not the live picture.
    fn subject(&self) -> Option<&StripItem> {
        self.files.subject.as_ref().and_then(|id| self.snapshots.strip.find(id))
    }

    /// The name to suggest for a file of what is to be saved.
    pub(super) fn suggested_name(&self, purpose: Purpose) -> PathBuf {
        let extension = purpose.extensions().first().copied().unwrap_or_default();
        match self.subject() {
            // Not as an extension: a name may hold dots, and what would be folders.
            Some(item) => {
                let name = item.record.name.replace(['/', '\\', ':'], "-");
                format!("{name}.{extension}").into()
            }
            None => {
                let title = self.opened.short_title();
                let number = if purpose == Purpose::SaveFlipbook { ".####" } else { "" };
                format!("{title}{number}.{extension}").into()
            }
        }
    }

    /// The content to save of the snapshot that was shown when it was asked for; `None` where it is
    /// not there (any more).
    pub(super) fn snapshot_content(&self, purpose: Purpose) -> Option<Content> {
        let item = self.subject()?;
        match purpose {
            Purpose::SaveExr => Some(Content::Copy(self.snapshots.file(item)?)),
            Purpose::SavePng => {
                let (picture, tone) = (item.picture()?.clone(), self.editor.document.tone);
                Some(Content::Shown { picture, tone })
            }
            _ => None,
        }
    }

    /// The strip under the picture, where it is wanted.
    pub(super) fn strip_row(&mut self, ui: &mut Ui) {
        if !self.snapshots.strip.is_open() {
            return;
        }
        let live = self.live_render.picture().cloned();
        let panel = egui::Panel::bottom("snapshots").frame(theme::panel_frame());
        let asked = panel
            .show(ui, |ui| {
                crate::app::snapshots::panel::show(ui, &mut self.snapshots, live.as_ref())
            })
            .inner;
        let ctx = ui.ctx().clone();
        for command in asked {
            self.execute(&ctx, command);
        }
    }
}
