//! What style sheets and `style` attributes say about geometry.

/// Properties of CSS that change what is drawn where (SVG 2, geometry properties; CSS transforms; motion paths).
const GEOMETRY: [&str; 18] = [
    "cx",
    "cy",
    "d",
    "height",
    "offset",
    "offset-path",
    "r",
    "rotate",
    "rx",
    "ry",
    "scale",
    "transform",
    "transform-origin",
    "translate",
    "width",
    "x",
    "y",
    "zoom",
];

/// Names and values of the declarations of a `style` attribute or the inside of a rule, without their importance.
pub(super) fn declarations(style: &str) -> impl Iterator<Item = (&str, &str)> {
    style.split(';').filter_map(|declaration| {
        let (name, value) = declaration.split_once(':')?;
        Some((name.trim(), value.split('!').next().unwrap_or_default().trim()))
    })
}

/// The name of a property that would change the geometry.
pub(super) fn geometry(name: &str) -> Option<&'static str> {
    GEOMETRY.into_iter().find(|known| name.eq_ignore_ascii_case(known))
}

/// The geometry properties that the rules of a style sheet set, in order; `display` where it hides something.
pub(super) fn in_sheet(sheet: &str) -> Vec<&'static str> {
    let sheet = without_comments(sheet);
    // Rules within rules (as of media) have their selectors in front of the first declaration.
    let inside = sheet.split('}').filter_map(|rule| rule.rsplit_once('{')).map(|(_, inside)| inside);
    let named = |(name, value): (&str, &str)| match geometry(name) {
        None if name.eq_ignore_ascii_case("display") && value.eq_ignore_ascii_case("none") => Some("display"),
        found => found,
    };
    inside.flat_map(declarations).filter_map(named).collect()
}

fn without_comments(sheet: &str) -> String {
    let mut parts = sheet.split("/*");
    let mut kept = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        kept.push_str(part.split_once("*/").map_or("", |(_, rest)| rest));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn geometry_is_found_in_sheets() {
        for (sheet, expected) in [
            ("", &[][..]),
            (".a { fill: red; stroke-width: 2 }", &[]),
            (".a{display:none}", &["display"]),
            (".a { display: inline } .b { DISPLAY : None !important; }", &["display"]),
            ("/* .a { r: 3 } */ #b { transform: rotate(3deg); r: 5px }", &["transform", "r"]),
            ("@media print { .a { d: path('M0 0') } } .c { x: 3", &["d", "x"]),
            ("}}{{;:;/*", &[]),
        ] {
            assert_eq!(in_sheet(sheet), expected, "{sheet}");
        }
    }
}
