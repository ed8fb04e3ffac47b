//! Paths followed to the file that defines what they name, through imports, re-exports and globs.

use std::collections::BTreeSet;

use crate::modules::{Module, Package};

/// The library, as the other targets of the package name it.
const LIBRARY: &str = "flambeau";

/// The end of a path within the package.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Target {
    /// A module itself.
    Module(usize),
    /// An item, with the file that defines it.
    Item {
        /// The defining file.
        file: String,
        /// Its name there.
        name: String,
    },
}

type Targets = BTreeSet<Target>;

/// A search through the modules, which ends where imports lead in a loop.
pub struct Search<'p> {
    package: &'p Package,
    open: Vec<(usize, String)>,
}

impl<'p> Search<'p> {
    /// A search through the modules of `package`.
    pub fn new(package: &'p Package) -> Self {
        Self { package, open: Vec::new() }
    }

    /// All that a path in `module` may name; none where it leaves the package.
    pub fn path(&mut self, module: usize, path: &[String]) -> Targets {
        let Some((first, mut rest)) = path.split_first() else { return Targets::new() };
        let mut targets = match first.as_str() {
            "::" => {
                let Some((name, others)) = rest.split_first() else { return Targets::new() };
                rest = others;
                self.library(name)
            }
            first => self.first(module, first, !rest.is_empty()),
        };
        for name in rest {
            let modules: Vec<usize> = targets.iter().filter_map(Target::module).collect();
            if modules.is_empty() {
                break;
            }
            targets = modules.into_iter().flat_map(|module| self.member(module, name)).collect();
        }
        let items: Targets = targets.iter().filter(|target| target.is_item()).cloned().collect();
        if items.is_empty() { targets } else { items }
    }

    /// The macros that a bare name in `module` may call: imported, or of a module around it.
    pub fn bare_macro(&mut self, module: usize, name: &str) -> Targets {
        let mut targets = self.name(module, name).unwrap_or_default();
        let mut around = Some(module);
        while let Some(module) = around.map(|index| self.module(index)) {
            if module.macros.contains(name) {
                let (file, name) = (module.file.clone(), name.to_owned());
                targets.insert(Target::Item { file, name });
            }
            around = module.parent;
        }
        targets
    }

    fn first(&mut self, module: usize, name: &str, goes_on: bool) -> Targets {
        let special = match name {
            "crate" => Some(self.module(module).root),
            "self" => Some(module),
            "super" => self.module(module).parent,
            _ => None,
        };
        match special {
            Some(module) => Targets::from([Target::Module(module)]),
            None => match self.name(module, name) {
                Some(targets) => targets,
                None if goes_on => self.library(name),
                None => Targets::new(),
            },
        }
    }

    fn library(&self, name: &str) -> Targets {
        let root = self.package.library.filter(|_| name == LIBRARY);
        root.map(Target::Module).into_iter().collect()
    }

    /// A name that is asked of a module from outside. A name that is not found there is one that
    /// a macro defines.
    fn member(&mut self, module: usize, name: &str) -> Targets {
        match name {
            "self" | "super" | "crate" => self.first(module, name, true),
            _ => self.name(module, name).unwrap_or_else(|| {
                let (file, name) = (self.module(module).file.clone(), name.to_owned());
                Targets::from([Target::Item { file, name }])
            }),
        }
    }

    /// All that a name means in a module; `None` for a name that it does not have.
    fn name(&mut self, module: usize, name: &str) -> Option<Targets> {
        let inside = self.module(module);
        let mut targets = Targets::new();
        let children = inside.children.get(name).into_iter().flatten();
        targets.extend(children.map(|child| Target::Module(*child)));
        let item = |file: &String| Target::Item { file: file.clone(), name: name.to_owned() };
        targets.extend(inside.defined.get(name).map(item));
        let mut known = !targets.is_empty();
        if self.open.iter().any(|(open, asked)| *open == module && asked == name) {
            return known.then_some(targets);
        }
        self.open.push((module, name.to_owned()));
        for import in inside.imports.iter().filter(|import| import.name.as_deref() == Some(name)) {
            known = true;
            targets.extend(self.path(module, &import.path));
        }
        if !known && let Some(found) = self.through_globs(module, name) {
            known = true;
            targets.extend(found);
        }
        self.open.pop();
        known.then_some(targets)
    }

    fn through_globs(&mut self, module: usize, name: &str) -> Option<Targets> {
        let globs = self.module(module).imports.iter().filter(|import| import.name.is_none());
        let mut found: Option<Targets> = None;
        for glob in globs {
            for source in self.path(module, &glob.path).iter().filter_map(Target::module) {
                if let Some(targets) = self.name(source, name) {
                    found.get_or_insert_default().extend(targets);
                }
            }
        }
        found
    }

    fn module(&self, index: usize) -> &'p Module {
        &self.package.modules[index]
    }
}

impl Target {
    fn module(&self) -> Option<usize> {
        match self {
            Self::Module(index) => Some(*index),
            Self::Item { .. } => None,
        }
    }

    fn is_item(&self) -> bool {
        self.module().is_none()
    }
}
