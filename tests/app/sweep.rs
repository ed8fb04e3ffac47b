//! All strategies tried on the shot: begun by a key, cancelled, tried again, used, undone, stale.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use flambeau::app::App;
use flambeau::render::sweep::{SweepProgress, TrialKind, TrialSource};
use flambeau::transport::strategy::Preset;
use flambeau::transport::toggle::Toggle;

use super::{BALL, Window};

impl Window {
    fn sweep(&mut self) {
        self.press(Modifiers::SHIFT, Key::C);
    }

    fn until_swept(&mut self) {
        self.until("the strategies are ranked", |app| {
            !app.sweep().is_running() && app.sweep().results().is_some()
        });
    }

    /// Cancels the sweep once every strategy has begun, and makes the next one short.
    fn until_quick(&mut self) {
        self.sweep();
        self.until("strategies are rendered", |app| {
            matches!(app.sweep().progress(), Some((SweepProgress::Rendering(part), _)) if part > 0.01)
        });
        self.click(Role::Button, "Cancel");
        self.until_swept();
        let field = self.harness.get_by_role_and_label(Role::SpinButton, "Time for each");
        field.set_value_accesskit(0.1);
        self.settle();
    }
}

fn is_held(app: &App) -> bool {
    app.live_render().held()
}

fn open() -> Option<Window> {
    let text = BALL.replace("size = [64, 48]", "size = [32, 24]").replace("spp = 4", "spp = 0");
    let mut window = Window::open(&text)?;
    window.click(Role::Button, "Fixed");
    Some(window)
}

#[test]
fn a_key_tries_all_strategies_and_a_button_uses_the_best() {
    let Some(mut window) = open() else { return };
    window.until("there is a picture", |app| app.live_render().is_current());
    window.until_quick();
    assert!(window.has("Cancelled before all strategies had their time."));
    window.click(Role::Button, "Sweep again");
    assert!(window.has("Sweep: ") && is_held(window.app()), "the live render waits");
    window.until_swept();
    assert!(!is_held(window.app()) && !window.has("Cancelled before"));

    let ranking = window.app().sweep().results().unwrap().ranking.clone();
    assert_eq!(ranking.entries.len(), 12);
    let rendered =
        ranking.entries.iter().filter(|entry| entry.trial.source == TrialSource::Rendered);
    for entry in rendered {
        let side = entry.side.unwrap();
        assert!(side.cpu_seconds >= 0.1 && side.cpu_seconds < 2.0, "{:?}", side.cpu_seconds);
    }
    assert!(window.has(&flambeau::render::sweep::words::headline(&ranking)));
    assert!(window.has("as full") && window.has("times as fast as baseline"));
    assert!(window.has("In use: full"), "the scene has every strategy on");

    let kind = TrialKind::Without(Toggle::MajorantBoost);
    window.click(Role::Button, &format!("Use: {}", kind.name()));
    let expected = Toggle::MajorantBoost.set(&Preset::Full.strategy(), false);
    assert_eq!(window.document().settings.strategy, expected);
    assert!(window.has(&format!("In use: {}", kind.name())));
    assert!(!window.has("has changed since"), "toggles are what was tried");
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.document().settings.strategy, Preset::Full.strategy());
}

/// What was found is no longer of the shot once that is edited, and the live render goes on at
/// once.
#[test]
fn results_of_another_shot_say_so() {
    let Some(mut window) = open() else { return };
    window.until("there is a picture", |app| app.live_render().is_current());
    window.until_quick();
    assert!(!window.has("has changed since"));
    window.sweep();
    window.until("the live render waits", is_held);
    window.press(Modifiers::NONE, Key::F);
    assert!(!is_held(window.app()), "it shows something else now");
    window.until_swept();
    assert!(window.has("The shot or an advanced setting has changed since: sweep again."));
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(!window.has("has changed since"), "undo brings the shot back");
}

/// The strategy goes to the side that is edited.
#[test]
fn the_edited_side_of_a_comparison_takes_a_strategy_over() {
    let Some(mut window) = open() else { return };
    window.until("there is a picture", |app| app.live_render().is_current());
    window.until_quick();
    window.press(Modifiers::NONE, Key::C);
    window.press(Modifiers::NONE, Key::B);
    assert!(window.has("In use: baseline"));
    window.click(Role::Button, "Use: light probes alone");
    let document = window.document();
    assert_eq!(
        document.settings.strategy,
        Toggle::LightProbes.set(&Preset::Baseline.strategy(), true)
    );
    assert_eq!(document.compared.unwrap().other, Preset::Full.strategy());
}
