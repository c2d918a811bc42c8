//! Rows, and our time beside the fastest peer's at the same measured error.

use crate::judge::Judgement;
use std::fmt;

/// A method on a model at one level.
pub(crate) struct Row {
    pub(crate) model: &'static str,
    pub(crate) method: &'static str,
    /// A tolerance, a depth or a number of cells.
    pub(crate) level: f64,
    pub(crate) seconds: f64,
    pub(crate) bytes: f64,
    pub(crate) judgement: Judgement,
}

impl Row {
    pub(crate) const HEADER: &'static str = "model,method,level,triangles,error of mesh,error of surface,\
         error at creases,volume error,seconds,MB,closed,non-manifold edges,self-crossings";

    fn is_ours(&self) -> bool {
        self.method.starts_with("ogee")
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Row { model, method, level, seconds, bytes, judgement: j } = self;
        let creases = j.creases.map_or(String::new(), |error| format!("{error:.2e}"));
        write!(
            f,
            "{model},{method},{level},{},{:.2e},{:.2e},{creases},{:.1e},{seconds:.6},{:.1},{},{},{}",
            j.triangles,
            j.from_mesh,
            j.from_surface,
            j.volume,
            bytes / 1e6,
            if j.closed { "yes" } else { "no" },
            j.non_manifold_edges,
            j.crossings
        )
    }
}

/// What a peer needs for an error.
struct Offer {
    method: &'static str,
    seconds: f64,
    triangles: f64,
}

/// For each of our rows the fastest peer at our measured error, and at the tolerance that we were asked for.
pub(crate) fn print(rows: &[Row]) {
    println!();
    println!(
        "model,method,tolerance,measured,seconds,triangles,fastest peer,peer seconds,time ratio,peer triangles,\
         triangle ratio,fastest peer at tolerance,peer seconds at tolerance,time ratio at tolerance,\
         triangle ratio at tolerance"
    );
    for row in rows.iter().filter(|row| row.is_ours()) {
        let error = row.judgement.error();
        let equal = columns(row, fastest(rows, row.model, error));
        let asked = fastest(rows, row.model, row.level).map(|offer| {
            let ratios = [row.seconds / offer.seconds, row.judgement.triangles as f64 / offer.triangles];
            format!("{},{:.6},{:.5},{:.5}", offer.method, offer.seconds, ratios[0], ratios[1])
        });
        println!(
            "{},{},{},{error:.2e},{:.6},{},{equal},{}",
            row.model,
            row.method,
            row.level,
            row.seconds,
            row.judgement.triangles,
            asked.unwrap_or_else(|| "none gets there,,,".to_owned())
        );
    }
}

fn columns(row: &Row, offer: Option<Offer>) -> String {
    let Some(Offer { method, seconds, triangles }) = offer else {
        return "none gets there,,,,".to_owned();
    };
    let ratio = row.seconds / seconds;
    format!(
        "{method},{seconds:.6},{ratio:.5},{triangles:.0},{:.5}",
        row.judgement.triangles as f64 / triangles
    )
}

/// The peer that reaches an error in the least time, by power laws between the neighbouring rows of each.
fn fastest(rows: &[Row], model: &str, error: f64) -> Option<Offer> {
    let mut best: Option<Offer> = None;
    let peers = rows.iter().filter(|row| row.model == model && !row.is_ours());
    let mut names: Vec<&'static str> = peers.map(|row| row.method).collect();
    names.dedup();
    for method in names {
        let own: Vec<&Row> = rows.iter().filter(|row| row.model == model && row.method == method).collect();
        for offer in offers(method, &own, error) {
            if best.as_ref().is_none_or(|known| offer.seconds < known.seconds) {
                best = Some(offer);
            }
        }
    }
    best
}

/// Rows that are good enough as they are, and places between rows of which one is.
fn offers(method: &'static str, rows: &[&Row], error: f64) -> Vec<Offer> {
    let good = rows.iter().filter(|row| row.judgement.error() <= error);
    let mut offers: Vec<Offer> = good
        .map(|row| Offer { method, seconds: row.seconds, triangles: row.judgement.triangles as f64 })
        .collect();
    for pair in rows.windows(2) {
        let [coarse, fine] = [0, 1].map(|i| pair[i].judgement.error());
        if coarse > error && fine < error && coarse.is_finite() && fine > 0.0 {
            let t = (error / coarse).ln() / (fine / coarse).ln();
            let between = |a: f64, b: f64| (a.ln() + t * (b.ln() - a.ln())).exp();
            let triangles = [0, 1].map(|i| pair[i].judgement.triangles as f64);
            offers.push(Offer {
                method,
                seconds: between(pair[0].seconds, pair[1].seconds),
                triangles: between(triangles[0], triangles[1]),
            });
        }
    }
    offers
}
