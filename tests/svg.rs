//! SVG as files have it: every legal form of path data, shapes, transforms, uses, and what is no SVG.

use ogee::curve::Path;
use ogee::io::svg::{self, Drawing};
use ogee::math::Vec2;
use std::f64::consts::PI;

fn draw(inside: &str) -> Drawing {
    let text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink'>{inside}</svg>"
    );
    svg::read(text.as_bytes()).unwrap_or_else(|error| panic!("{inside}: {error}"))
}

fn fails(inside: &str) -> String {
    let text = format!("<svg xmlns='http://www.w3.org/2000/svg'>\n{inside}</svg>");
    svg::read(text.as_bytes()).expect_err(inside).to_string()
}

fn path(data: &str) -> Path {
    svg::read_path(data).unwrap_or_else(|error| panic!("{data}: {error}"))
}

fn length(path: &Path) -> f64 {
    path.length(1e-13).expect("a length").value
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1e-300), "{found:e} for {expected:e}");
}

#[test]
fn every_form_of_path_data() {
    // Each says the same as the plain form beside it.
    for (form, plain) in [
        ("M10-20l30.1.5.1-20z", "M 10 -20 L 40.1 -19.5 L 40.2 -39.5 Z"),
        ("m1 2 3 4 5 6", "M 1 2 L 4 6 L 9 12"),
        ("M1,2,3,4", "M 1 2 L 3 4"),
        ("  M\n1\t2 , 3 ,4\r", "M 1 2 L 3 4"),
        ("M0 0H1 2h3V1v1 1", "M 0 0 L 1 0 L 2 0 L 5 0 L 5 1 L 5 2 L 5 3"),
        ("M0 0c1 2 3 4 5 6s1 2 3 4", "M 0 0 C 1 2 3 4 5 6 C 7 8 6 8 8 10"),
        ("M0 0S1 2 3 4", "M 0 0 C 0 0 1 2 3 4"),
        ("M0 0Q1 1 2 0S1 2 3 4", "M 0 0 Q 1 1 2 0 C 2 0 1 2 3 4"),
        ("M0 0q1 1 2 0t2 0 2 0", "M 0 0 Q 1 1 2 0 Q 3 -1 4 0 Q 5 1 6 0"),
        ("M0 0C1 1 2 2 3 0T5 5", "M 0 0 C 1 1 2 2 3 0 Q 3 0 5 5"),
        ("M0 0T5 5", "M 0 0 Q 0 0 5 5"),
        ("M0 0a1 1 0 112 0", "M 0 0 A 1 1 0 1 1 2 0"),
        ("M0 0a1 1 0 01.5.5", "M 0 0 A 1 1 0 0 1 0.5 0.5"),
        ("M0 0a1 1 0 1 , 0 ,2,0 1,1 0 00-2-0", "M 0 0 A 1 1 0 1 0 2 0 A 1 1 0 0 0 0 0"),
        ("M0 0A-1-1 0 1 1 2 0", "M 0 0 A 1 1 0 1 1 2 0"),
        ("M0 0A0 1 0 1 1 2 0", "M 0 0 L 2 0"),
        ("M0 0A1 1 0 1 1 0 0L1 1", "M 0 0 L 1 1"),
        ("M1e2-1E-2L+.5e+1 5.", "M 100 -0.01 L 5 5"),
        ("M0 0L1 1zL2 2", "M 0 0 L 1 1 Z M 0 0 L 2 2"),
        ("M1 1l1 1zm1 0l1 1", "M 1 1 L 2 2 Z M 2 1 L 3 2"),
        ("M0 0M1 1L2 2", "M 1 1 L 2 2"),
        ("M0 0z", ""),
        ("none", ""),
        (" ", ""),
        ("M 4 4", ""),
    ] {
        assert_eq!(path(form), path(plain), "{form}");
    }
}

#[test]
fn broken_path_data_is_refused_with_its_place() {
    for (data, expected) in [
        ("L0 0", "line 1, column 1: expected a move, M or m, found `L0`"),
        ("M0", "line 1, column 3: the value ends where a number should follow"),
        ("M0 0L1", "line 1, column 7: the value ends where a number should follow"),
        ("M0 0,L1 1", "line 1, column 6: expected a number, found `L1`"),
        ("M,0 0", "line 1, column 2: expected a number, found `,0`"),
        ("M0,,0", "line 1, column 4: expected a number, found `,0`"),
        ("M0 0\nL1 x", "line 2, column 4: expected a number, found `x`"),
        ("M0 0z5 5", "line 1, column 6: expected a command, one of MLHVCSQTAZ, large or small, found `5`"),
        ("M0 0a1 1 0 2 0 1 1", "line 1, column 12: expected a flag, 0 or 1, found `2`"),
        ("M1e999 0", "line 1, column 2: expected a number, found `1e999`"),
        ("M0 0L.", "line 1, column 6: expected a number, found `.`"),
        ("M0 0Lé 1", "line 1, column 6: expected a number, found `é`"),
        (
            "M1e308 0l1e308 0",
            "line 1, column 10: expected coordinates within the range of numbers, found `1e308`",
        ),
    ] {
        assert_eq!(svg::read_path(data).expect_err(data).to_string(), expected, "{data}");
    }
}

#[test]
fn basic_shapes_are_what_svg_says() {
    let drawing = draw(
        "<rect x='1' y='2' width='3' height='4'/><circle r='2'/><ellipse cx='5' rx='3' ry='1'/>\
         <line x2='3' y2='4'/><polyline points='0,0 3,0 3,4'/><polygon points='0 0 3 0 3-4'/>\
         <rect width='10' height='6' rx='2'/><rect width='4' height='4' rx='9'/><path d='M0 0h1'/>",
    );
    let expected = [
        ("rect", 4, 14.0, 12.0, true),
        ("circle", 4, 4.0 * PI, 4.0 * PI, true),
        ("ellipse", 4, 13.364_893_220_555_258, 3.0 * PI, true),
        ("line", 1, 5.0, 0.0, false),
        ("polyline", 2, 7.0, 6.0, false),
        ("polygon", 3, 12.0, -6.0, true),
        ("rect", 8, 16.0 + 4.0 * PI, 44.0 + 4.0 * PI, true),
        ("rect", 4, 4.0 * PI, 4.0 * PI, true),
        ("path", 1, 1.0, 0.0, false),
    ];
    assert_eq!(drawing.shapes.len(), expected.len());
    for (shape, (element, segments, long, area, closed)) in drawing.shapes.iter().zip(expected) {
        assert_eq!((shape.element.as_str(), shape.path.pieces().count()), (element, segments));
        assert_eq!(shape.path.is_closed(), closed, "{element}");
        near(length(&shape.path), long);
        near(shape.path.area(), area);
    }
    let bounds = drawing.shapes[2].path.bounding_box().expect("a box");
    assert!(
        (bounds.min - Vec2::new(2.0, -1.0)).length() < 1e-14
            && (bounds.max - Vec2::new(8.0, 1.0)).length() < 1e-14
    );
}

#[test]
fn shapes_without_size_are_empty() {
    let drawing = draw("<rect width='0' height='3'/><circle/><polygon points='1 1'/><path/><line/>");
    let counts: Vec<usize> = drawing.shapes.iter().map(|shape| shape.path.pieces().count()).collect();
    assert_eq!(counts, [0, 0, 0, 0, 1]);
    assert_eq!(drawing.shapes[0].path.bounding_box(), None);
}

#[test]
fn transforms_apply_from_the_inside_out() {
    let end = |inside: &str| draw(inside).shapes[0].path.subpaths[0].end();
    for (transform, expected) in [
        ("translate(10)", (12.0, 1.0)),
        ("translate(10,20) scale(2)", (14.0, 22.0)),
        ("scale(2 3)", (4.0, 3.0)),
        ("rotate(90)", (-1.0, 2.0)),
        ("rotate(90 1 1)", (1.0, 2.0)),
        ("matrix(1 2 3 4 5 6)", (10.0, 14.0)),
        ("skewX(45)", (3.0, 1.0)),
        ("skewY(45),translate(1 , 0)", (3.0, 4.0)),
        ("", (2.0, 1.0)),
    ] {
        let found = end(&format!("<path transform='{transform}' d='M0 0L2 1'/>"));
        assert!((found - Vec2::from(expected)).length() < 1e-15, "{transform}: {found}");
    }
    let nested = end("<g transform='scale(2)'><g transform='translate(1)'><path d='M0 0L2 1'/></g></g>");
    assert_eq!(nested, Vec2::new(6.0, 2.0));
    // A stretched circle is an ellipse, still exact.
    let circle = &draw("<circle r='1' transform='scale(3 1) rotate(20)'/>").shapes[0].path;
    near(length(circle), 13.364_893_220_555_258);
    near(circle.area(), 3.0 * PI);
}

#[test]
fn uses_and_views_are_followed() {
    let drawing = draw(
        "<defs><path id='a' d='M0 0h1'/><g id='b'><use href='#a' x='1'/></g></defs>\
         <symbol id='s' viewBox='0 0 2 2'><line x2='2'/></symbol>\
         <use xlink:href='#a' x='5' y='6'/><use href='#b' transform='scale(2)'/><use href='#s' width='10' height='10'/>\
         <use href='#nowhere'/><use href='other.svg#a'/><clipPath><path d='M0 0h9'/></clipPath>\
         <g display='none'><path d='M0 0h9'/></g><path style='fill:red; display : none' d='M0 0h9'/>\
         <svg x='1' y='1' width='20' height='10' viewBox='0 0 1 1'><path d='M0 0h1'/></svg>\
         <svg width='20' height='10' viewBox='0 0 1 1' preserveAspectRatio='none'><path d='M0 0h1'/></svg>\
         <svg width='20' height='10' viewBox='0 0 1 1' preserveAspectRatio='xMaxYMin slice'><path d='M0 0h1'/></svg>",
    );
    let ends: Vec<[f64; 4]> = drawing
        .shapes
        .iter()
        .map(|shape| {
            let part = &shape.path.subpaths[0];
            [part.start().x, part.start().y, part.end().x, part.end().y]
        })
        .collect();
    assert_eq!(
        ends,
        [
            [5.0, 6.0, 6.0, 6.0],
            [2.0, 0.0, 4.0, 0.0],
            [0.0, 0.0, 10.0, 0.0],
            [6.0, 1.0, 16.0, 1.0],
            [0.0, 0.0, 20.0, 0.0],
            [0.0, 0.0, 20.0, 0.0],
        ]
    );
}

#[test]
fn units_and_sizes() {
    let read = |head: &str| {
        svg::read(format!("<svg {head}><line x2='1in' y2='50%'/></svg>").as_bytes()).expect(head)
    };
    let drawing = read("width='100mm' height='5cm' viewBox='0 0 200 100'");
    assert_eq!(drawing.view, Some([Vec2::ZERO, Vec2::new(200.0, 100.0)]));
    assert!((drawing.millimetres() - Vec2::splat(0.5)).length() < 1e-15);
    assert_eq!(drawing.shapes[0].path.subpaths[0].end(), Vec2::new(96.0, 50.0));
    assert_eq!(read("width='100%'").size, [None, None]);
    assert_eq!(read("width='72pt' height='6pc'").size, [Some(96.0), Some(96.0)]);
    assert!((read("").millimetres() - Vec2::splat(25.4 / 96.0)).length() < 1e-15);
}

#[test]
fn what_is_not_svg_is_refused_with_its_place() {
    for (inside, expected) in [
        ("<path d='M0 0\nL1 q'/>", "line 3, column 4: expected a number, found `q`"),
        ("  <path d='M0 0L1'/>", "line 2, column 18: the value ends where a number should follow"),
        ("<path d='&lt;'/>", "line 2, column 10: expected a move, M or m, found `<`"),
        (
            "<polygon points='0 0 1'/>",
            "line 2, column 23: the value ends where the second coordinate of a point should follow",
        ),
        ("<circle r='-1'/>", "line 2, column 12: expected a length that is not negative, found `-1`"),
        (
            "<circle r='1furlong'/>",
            "line 2, column 13: expected a unit: px, in, cm, mm, Q, pt, pc, em, ex or %, found `furlong`",
        ),
        (
            "<g transform='turn(3)'/>",
            "line 2, column 15: expected one of matrix, translate, scale, rotate, skewX, skewY, found `turn(3)`",
        ),
        (
            "<g transform='rotate(1 2)'/>",
            "line 2, column 15: expected a map with its number of arguments, found `rotate(1`",
        ),
        (
            "<g transform='scale(1e300)'><g transform='scale(1e300)'><line x2='1'/></g></g>",
            "line 2, column 57: coordinates leave the range of numbers",
        ),
        ("<g id='a'><use href='#a'/></g>", "line 2, column 11: more than 32 levels of use"),
        ("<path d='M0 0' ", "line 2, column 16: invalid name token"),
    ] {
        let found = fails(inside);
        assert!(found.starts_with(expected), "{inside}: {found}");
    }
    for (bytes, expected) in [
        (&b""[..], "line 1, column 1: "),
        (b"<html/>", "line 1, column 1: expected an svg element, found `html`"),
        (b"\xff\xfe<\0", "line 1, column 1: a text in UTF-16 cannot be read"),
        (b"\x1f\x8b\x08", "line 1, column 1: a compressed drawing (.svgz) cannot be read"),
        (b"<svg>\xff</svg>", "line 1, column 1: a text that is not UTF-8 cannot be read"),
        (b"not xml at all", "line 1, column 1: "),
    ] {
        let found = svg::read(bytes).expect_err("no SVG").to_string();
        assert!(found.starts_with(expected), "{found}");
    }
}

#[test]
fn hostile_files_end_soon() {
    // Each level uses the one below ten times: 10^12 lines.
    let mut text = String::from("<path id='a0' d='M0 0h1'/>");
    for level in 1..=12 {
        text += &format!("<g id='a{level}'>{}</g>", format!("<use href='#a{}'/>", level - 1).repeat(10));
    }
    let found = fails(&format!("<defs>{text}</defs><use href='#a12'/>"));
    assert!(found.ends_with("more than 1000000 elements"), "{found}");
    // A hundred thousand pieces, a hundred times.
    let long = format!("<defs><path id='a' d='M0 0h{}'/></defs>", "1 ".repeat(100_000));
    let found = fails(&format!("{long}{}", "<use href='#a'/>".repeat(100)));
    assert!(found.ends_with("more than 4000000 pieces of paths"), "{found}");
    // Entities within entities.
    let mut bomb = String::from("<!DOCTYPE svg [<!ENTITY a 'aaaaaaaaaa'>");
    for (name, of) in "bcdefghijkl".chars().zip("abcdefghijk".chars()) {
        bomb += &format!("<!ENTITY {name} '{}'>", format!("&{of};").repeat(10));
    }
    assert!(svg::read(format!("{bomb}]><svg><path d='&l;'/></svg>").as_bytes()).is_err());
    let deep = format!("<svg>{}<line x2='1'/>{}</svg>", "<g>".repeat(20_000), "</g>".repeat(20_000));
    if let Ok(drawing) = svg::read(deep.as_bytes()) {
        assert_eq!(drawing.shapes.len(), 1);
    }
}

#[test]
fn text_is_counted_and_passed_over() {
    let drawing = draw("<text>a</text><g><text>b</text><image/></g><title>c</title>");
    assert_eq!(drawing.ignored, [("image".to_owned(), 1), ("text".to_owned(), 2)]);
}

#[test]
fn styles_are_obeyed_or_named() {
    let drawing = draw(
        "<style>/* .x { r: 1 } */ .a { fill: red; transform: scale(2) } @media print { .b { display: none } }</style>
        <line x2='1' style='display: none !important'/><line x2='2' display='none' style='display:inline'/>
        <line x2='3' style='stroke: red; transform: translate(3px)'/><circle r='1' style='cx: 5px; Transform: none'/>",
    );
    let ends: Vec<f64> =
        drawing.shapes.iter().map(|shape| shape.path.subpaths[0].pieces()[0].end().x).collect();
    assert_eq!(ends[..2], [2.0, 3.0]);
    let expected = [("cx", 1), ("display", 1), ("transform", 3)];
    assert_eq!(drawing.disobeyed, expected.map(|(name, count)| (name.to_owned(), count)));
}
