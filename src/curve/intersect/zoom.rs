//! A second look at places that rounding left open: the little that the curves do there, cut out in double-double and
//! brought to unit size, is a pair of curves like any other, whose rounding is less by the size of the place.

use super::part::Store;
use super::scene::Scene;
use super::search::{Crossing, Open, Search};
use super::{SHORT_BUDGET, touch};

/// A touch makes one place, or two at its crossings; where there are more the curves run together.
const MOST_PLACES: usize = 8;
/// Wider places are where curves run together.
const WIDEST: f64 = 1.0 / 4096.0;

/// The crossings of a search when a second look settles all that it left open, else `None`.
pub(super) fn settled<S: Store>(scene: &Scene<S>, search: &Search<'_, S>) -> Option<Vec<Crossing>> {
    if search.budget_is_spent() {
        return None;
    }
    let places = touch::groups(&search.open);
    let is_wide = |place: &Open| place[1] - place[0] > WIDEST || place[3] - place[2] > WIDEST;
    if places.len() > MOST_PLACES || places.iter().any(is_wide) {
        return None;
    }
    let mut found = search.crossings.clone();
    for place in places {
        let here = crossings_in(scene, widened(place))?;
        found.retain(|known| !here.iter().any(|crossing| crossing.is_same(known)));
        found.extend(here);
    }
    Some(found)
}

/// A little more than a place, so that what is at its border is inside.
fn widened([a_low, a_high, b_low, b_high]: Open) -> Open {
    let wider = |low: f64, high: f64| {
        let margin = 0.25 * (high - low);
        [(low - margin).max(0.0), (high + margin).min(1.0)]
    };
    let ([a, b], [c, d]) = (wider(a_low, a_high), wider(b_low, b_high));
    [a, b, c, d]
}

fn crossings_in<S: Store>(scene: &Scene<S>, place: Open) -> Option<Vec<Crossing>> {
    let window = scene.window(place)?;
    let mut search = Search::new(&window, SHORT_BUDGET, true);
    let [a, b] = window.parts();
    search.run(&a, &b);
    if !search.open.is_empty() {
        return None;
    }
    let outward = |x: f64, low: f64, high: f64| low + x * (high - low);
    let [a_low, a_high, b_low, b_high] = place;
    let crossing = |c: &Crossing| Crossing {
        s: outward(c.s, a_low, a_high),
        t: outward(c.t, b_low, b_high),
        radius: [
            c.radius[0] * (a_high - a_low) + f64::EPSILON,
            c.radius[1] * (b_high - b_low) + f64::EPSILON,
        ],
    };
    Some(search.crossings.iter().map(crossing).collect())
}
