//! The habits of the repository, tested: use goes down only, and every outside crate has one home.

use std::fs;
use std::path::Path;

/// Every outside crate and the places that may name it (a path below `src/`, a file or a folder).
const HOMES: &[(&str, &[&str])] = &[
    ("annotate_snippets", &["cli"]),
    ("clap", &["cli"]),
    ("csv", &["io/csv.rs"]),
    ("dejavu", &["plot/text.rs"]),
    ("dashu_int", &["numeric/integer_polynomial.rs"]),
    ("dashu_ratio", &["numeric/rational.rs"]),
    ("glam", &["math"]),
    ("indicatif", &["cli"]),
    ("libm", &["math"]),
    ("png", &["io/png.rs"]),
    ("rayon", &["par.rs"]),
    ("robust", &["numeric/predicates.rs"]),
    ("roxmltree", &["io/svg"]),
    ("serde_json", &["io", "cli"]),
    ("siphasher", &["numeric/hash.rs"]),
    ("spade", &["polygon/triangulate.rs"]),
    ("stacker", &["script/stack.rs"]),
    ("svg", &["io/svg", "plot"]),
    ("tiny_skia", &["plot/raster.rs"]),
    ("ttf_parser", &["plot"]),
];

/// Modules in the order `lib.rs` declares them, each with the layer comment it stands under.
struct House {
    modules: Vec<(String, String)>,
}

impl House {
    fn of(lib: &str) -> House {
        let mut layer = String::new();
        let mut modules = Vec::new();
        for line in lib.lines() {
            if let Some(name) = line.strip_prefix("// ") {
                layer = name.to_owned();
            } else if let Some(name) = line.strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(';')) {
                modules.push((layer.clone(), name.to_owned()));
            }
        }
        House { modules }
    }

    fn rank(&self, module: &str) -> Option<usize> {
        self.modules.iter().position(|(_, name)| name == module)
    }

    /// Layers in the order of their comments.
    fn depth(&self, layer: &str) -> usize {
        let mut layers: Vec<&str> = self.modules.iter().map(|(layer, _)| layer.as_str()).collect();
        layers.dedup();
        layers.iter().position(|&l| l == layer).expect("a layer of this house")
    }

    /// What is wrong with a file at `path` below `src/`.
    fn breaches(&self, path: &str, text: &str) -> Vec<String> {
        let code = without_comments(text);
        let mut found = Vec::new();
        let own = path.split(['/', '.']).next().unwrap_or_default();
        if let Some(rank) = self.rank(own) {
            for used in crate_uses(&code) {
                let Some(used_rank) = self.rank(&used) else { continue };
                let (layer, used_layer) = (&self.modules[rank].0, &self.modules[used_rank].0);
                if used != own && self.depth(used_layer) > self.depth(layer) {
                    found.push(format!("{path}: {own} ({layer}) uses {used} above it ({used_layer})"));
                } else if used != own && layer == used_layer && layer == "verbs" {
                    found.push(format!("{path}: the verb {own} uses the verb {used}"));
                } else if used != own && layer == used_layer && !self.may_use_sideways(rank, used_rank) {
                    found.push(format!("{path}: {own} uses {used}, which lib.rs does not list before it"));
                }
            }
        }
        for (name, homes) in HOMES {
            let at_home = homes.iter().any(|home| path == *home || path.starts_with(&format!("{home}/")));
            if !at_home && names_crate(&code, name) {
                found.push(format!("{path}: names the crate {name}, whose home is {}", homes.join(", ")));
            }
        }
        found
    }

    /// Within a layer, use follows the order of the map at the top of `lib.rs`; rustfmt sorts the declarations, so
    /// the map's table holds the order.
    fn may_use_sideways(&self, user: usize, used: usize) -> bool {
        let order = map_order();
        let place = |index: usize| order.iter().position(|name| *name == self.modules[index].1);
        place(used) < place(user)
    }
}

/// The modules in the order of the table at the top of `lib.rs`.
fn map_order() -> Vec<String> {
    let lib = fs::read_to_string("src/lib.rs").expect("src/lib.rs");
    let rows = lib.lines().filter(|line| line.starts_with("//! | "));
    rows.flat_map(|row| row.split('`').skip(1).step_by(2)).map(str::to_owned).collect()
}

fn without_comments(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Top-level modules that the code names as `crate::m` or within `crate::{...}`.
fn crate_uses(code: &str) -> Vec<String> {
    let mut uses = Vec::new();
    for (start, _) in code.match_indices("crate::") {
        let rest = &code[start + "crate::".len()..];
        if let Some(list) = rest.strip_prefix('{') {
            uses.extend(top_level_names(list));
        } else {
            uses.push(leading_name(rest));
        }
    }
    uses
}

/// The first name of each item of a use list, up to its closing brace.
fn top_level_names(list: &str) -> Vec<String> {
    let (mut depth, mut item, mut names) = (0, String::new(), Vec::new());
    for c in list.chars() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => names.push(leading_name(std::mem::take(&mut item).trim())),
            _ if depth == 0 => item.push(c),
            _ => {}
        }
    }
    names.push(leading_name(item.trim()));
    names
}

fn leading_name(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// Whether the code names the crate in a path or an attribute.
fn names_crate(code: &str, name: &str) -> bool {
    code.match_indices(name).any(|(start, _)| {
        let before = code[..start].chars().next_back();
        let after = &code[start + name.len()..];
        let whole = !before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':' || c == '.');
        whole
            && (after.starts_with("::")
                || (code[..start].trim_end().ends_with("use") && after.starts_with([';', ' '])))
    })
}

fn sources(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let name = path.strip_prefix("src").expect("below src").to_string_lossy().replace('\\', "/");
            found.push((name, fs::read_to_string(&path).expect("a text")));
        }
    }
}

fn house() -> House {
    House::of(&fs::read_to_string("src/lib.rs").expect("src/lib.rs"))
}

#[test]
fn use_goes_down_and_crates_stay_home() {
    let house = house();
    let mut files = Vec::new();
    sources(Path::new("src"), &mut files);
    let breaches: Vec<String> = files.iter().flat_map(|(path, text)| house.breaches(path, text)).collect();
    assert!(files.len() > 10 && breaches.is_empty(), "{}", breaches.join("\n"));
}

#[test]
fn the_map_names_every_module() {
    let house = house();
    let mapped = map_order();
    for (_, module) in &house.modules {
        assert!(mapped.contains(module), "the map in lib.rs lacks {module}");
    }
}

#[test]
fn every_dependency_has_a_home() {
    let manifest = fs::read_to_string("Cargo.toml").expect("Cargo.toml");
    let section = manifest.split("[dependencies]").nth(1).and_then(|rest| rest.split("\n[").next());
    for line in section.expect("dependencies").lines().filter(|line| line.contains('=')) {
        let name = line.split([' ', '.', '=']).next().unwrap_or_default().replace('-', "_");
        assert!(HOMES.iter().any(|(home, _)| *home == name), "{name} has no home in tests/tidy.rs");
    }
}

#[test]
fn planted_breaches_are_seen() {
    let house = house();
    let planted = [
        ("mesh/mod.rs", "use crate::boolean::Op;", "above it"),
        ("mesh/mod.rs", "fn f() -> crate::csg::Csg {}", "above it"),
        ("math/mod.rs", "use crate::{mesh::{Mesh, Solid}, par};", "above it"),
        ("boolean/mod.rs", "use crate::hull;", "the verb boolean uses the verb hull"),
        ("spatial/mod.rs", "use crate::mesh::Mesh;", "does not list before it"),
        ("io/stl.rs", "use png::Encoder;", "names the crate png"),
        ("script/mod.rs", "fn f() { rayon::join(a, b); }", "names the crate rayon"),
        ("polygon/mod.rs", "use spade;", "names the crate spade"),
    ];
    for (path, text, expected) in planted {
        let found = house.breaches(path, text);
        assert!(found.iter().any(|breach| breach.contains(expected)), "{path}: {text}: {found:?}");
    }
    let fine = [
        ("boolean/mod.rs", "use crate::mesh::Mesh; // not crate::hull"),
        ("script/mod.rs", "use crate::csg::Csg;"),
        ("io/png.rs", "use png::Encoder;"),
    ];
    for (path, text) in fine {
        assert_eq!(house.breaches(path, text), Vec::<String>::new(), "{path}: {text}");
    }
}
