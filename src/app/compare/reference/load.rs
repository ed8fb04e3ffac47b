//! References on their way: read from files or taken from pictures, off the window's thread.

use std::path::{Path, PathBuf};
use std::sync::{Arc, mpsc};

use crate::error::{Error, Result};
use crate::image::Reference;
use crate::image::exr::read_info;
use crate::render::Picture;
use crate::scene::settings::CameraSettings;
use crate::scene::{self, Settings};

/// A loaded reference with what it shows.
#[derive(Debug)]
pub struct LoadedReference {
    /// The user's name for the reference.
    pub name: String,
    /// The picture.
    pub reference: Reference,
    /// File that the reference came from.
    pub path: Option<PathBuf>,
    shows: Shows,
}

/// The contents of a reference, as far as known.
#[derive(Debug)]
enum Shows {
    /// Unknown contents.
    Unknown,
    /// The view of this camera.
    Camera(CameraSettings),
    /// A scene with these settings.
    Scene(Box<Settings>),
}

/// Origin of a reference: a file, or a picture of the window.
pub enum ReferenceOrigin {
    /// A file; the name is what the user calls it.
    File(String, PathBuf),
    /// A picture of these settings.
    Picture(String, Arc<Picture>, Box<Settings>),
}

impl ReferenceOrigin {
    /// A file under its own name.
    pub fn file(path: PathBuf) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Self::File(name, path)
    }
}

impl LoadedReference {
    /// Loads the reference from its origin.
    ///
    /// # Errors
    /// As [`Reference::load`] and [`Reference::new`].
    pub fn new(origin: ReferenceOrigin) -> Result<Self> {
        match origin {
            ReferenceOrigin::File(name, path) => {
                let reference = Reference::load(&path)?;
                let shows = camera(&path).map_or(Shows::Unknown, Shows::Camera);
                Ok(Self { name, reference, path: Some(path), shows })
            }
            ReferenceOrigin::Picture(name, picture, settings) => {
                let reference = Reference::new(&name, picture.size, picture.pixels.clone())?;
                Ok(Self { name, reference, path: None, shows: Shows::Scene(settings) })
            }
        }
    }

    /// Reason why errors against the reference mean little for a render of `settings`, if it is
    /// known to show something else.
    pub fn warning(&self, settings: &Settings) -> Option<&'static str> {
        match &self.shows {
            Shows::Unknown => None,
            Shows::Camera(camera) if *camera != settings.camera => Some("its camera differs"),
            Shows::Camera(_) => None,
            Shows::Scene(then) if then.camera != settings.camera => Some("its camera differs"),
            Shows::Scene(then) => {
                let same = then.scene == settings.scene
                    && then.path == settings.path
                    && then.environment == settings.environment
                    && then.volume == settings.volume
                    && then.light == settings.light
                    && then.surface == settings.surface;
                (!same).then_some("the scene has changed since")
            }
        }
    }
}

/// The camera of an EXR that Flambeau wrote.
fn camera(path: &Path) -> Option<CameraSettings> {
    let header = read_info(path).ok()?.header?;
    scene::settings_of(&header, "").ok().map(|settings| settings.camera)
}

/// A reference under way.
pub struct Loading(mpsc::Receiver<Result<LoadedReference>>);

impl Loading {
    /// Starts to load a reference from `origin`; `wake` is called once it is there.
    ///
    /// # Errors
    /// When the system refuses to start a thread.
    pub fn start(origin: ReferenceOrigin, wake: impl FnOnce() + Send + 'static) -> Result<Self> {
        let (sender, receiver) = mpsc::channel();
        let work = move || {
            // Nobody listens any more where another one was asked for.
            let _ = sender.send(LoadedReference::new(origin));
            wake();
        };
        let thread = std::thread::Builder::new().name("reference".to_owned()).spawn(work);
        thread.map_err(|error| Error::io("the thread for references", error))?;
        Ok(Self(receiver))
    }

    /// The outcome, once.
    pub fn poll(&self) -> Option<Result<LoadedReference>> {
        match self.0.try_recv() {
            Ok(result) => Some(result),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => {
                let reason = "it could not be loaded; try again, or another file";
                Some(Err(Error::invalid("the reference", "", reason)))
            }
        }
    }
}
