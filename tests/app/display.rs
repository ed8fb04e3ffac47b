//! How the picture is brought to the screen.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use flambeau::image::tone::{Channel, Tone, ToneCurve, auto_exposure};
use flambeau::math::Rgb;
use flambeau::render::Layer;

use super::{BALL, Window};

/// A window on the ball at its own size, with all of its samples.
fn open() -> Option<Window> {
    let mut window = Window::open(BALL)?;
    window.click(Role::Button, "Fixed");
    window.until_finished();
    Some(window)
}

/// Holds each pixel that is seen against what `tone` makes of `pixels`: the shader against the code
/// that writes PNGs.
fn assert_shown(window: &mut Window, pixels: &[[f32; 4]], tone: Tone) {
    window.harness.remove_cursor();
    window.settle();
    let area = window.harness.get_by_role_and_label(Role::Image, "Picture").rect();
    let shown = window.harness.render().unwrap();
    let enlarged = (area.width() / 64.0).min(area.height() / 48.0).floor();
    let corner = (area.center() - enlarged * egui::vec2(32.0, 24.0)).round();
    let encoder = tone.encoder();
    // The legend of false color lies over the lower left corner.
    for y in 0..32 {
        for x in 0..64 {
            let [r, g, b, _] = pixels[y * 64 + x];
            let expected = encoder.encode(Rgb::new(r, g, b));
            let at = corner + enlarged * egui::vec2(x as f32 + 0.5, y as f32 + 0.5);
            let pixel = shown.get_pixel(at.x as u32, at.y as u32).0;
            for (expected, pixel) in std::iter::zip(expected, pixel) {
                assert!(
                    expected.abs_diff(pixel) <= 1,
                    "{tone:?} at {x},{y}: {expected} is {pixel}"
                );
            }
        }
    }
}

#[test]
fn every_curve_balance_and_channel_is_that_of_saved_pictures() {
    let Some(mut window) = open() else { return };
    let pixels = window.app().live_render().picture().unwrap().pixels.clone();
    assert_shown(&mut window, &pixels, Tone::default());
    for (curve, name) in [(ToneCurve::Agx, "AgX"), (ToneCurve::Linear, "Linear")] {
        window.press(Modifiers::NONE, Key::T);
        assert_eq!(window.document().tone.curve, curve);
        assert!(window.has(name));
        assert_shown(&mut window, &pixels, Tone { curve, ..Tone::default() });
    }
    window.press(Modifiers::NONE, Key::T);
    window.press(Modifiers::SHIFT, Key::T);
    let stops = Tone { channel: Channel::FalseColor, ..Tone::default() };
    assert_eq!(window.document().tone, stops);
    assert!(window.has("Stops from middle gray"));
    assert_shown(&mut window, &pixels, stops);
    window.press(Modifiers::SHIFT, Key::T);
    for channel in [Channel::Red, Channel::Green, Channel::Blue, Channel::Luminance] {
        window.click(Role::ComboBox, "Show");
        window.click(Role::Button, channel.name());
        assert_shown(&mut window, &pixels, Tone { channel, ..Tone::default() });
    }
}

#[test]
fn white_balance_is_set_undone_and_that_of_saved_pictures() {
    let Some(mut window) = open() else { return };
    let pixels = window.app().live_render().picture().unwrap().pixels.clone();
    let slider = window.harness.get_by_role_and_label(Role::Slider, "White balance");
    slider.set_value_accesskit(2500.0);
    window.settle();
    assert_eq!(window.document().tone.white, 2500.0);
    assert_shown(&mut window, &pixels, Tone { white: 2500.0, ..Tone::default() });
    let slider = window.harness.get_by_role_and_label(Role::Slider, "Tint");
    slider.set_value_accesskit(40.0);
    window.settle();
    assert_shown(&mut window, &pixels, Tone { white: 2500.0, tint: 40.0, ..Tone::default() });
    for tone in [Tone { white: 2500.0, ..Tone::default() }, Tone::default()] {
        window.press(Modifiers::COMMAND, Key::Z);
        assert_eq!(window.document().tone, tone);
    }
}

#[test]
fn a_key_exposes_for_the_picture() {
    let Some(mut window) = open() else { return };
    let pixels = window.app().live_render().picture().unwrap().pixels.clone();
    let exposure = auto_exposure(&pixels).unwrap();
    assert_ne!(exposure, 0.0);
    window.press(Modifiers::NONE, Key::A);
    assert_eq!(window.document().tone.exposure, exposure);
    assert_shown(&mut window, &pixels, Tone { exposure, ..Tone::default() });
}

#[test]
fn layers_take_the_place_of_the_picture() {
    let Some(mut window) = open() else { return };
    for (layer, legend) in [
        (Layer::Direct, None),
        (Layer::Indirect, None),
        (Layer::Depth, Some("Depth, length")),
        (Layer::Noise, Some("Noise (luminance)")),
    ] {
        window.click(Role::ComboBox, "Layer");
        window.click(Role::Button, layer.name());
        window.until("the layer is there", |app| {
            app.live_render().picture().is_some_and(|picture| picture.layer.layer == Some(layer))
        });
        window.settle();
        match legend {
            Some(legend) => assert!(window.has(legend), "{layer:?}"),
            None => {
                let light = window.app().live_render().picture().unwrap().layer.light.clone();
                assert_shown(&mut window, &light, Tone::default());
            }
        }
    }
    window.click(Role::ComboBox, "Layer");
    window.click(Role::Button, "Beauty");
    let pixels = window.app().live_render().picture().unwrap().pixels.clone();
    assert_shown(&mut window, &pixels, Tone::default());
}

#[test]
fn a_list_closes_with_the_key_that_chooses() {
    let Some(mut window) = open() else { return };
    window.harness.get_by_role_and_label(Role::ComboBox, "Layer").focus();
    window.settle();
    window.press(Modifiers::NONE, Key::Enter);
    window.harness.get_by_role_and_label(Role::Button, Layer::Depth.name()).focus();
    window.settle();
    window.press(Modifiers::NONE, Key::Enter);
    window.until("the layer is there", |app| {
        app.live_render().picture().is_some_and(|picture| picture.layer.layer == Some(Layer::Depth))
    });
    assert!(window.harness.query_by_role_and_label(Role::Button, Layer::Noise.name()).is_none());
}

/// Only a texel a block is brought onto the graphics card.
#[test]
fn a_coarse_picture_shows_its_blocks() {
    let Some(mut window) = open() else { return };
    window.press(Modifiers::NONE, Key::Space);
    window.press(Modifiers::NONE, Key::Num1);
    window.until("the coarse picture is there", |app| {
        app.live_render().picture().is_some_and(|picture| !picture.complete)
    });
    let picture = window.app().live_render().picture().unwrap().clone();
    let side = 1 << picture.block_log2;
    assert!(side > 1, "the picture is not of blocks");
    for (index, pixel) in picture.pixels.iter().enumerate() {
        let (x, y) = (index % 64, index / 64);
        assert_eq!(*pixel, picture.pixels[y / side * side * 64 + x / side * side], "{x},{y}");
    }
    assert_shown(&mut window, &picture.pixels, Tone::default());
}
