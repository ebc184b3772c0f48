//! Summarises the figures of a family in a sentence.

use super::figures::{EXACT, JUDGE, Row, Section};
use super::tables::{difficulty, exponent, grouped, share};

/// One sentence on a family or a scene: how the exact tree fared, which others err and where first,
/// which do not, which gave up, and what is wrong at most.
pub(super) fn sentence(section: &Section) -> String {
    // The judge is not judged.
    let is_other = |&method: &&str| method != EXACT && method != JUDGE;
    let others: Vec<&str> = section.methods().into_iter().filter(is_other).collect();
    let (mut at_once, mut later, mut right) = (Vec::new(), Vec::new(), Vec::new());
    let mut gave_up: Vec<(String, Vec<&str>)> = Vec::new();
    for &method in &others {
        let failed: Vec<&Row> = section.of(method).filter(|row| row.found.is_err()).collect();
        match section.of(method).position(is_wrong) {
            Some(0) => at_once.push(method),
            Some(step) => later.push((step, method)),
            None if failed.is_empty() => right.push(method),
            None => {}
        }
        if !failed.is_empty() {
            let steps = at(&failed);
            match gave_up.iter_mut().find(|group| group.0 == steps) {
                Some(group) => group.1.push(method),
                None => gave_up.push((steps, vec![method])),
            }
        }
    }
    let mut parts = vec![verdict(section)];
    if !at_once.is_empty() {
        let always = |method: &&str| section.of(method).all(is_wrong);
        let place = match section.of(EXACT).collect::<Vec<&Row>>()[..] {
            [_, _, ..] if at_once.iter().all(always) => " at every step".to_owned(),
            [first, _, ..] => format!(" already{}", at(&[first])),
            _ => String::new(),
        };
        parts.push(format!("others err{place} ({})", names(&at_once, &others)));
    }
    later.sort_by_key(|&(step, _)| step);
    let more = if at_once.is_empty() { "others err" } else { "more err" };
    parts.extend(onsets(section, &later, &others).map(|steps| format!("{more} {steps}")));
    if !right.is_empty() {
        parts.push(format!("no wrong pixel: {}", names(&right, &others)));
    }
    let given_up = |(steps, methods): &(String, Vec<&str>)| {
        format!("given up{steps} ({})", names(methods, &others))
    };
    parts.extend(gave_up.iter().map(given_up));
    parts.extend(worst(section, &others));
    parts.join("; ") + "."
}

/// Where those begin to err that do not at the first step, given in order with these steps.
fn onsets(section: &Section, later: &[(usize, &str)], others: &[&str]) -> Option<String> {
    let (first, last) = (later.first()?.0, later.last()?.0);
    let group = |is_in: &dyn Fn(usize) -> bool| {
        let methods = later.iter().filter(|(step, _)| is_in(*step)).map(|&(_, method)| method);
        format!("({})", names(&methods.collect::<Vec<&str>>(), others))
    };
    let place = |step: usize| {
        let row = section.of(EXACT).nth(step);
        row.and_then(|row| row.difficulty).map_or(String::new(), difficulty)
    };
    let mut parts = vec![format!("first at {} {}", place(first), group(&|step| step == first))];
    if later.iter().any(|&(step, _)| first < step && step < last) {
        parts.push(format!("in between {}", group(&|step| first < step && step < last)));
    }
    if first < last {
        parts.push(format!("not before {} {}", place(last), group(&|step| step == last)));
    }
    Some(parts.join(", "))
}

/// The kinds that methods are of: how their names begin, and what they are called together. A
/// method of no kind is named.
const KINDS: [(&[&str], &str); 3] = [
    (&["bsp f64"], "`f64` trees"),
    (&["bsp f32"], "`f32` trees"),
    (&["z ", "w "], "depth buffers"),
];
/// At most this many methods are named one by one; more are counted by kind.
const NAMED: usize = 4;

/// Methods of all that there are, with few names.
fn names(methods: &[&str], all: &[&str]) -> String {
    match methods.len() {
        count if count == all.len() && count > 1 => return format!("all {count}"),
        0..=NAMED => return methods.join(", "),
        _ => {}
    }
    let kind_of = |method: &str| {
        let has = |starts: &[&str]| starts.iter().any(|start| method.starts_with(start));
        KINDS.into_iter().find(|(starts, _)| has(starts)).map(|(_, kind)| kind)
    };
    let count = |list: &[&str], kind| list.iter().filter(|m| kind_of(m) == Some(kind)).count();
    let mut parts: Vec<String> = Vec::new();
    for &method in methods {
        let Some(kind) = kind_of(method) else {
            parts.push(method.to_owned());
            continue;
        };
        let part = match (count(methods, kind), count(all, kind)) {
            (1, _) => method.to_owned(),
            (some, every) if some == every => format!("all {every} {kind}"),
            (some, every) => format!("{some} of {every} {kind}"),
        };
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    parts.join(", ")
}

/// How the exact tree fared.
fn verdict(section: &Section) -> String {
    let exact = section.exactness();
    if !exact.is_zero() {
        return format!("**{exact}**");
    }
    let steps = match exact.rows {
        1 => String::new(),
        rows => format!(", over all {rows} steps"),
    };
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

/// Where in the sweep these rows are.
fn at(rows: &[&Row]) -> String {
    let steps: Vec<String> = rows.iter().filter_map(|row| row.difficulty.map(difficulty)).collect();
    if steps.is_empty() { String::new() } else { format!(" at {}", steps.join(", ")) }
}

/// The worst of all, and whose it is.
fn worst(section: &Section, others: &[&str]) -> Option<String> {
    let share_of = |row: &Row| row.found.as_ref().map_or(0.0, |f| f.picture.wrong_share());
    let rows = || section.rows.iter().filter(|row| is_wrong(row));
    let most = rows().map(share_of).fold(0.0, f64::max);
    let first = rows().find(|row| share_of(row) == most)?;
    let as_bad = |row: &&Row| share_of(row) == most && row.difficulty == first.difficulty;
    let worst: Vec<&Row> = rows().filter(as_bad).collect();
    let pictures = worst.iter().filter_map(|row| row.found.as_ref().ok());
    let depth = pictures.map(|figures| figures.picture.depth_max).fold(0.0, f64::max);
    let how = if depth > 0.0 {
        format!("up to {} of the extent too deep", exponent(depth))
    } else {
        "all of them holes or spills".to_owned()
    };
    let picture = &first.found.as_ref().ok()?.picture;
    let share = share(picture.wrong(), picture.covered);
    let methods: Vec<&str> = worst.iter().map(|row| &*row.method).collect();
    Some(format!("the most is {share}{}, by {}, {how}", at(&[first]), names(&methods, others)))
}

#[cfg(test)]
mod tests {
    use binspace_evidence::measure::PictureError;
    use binspace_evidence::method::Space;

    use super::{names, sentence};
    use crate::commands::report::figures::{Figures, Row, Section, Subject};

    fn row(difficulty: Option<f64>, method: &str, wrong: Option<usize>) -> Row {
        let figures = |wrong_order| {
            let mut picture = PictureError::default();
            (picture.covered, picture.wrong_order) = (10, wrong_order);
            Figures {
                picture,
                accuracy: None,
                area: None,
                removed: 0.0,
                grid: 0.0,
                pieces: 1,
                build: 0.0,
                order: 0.0,
                draw: 0.0,
                bytes: 0,
            }
        };
        let found = wrong.map(figures).ok_or_else(|| "over budget".to_owned());
        let (method, space) = (method.to_owned(), Space::Object);
        Row { difficulty, faces: 1, views: 1, method, space, found }
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
            "over all 2 steps; others err at every step (z 16); more err first at 1e-2 (newell); ",
            "no wrong pixel: z; given up at 1e-2 (w); ",
            "the most is 50 % at 1e-2, by newell",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }

    #[test]
    fn of_a_scene_that_is_no_sweep_it_is_told_as_well() {
        let rows = [("bsp exact", 0), ("centroid", 2), ("z", 0)];
        let text = said(rows.map(|(method, wrong)| row(None, method, Some(wrong))).into());
        assert!(text.contains("others err (centroid); no wrong pixel: z;"));
        let text = said(vec![row(None, "bsp exact", Some(1)), row(None, "z", Some(0))]);
        assert!(text.starts_with("**bsp exact: 1 of 10 pixels wrong"), "{text}");
    }

    #[test]
    fn many_methods_are_counted_by_kind() {
        let all = [
            "bsp f64 1e-9",
            "bsp f64 1e-6",
            "bsp f64 1e-3",
            "bsp f32 1e-4",
            "bsp f32 1e-3",
            "centroid",
            "newell",
            "z 16",
            "z 24",
            "w 16",
        ];
        assert_eq!(names(&all, &all), "all 10");
        assert_eq!(names(&all[3..7], &all), "bsp f32 1e-4, bsp f32 1e-3, centroid, newell");
        let found = names(&all[1..8], &all);
        assert_eq!(found, "2 of 3 `f64` trees, all 2 `f32` trees, centroid, newell, z 16");
    }

    #[test]
    fn onsets_are_the_first_the_last_and_those_between() {
        let mut rows = Vec::new();
        for (number, step) in [(0, 1.0), (1, 10.0), (2, 100.0), (3, 1000.0)] {
            for (method, onset) in [("bsp exact", 9), ("a", 1), ("b", 2), ("c", 3), ("d", 3)] {
                rows.push(row(Some(step), method, Some(usize::from(number >= onset))));
            }
        }
        let text = said(rows);
        assert!(
            text.contains("others err first at 10 (a), in between (b), not before 1000 (c, d);")
        );
        assert!(text.contains("the most is 10 % at 10, by a,"), "{text}");
    }
}
