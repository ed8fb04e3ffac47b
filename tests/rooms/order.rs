//! The order of rooms as a table, and the arrows that run against it.

use std::collections::BTreeMap;

use crate::arrows::Arrows;
use crate::circles::arrow;

/// The order of what lies in a folder.
pub struct Order<'t> {
    /// The folder whose files are in this order.
    pub folder: &'t str,
    /// Names of rooms, the lowest layer first. `probes` names the file `probes.rs` with all files
    /// of the folder `probes`; a file belongs to the longest name that names it. The rooms of one
    /// layer know nothing of each other.
    pub layers: &'t [&'t [&'t str]],
}

impl Order<'_> {
    /// All that is against this order: files without a room, rooms without a file, and arrows
    /// that run up or sideways.
    pub fn faults<'f>(
        &self,
        files: impl IntoIterator<Item = &'f str>,
        arrows: &Arrows,
    ) -> Vec<String> {
        let rooms = self.rooms();
        let mut faults = self.twice_named();
        let mut used: BTreeMap<&str, usize> = rooms.keys().map(|room| (*room, 0)).collect();
        for file in files.into_iter().filter(|file| self.holds(file)) {
            match self.room(file) {
                Some(room) => *used.entry(room).or_default() += 1,
                None => faults.push(format!("{file} is in no layer of {}", self.folder)),
            }
        }
        let empty = used.iter().filter(|(_, count)| **count == 0);
        let folder = self.folder;
        faults.extend(empty.map(|(room, _)| format!("{folder}/{room} is no file and no folder")));
        faults.extend(self.against(&rooms, arrows));
        faults
    }

    /// The room of a file; `None` outside the folder and for a file that no name fits.
    pub fn room(&self, file: &str) -> Option<&str> {
        let path = file.strip_prefix(self.folder)?.strip_prefix('/')?.strip_suffix(".rs")?;
        let fits = |room: &&&str| {
            path.strip_prefix(**room).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        let names = self.layers.iter().copied().flatten();
        names.filter(fits).max_by_key(|room| room.len()).copied()
    }

    fn holds(&self, file: &str) -> bool {
        file.strip_prefix(self.folder).is_some_and(|rest| rest.starts_with('/'))
    }

    fn rooms(&self) -> BTreeMap<&str, usize> {
        let layers = self.layers.iter().enumerate();
        layers.flat_map(|(layer, rooms)| rooms.iter().map(move |room| (*room, layer))).collect()
    }

    fn twice_named(&self) -> Vec<String> {
        let mut names: Vec<_> = self.layers.iter().copied().flatten().collect();
        names.sort();
        let twice = names.windows(2).filter(|pair| pair[0] == pair[1]);
        twice
            .map(|pair| format!("{} stands twice in the order of {}", pair[0], self.folder))
            .collect()
    }

    fn against(&self, rooms: &BTreeMap<&str, usize>, arrows: &Arrows) -> Vec<String> {
        let mut faults = Vec::new();
        for ((from, to), names) in arrows {
            let (Some(above), Some(below)) = (self.room(from), self.room(to)) else { continue };
            if above != below && rooms[above] <= rooms[below] {
                let way = if rooms[above] == rooms[below] { "sideways" } else { "up" };
                faults.push(format!("an arrow runs {way}: {}", arrow(from, to, names)));
            }
        }
        faults
    }
}
