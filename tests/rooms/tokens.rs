//! Paths among the tokens of macros and attributes, where no grammar says what is a path.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

use crate::imports::{Import, flatten};

/// What tokens name.
pub enum Found {
    /// A path.
    Path {
        /// Its segments; `::` stands first where the path begins with it.
        segments: Vec<String>,
        /// Its line.
        line: usize,
    },
    /// One name of a `use`, as a macro may write it.
    Use(Import),
}

/// Keys of attributes whose text is a path.
const QUOTED: [&str; 8] = [
    "default",
    "with",
    "serialize_with",
    "deserialize_with",
    "skip_serializing_if",
    "schema_with",
    "from",
    "into",
];

/// The segments of a path, without what stands in angle brackets.
pub fn segments(path: &syn::Path) -> Vec<String> {
    let leading = path.leading_colon.map(|_| "::".to_owned());
    let names = path.segments.iter().map(|segment| segment.ident.to_string());
    leading.into_iter().chain(names).collect()
}

/// All paths among the tokens, also those of one segment; fields and methods are left out.
pub fn paths(tokens: TokenStream) -> Vec<Found> {
    let mut scan = Scan { tokens: tokens.into_iter().collect(), at: 0, found: Vec::new() };
    scan.run();
    scan.found
}

/// Paths that an attribute holds as text, such as `default = "crate::one"`.
pub fn quoted_paths(tokens: TokenStream) -> Vec<(Vec<String>, usize)> {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut found = Vec::new();
    for window in tokens.windows(3) {
        let [TokenTree::Ident(key), TokenTree::Punct(equals), TokenTree::Literal(text)] = window
        else {
            continue;
        };
        let line = text.span().start().line;
        let text = text.to_string();
        let path = syn::parse_str::<syn::Path>(text.trim_matches('"'));
        if equals.as_char() == '=' && QUOTED.contains(&key.to_string().as_str()) {
            found.extend(path.map(|path| (segments(&path), line)));
        }
    }
    found
}

struct Scan {
    tokens: Vec<TokenTree>,
    at: usize,
    found: Vec<Found>,
}

impl Scan {
    fn run(&mut self) {
        while let Some(token) = self.tokens.get(self.at) {
            match token {
                TokenTree::Ident(_) => self.path(),
                TokenTree::Group(group) => {
                    self.found.extend(paths(group.stream()));
                    self.at += 1;
                }
                _ => self.at += 1,
            }
        }
    }

    fn path(&mut self) {
        let line = self.tokens[self.at].span().start().line;
        let is_member = self.punct_before(1) == Some('.') && self.punct_before(2) != Some('.');
        let is_leading = self.punct_before(1) == Some(':') && self.punct_before(2) == Some(':');
        let is_variable = self.punct_before(1) == Some('$');
        let mut segments: Vec<String> = is_leading.then(|| "::".to_owned()).into_iter().collect();
        let first = self.take_ident();
        if is_member || (is_variable && first != "crate") {
            return;
        }
        segments.push(first);
        while self.colons_here() {
            self.at += 2;
            match self.tokens.get(self.at) {
                Some(TokenTree::Ident(_)) => segments.push(self.take_ident()),
                Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                    self.found.extend(uses(&segments, TokenTree::Group(group.clone()).into()));
                    return;
                }
                Some(TokenTree::Punct(star)) if star.as_char() == '*' => {
                    let star = TokenTree::Punct(star.clone());
                    self.found.extend(uses(&segments, star.into()));
                    return;
                }
                _ => break,
            }
        }
        self.found.push(Found::Path { segments, line });
    }

    fn take_ident(&mut self) -> String {
        self.at += 1;
        self.tokens[self.at - 1].to_string()
    }

    fn punct_before(&self, back: usize) -> Option<char> {
        match self.tokens.get(self.at.checked_sub(back)?)? {
            TokenTree::Punct(punct) => Some(punct.as_char()),
            _ => None,
        }
    }

    fn colons_here(&self) -> bool {
        let colon = |at: usize| matches!(self.tokens.get(at), Some(TokenTree::Punct(punct)) if punct.as_char() == ':');
        colon(self.at) && colon(self.at + 1)
    }
}

/// The names of a group or star that follows a path.
fn uses(segments: &[String], tokens: TokenStream) -> Vec<Found> {
    let line = tokens.clone().into_iter().next().map_or(0, |token| token.span().start().line);
    let mut import = Import { path: segments.to_vec(), name: None, reexport: false, line };
    let mut imports = Vec::new();
    if let Ok(tree) = syn::parse2(tokens) {
        flatten(&tree, &mut import, &mut imports);
    }
    imports.into_iter().map(Found::Use).collect()
}
