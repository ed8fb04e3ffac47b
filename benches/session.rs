//! Time from an edit to the next picture: the scene built again from its settings, the running
//! render dropped, the first coarse picture of the new one published.

use std::sync::{Arc, mpsc};

use divan::Bencher;
use flambeau::{
    error::NO_PROGRESS,
    render::{Request, Session},
    scene::{self, DEFAULT_SCENE, Settings, VolumeCache},
    transport::Frame,
};
use glam::UVec2;

fn main() {
    divan::main();
}

const SIZE: UVec2 = UVec2::new(960, 540);

struct Window {
    session: Session,
    published: mpsc::Receiver<()>,
    cache: VolumeCache,
    settings: Settings,
    generation: u64,
}

impl Window {
    fn open() -> Self {
        let (news, published) = mpsc::channel();
        let news = std::sync::Mutex::new(news);
        let session = Session::new(None, move || {
            // The receiver may be gone at the end of the benchmark.
            let _ = news.lock().unwrap().send(());
        });
        let settings = scene::load(DEFAULT_SCENE).unwrap();
        let cache = VolumeCache::default();
        Self { session: session.unwrap(), published, cache, settings, generation: 0 }
    }

    fn edit(&mut self, change: impl Fn(&mut Settings, u64)) {
        self.generation += 1;
        change(&mut self.settings, self.generation);
        let scene =
            Arc::new(flambeau::scene::assemble(&self.settings, &self.cache, NO_PROGRESS).unwrap());
        self.session.start(Request {
            sampler: Arc::new(Frame::new(scene, SIZE, 0, NO_PROGRESS).unwrap()),
            size: SIZE,
            spp: 0,
            generation: self.generation,
            resume: None,
            provisional: false,
        });
        while self.session.latest().is_none_or(|p| p.generation != self.generation) {
            self.published.recv().unwrap();
        }
    }
}

/// The camera moves: nothing of the volumes is built again.
#[divan::bench(sample_count = 30, sample_size = 1)]
fn camera_edit_to_picture(bencher: Bencher) {
    let mut window = Window::open();
    window.edit(|_, _| ());
    bencher.bench_local(|| {
        window.edit(|settings, n| settings.camera.position[0] = 0.6 + 0.001 * n as f32);
    });
}

/// The density slider moves: the majorants of that volume are built again.
#[divan::bench(sample_count = 30, sample_size = 1)]
fn density_edit_to_picture(bencher: Bencher) {
    let mut window = Window::open();
    window.edit(|_, _| ());
    bencher.bench_local(|| {
        window.edit(|settings, n| {
            let scale = 12.0 + 0.01 * n as f32;
            settings.volume[0].density.scale = scene::settings::Color::Gray(scale);
        });
    });
}
