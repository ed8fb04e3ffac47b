//! Undo and redo: whole states with the names of the edits between them.

/// Number of edits that can be taken back.
const LIMIT: usize = 200;

/// A continuous action of the user, such as a drag: its changes undo as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gesture(pub u64);

/// The states before and after the present one.
#[derive(Debug)]
pub struct History<T> {
    undo: Vec<UndoStep<T>>,
    redo: Vec<UndoStep<T>>,
}

#[derive(Debug)]
struct UndoStep<T> {
    name: String,
    gesture: Gesture,
    /// State on the other side of the edit.
    state: T,
}

impl<T> Default for History<T> {
    fn default() -> Self {
        Self { undo: Vec::new(), redo: Vec::new() }
    }
}

impl<T> History<T> {
    /// Remembers that the edit `name` led away from `before`. Further changes of the same name
    /// within one gesture belong to the same edit.
    pub fn record(&mut self, before: T, name: &str, gesture: Gesture) {
        self.redo.clear();
        if self.undo.last().is_some_and(|last| last.name == name && last.gesture == gesture) {
            return;
        }
        if self.undo.len() == LIMIT {
            self.undo.remove(0);
        }
        self.undo.push(UndoStep { name: name.to_owned(), gesture, state: before });
    }

    /// Takes the last edit back: the state before it, given the present one.
    pub fn undo(&mut self, present: T) -> Result<T, T> {
        step(&mut self.undo, &mut self.redo, present)
    }

    /// Makes the last edit taken back again, given the present state.
    pub fn redo(&mut self, present: T) -> Result<T, T> {
        step(&mut self.redo, &mut self.undo, present)
    }

    /// The name of the edit that [`Self::undo`] takes back.
    pub fn undo_name(&self) -> Option<&str> {
        self.undo.last().map(|entry| entry.name.as_str())
    }

    /// The name of the edit that [`Self::redo`] makes again.
    pub fn redo_name(&self) -> Option<&str> {
        self.redo.last().map(|entry| entry.name.as_str())
    }
}

/// Moves the last entry of `from` to `to`, exchanging its state with the present one; gives the
/// present state back as an error where there is nothing to move.
fn step<T>(from: &mut Vec<UndoStep<T>>, to: &mut Vec<UndoStep<T>>, present: T) -> Result<T, T> {
    let Some(mut entry) = from.pop() else { return Err(present) };
    let state = std::mem::replace(&mut entry.state, present);
    to.push(entry);
    Ok(state)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drag_is_one_edit_and_two_drags_are_two() {
        let mut history = History::default();
        history.record(0, "density", Gesture(1));
        history.record(1, "density", Gesture(1));
        history.record(2, "density", Gesture(2));
        assert_eq!(history.undo(3), Ok(2));
        assert_eq!(history.undo(2), Ok(0));
        assert_eq!(history.undo(0), Err(0));
        assert_eq!(history.redo(0), Ok(2));
        assert_eq!(history.redo_name(), Some("density"));
    }

    #[test]
    fn another_name_in_the_same_gesture_is_another_edit() {
        let mut history = History::default();
        history.record(0, "density", Gesture(1));
        history.record(1, "albedo", Gesture(1));
        assert_eq!(history.undo_name(), Some("albedo"));
        assert_eq!(history.undo(2), Ok(1));
    }

    #[test]
    fn an_edit_after_an_undo_forgets_what_was_undone() {
        let mut history = History::default();
        history.record(0, "a", Gesture(1));
        assert_eq!(history.undo(1), Ok(0));
        history.record(0, "b", Gesture(2));
        assert_eq!(history.redo(5), Err(5));
        assert_eq!(history.undo(5), Ok(0));
    }

    #[test]
    fn the_oldest_edits_fall_off() {
        let mut history = History::default();
        for state in 0..LIMIT + 10 {
            history.record(state, "step", Gesture(state as u64));
        }
        let mut state = LIMIT + 10;
        while let Ok(before) = history.undo(state) {
            state = before;
        }
        assert_eq!(state, 10);
    }
}
