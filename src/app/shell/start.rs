//! The start row: the scenes that Flambeau brings along as small pictures, the files of before,
//! and how to go on. A row under the picture, which renders meanwhile.

use egui::accesskit::Role;
use egui::{
    Align, Color32, Context, Label, Layout, Rect, Response, RichText, ScrollArea, Sense, Stroke,
    StrokeKind, TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo, pos2, vec2,
};

use crate::app::command::Command;
use crate::app::ui::theme::{color, size, space};
use crate::app::ui::widgets::key_of;

/// Room for a small picture, in points.
const PICTURE: Vec2 = vec2(96.0, 54.0);
/// Height of the line of text under a card.
const LINE: f32 = 16.0;
/// Width of the column of files.
const FILES: f32 = 176.0;
/// Files of before that there is room for.
const MOST_FILES: usize = 3;
/// Height of a window from which on the cards lie in two rows, in points.
const TALL: f32 = 680.0;

/// An embedded scene: its name, what it shows, and its small picture.
type Card = (&'static str, &'static str, &'static [u8]);

/// The embedded scenes, the simplest ones first.
const CARDS: [Card; 14] = [
    (
        "torch",
        "A torch burning behind smoke",
        include_bytes!("../../../assets/thumbnails/torch.png"),
    ),
    (
        "campfire",
        "A wide fire and its smoke, at dusk",
        include_bytes!("../../../assets/thumbnails/campfire.png"),
    ),
    (
        "explosion",
        "A hot core wrapped in dense smoke",
        include_bytes!("../../../assets/thumbnails/explosion.png"),
    ),
    ("fog", "A torch in uneven mist", include_bytes!("../../../assets/thumbnails/fog.png")),
    ("cloud", "A cumulus under a low sun", include_bytes!("../../../assets/thumbnails/cloud.png")),
    (
        "plume",
        "A column of smoke in the sun",
        include_bytes!("../../../assets/thumbnails/plume.png"),
    ),
    (
        "phoenix",
        "A bird made of fire, wrapped in smoke",
        include_bytes!("../../../assets/thumbnails/phoenix.png"),
    ),
    (
        "tunnel",
        "Torches on the pillars of a misty tunnel",
        include_bytes!("../../../assets/thumbnails/tunnel.png"),
    ),
    (
        "mist",
        "A campfire in thin mist, among trees",
        include_bytes!("../../../assets/thumbnails/mist.png"),
    ),
    (
        "hearth",
        "A fire among balls from polished to dull",
        include_bytes!("../../../assets/thumbnails/hearth.png"),
    ),
    (
        "blast",
        "An explosion behind thick smoke, between houses",
        include_bytes!("../../../assets/thumbnails/blast.png"),
    ),
    (
        "godrays",
        "Beams of sunlight in a dark, hazy room",
        include_bytes!("../../../assets/thumbnails/godrays.png"),
    ),
    (
        "lamps",
        "Strong lamps in thin and thick clouds",
        include_bytes!("../../../assets/thumbnails/lamps.png"),
    ),
    (
        "street",
        "Two hundred torches in thin fog, at night",
        include_bytes!("../../../assets/thumbnails/street.png"),
    ),
];

/// The choice of the user.
#[derive(Clone, Debug, PartialEq)]
pub enum StartChoice {
    /// Open a file or an embedded scene.
    Open(String),
    /// A command.
    Command(Command),
    /// Close the row.
    Close,
}

/// The row, while it is open.
#[derive(Default)]
pub struct StartRow {
    /// The small pictures on the graphics card, once they are there.
    pictures: Vec<Option<TextureHandle>>,
}

impl StartRow {
    /// Shows the row; `recent` are the files of before, `again` whether it comes at each start.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        recent: &[String],
        again: &mut bool,
    ) -> Option<StartChoice> {
        let mut choice = None;
        head(ui, again, &mut choice);
        ui.add_space(space::TIGHT);
        ui.horizontal_top(|ui| {
            let width = (ui.available_width() - FILES - 2.0 * space::ROW).max(PICTURE.x);
            let rows = if ui.ctx().content_rect().height() < TALL { 1 } else { 2 };
            let height = rows as f32 * (PICTURE.y + LINE + space::ROW);
            ui.allocate_ui(vec2(width, height), |ui| self.cards(ui, rows, &mut choice));
            ui.vertical(|ui| files(ui, recent, &mut choice));
        });
        choice
    }

    /// The cards in rows of equal length. The wheel moves them where they are wider than the window.
    fn cards(&mut self, ui: &mut Ui, rows: usize, choice: &mut Option<StartChoice>) {
        if self.pictures.is_empty() {
            self.pictures = CARDS.iter().map(|card| picture(ui.ctx(), card)).collect();
        }
        let cards: Vec<_> = CARDS.iter().zip(&self.pictures).collect();
        ui.style_mut().always_scroll_the_only_direction = true;
        ScrollArea::horizontal().auto_shrink([true, false]).show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(4.0, space::ROW);
            ui.vertical(|ui| {
                for row in cards.chunks(CARDS.len().div_ceil(rows)) {
                    ui.horizontal_top(|ui| card_row(ui, row, choice));
                }
            });
        });
    }
}

/// A row of scenes with their small pictures.
fn card_row(
    ui: &mut Ui,
    row: &[(&Card, &Option<TextureHandle>)],
    choice: &mut Option<StartChoice>,
) {
    // Room for the outline.
    ui.add_space(2.0);
    for ((name, words, _), picture) in row {
        if card(ui, name, picture.as_ref()).on_hover_text(*words).clicked() {
            *choice = Some(StartChoice::Open(format!("builtin:{name}")));
        }
    }
}

/// Line above the cards: what can be done, and the button that closes the row.
fn head(ui: &mut Ui, again: &mut bool, choice: &mut Option<StartChoice>) {
    ui.horizontal(|ui| {
        ui.label(RichText::new("Start with a scene").color(color::TEXT_STRONG));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let help = format!("Close this row.  [Esc, {}]", key_of(ui, Command::Start));
            if ui.button("Close").on_hover_text(help).clicked() {
                *choice = Some(StartChoice::Close);
            }
            ui.checkbox(again, "Show at start")
                .on_hover_text("Show this row whenever Flambeau starts without a file.");
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let text = "Drag the picture to orbit, drop a .vdb or .nvdb to open it. 1 to 5 \
                            switch strategies, C compares, F1 lists keys.";
                ui.add(Label::new(RichText::new(text).color(color::TEXT_DIM)).truncate());
            });
        });
    });
}

/// The column of files.
fn files(ui: &mut Ui, recent: &[String], choice: &mut Option<StartChoice>) {
    let open = Command::Open;
    let help = format!("{}  [{}]", open.tooltip(), key_of(ui, open));
    if ui.button(open.text()).on_hover_text(help).clicked() {
        *choice = Some(StartChoice::Command(open));
    }
    for path in recent.iter().take(MOST_FILES) {
        let name = std::path::Path::new(path).file_name().unwrap_or_default().to_string_lossy();
        let text = RichText::new(name).color(color::TEXT);
        let button = egui::Button::new(text).frame(false).truncate();
        if ui.add(button).on_hover_text(path).clicked() {
            *choice = Some(StartChoice::Open(path.clone()));
        }
    }
}

/// A scene that can be chosen.
fn card(ui: &mut Ui, name: &str, picture: Option<&TextureHandle>) -> Response {
    let (rect, response) = ui.allocate_exact_size(PICTURE + vec2(0.0, LINE), Sense::click());
    let label = format!("Scene {name}");
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
    let area = Rect::from_min_size(rect.min, PICTURE);
    ui.painter().rect_filled(area, space::RADIUS, color::WELL);
    if let Some(picture) = picture {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter().image(picture.id(), area, whole, Color32::WHITE);
    }
    let is_near = response.hovered() || response.has_focus();
    let tint = if is_near { color::TEXT_STRONG } else { color::TEXT };
    let font = egui::FontId::proportional(size::SMALL);
    let at = area.left_bottom() + vec2(0.0, space::TIGHT);
    ui.painter().text(at, egui::Align2::LEFT_TOP, name, font, tint);
    if is_near {
        let stroke = Stroke::new(2.0, color::ACCENT);
        ui.painter().rect_stroke(area, space::RADIUS, stroke, StrokeKind::Outside);
    }
    response
}

/// Puts a small picture onto the graphics card.
fn picture(ctx: &Context, (name, _, png): &Card) -> Option<TextureHandle> {
    let decoded = image::load_from_memory_with_format(png, image::ImageFormat::Png).ok()?.to_rgb8();
    let size = [decoded.width() as usize, decoded.height() as usize];
    let image = egui::ColorImage::from_rgb(size, decoded.as_raw());
    Some(ctx.load_texture(format!("scene {name}"), image, TextureOptions::LINEAR))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    #[test]
    fn every_embedded_scene_has_its_picture() {
        let known: Vec<&str> = scene::embedded_scenes().collect();
        assert_eq!(CARDS.map(|(name, ..)| name).to_vec(), known);
        for (name, words, png) in CARDS {
            let image = image::load_from_memory(png).unwrap().to_rgb8();
            let size = 2.0 * PICTURE;
            let expected = (size.x as u32, size.y as u32);
            assert_eq!(image.dimensions(), expected, "{name}: sharp on fine screens too");
            assert!(image.pixels().any(|pixel| pixel.0.iter().any(|&v| v > 60)), "{name} is dark");
            assert!(!words.is_empty());
        }
    }
}
