//! The visual style of the window in one place: colors, spacing, type. Panels take from here and
//! spell out none of their own. Everything but the accents is neutral gray, so that nothing tints
//! the eye that judges the picture.
#![allow(clippy::disallowed_methods, reason = "this is the place that spells colors out")]

use egui::{Color32, Context, CornerRadius, FontFamily, FontId, Margin, Stroke, TextStyle, vec2};

/// Colors, all sRGB-coded.
pub mod color {
    use egui::Color32;

    /// Around the picture.
    pub const SURROUND: Color32 = Color32::from_gray(44);
    /// Panels and bars.
    pub const PANEL: Color32 = Color32::from_gray(30);
    /// Text fields and slider rails: lower than the panel.
    pub const WELL: Color32 = Color32::from_gray(19);
    /// Buttons and boxes at rest.
    pub const RAISED: Color32 = Color32::from_gray(50);
    /// Buttons and boxes under the pointer.
    pub const RAISED_HOVER: Color32 = Color32::from_gray(60);
    /// Buttons and boxes while pressed.
    pub const RAISED_ACTIVE: Color32 = Color32::from_gray(80);
    /// Menus and tooltips, which float above the panels.
    pub const FLOATING: Color32 = Color32::from_gray(38);
    /// Lines between panels and around what floats.
    pub const LINE: Color32 = Color32::from_gray(54);
    /// Values and headings.
    pub const TEXT_STRONG: Color32 = Color32::from_gray(238);
    /// Ordinary text.
    pub const TEXT: Color32 = Color32::from_gray(205);
    /// Labels, units and explanations.
    pub const TEXT_DIM: Color32 = Color32::from_gray(168);
    /// Things that are on, selected or in progress.
    pub const ACCENT: Color32 = Color32::from_rgb(230, 142, 62);
    /// Selected text and pressed segments behind their text.
    pub const ACCENT_FILL: Color32 = Color32::from_rgb(112, 66, 26);
    /// Something to know.
    pub const WARNING: Color32 = Color32::from_rgb(226, 184, 92);
    /// Curves: what is there.
    pub const CURVE: Color32 = Color32::from_gray(170);
    /// Curves: what chance draws.
    pub const CURVE_CHANCE: Color32 = Color32::from_rgb(96, 170, 240);
    /// Curves: what probes draw.
    pub const CURVE_PROBES: Color32 = ACCENT;
    /// Curves of emission.
    pub const CURVE_EMISSION: Color32 = Color32::from_rgb(132, 204, 120);
    /// Axes of the world over the picture: x, y and z.
    pub const AXES: [Color32; 3] = [
        Color32::from_rgb(226, 96, 96),
        Color32::from_rgb(120, 196, 96),
        Color32::from_rgb(104, 150, 240),
    ];
    /// The color of an 8-bit sRGB code that means a number.
    pub const fn of([r, g, b]: [u8; 3]) -> Color32 {
        Color32::from_rgb(r, g, b)
    }

    /// Numbers written into bright and into dark pixels of the picture.
    pub const ON_PICTURE: [Color32; 2] = [Color32::BLACK, Color32::WHITE];

    /// Something that failed.
    pub const ERROR: Color32 = Color32::from_rgb(238, 126, 112);
}

/// Distances in points.
pub mod space {
    /// Space between things that belong together.
    pub const TIGHT: f32 = 4.0;
    /// Space between rows and columns.
    pub const ROW: f32 = 6.0;
    /// Space between a panel's edge and its contents.
    pub const PANEL: i8 = 12;
    /// Width of the panel column.
    pub const COLUMN: f32 = 352.0;
    /// Width of the label in a row of settings.
    pub const LABEL: f32 = 140.0;
    /// Width of the number in a row of settings.
    pub const NUMBER: f32 = 68.0;
    /// Width and height of a histogram beside the name of a grid.
    pub const HISTOGRAM: [f32; 2] = [96.0, 20.0];
    /// Height of a color ramp, and of the handles of its stops below it.
    pub const RAMP: [f32; 2] = [26.0, 14.0];
    /// Width of the handle of a stop.
    pub const STOP: f32 = 11.0;
    /// Height of a row of settings.
    pub const ROW_HEIGHT: f32 = 20.0;
    /// Height of the status line.
    pub const STATUS: f32 = 28.0;
    /// Roundness of buttons and fields.
    pub const RADIUS: u8 = 4;
}

/// Sizes of text in points.
pub mod size {
    /// Explanations under a control.
    pub const SMALL: f32 = 11.5;
    /// Size of body text.
    pub const BODY: f32 = 13.0;
    /// Size of panel headings.
    pub const HEADING: f32 = 13.5;
}

/// Dresses `ctx` in the one dark theme.
pub fn apply(ctx: &Context) {
    ctx.set_theme(egui::Theme::Dark);
    ctx.all_styles_mut(|style| {
        set_type(style);
        set_spacing(&mut style.spacing);
        set_visuals(&mut style.visuals);
        style.animation_time = 0.08;
        style.explanation_tooltips = false;
        style.interaction.tooltip_delay = 0.4;
        style.interaction.selectable_labels = false;
    });
}

fn set_type(style: &mut egui::Style) {
    let font = |size| FontId::new(size, FontFamily::Proportional);
    style.text_styles = [
        (TextStyle::Small, font(size::SMALL)),
        (TextStyle::Body, font(size::BODY)),
        (TextStyle::Button, font(size::BODY)),
        (TextStyle::Heading, font(size::HEADING)),
        (TextStyle::Monospace, FontId::new(size::SMALL, FontFamily::Monospace)),
    ]
    .into();
}

fn set_spacing(spacing: &mut egui::style::Spacing) {
    spacing.item_spacing = vec2(space::ROW, space::ROW);
    spacing.button_padding = vec2(8.0, 2.0);
    spacing.menu_margin = Margin::same(6);
    spacing.window_margin = Margin::same(space::PANEL);
    spacing.interact_size = vec2(40.0, space::ROW_HEIGHT);
    spacing.slider_rail_height = 4.0;
    spacing.combo_width = 80.0;
    spacing.icon_width = 15.0;
    spacing.icon_width_inner = 9.0;
    spacing.icon_spacing = 7.0;
    spacing.tooltip_width = 320.0;
    spacing.indent = 14.0;
    spacing.scroll = egui::style::ScrollStyle::thin();
}

fn set_visuals(visuals: &mut egui::Visuals) {
    visuals.panel_fill = color::PANEL;
    visuals.window_fill = color::FLOATING;
    visuals.window_stroke = Stroke::new(1.0, color::LINE);
    visuals.window_corner_radius = CornerRadius::same(space::RADIUS + 2);
    visuals.menu_corner_radius = CornerRadius::same(space::RADIUS + 2);
    visuals.extreme_bg_color = color::WELL;
    visuals.code_bg_color = color::WELL;
    visuals.faint_bg_color = Color32::from_gray(34);
    visuals.warn_fg_color = color::WARNING;
    visuals.error_fg_color = color::ERROR;
    visuals.hyperlink_color = color::ACCENT;
    visuals.weak_text_color = Some(color::TEXT_DIM);
    visuals.selection.bg_fill = color::ACCENT_FILL;
    visuals.selection.stroke = Stroke::new(1.0, color::TEXT_STRONG);
    visuals.slider_trailing_fill = true;
    visuals.handle_shape = egui::style::HandleShape::Rect { aspect_ratio: 0.5 };
    visuals.indent_has_left_vline = false;
    visuals.disabled_alpha = 0.45;

    let widgets = &mut visuals.widgets;
    let states = [
        (&mut widgets.noninteractive, color::PANEL, color::LINE, color::TEXT),
        (&mut widgets.inactive, color::RAISED, Color32::TRANSPARENT, color::TEXT),
        (&mut widgets.hovered, color::RAISED_HOVER, Color32::TRANSPARENT, color::TEXT_STRONG),
        (&mut widgets.active, color::RAISED_ACTIVE, Color32::TRANSPARENT, color::TEXT_STRONG),
        (&mut widgets.open, color::RAISED_HOVER, Color32::TRANSPARENT, color::TEXT_STRONG),
    ];
    for (state, fill, line, text) in states {
        state.bg_fill = fill;
        state.weak_bg_fill = fill;
        state.bg_stroke = Stroke::new(1.0, line);
        state.fg_stroke = Stroke::new(1.0, text);
        state.corner_radius = CornerRadius::same(space::RADIUS);
        state.expansion = 0.0;
    }
    // Keyboard focus shows as the accent's outline; everything pressed keeps its shape.
    widgets.active.bg_stroke = Stroke::new(1.0, color::ACCENT);
}

/// The frame of bars and panels.
pub fn panel_frame() -> egui::Frame {
    egui::Frame::new().fill(color::PANEL).inner_margin(Margin::symmetric(space::PANEL, 6))
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::Rgba;

    /// WCAG 2.1's contrast ratio: of relative luminances, each with 0.05 of stray light.
    fn contrast(text: Color32, ground: Color32) -> f32 {
        let light = |color: Color32| {
            let color = Rgba::from(color);
            0.2126 * color.r() + 0.7152 * color.g() + 0.0722 * color.b() + 0.05
        };
        light(text).max(light(ground)) / light(text).min(light(ground))
    }

    #[test]
    fn all_text_can_be_read() {
        assert!((contrast(Color32::WHITE, Color32::BLACK) - 21.0).abs() < 1e-3);
        use color::*;
        let plain = [TEXT_STRONG, TEXT, TEXT_DIM, ACCENT, WARNING, ERROR];
        for ground in [SURROUND, PANEL, WELL, FLOATING, RAISED] {
            for text in plain {
                let ratio = contrast(text, ground);
                assert!(ratio >= 4.5, "{text:?} on {ground:?}: {ratio}");
            }
        }
        for (ground, texts) in [
            // The key beside the command under the pointer.
            (RAISED_HOVER, vec![TEXT_STRONG, TEXT, TEXT_DIM]),
            (RAISED_ACTIVE, vec![TEXT_STRONG, TEXT]),
            (ACCENT_FILL, vec![TEXT_STRONG]),
        ] {
            for text in texts {
                let ratio = contrast(text, ground);
                assert!(ratio >= 4.5, "{text:?} on {ground:?}: {ratio}");
            }
        }
    }
}
