//! Commands whose keys are pressed.

use egui::{Context, Key, KeyboardShortcut};

use super::Command;

impl Command {
    /// The commands whose keys were pressed since the last frame. Plain keys belong to a text
    /// field while one is edited, and to any focused control where they would press it.
    pub fn pressed(ctx: &Context) -> Vec<Self> {
        let typing = ctx.text_edit_focused();
        let focused = ctx.egui_wants_keyboard_input();
        let mut commands: Vec<Self> = Self::all().collect();
        // Keys match with superfluous modifiers too, so the most specific come first.
        commands.sort_by_key(|command| {
            let modifiers = command.shortcut().modifiers;
            std::cmp::Reverse(
                u8::from(modifiers.command) + u8::from(modifiers.shift) + u8::from(modifiers.alt),
            )
        });
        ctx.input_mut(|input| {
            commands
                .into_iter()
                .filter(|command| {
                    let shortcut = command.shortcut();
                    let taken = match shortcut.logical_key {
                        // No text has these.
                        Key::F1 | Key::F6 | Key::F11 => false,
                        Key::Space | Key::ArrowLeft | Key::ArrowRight | Key::Delete => focused,
                        _ => typing,
                    };
                    let plain = !shortcut.modifiers.command;
                    !(plain && taken) && is_pressed(input, &shortcut)
                })
                .collect()
        })
    }
}

/// Whether a shortcut was pressed, which then is nobody else's; Escape also closes what is open.
fn is_pressed(input: &mut egui::InputState, shortcut: &KeyboardShortcut) -> bool {
    match shortcut.logical_key {
        Key::Escape => input.key_pressed(Key::Escape),
        _ => input.consume_shortcut(shortcut),
    }
}
