use crate::plot::Show;

const NAMES: &str = "points, polygon, construction=T, tangents, normals, curvature, hull, box, inflections, \
intersections, joints";

/// What a list of names asks for.
pub(super) fn parse(text: &str) -> Result<Show, String> {
    let mut show = Show::default();
    for word in text.split(',').map(str::trim).filter(|word| !word.is_empty()) {
        let (name, value) = word.split_once('=').map_or((word, None), |(name, value)| (name, Some(value)));
        if value.is_some() && name != "construction" {
            return Err(format!("`{name}` takes no value"));
        }
        match name {
            "points" => show.points = true,
            "polygon" => show.polygon = true,
            "construction" => show.construction = Some(parameter(value)?),
            "tangents" => show.tangents = true,
            "normals" => show.normals = true,
            "curvature" => show.curvature = true,
            "hull" => show.hull = true,
            "box" => show.bounds = true,
            "inflections" => show.inflections = true,
            "intersections" => show.intersections = true,
            "joints" => show.joints = true,
            unknown => return Err(format!("`{unknown}` is none of {NAMES}")),
        }
    }
    Ok(show)
}

fn parameter(value: Option<&str>) -> Result<f64, String> {
    let t = value.map_or(Ok(0.5), str::parse).ok().filter(|t| (0.0..=1.0).contains(t));
    t.ok_or_else(|| "the parameter of construction=T goes from 0 to 1".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists() {
        let some = parse("points, construction=0.25,box").unwrap();
        assert_eq!(some, Show { points: true, bounds: true, construction: Some(0.25), ..Show::default() });
        assert_eq!(parse("construction").unwrap().construction, Some(0.5));
        assert_eq!(parse(""), Ok(Show::default()));
        for wrong in ["pionts", "points=3", "construction=2", "construction=x"] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }
}
