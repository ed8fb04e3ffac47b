//! Which file takes which names from which other: every path in the code, followed to the file
//! that defines its item.

use std::collections::BTreeMap;

use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, Macro, Meta};

use crate::imports::{Import, attributes};
use crate::modules::{Package, is_test_only};
use crate::resolve::{Search, Target};
use crate::tokens::{self, Found};

/// How a file takes a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Use {
    /// The first line that does.
    pub line: usize,
    /// Whether it hands the name on by `pub use` and has no other use for it.
    pub reexport: bool,
}

/// Names that a file takes from another.
pub type Names = BTreeMap<String, Use>;

/// Names by the file that takes them and the file that defines them.
pub type Arrows = BTreeMap<(String, String), Names>;

/// The arrows of all code that is not a test.
pub fn of(package: &Package) -> Arrows {
    let mut arrows = Arrows::new();
    for (index, module) in package.modules.iter().enumerate().filter(|(_, module)| !module.test) {
        let mut reader = Reader { package, module: index, arrows: &mut arrows };
        for import in &module.imports {
            reader.import(import);
        }
        for item in &module.items {
            reader.visit_item(item);
        }
    }
    arrows
}

struct Reader<'p, 'a> {
    package: &'p Package,
    module: usize,
    arrows: &'a mut Arrows,
}

impl Reader<'_, '_> {
    fn search(&self) -> Search<'_> {
        Search::new(self.package)
    }

    fn path(&mut self, path: &[String], line: usize) {
        for target in self.search().path(self.module, path) {
            self.target(target, line);
        }
    }

    fn target(&mut self, target: Target, line: usize) {
        self.taken(target, Use { line, reexport: false });
    }

    fn taken(&mut self, target: Target, taken: Use) {
        let Target::Item { file, name } = target else { return };
        let here = &self.package.modules[self.module].file;
        if *here != file {
            let names = self.arrows.entry((here.clone(), file)).or_default();
            let known = names.entry(name).or_insert(taken);
            known.line = taken.line.min(known.line);
            known.reexport &= taken.reexport;
        }
    }

    /// An imported module is no arrow, since the paths through it are; a glob takes all that the
    /// file of its module defines.
    fn import(&mut self, import: &Import) {
        let taken = Use { line: import.line, reexport: import.reexport };
        for target in self.search().path(self.module, &import.path) {
            match target {
                Target::Module(source) if import.name.is_none() => {
                    let source = &self.package.modules[source];
                    if !source.defined.is_empty() {
                        let (file, name) = (source.file.clone(), "*".to_owned());
                        self.taken(Target::Item { file, name }, taken);
                    }
                }
                target => self.taken(target, taken),
            }
        }
    }

    /// A path that an attribute quotes may end in a module, whose functions are then called.
    fn quoted(&mut self, path: &[String], line: usize) {
        for target in self.search().path(self.module, path) {
            let target = match target {
                Target::Module(index) => {
                    let file = self.package.modules[index].file.clone();
                    Target::Item { file, name: path.join("::") }
                }
                item => item,
            };
            self.target(target, line);
        }
    }

    fn tokens(&mut self, tokens: proc_macro2::TokenStream) {
        for found in tokens::paths(tokens) {
            match found {
                Found::Path { segments, line } => self.path(&segments, line),
                Found::Use(import) => self.import(&import),
            }
        }
    }
}

impl Visit<'_> for Reader<'_, '_> {
    fn visit_item(&mut self, item: &Item) {
        if !attributes(item).iter().any(is_test_only) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &ImplItem) {
        let attributes: &[Attribute] = match item {
            ImplItem::Const(item) => &item.attrs,
            ImplItem::Fn(item) => &item.attrs,
            _ => &[],
        };
        if !attributes.iter().any(is_test_only) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_path(&mut self, path: &syn::Path) {
        self.path(&tokens::segments(path), path.span().start().line);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &Macro) {
        let line = call.span().start().line;
        match call.path.get_ident() {
            Some(name) => {
                for target in self.search().bare_macro(self.module, &name.to_string()) {
                    self.target(target, line);
                }
            }
            None => self.visit_path(&call.path),
        }
        self.tokens(call.tokens.clone());
    }

    fn visit_attribute(&mut self, attribute: &Attribute) {
        self.visit_path(attribute.path());
        if let Meta::List(list) = &attribute.meta {
            for (segments, line) in tokens::quoted_paths(list.tokens.clone()) {
                self.quoted(&segments, line);
            }
            self.tokens(list.tokens.clone());
        }
    }
}
