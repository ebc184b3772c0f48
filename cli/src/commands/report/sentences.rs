//! What the figures of a family say, in words.

use super::figures::{EXACT, JUDGE, Row, Section};
use super::tables::{difficulty, exponent, grouped, share};

/// One sentence on a family or a scene: how the exact tree fared, where others begin to err, which
/// do not, and which gave up.
pub(super) fn sentence(section: &Section) -> String {
    let mut parts = vec![verdict(section)];
    // The judge is not judged.
    let is_other = |&method: &&str| method != EXACT && method != JUDGE;
    let others: Vec<&str> = section.methods().into_iter().filter(is_other).collect();
    let (mut onsets, mut right, mut gave_up) = (Vec::<(usize, Vec<&str>)>::new(), vec![], vec![]);
    for method in others {
        let rows: Vec<&Row> = section.of(method).collect();
        let onset = rows.iter().position(|row| is_wrong(row));
        let failed = rows.iter().position(|row| row.found.is_err());
        match (onset, failed) {
            (Some(step), _) => match onsets.iter_mut().find(|group| group.0 == step) {
                Some(group) => group.1.push(method),
                None => onsets.push((step, vec![method])),
            },
            (None, None) => right.push(method),
            (None, Some(_)) => {}
        }
        if let Some(step) = failed {
            gave_up.push(format!("{method} gave up{}", at(rows[step])));
        }
    }
    onsets.sort_unstable();
    for (i, (step, methods)) in onsets.iter().enumerate() {
        let row = section.of(methods[0]).nth(*step);
        let place = row.map_or(String::new(), at);
        let verb = if i == 0 { "others err first" } else { "then" };
        parts.push(format!("{verb}{place}: {}", methods.join(", ")));
    }
    if !right.is_empty() {
        parts.push(format!("without a wrong pixel as well: {}", right.join(", ")));
    }
    parts.extend(gave_up);
    parts.extend(worst(section));
    parts.join("; ") + "."
}

/// How the exact tree fared.
fn verdict(section: &Section) -> String {
    let exact = section.exactness();
    if !exact.is_zero() {
        return format!("**{exact}**");
    }
    let steps =
        if exact.rows > 1 { format!(" in all {} steps", exact.rows) } else { String::new() };
    format!(
        "**{EXACT}** paints 0 wrong pixels of {}, misplaces 0 of {} vertices and tears no \
         polygon{steps}",
        grouped(exact.pixels),
        grouped(exact.vertices)
    )
}

fn is_wrong(row: &Row) -> bool {
    row.found.as_ref().is_ok_and(|figures| figures.picture.wrong() > 0)
}

/// Where in the sweep.
fn at(row: &Row) -> String {
    row.difficulty.map_or(String::new(), |step| format!(" at {}", difficulty(step)))
}

/// The worst of all.
fn worst(section: &Section) -> Option<String> {
    let rows = section.rows.iter().filter(|row| is_wrong(row));
    let pictures = rows.filter_map(|row| Some((row, &row.found.as_ref().ok()?.picture)));
    let (row, picture) = pictures.max_by(|a, b| a.1.wrong_share().total_cmp(&b.1.wrong_share()))?;
    let how = if picture.depth_max > 0.0 {
        format!("up to {} of the extent too deep", exponent(picture.depth_max))
    } else {
        "all of them holes or spills".to_owned()
    };
    let share = share(picture.wrong(), picture.covered);
    Some(format!("the most is {share} by {}{}, {how}", row.method, at(row)))
}

#[cfg(test)]
mod tests {
    use binspace::measure::PictureError;

    use super::sentence;
    use crate::commands::report::figures::{Figures, Row, Section, Subject};

    fn row(difficulty: Option<f64>, method: &str, wrong: Option<usize>) -> Row {
        let figures = |wrong_order| {
            let mut picture = PictureError::default();
            (picture.covered, picture.wrong_order) = (10, wrong_order);
            Figures {
                picture,
                accuracy: None,
                area: None,
                grid: 0.0,
                pieces: 1,
                build: 0.0,
                order: 0.0,
                draw: 0.0,
                bytes: 0,
            }
        };
        let found = wrong.map(figures).ok_or_else(|| "over budget".to_owned());
        Row { difficulty, faces: 1, views: 1, method: method.to_owned(), found }
    }

    fn said(rows: Vec<Row>) -> String {
        sentence(&Section { subject: Subject::Scene("s".into()), rows })
    }

    #[test]
    fn who_errs_where_is_told_from_who_does_not_and_who_gave_up() {
        let mut rows = Vec::new();
        for (step, wrong) in [(0.1, [0, 0, 3]), (0.01, [0, 5, 4])] {
            for (method, wrong) in ["bsp exact", "newell", "z 16"].into_iter().zip(wrong) {
                rows.push(row(Some(step), method, Some(wrong)));
            }
            rows.push(row(Some(step), "w", (step > 0.05).then_some(0)));
            rows.push(row(Some(step), "z", Some(0)));
        }
        let text = said(rows);
        for part in [
            "**bsp exact** paints 0 wrong pixels of 20",
            "in all 2 steps; others err first at 1e-1: z 16; then at 1e-2: newell; ",
            "without a wrong pixel as well: z; w gave up at 1e-2; ",
            "the most is 50 % by newell at 1e-2",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }

    #[test]
    fn of_a_scene_that_is_no_sweep_it_is_told_as_well() {
        let rows = [("bsp exact", 0), ("centroid", 2), ("z", 0)];
        let text = said(rows.map(|(method, wrong)| row(None, method, Some(wrong))).into());
        assert!(text.contains("others err first: centroid; without a wrong pixel as well: z;"));
        let text = said(vec![row(None, "bsp exact", Some(1)), row(None, "z", Some(0))]);
        assert!(text.starts_with("**bsp exact: 1 of 10 pixels wrong"), "{text}");
    }
}
