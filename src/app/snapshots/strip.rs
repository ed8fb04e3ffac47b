//! The snapshots in a row with the live picture at its end: which one is shown, names and notes,
//! deleting and taking that back. Pure logic; what the disk has to do is handed out as jobs.

use std::sync::Arc;

use egui::{ColorImage, TextureHandle};

use super::disk::{DiskJob, SnapshotWithThumbnail};
use super::record::{LONGEST_NAME, LONGEST_NOTE, Record};
use super::store::StoredSnapshot;
use crate::render::Picture;

/// Bytes of pictures that are held ready to be flipped to.
const READY_BYTES: usize = 512 << 20;

/// A snapshot in the strip.
pub struct StripItem {
    /// The snapshot as it is on the disk.
    pub entry: StoredSnapshot,
    /// Name and note as they are being edited, and the figures.
    pub record: Record,
    /// The small picture.
    pub thumbnail: Option<SmallPicture>,
    picture: Option<Arc<Picture>>,
    unreadable: bool,
}

/// A small picture on its way to the graphics card.
pub enum SmallPicture {
    /// The picture is not on the graphics card yet.
    Waiting(ColorImage),
    /// The picture is on the graphics card.
    Ready(TextureHandle),
}

/// The snapshots, the oldest first.
#[derive(Default)]
pub struct Strip {
    items: Vec<StripItem>,
    /// The place of the one shown; none: the live picture.
    shown: Option<usize>,
    /// The deleted snapshots, the latest last, each with the place it had.
    deleted: Vec<(usize, StripItem)>,
    /// Whether another picture is shown since the strip was last drawn.
    moved: bool,
    /// Whether the picture shown should bring its variance along.
    pub wants_variance: bool,
    /// Whether the user wants to see the strip; `None`: once there is something in it.
    open: Option<bool>,
}

impl StripItem {
    fn new((entry, thumbnail): SnapshotWithThumbnail) -> Self {
        let record = entry.record.clone();
        let thumbnail = thumbnail.map(SmallPicture::Waiting);
        Self { entry, record, thumbnail, picture: None, unreadable: false }
    }

    /// Picture of the snapshot, once it is read.
    pub fn picture(&self) -> Option<&Arc<Picture>> {
        self.picture.as_ref()
    }
}

impl Strip {
    /// Adds the snapshots of earlier runs.
    pub fn fill(&mut self, earlier: Vec<SnapshotWithThumbnail>) {
        let count = earlier.len();
        self.items.splice(0..0, earlier.into_iter().map(StripItem::new));
        self.shown = self.shown.map(|index| index + count);
    }

    /// Takes in a new snapshot; what is shown stays.
    pub fn push(&mut self, kept: SnapshotWithThumbnail, picture: Arc<Picture>) {
        self.items.push(StripItem { picture: Some(picture), ..StripItem::new(kept) });
        self.let_go();
    }

    /// Forgets snapshots that are gone from the disk.
    pub fn remove(&mut self, gone: &[StoredSnapshot]) {
        gone.iter().for_each(|entry| self.lose(&entry.id));
    }

    /// Forgets a snapshot that is gone from the disk.
    pub fn lose(&mut self, id: &str) {
        let shown = self.shown_item().map(|item| item.entry.id.clone());
        self.items.retain(|item| item.entry.id != id);
        self.shown = shown.and_then(|id| self.place_of(&id));
    }

    /// All snapshots, the oldest first.
    pub fn items_mut(&mut self) -> &mut [StripItem] {
        &mut self.items
    }

    /// All snapshots, the oldest first.
    pub fn items(&self) -> &[StripItem] {
        &self.items
    }

    /// The snapshot in the folder `id`.
    pub fn find(&self, id: &str) -> Option<&StripItem> {
        self.items.iter().find(|item| item.entry.id == id)
    }

    fn place_of(&self, id: &str) -> Option<usize> {
        self.items.iter().position(|item| item.entry.id == id)
    }

    /// The place of the snapshot shown; none: the live picture.
    pub fn shown(&self) -> Option<usize> {
        self.shown
    }

    /// The snapshot shown.
    pub fn shown_item(&self) -> Option<&StripItem> {
        self.shown.and_then(|index| self.items.get(index))
    }

    /// The snapshot shown, to edit its name and note.
    pub fn shown_item_mut(&mut self) -> Option<&mut StripItem> {
        self.shown.and_then(|index| self.items.get_mut(index))
    }

    /// Shows the snapshot at this place, or the live picture.
    pub fn show(&mut self, index: Option<usize>) {
        self.shown = index.filter(|&index| index < self.items.len());
        self.moved = true;
    }

    /// Whether the picture shown has changed since this was last asked.
    pub fn take_moved(&mut self) -> bool {
        std::mem::take(&mut self.moved)
    }

    /// Flips to the one before; the live picture comes after the newest.
    pub fn show_previous(&mut self) {
        let before = self.shown.unwrap_or(self.items.len());
        self.show(before.checked_sub(1).or(self.shown));
    }

    /// Flips to the one after.
    pub fn show_next(&mut self) {
        self.show(self.shown.map(|index| index + 1));
    }

    /// Whether the strip is on the screen.
    pub fn is_open(&self) -> bool {
        self.open.unwrap_or(!self.items.is_empty())
    }

    /// Shows or folds the strip.
    pub fn toggle(&mut self) {
        self.open = Some(!self.is_open());
    }

    /// The picture that the disk should be asked to read: the one shown, or one that is a key away.
    pub fn wanted(&self) -> Option<DiskJob> {
        let shown = self.shown?;
        let near = [Some(shown), shown.checked_sub(1), Some(shown + 1)];
        let items = near.into_iter().flatten().filter_map(|index| self.items.get(index));
        let missing = |item: &&StripItem| item.picture.is_none() && !item.unreadable;
        if self.wants_variance
            && let Some(item) = self.shown_item()
            && !item.unreadable
            && item.picture.as_ref().is_none_or(|picture| picture.variance.is_empty())
        {
            return Some(DiskJob::ReadWithVariance(item.entry.clone()));
        }
        items.into_iter().find(missing).map(|item| DiskJob::Read(item.entry.clone()))
    }

    /// Takes in a picture, or that there is none. Whether it was to be shown now.
    pub fn take_in(&mut self, id: &str, picture: Option<Arc<Picture>>) -> bool {
        let Some(index) = self.place_of(id) else { return false };
        self.items[index].unreadable = picture.is_none();
        self.items[index].picture = picture;
        self.let_go();
        self.shown == Some(index)
    }

    /// Lets go of the pictures farthest from the one shown while they take too much memory.
    fn let_go(&mut self) {
        let size = |item: &StripItem| {
            item.picture.as_ref().map_or(0, |picture| {
                size_of_val(picture.pixels.as_slice()) + size_of_val(picture.variance.as_slice())
            })
        };
        let center = self.shown.unwrap_or(self.items.len());
        let mut places: Vec<usize> = (0..self.items.len()).collect();
        places.sort_by_key(|place| place.abs_diff(center));
        let mut total = 0;
        for place in places {
            let item = &mut self.items[place];
            total += size(item);
            if total > READY_BYTES && place.abs_diff(center) > 1 {
                item.picture = None;
            }
        }
    }

    /// Deletes the snapshot shown and shows the next.
    pub fn delete(&mut self) -> Option<DiskJob> {
        let index = self.shown.filter(|&index| index < self.items.len())?;
        let item = self.items.remove(index);
        let job = DiskJob::Delete(item.entry.id.clone());
        self.deleted.push((index, item));
        self.show(Some(index));
        Some(job)
    }

    /// Brings the snapshot deleted last back and shows it.
    pub fn undo_delete(&mut self) -> Option<DiskJob> {
        let (index, item) = self.deleted.pop()?;
        let job = DiskJob::Restore(item.entry.id.clone());
        let index = index.min(self.items.len());
        self.items.insert(index, item);
        self.show(Some(index));
        Some(job)
    }

    /// The name of the snapshot deleted last.
    pub fn last_deleted(&self) -> Option<&str> {
        self.deleted.last().map(|(_, item)| item.record.name.as_str())
    }

    /// Forgets what was deleted, and has it removed for good.
    pub fn forget_deleted(&mut self) -> Option<DiskJob> {
        let ids: Vec<String> = self.deleted.drain(..).map(|(_, item)| item.entry.id).collect();
        (!ids.is_empty()).then_some(DiskJob::Forget(ids))
    }

    /// The names and notes edited since, to be written down. An empty name becomes what it was.
    pub fn edited(&mut self) -> Vec<DiskJob> {
        let mut jobs = Vec::new();
        for item in &mut self.items {
            if item.record == item.entry.record {
                continue;
            }
            item.record.note = cut(&item.record.note, LONGEST_NOTE);
            item.record.name = match cut(&item.record.name, LONGEST_NAME) {
                name if name.is_empty() => item.entry.record.name.clone(),
                name => name,
            };
            if item.record != item.entry.record {
                item.entry.record = item.record.clone();
                jobs.push(DiskJob::Describe(item.entry.id.clone(), item.record.clone()));
            }
        }
        jobs
    }

    /// `name`, with a number where there is one of that name already.
    pub fn free_name(&self, name: &str) -> String {
        let is_free = |name: &String| self.items.iter().all(|item| item.record.name != *name);
        let numbered = (2..).map(|number| format!("{name} {number}"));
        std::iter::once(name.to_owned()).chain(numbered).find(is_free).unwrap_or_default()
    }

    /// Size of all snapshots on the disk, in bytes.
    pub fn bytes(&self) -> u64 {
        self.items.iter().map(|item| item.entry.bytes).sum()
    }
}

/// A line of text without blanks around it and control characters in it.
fn cut(text: &str, longest: usize) -> String {
    let line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    line.trim().chars().take(longest).collect::<String>().trim_end().to_owned()
}

#[cfg(test)]
mod tests;
