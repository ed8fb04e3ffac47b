//! Names that `use` brings into a module, one by one.

use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Item, ItemMod, ItemUse, UseTree, Visibility};

use crate::modules::is_test_only;

/// One name of a `use` declaration.
#[derive(Clone)]
pub struct Import {
    /// Segments of the path; `::` stands first where the path begins with it. Without the `*` of a
    /// glob.
    pub path: Vec<String>,
    /// The name that it gets here; `None` for a glob.
    pub name: Option<String>,
    /// Whether other modules may take it from here.
    pub reexport: bool,
    /// Line of the declaration.
    pub line: usize,
}

/// The imports of a module and of the blocks in it; those of its tests and its modules are left
/// out.
pub fn of_items(items: &[Item]) -> Vec<Import> {
    let mut gatherer = Gatherer::default();
    for item in items {
        gatherer.visit_item(item);
    }
    gatherer.imports
}

#[derive(Default)]
struct Gatherer {
    imports: Vec<Import>,
}

impl Visit<'_> for Gatherer {
    fn visit_item(&mut self, item: &Item) {
        if !attributes(item).iter().any(is_test_only) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, _: &ItemMod) {}

    fn visit_item_use(&mut self, item: &ItemUse) {
        let path = item.leading_colon.map(|_| "::".to_owned()).into_iter().collect();
        let reexport = !matches!(item.vis, Visibility::Inherited);
        let line = item.span().start().line;
        let mut import = Import { path, name: None, reexport, line };
        flatten(&item.tree, &mut import, &mut self.imports);
    }
}

/// Adds the imports of a tree below the path of `import`, which comes back as it was.
pub fn flatten(tree: &UseTree, import: &mut Import, imports: &mut Vec<Import>) {
    let depth = import.path.len();
    match tree {
        UseTree::Path(path) => {
            import.path.push(path.ident.to_string());
            flatten(&path.tree, import, imports);
        }
        UseTree::Group(group) => {
            for tree in &group.items {
                flatten(tree, import, imports);
            }
        }
        UseTree::Glob(_) => imports.push(Import { name: None, ..import.clone() }),
        UseTree::Name(name) => add(&name.ident, &name.ident, import, imports),
        UseTree::Rename(rename) => add(&rename.ident, &rename.rename, import, imports),
    }
    import.path.truncate(depth);
}

fn add(ident: &syn::Ident, name: &syn::Ident, import: &mut Import, imports: &mut Vec<Import>) {
    let mut name = name.to_string();
    if ident == "self" && !import.path.is_empty() {
        if name == "self" {
            name.clone_from(&import.path[import.path.len() - 1]);
        }
    } else {
        import.path.push(ident.to_string());
    }
    imports.push(Import { name: Some(name), ..import.clone() });
}

/// The attributes of an item.
pub fn attributes(item: &Item) -> &[syn::Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}
