//! The modules of a package: `mod` declarations are followed from the crate roots to their files,
//! whatever `#[cfg]` stands on them.

use std::collections::{BTreeMap, BTreeSet};

use syn::{Attribute, Item, ItemMod, Meta};

use crate::imports::{self, Import};
use crate::source::{Sources, is_root};

/// One module, inline or in a file of its own.
#[derive(Default)]
pub struct Module {
    /// The file that holds its items.
    pub file: String,
    /// The module that declares it; `None` for the root of a crate.
    pub parent: Option<usize>,
    /// The root of its crate.
    pub root: usize,
    /// Whether it is compiled for tests only.
    pub test: bool,
    /// Modules that it declares; two of one name where `#[cfg]` chooses between them.
    pub children: BTreeMap<String, Vec<usize>>,
    /// Names that `use` brings in, also those of a block.
    pub imports: Vec<Import>,
    /// Names that are defined here, with the file that does so.
    pub defined: BTreeMap<String, String>,
    /// Names of the `macro_rules!` written here.
    pub macros: BTreeSet<String>,
    /// Its items, without modules.
    pub items: Vec<Item>,
}

/// All modules of a package, with what could not be read.
#[derive(Default)]
pub struct Package {
    /// A module stands before its children.
    pub modules: Vec<Module>,
    /// The root of the library.
    pub library: Option<usize>,
    /// Files that do not parse, modules without a file and files without a module.
    pub faults: Vec<String>,
}

/// Where the source of a module stands.
#[derive(Clone, Default)]
struct Place {
    file: String,
    /// The folder in which the files of its children lie.
    folder: String,
    inline: bool,
    test: bool,
    parent: Option<usize>,
}

impl Package {
    /// Reads the modules of all crates among the sources.
    pub fn read(sources: &Sources) -> Self {
        let mut package = Self::default();
        for file in sources.keys().filter(|path| is_root(path)) {
            let place =
                Place { file: file.clone(), folder: folder(file).into(), ..Place::default() };
            let root = package.read_file(sources, place);
            if file == "src/lib.rs" {
                package.library = root;
            }
        }
        let read: BTreeSet<_> = package.modules.iter().map(|module| &module.file).collect();
        let stray = sources.keys().filter(|file| !read.contains(file));
        package.faults.extend(stray.map(|file| format!("{file}: no module declares this file")));
        package
    }

    /// Files that hold nothing but tests.
    pub fn test_files(&self) -> BTreeSet<&str> {
        let code: BTreeSet<_> = self.files();
        let all = self.modules.iter().map(|module| module.file.as_str());
        all.filter(|file| !code.contains(file)).collect()
    }

    /// Files that hold more than tests.
    pub fn files(&self) -> BTreeSet<&str> {
        let code = self.modules.iter().filter(|module| !module.test);
        code.map(|module| module.file.as_str()).collect()
    }

    fn read_file(&mut self, sources: &Sources, place: Place) -> Option<usize> {
        match syn::parse_file(sources.get(&place.file)?) {
            Ok(file) => Some(self.add(sources, place, file.items)),
            Err(error) => {
                let line = error.span().start().line;
                self.faults.push(format!("{}:{line}: {error}", place.file));
                None
            }
        }
    }

    fn add(&mut self, sources: &Sources, place: Place, items: Vec<Item>) -> usize {
        let index = self.modules.len();
        let (declared, items): (Vec<_>, Vec<_>) =
            items.into_iter().partition(|item| matches!(item, Item::Mod(_)));
        self.modules.push(Module {
            file: place.file.clone(),
            parent: place.parent,
            root: place.parent.map_or(index, |parent| self.modules[parent].root),
            test: place.test,
            imports: imports::of_items(&items),
            ..Module::default()
        });
        self.define(index, &items);
        self.modules[index].items = items;
        for item in declared {
            if let Item::Mod(module) = item {
                let name = module.ident.to_string();
                let child = self.declare(sources, &place, index, module);
                self.modules[index].children.entry(name).or_default().extend(child);
            }
        }
        index
    }

    fn define(&mut self, index: usize, items: &[Item]) {
        for item in items {
            let file = self.modules[index].file.clone();
            if let Some(name) = name_of(item) {
                self.modules[index].defined.insert(name, file.clone());
            }
            let Item::Macro(rules) = item else { continue };
            let Some(name) = rules.ident.as_ref().map(ToString::to_string) else { continue };
            if rules.attrs.iter().any(|attribute| attribute.path().is_ident("macro_export")) {
                let root = self.modules[index].root;
                self.modules[root].defined.insert(name.clone(), file);
            }
            self.modules[index].macros.insert(name);
        }
    }

    fn declare(
        &mut self,
        sources: &Sources,
        place: &Place,
        parent: usize,
        module: ItemMod,
    ) -> Option<usize> {
        let name = module.ident.to_string();
        let test = place.test || module.attrs.iter().any(is_test_only);
        let below = Place { test, parent: Some(parent), ..place.clone() };
        let path = path_attribute(&module.attrs);
        if let Some((_, items)) = module.content {
            let folder = format!("{}/{name}", place.folder);
            return Some(self.add(sources, Place { folder, inline: true, ..below }, items));
        }
        let candidates = files_of(&name, path.as_deref(), place);
        let Some(file) = candidates.into_iter().find(|file| sources.contains_key(file)) else {
            self.faults.push(format!("{}: the module {name} has no file", place.file));
            return None;
        };
        let holds_children = path.is_some() || file.ends_with("/mod.rs");
        let folder = if holds_children { folder(&file) } else { file.trim_end_matches(".rs") };
        let folder = folder.to_owned();
        self.read_file(sources, Place { file, folder, inline: false, ..below })
    }
}

fn folder(file: &str) -> &str {
    file.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// The files in which a module declared without a body may lie.
fn files_of(name: &str, path: Option<&str>, place: &Place) -> Vec<String> {
    match path {
        Some(path) if place.inline => vec![joined(&place.folder, path)],
        Some(path) => vec![joined(folder(&place.file), path)],
        None => {
            vec![format!("{}/{name}.rs", place.folder), format!("{}/{name}/mod.rs", place.folder)]
        }
    }
}

/// The path from a folder, with `..` taken back.
fn joined(folder: &str, path: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').collect();
    for part in path.split('/') {
        match part {
            "." => {}
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// The file that `#[path = "…"]` names.
fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    let attribute = attributes.iter().find(|attribute| attribute.path().is_ident("path"))?;
    let syn::Expr::Lit(literal) = &attribute.meta.require_name_value().ok()?.value else {
        return None;
    };
    match &literal.lit {
        syn::Lit::Str(path) => Some(path.value()),
        _ => None,
    }
}

/// Whether the attribute keeps what it stands on out of every build but that of the tests.
pub fn is_test_only(attribute: &Attribute) -> bool {
    attribute.path().is_ident("test")
        || attribute.path().is_ident("cfg")
            && attribute.parse_args::<Meta>().is_ok_and(|predicate| demands_test(&predicate))
}

fn demands_test(predicate: &Meta) -> bool {
    match predicate {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) if list.path.is_ident("all") => {
            let parser = syn::punctuated::Punctuated::<Meta, syn::Token![,]>::parse_terminated;
            list.parse_args_with(parser).is_ok_and(|parts| parts.iter().any(demands_test))
        }
        _ => false,
    }
}

/// The name that an item gives to its module.
fn name_of(item: &Item) -> Option<String> {
    let name = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::TraitAlias(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        _ => return None,
    };
    Some(name.to_string())
}
