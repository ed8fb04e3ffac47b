//! The row of the time line: where it stands, which frames have pictures, how it plays.

use egui::{
    Align, Button, DragValue, Layout, Rect, RichText, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use super::TimeLine;
use crate::app::command::Command;
use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::{arrow_steps, key_help, key_of};
use crate::format::mebibytes;

/// Least width of the track that leaves room for the settings of the flipbook beside it.
const TRACK: f32 = 200.0;
/// Room that these settings take.
const SETTINGS: f32 = 380.0;

/// The row and what it may change.
pub struct TimeBar<'a> {
    /// The time line.
    pub time_line: &'a mut TimeLine,
    /// The frame of the scene.
    pub frame: &'a mut f64,
    /// Frames per second of the scene.
    pub fps: &'a mut f64,
    /// Memory of the volumes of all frames that are kept, and how much frames may take that are not
    /// shown, in bytes.
    pub volumes: [usize; 2],
    /// Missing files and grids of the present frame, in words.
    pub gaps: Vec<String>,
    /// Commands that buttons ask for.
    pub commands: &'a mut Vec<Command>,
}

/// Shows the row. Whether the frames per second were edited.
pub fn show(ui: &mut Ui, bar: &mut TimeBar<'_>) -> bool {
    let Some(range) = bar.time_line.range() else { return false };
    let mut edited = false;
    ui.horizontal(|ui| {
        play_buttons(ui, bar);
        frame_field(ui, bar, range);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.available_width() > SETTINGS + TRACK {
                edited = settings(ui, bar);
            }
            track(ui, bar, range);
        });
    });
    for gap in &bar.gaps {
        ui.label(RichText::new(gap).color(color::WARNING));
    }
    edited
}

fn play_buttons(ui: &mut Ui, bar: &mut TimeBar<'_>) {
    let play = if bar.time_line.is_playing() { "Stop" } else { "Play" };
    let buttons = [
        ("◀", 24.0, Command::PreviousFrame),
        (play, 52.0, Command::Play),
        ("▶", 24.0, Command::NextFrame),
    ];
    for (text, width, command) in buttons {
        let button = Button::new(text).min_size(vec2(width, 0.0));
        let help = format!("{}  [{}]", command.tooltip(), key_of(ui, command));
        let response = ui.add(button).on_hover_text(help);
        let name = if command == Command::Play { text } else { command.text() };
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, name));
        if response.clicked() {
            bar.commands.push(command);
        }
    }
}

fn frame_field(ui: &mut Ui, bar: &mut TimeBar<'_>, range: [i32; 2]) {
    let mut frame = bar.time_line.shown(bar.frame.round() as i32);
    let field = DragValue::new(&mut frame).range(range[0]..=range[1]).speed(0.1);
    let field =
        ui.add_sized([48.0, space::ROW_HEIGHT], field).on_hover_text(key_help("time.frame"));
    let field = field.accessible_name("Frame");
    if field.changed() {
        go_to(bar, frame);
    }
    ui.label(RichText::new(format!("of {}–{}", range[0], range[1])).color(color::TEXT_DIM));
}

/// The frames as a line with a mark where it stands, which goes wherever it is clicked or dragged.
fn track(ui: &mut Ui, bar: &mut TimeBar<'_>, [first, last]: [i32; 2]) {
    let size = vec2(ui.available_width().max(40.0), space::ROW_HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let frame = bar.time_line.shown(bar.frame.round() as i32).clamp(first, last);
    let count = f64::from(last) - f64::from(first) + 1.0;
    let x = |frame: f64| rect.left() + rect.width() * ((frame - f64::from(first)) / count) as f32;
    let piece = |frame: i32, height: f32| {
        let (left, right) = (x(f64::from(frame)), x(f64::from(frame) + 1.0));
        let y = rect.center().y;
        Rect::from_min_max(pos2(left, y - height), pos2(right.max(left + 1.0), y + height))
    };
    let painter = ui.painter();
    let line = Rect::from_min_max(piece(first, 3.0).min, piece(last, 3.0).max);
    painter.rect_filled(line, 1.0, color::RAISED);
    for (frame, _) in bar.time_line.flipbook.frames() {
        painter.rect_filled(piece(frame, 3.0), 0.0, color::ACCENT.gamma_multiply(0.6));
    }
    let mark = piece(frame, 8.0);
    let mark = Rect::from_center_size(mark.center(), vec2(mark.width().max(4.0), mark.height()));
    painter.rect_filled(mark, 1.0, color::TEXT_STRONG);
    if response.has_focus() {
        let outline = Stroke::new(1.0, color::ACCENT);
        painter.rect_stroke(rect, 1.0, outline, egui::StrokeKind::Inside);
    }
    let mut wanted = frame;
    if let Some(at) = response.interact_pointer_pos() {
        let share = f64::from((at.x - rect.left()) / rect.width());
        wanted = (f64::from(first) + share * count).floor() as i32;
    }
    if response.has_focus() {
        wanted += arrow_steps(ui, response.id).x as i32;
    }
    response.widget_info(|| WidgetInfo::slider(true, f64::from(frame), "Time line"));
    let wanted = wanted.clamp(first, last);
    if wanted != frame {
        go_to(bar, wanted);
    }
    response.on_hover_text("Click or drag to go to a frame. Bright frames are in the flipbook.");
}

/// The settings of the flipbook, from right to left. Whether the frames per second were edited.
fn settings(ui: &mut Ui, bar: &mut TimeBar<'_>) -> bool {
    let flipbook = &bar.time_line.flipbook;
    let [first, last] = bar.time_line.range().unwrap_or_default();
    let frames = i64::from(last) - i64::from(first) + 1;
    let memory = mebibytes(flipbook.bytes());
    let text = format!("{} of {frames} frames, {memory}", flipbook.len());
    let [volumes, room] = bar.volumes.map(mebibytes);
    let help = format!(
        "Frames whose pictures are kept, and the memory they take. Volumes read so far, also in \
         advance: {volumes}; those of frames that are not shown may take {room}."
    );
    ui.label(RichText::new(text).color(color::TEXT_DIM)).on_hover_text(help);
    let samples = DragValue::new(&mut bar.time_line.samples).range(1..=1 << 20).suffix(" spp");
    let help = "Flipbook: samples per pixel after which playing goes on to the next frame. Frames \
                that have a picture play at the pace of the scene.";
    let field = ui.add_sized([62.0, space::ROW_HEIGHT], samples).on_hover_text(help);
    let field = field.accessible_name("Flipbook samples");
    if field.changed() {
        bar.time_line.flipbook.clear();
    }
    let fps = DragValue::new(bar.fps).range(0.1..=1000.0).speed(0.1).suffix(" fps");
    let fps = ui.add_sized([62.0, space::ROW_HEIGHT], fps).on_hover_text(key_help("time.fps"));
    let fps = fps.accessible_name("Frames per second");
    let edited = fps.changed();
    ui.checkbox(&mut bar.time_line.loops, "Loop")
        .on_hover_text("The first frame follows the last.");
    edited
}

/// Goes to a frame and stays there.
fn go_to(bar: &mut TimeBar<'_>, frame: i32) {
    bar.time_line.stop();
    *bar.frame = f64::from(frame);
}
