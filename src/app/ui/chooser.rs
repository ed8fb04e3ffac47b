//! Choosing one of many things by its name, from a list that stays short.

use egui::{Button, Id, ScrollArea, TextEdit, Ui};

/// Height of the list, in points.
const HEIGHT: f32 = 132.0;

/// The state that the list was left in.
#[derive(Clone, Debug, Default)]
struct Memory {
    chosen: usize,
    /// The part of a name that is looked for.
    text: String,
}

/// Lists `names`, those that hold what is typed above them, and returns the chosen one's index; 0
/// until there is a choice. `what` says what they are the names of.
pub fn choose(ui: &mut Ui, what: &str, names: &[String]) -> usize {
    // Of another scene the choice is another one.
    let id = ui.make_persistent_id((what, names));
    let mut memory: Memory = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    memory.chosen = memory.chosen.min(names.len().saturating_sub(1));
    field(ui, what, &mut memory.text);
    list(ui, id, names, &mut memory);
    let chosen = memory.chosen;
    ui.data_mut(|data| data.insert_temp(id, memory));
    chosen
}

fn field(ui: &mut Ui, what: &str, text: &mut String) {
    let hint = format!("Find a {what}");
    let edit = TextEdit::singleline(text).hint_text(&hint).desired_width(f32::INFINITY);
    let field = ui.add(edit).accessible_name(hint);
    if field.gained_focus() {
        // Whoever types here wants to see the list below.
        let mut seen = field.rect;
        seen.max.y += HEIGHT;
        ui.scroll_to_rect(seen, None);
    }
}

fn list(ui: &mut Ui, id: Id, names: &[String], memory: &mut Memory) {
    let found = matching(names, &memory.text);
    if found.is_empty() {
        ui.weak("No name contains these letters.");
    }
    let height = ui.spacing().interact_size.y;
    let area = ScrollArea::vertical().id_salt(id).max_height(HEIGHT).auto_shrink([false, true]);
    area.show_rows(ui, height, found.len(), |ui, rows| {
        for &index in found.get(rows).unwrap_or_default() {
            let is_chosen = index == memory.chosen;
            // Rows are of one height.
            let label = Button::selectable(is_chosen, &names[index]).truncate();
            if ui.add(label).clicked() {
                memory.chosen = index;
            }
        }
    });
}

/// The places of the names that hold `text`, in any case.
fn matching(names: &[String], text: &str) -> Vec<usize> {
    let text = text.trim().to_lowercase();
    let holds = |index: &usize| names[*index].to_lowercase().contains(&text);
    (0..names.len()).filter(holds).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_by_a_part_of_them() {
        let names = ["Fog", "left 1", "left 12", "right 1"].map(String::from);
        assert_eq!(matching(&names, ""), [0, 1, 2, 3]);
        assert_eq!(matching(&names, " LEFT 1"), [1, 2]);
        assert_eq!(matching(&names, "fog"), [0]);
        assert_eq!(matching(&names, "x"), Vec::<usize>::new());
    }
}
