//! What the documents say of the code is so: files they name exist, constants have the values they
//! give.

use std::path::{Path, PathBuf};

const DOCUMENTS: [&str; 4] =
    ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "assets/docs/estimators.md"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()
}

fn read(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Pieces of a Markdown text between backticks, code blocks left out.
fn code(text: &str) -> Vec<String> {
    let prose = text.split("```").step_by(2);
    prose.flat_map(|prose| prose.split('`').skip(1).step_by(2).map(str::to_owned)).collect()
}

#[test]
fn files_that_documents_name_exist() {
    let folders = ["src/", "tests/", "benches/", "assets/", "scenes/", "examples/"];
    for document in DOCUMENTS {
        let text = read(document);
        let code = code(&text);
        let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        let links = links.filter(|link| !link.contains("://")).map(str::to_owned);
        let folder = root().join(document).parent().unwrap().to_owned();
        let named = code.iter().filter(|name| folders.iter().any(|f| name.starts_with(f)));
        let named = named.filter(|name| !name.contains([' ', '*', '<'])).map(|n| root().join(n));
        let all: Vec<PathBuf> = named.chain(links.map(|link| folder.join(link))).collect();
        assert!(!all.is_empty(), "{document} names no file");
        for path in all {
            assert!(path.exists(), "{document} names {}, which is not there", path.display());
        }
    }
}

/// A row of the estimators' tables of constants: name, value, file.
fn constant(line: &str) -> Option<[&str; 3]> {
    let mut cells = line.strip_prefix('|')?.split('|').map(|cell| cell.trim().trim_matches('`'));
    let [name, value, file] = [cells.next()?, cells.next()?, cells.next()?];
    file.starts_with("src/").then_some([name, value, file])
}

#[test]
fn measured_constants_are_as_told() {
    let text = read("assets/docs/estimators.md");
    let rows: Vec<[&str; 3]> = text.lines().filter_map(constant).collect();
    assert!(rows.len() > 50, "{} rows: the test looks in the wrong place", rows.len());
    let is_wrong = |[name, value, file]: &&[&str; 3]| {
        let source = std::fs::read_to_string(root().join(file)).unwrap_or_default();
        let definition = source.lines().find(|line| line.contains(&format!("const {name}: ")));
        definition.is_none_or(|line| !line.ends_with(&format!(" = {value};")))
    };
    let wrong: Vec<_> = rows.iter().filter(is_wrong).collect();
    assert!(wrong.is_empty(), "these constants are elsewhere or have other values: {wrong:?}");
}
