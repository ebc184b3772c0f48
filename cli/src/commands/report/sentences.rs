//! What the figures of a family say, in words.

use super::figures::{EXACT, Section};
use super::tables::{difficulty, exponent, grouped, share};

/// One sentence on a family: how the exact tree fared, and where others begin to err.
pub(super) fn sentence(section: &Section) -> String {
    let exact = section.exactness();
    let steps = section.of(EXACT).count();
    let verdict = if exact.is_zero() {
        format!(
            "**{EXACT}** paints 0 wrong pixels of {} and misplaces 0 of {} vertices and tears no \
             polygon in all {steps} steps",
            grouped(exact.pixels),
            grouped(exact.vertices)
        )
    } else {
        format!("**{exact}**")
    };
    let others: Vec<&str> = section.methods().into_iter().filter(|&m| m != EXACT).collect();
    let mut groups: Vec<(f64, Vec<&str>)> = Vec::new();
    let mut never = Vec::new();
    for method in others {
        let is_wrong = |found: &Result<super::figures::Figures, String>| {
            found.as_ref().is_ok_and(|figures| figures.picture.wrong() > 0)
        };
        let first = section.of(method).find(|row| is_wrong(&row.found));
        match first.and_then(|row| row.difficulty) {
            None => never.push(method),
            Some(step) => match groups.iter_mut().find(|group| group.0 == step) {
                Some(group) => group.1.push(method),
                None => groups.push((step, vec![method])),
            },
        }
    }
    let place = |step: f64| section.rows.iter().position(|row| row.difficulty == Some(step));
    groups.sort_by_key(|group| place(group.0));
    let mut parts = vec![verdict];
    for (i, (step, methods)) in groups.iter().enumerate() {
        let verb = if i == 0 { "others err first at" } else { "at" };
        parts.push(format!("{verb} {}: {}", difficulty(*step), methods.join(", ")));
    }
    if !never.is_empty() {
        parts.push(format!("without a wrong pixel as well: {}", never.join(", ")));
    }
    parts.join("; ") + &worst(section) + "."
}

/// The worst of all.
fn worst(section: &Section) -> String {
    let rows = section.rows.iter().filter_map(|row| {
        let figures = row.found.as_ref().ok()?;
        (figures.picture.wrong() > 0).then_some((row, &figures.picture))
    });
    let worst = rows.max_by(|a, b| a.1.wrong_share().total_cmp(&b.1.wrong_share()));
    worst.map_or(String::new(), |(row, picture)| {
        let step = row.difficulty.map_or(String::new(), |d| format!(" at {}", difficulty(d)));
        format!(
            "; the most is {} by {}{step}, up to {} of the extent too deep",
            share(picture.wrong(), picture.covered),
            row.method,
            exponent(picture.depth_max)
        )
    })
}
