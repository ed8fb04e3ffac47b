//! What is drawn over the picture to understand the render.

use super::*;

#[test]
fn cells_are_drawn_over_the_picture_and_follow_the_camera() {
    let noise = r#"
[[volume]]
shape = "noise"
translate = [0, 0, 1.2]
frequency = 3.0
density = { scale = 9.0 }
"#;
    let Some(mut window) = Window::open(&(BALL.to_owned() + noise)) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    let opened = window.document().clone();
    let plain = shown_picture(&mut window);
    let above_legend = 0..plain.height() - 110;
    window.click(Role::DisclosureTriangle, "Diagnostics");
    assert!(!window.has("Majorant, 1/length"), "nothing is drawn that was not asked for");

    window.click(Role::Button, "Majorants");
    window.until_it_says("Majorant, 1/length");
    assert!(window.has(" cells"), "the legend counts them");
    let drawn = shown_picture(&mut window);
    assert!(differing(&plain, &drawn, above_legend.clone()) > 500, "no cells are drawn");
    assert_eq!(window.document(), &opened, "what is shown is no edit");

    // The camera moves: the same cells elsewhere.
    let start = window.harness.get_by_role_and_label(Role::Image, "Picture").rect().center();
    window.harness.drag_at(start);
    window.harness.hover_at(start + egui::vec2(60.0, 0.0));
    window.harness.drop_at(start + egui::vec2(60.0, 0.0));
    window.harness.step();
    window.until_finished();
    assert!(window.has("Majorant, 1/length"));
    let turned = shown_picture(&mut window);
    assert!(differing(&drawn, &turned, above_legend) > 500);

    window.click(Role::Button, "Off");
    assert!(!window.has("Majorant, 1/length"));
}

/// Once the pilot pass has run, the section says what the time is spent on, and how many samples
/// pay at each bounce.
#[test]
fn the_time_is_told_by_what_it_is_spent_on() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.click(Role::DisclosureTriangle, "Diagnostics");
    window.until_finished();
    assert!(window.has("Where the time goes"), "the time is not told");
    assert!(window.has("emission along rays"), "the fire's part is not told");
    assert!(window.has("first, in smoke"), "the bounces are not told");
}

/// The ball emits ε = μ_a · le with lum ε = 1.2 · (0.2126 · 2 + 0.7152 · 0.7 + 0.0722 · 0.2) =
/// 1.128 over 4π/3: a power of 4.726, in one cell.
#[test]
fn the_energy_of_cells_has_a_legend_with_numbers() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    window.click(Role::DisclosureTriangle, "Diagnostics");
    window.click(Role::Button, "Energy");
    window.until_it_says("Emitted power per cell");
    assert!(window.has("One cell"));
    assert_eq!(window.harness.query_all_by_label("4.726").count(), 3, "both ends and the middle");

    let smoke = BALL.replace("\"source\", le = [2.0, 0.7, 0.2]", "\"none\"");
    let path = window.folder.path().join("smoke.toml");
    std::fs::write(&path, smoke).unwrap();
    window.harness.input_mut().dropped_files.push(Arc::new(Dropped(path)));
    window.until_it_says("No volume emits light.");
}

#[test]
fn probes_are_drawn_over_the_picture_where_there_are_any() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    window.click(Role::DisclosureTriangle, "Diagnostics");
    window.harness.remove_cursor();
    window.settle();
    let plain = shown_picture(&mut window);
    window.click(Role::Button, "Probes");
    window.until_it_says("Scattered light, radiance/length");
    window.harness.remove_cursor();
    window.settle();
    let drawn = shown_picture(&mut window);
    assert!(differing(&plain, &drawn, 0..plain.height() - 110) > 500, "no probes are drawn");
    window.press(Modifiers::NONE, Key::Num5);
    window.until_it_says("No probe receives light.");
    // Until then the panel may move under the hand.
    window.until_finished();
    window.click(Role::Button, "Off");
    assert!(!window.has("Scattered light, radiance/length"));
}

/// The ray through the middle of the ball crosses 2 of μ_t = 2.
#[test]
fn a_click_looks_into_the_ray_of_a_pixel() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    let opened = window.document().clone();
    window.click(Role::DisclosureTriangle, "Diagnostics");
    window.click(Role::CheckBox, "Inspect a ray");
    assert!(!window.has("optical depth"), "nothing is in the way before a pixel is picked");
    let area = window.harness.get_by_role_and_label(Role::Image, "Picture").rect();
    let click = |window: &mut Window, at: egui::Pos2| {
        window.harness.drag_at(at);
        window.harness.drop_at(at);
        window.harness.step();
        window.settle();
    };
    // The window of the ray lies below on the right.
    let enlarged = (area.width() / 64.0).min(area.height() / 48.0).floor();
    let pixel = |x: f32, y: f32| area.center() + enlarged * egui::vec2(x - 31.5, y - 23.5);
    click(&mut window, pixel(32.0, 24.0));
    window.until_it_says("Pixel 32, 24: optical depth 3.9");
    assert!(window.has("Extinction 2") && window.has("Transmittance 1"));
    assert_eq!(window.document(), &opened, "looking is no edit");

    let plot =
        window.harness.get_by_role_and_label(Role::Image, "Fractions along the ray, fraction");
    let end = plot.rect().right_center() - egui::vec2(8.0, 0.0);
    window.harness.hover_at(end);
    window.settle();
    let read = window
        .harness
        .get_by(|node| node.value().is_some_and(|value| value.starts_with("Transmittance ")));
    let read = read.value().unwrap();
    let transmittance: f32 = read["Transmittance ".len()..].parse().unwrap();
    assert!((0.01..0.04).contains(&transmittance), "exp(−4) = 0.018 at the far end: {read}");

    // Zoomed in, the pixel under the pointer is the one that is picked.
    let corner = pixel(3.0, 3.0);
    window.harness.hover_at(corner);
    window.press(Modifiers::NONE, Key::Z);
    window.press(Modifiers::NONE, Key::Z);
    click(&mut window, corner);
    window.until_it_says("no medium along this ray");
    window.click(Role::Button, "Close window");
    assert!(!window.has("no medium along this ray"));
    click(&mut window, pixel(32.0, 24.0));
    assert!(!window.has("optical depth"), "closed, clicks pick nothing");
}

#[test]
fn the_map_of_steps_colors_each_pixel_by_what_it_costs() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    let plain = shown_picture(&mut window);
    window.click(Role::DisclosureTriangle, "Diagnostics");
    window.click(Role::CheckBox, "Map of tracking steps");
    window.until("the steps are there", |app| {
        app.live_render().picture().is_some_and(|picture| !picture.layer.numbers.is_empty())
    });
    window.harness.remove_cursor();
    window.settle();
    let title = window.harness.get_by_label("Tracking steps per sample").rect();
    let picture = window.app().live_render().picture().unwrap().clone();
    let scale = Scale::rounded(picture.layer.range.unwrap());
    let area = window.harness.get_by_role_and_label(Role::Image, "Picture").rect();
    let shown = window.harness.render().unwrap();
    let enlarged = (area.width() / 64.0).min(area.height() / 48.0).floor();
    let corner = (area.center() - enlarged * egui::vec2(32.0, 24.0)).round();
    let mut bright = 0;
    for (index, &steps) in picture.layer.numbers.iter().enumerate() {
        let (x, y) = ((index % 64) as f32, (index / 64) as f32);
        let at = corner + enlarged * egui::vec2(x + 0.5, y + 0.5);
        if at.y > title.top() - 20.0 {
            continue;
        }
        let expected = match steps > 0.0 {
            true => ramp_color(scale.place(steps)).to_array(),
            false => [0, 0, 0, 255],
        };
        let pixel = shown.get_pixel(at.x as u32, at.y as u32).0;
        for channel in 0..3 {
            let off = i32::from(expected[channel]) - i32::from(pixel[channel]);
            assert!(off.abs() <= 1, "pixel {x},{y}: {expected:?} for {steps} steps, not {pixel:?}");
        }
        bright += i32::from(steps > 0.0);
    }
    assert!(bright > 500, "the ball costs nothing");

    window.click(Role::CheckBox, "Map of tracking steps");
    assert!(!window.has("Tracking steps per sample"));
    window.harness.remove_cursor();
    window.settle();
    assert_eq!(differing(&plain, &shown_picture(&mut window), 0..plain.height()), 0);
}
