//! The scripts in `examples/`: they build, their results are closed, and their volumes are OpenSCAD's.

use ogee::csg::{self, BuildOptions, Shape};
use ogee::mesh::{Mesh, Solid};
use ogee::script::{self, Host, Loaded, Message, Severity};
use std::collections::BTreeMap;
use std::fs;
use std::sync::Arc;

/// A host for scripts that need nothing from outside and have nothing to complain about.
#[derive(Default)]
struct Alone {
    complaints: Vec<Message>,
}

impl Host for Alone {
    fn script(&mut self, name: &str, _: &str) -> Result<Loaded, String> {
        Err(format!("{name} is not needed"))
    }

    fn mesh(&mut self, name: &str, _: &str) -> Result<Arc<Mesh>, String> {
        Err(format!("{name} is not needed"))
    }

    fn say(&mut self, message: Message) {
        if message.severity != Severity::Echo {
            self.complaints.push(message);
        }
    }
}

fn build(name: &str) -> Solid {
    build_with(name, Vec::new())
}

fn build_with(name: &str, define: Vec<String>) -> Solid {
    let path = format!("examples/{name}.scad");
    let main = Loaded { text: fs::read_to_string(&path).expect("an example"), name: path };
    let mut host = Alone::default();
    let options = script::Options { define, ..script::Options::default() };
    let evaluated = script::evaluate(main, &mut host, &options);
    assert!(host.complaints.is_empty(), "{name}: {:?}", host.complaints);
    let built = csg::build(&evaluated.expect("a recipe").recipe, &BuildOptions::default()).expect("a shape");
    match built.shape {
        Shape::Solid(solid) => solid,
        Shape::Region(_) => panic!("{name} is flat"),
    }
}

/// Names and volumes that `fixtures/examples/record.py` wrote, and the relative tolerance they are good to.
fn recorded() -> (BTreeMap<String, f64>, f64) {
    let text = fs::read_to_string("fixtures/examples/volumes.json").expect("the record");
    let record: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let volume =
        |(name, volume): (&String, &serde_json::Value)| (name.clone(), volume.as_f64().expect("a number"));
    let volumes = record["volumes"].as_object().expect("volumes").iter().map(volume).collect();
    (volumes, record["tolerance"].as_f64().expect("a tolerance"))
}

/// Parts and handles, counted by hand: screw holes, spokes, windows.
const COUNTED: [(&str, usize, u64); 13] = [
    ("bin", 1, 0),
    ("bracket", 1, 4),
    ("chess", 2, 0),
    ("classic", 1, 5),
    ("enclosure", 2, 12),
    ("gear", 1, 7),
    ("hinge", 2, 4),
    ("jar", 2, 0),
    ("knot", 1, 1),
    ("menger", 1, 1409),
    ("nameplate", 1, 2),
    ("perforated", 1, 85),
    ("vase", 1, 0),
];

/// Examples that use what OpenSCAD does not have: parts, handles, and what is set to be done soon.
/// The whorls of the shell go around its axis.
const OURS: [(&str, usize, u64, &[&str]); 3] =
    [("bottle", 2, 0, &[]), ("shell", 1, 1, &[]), ("knob", 1, 1, &["$fe=1"])];

#[test]
fn every_example_is_recorded() {
    let mut names: Vec<String> = fs::read_dir("examples")
        .expect("examples")
        .filter_map(|entry| {
            entry.expect("an entry").file_name().to_str()?.strip_suffix(".scad").map(str::to_owned)
        })
        .collect();
    names.sort();
    names.retain(|name| OURS.iter().all(|(own, ..)| own != name));
    assert_eq!(names, recorded().0.into_keys().collect::<Vec<_>>());
}

#[test]
fn volumes_are_those_of_openscad() {
    let (volumes, tolerance) = recorded();
    for (name, expected) in volumes {
        let found = build(&name).measures();
        assert!(found.closed && found.genus.is_some(), "{name}: {found:?}");
        assert!((found.volume / expected - 1.0).abs() < tolerance, "{name}: {} for {expected}", found.volume);
        if let Some(&(_, components, genus)) = COUNTED.iter().find(|(counted, ..)| *counted == name) {
            assert_eq!((found.components, found.genus), (components, Some(genus)), "{name}");
        }
    }
}

#[test]
fn our_own_examples_are_closed() {
    for (name, components, genus, define) in OURS {
        let found = build_with(name, define.iter().map(|&set| set.to_owned()).collect()).measures();
        assert!(found.closed, "{name}");
        assert_eq!((found.components, found.genus), (components, Some(genus)), "{name}: {found:?}");
    }
}

#[test]
fn splines_bound_the_area_they_should() {
    let main = Loaded {
        name: "area.scad".into(),
        text: "polygon(spline([for (i = [0:11]) [10 * cos(30 * i), 10 * sin(30 * i)]], closed = true, tolerance = 1e-4));"
            .into(),
    };
    let evaluated =
        script::evaluate(main, &mut Alone::default(), &script::Options::default()).expect("a recipe");
    let built = csg::build(&evaluated.recipe, &BuildOptions::default()).expect("a shape");
    let Shape::Region(region) = built.shape else { panic!("a region") };
    // A periodic cubic spline through 12 points of a circle is within 1e-4 of the radius.
    assert!((region.area() / (100.0 * std::f64::consts::PI) - 1.0).abs() < 5e-4, "{}", region.area());
}
