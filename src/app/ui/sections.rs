//! The parts of the panel column and which of them are open: as the user left them, at the next
//! start too.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use egui::{CollapsingHeader, Context, Id, RichText, Ui};

use crate::app::ui::theme::{color, space};

/// The sections opened and folded, shared between the window and the sections that it shows.
#[derive(Clone, Debug, Default)]
pub struct Sections(Arc<Mutex<SectionState>>);

/// Tops of the parts that are shown, in points below the top of the column, the first one first.
pub type Tops = Vec<(&'static str, f32)>;

#[derive(Debug, Default)]
struct SectionState {
    /// Top of the column on the screen.
    top: f32,
    tops: Tops,
    /// Scroll offset of the column, where one was decided.
    offset: Option<f32>,
    /// Open sections by title; one that is not in it is as at the first start.
    open: BTreeMap<String, bool>,
    /// Whether all are to be as at the first start.
    is_reset: bool,
}

impl Sections {
    /// Sections as they were left, for the parts shown in `ctx` to find.
    pub fn install(ctx: &Context, open: BTreeMap<String, bool>) -> Self {
        let sections = Self(Arc::new(Mutex::new(SectionState { open, ..SectionState::default() })));
        ctx.data_mut(|data| data.insert_temp(Id::NULL, sections.clone()));
        sections
    }

    fn of(ctx: &Context) -> Self {
        ctx.data_mut(|data| data.get_temp_mut_or_default::<Self>(Id::NULL).clone())
    }

    /// Sections that differ from the first start, by title.
    pub fn chosen(&self) -> BTreeMap<String, bool> {
        self.with(|chosen| chosen.open.clone())
    }

    /// Brings all back to what they were at the first start, in the next frame.
    pub fn reset(&self) {
        self.with(|chosen| {
            chosen.open.clear();
            chosen.is_reset = true;
        });
    }

    /// Ends a frame.
    pub fn settle(&self) {
        self.with(|chosen| chosen.is_reset = false);
    }

    /// Begins to show the sections from `top` on the screen downwards.
    pub fn begin(&self, top: f32) {
        self.with(|chosen| {
            chosen.top = top;
            chosen.tops.clear();
        });
    }

    /// Top of the column on the screen, scrolled out of sight or not.
    pub fn top(&self) -> f32 {
        self.with(|chosen| chosen.top)
    }

    /// Tops of the parts that were shown last.
    pub fn tops(&self) -> Tops {
        self.with(|chosen| chosen.tops.clone())
    }

    /// Scrolls the column when it is shown next.
    pub fn scroll(&self, offset: f32) {
        self.with(|chosen| chosen.offset = Some(offset));
    }

    /// Takes the scroll offset that the column is to get now.
    pub fn take_offset(&self) -> Option<f32> {
        self.with(|chosen| chosen.offset.take())
    }

    /// Notes that something begins here which is to stay where the hand is.
    fn mark(&self, ui: &Ui, name: &'static str) {
        let top = ui.cursor().top();
        self.with(|chosen| chosen.tops.push((name, top - chosen.top)));
    }

    fn with<T>(&self, then: impl FnOnce(&mut SectionState) -> T) -> T {
        then(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// A part of the panel column under a heading that folds it.
pub fn section(ui: &mut Ui, title: &'static str, contents: impl FnOnce(&mut Ui)) {
    section_under(ui, title, true, contents);
}

/// A section that is folded until opened.
pub fn folded_section(ui: &mut Ui, title: &'static str, contents: impl FnOnce(&mut Ui)) {
    section_under(ui, title, false, contents);
}

/// Notes that below here, inside of a part, something begins that what is above it may push.
pub fn mark(ui: &Ui, name: &'static str) {
    Sections::of(ui.ctx()).mark(ui, name);
}

fn section_under(ui: &mut Ui, title: &'static str, at_first: bool, contents: impl FnOnce(&mut Ui)) {
    let sections = Sections::of(ui.ctx());
    sections.mark(ui, title);
    let (was_open, is_reset) =
        sections.with(|chosen| (chosen.open.get(title).copied(), chosen.is_reset));
    let was_open = was_open.unwrap_or(at_first);
    let heading = RichText::new(title).heading().color(color::TEXT_STRONG);
    let header = CollapsingHeader::new(heading).default_open(was_open);
    let header = header.open(is_reset.then_some(at_first)).show_unindented(ui, contents);
    if header.header_response.clicked() {
        sections.with(|chosen| match at_first == was_open {
            true => drop(chosen.open.insert(title.to_owned(), !was_open)),
            false => drop(chosen.open.remove(title)),
        });
    }
    ui.add_space(space::TIGHT);
    ui.separator();
}
