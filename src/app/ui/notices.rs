//! Messages below the picture and never over it. Failures stay until dismissed; what went well
//! leaves by itself.

use egui::accesskit::Live;
use egui::{Frame, Margin, RichText, Stroke, Ui};

use super::theme::{color, space};

/// Severity of a notice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Something went well and is worth saying, such as a saved file. Leaves with the next one,
    /// or after a while.
    Done,
    /// Something failed; what was there before is still there.
    Failed,
    /// The settings as they are cannot be rendered. Leaves when they can.
    Refused,
}

/// A notice below the picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// Severity of the notice.
    pub level: Level,
    /// The event, its object, and how to fix it.
    pub text: String,
}

/// The messages shown at present, the newest last.
#[derive(Debug, Default)]
pub struct Notices {
    list: Vec<Notice>,
    /// Since when, in seconds of the window's clock, the one that leaves by itself is shown.
    since: Option<f64>,
}

/// Largest number of notices shown; more would crowd the picture out.
const MOST: usize = 3;
/// Seconds for which a message that leaves by itself is shown.
const STAY: f64 = 12.0;

impl Notices {
    /// Says that something went well.
    pub fn done(&mut self, text: impl Into<String>) {
        self.push(Notice { level: Level::Done, text: text.into() });
    }

    /// Says that something failed.
    pub fn failed(&mut self, text: impl Into<String>) {
        self.push(Notice { level: Level::Failed, text: text.into() });
    }

    /// Says why the settings cannot be rendered.
    pub fn refused(&mut self, text: impl Into<String>) {
        self.push(Notice { level: Level::Refused, text: text.into() });
    }

    /// Shows a message.
    pub fn push(&mut self, notice: Notice) {
        self.list.retain(|old| old.level == Level::Failed && *old != notice);
        self.since = None;
        self.list.push(notice);
        if self.list.len() > MOST {
            self.list.remove(0);
        }
    }

    /// Forgets every message of this level.
    pub fn clear(&mut self, level: Level) {
        self.list.retain(|notice| notice.level != level);
    }

    /// The messages, the newest last.
    pub fn list(&self) -> &[Notice] {
        &self.list
    }

    /// Shows the notices as a stack of bars, each with a button that dismisses it.
    pub fn show(&mut self, ui: &mut Ui) {
        let mut dismissed = None;
        for (index, notice) in self.list.iter().enumerate() {
            let (rect, is_dismissed) = bar(ui, notice);
            if is_dismissed {
                dismissed = Some(index);
            }
            // Who reads it or is about to copy its text keeps it.
            if notice.level == Level::Done && ui.rect_contains_pointer(rect) {
                self.since = None;
            }
        }
        if let Some(index) = dismissed {
            self.list.remove(index);
        }
        self.leave(ui);
    }

    /// Lets what went well leave after a while.
    fn leave(&mut self, ui: &Ui) {
        if !self.list.iter().any(|notice| notice.level == Level::Done) {
            return;
        }
        let now = ui.input(|input| input.time);
        let left = STAY - (now - *self.since.get_or_insert(now));
        match left > 0.0 {
            true => ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(left)),
            false => self.clear(Level::Done),
        }
    }
}

/// Shows one notice; its place, and whether it was dismissed. A screen reader reads it out.
fn bar(ui: &mut Ui, notice: &Notice) -> (egui::Rect, bool) {
    let (accent, heading) = match notice.level {
        Level::Done => (color::ACCENT, "Done"),
        Level::Failed => (color::ERROR, "Failed"),
        Level::Refused => (color::WARNING, "Not rendered"),
    };
    let frame = Frame::new()
        .fill(color::FLOATING)
        .stroke(Stroke::new(1.0, color::LINE))
        .corner_radius(space::RADIUS)
        .inner_margin(Margin::symmetric(10, 6));
    let output = frame.show(ui, |ui| {
        ui.horizontal_top(|ui| {
            ui.label(RichText::new(heading).color(accent).strong());
            let close = 70.0;
            let width = (ui.available_width() - close).max(80.0);
            ui.allocate_ui(egui::vec2(width, 0.0), |ui| {
                ui.set_width(width);
                let text = RichText::new(&notice.text).color(color::TEXT_STRONG);
                let label = ui.add(egui::Label::new(text).wrap().selectable(true));
                let live = if notice.level == Level::Done { Live::Polite } else { Live::Assertive };
                ui.ctx().accesskit_node_builder(label.id, |node| node.set_live(live));
            });
            ui.with_layout(egui::Layout::right_to_left(egui::Align::TOP), |ui| {
                ui.button("Dismiss").on_hover_text("Close this message.").clicked()
            })
            .inner
        })
        .inner
    });
    (output.response.rect, output.inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_stay_and_successes_leave() {
        let mut notices = Notices::default();
        notices.failed("a");
        notices.done("b");
        notices.failed("c");
        let texts: Vec<_> = notices.list().iter().map(|n| n.text.as_str()).collect();
        assert_eq!(texts, ["a", "c"]);
        for n in 0..9 {
            notices.failed(n.to_string());
        }
        assert_eq!(notices.list().len(), MOST);
    }
}
