//! Which known name was meant by a misspelt one.

/// The candidate nearest to `name`, when it is near enough that a slip of the fingers explains it; of equally near
/// ones the first.
pub(super) fn closest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let most = name.chars().count().div_ceil(3).min(3);
    let near = candidates.into_iter().map(|candidate| (distance(name, candidate), candidate));
    near.filter(|(distance, _)| (1..=most).contains(distance))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, c)| c)
}

/// Number of insertions, deletions, substitutions and swaps of neighbours that lead from one name to the other;
/// a change of case alone counts as one (optimal string alignment).
fn distance(a: &str, b: &str) -> usize {
    if a.len().abs_diff(b.len()) > 3 {
        return usize::MAX;
    }
    if a != b && a.eq_ignore_ascii_case(b) {
        return 1;
    }
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let substituted = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = substituted.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(before[j - 2] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::closest;

    #[test]
    fn slips_are_seen_through() {
        let known = ["cube", "cylinder", "translate", "union", "sphere"];
        let check = |name: &str, meant: Option<&str>| assert_eq!(closest(name, known), meant, "{name}");
        check("cubee", Some("cube"));
        check("cyclinder", Some("cylinder"));
        check("tranlsate", Some("translate"));
        check("Union", Some("union"));
        check("spehre", Some("sphere"));
        check("gear", None);
        check("x", None);
        check("cube", None);
    }
}
