//! The report itself.

use binspace_evidence::Family;

use super::culling::City;
use super::figures::{Section, Subject};
use super::growth::Growth;
use super::tables::{Table, details, escaped, grouped, share, steps};
use super::{Report, machine, summary};
use binspace_cli::units::{bytes, time};

/// All of the report.
pub(super) fn report(report: &Report<'_>) -> String {
    let mut text = head(report);
    text += &format!(
        "\n## Speed against error\n\n{}.\n\n![Speed against error](speed.svg)\n\n{}{}",
        report.exactness(),
        summary::headline(&report.sections).markdown(),
        LEGEND
    );
    if let Some(table) = summary::in_common(&report.sections) {
        text += &format!(
            "\nA method that gave up is compared above over easier trials than the others. This table \
             compares all methods over the trials that every method ended:\n\n{}",
            table.markdown()
        );
    }
    text += METHODS;
    text += "\n### All methods, all families\n\n";
    text += &summary::everything(&report.sections).markdown();
    text += "\n## The families, one by one\n\n\
             `f64` and `f32` trees are those with an epsilon; the exact depth buffer, which judges \
             all methods, is not counted among depth buffers here.\n";
    for section in &report.sections {
        match section.subject {
            Subject::Family(family) => text += &of_family(section, family),
            Subject::Scene(_) => {}
        }
    }
    text += &scenes(&report.sections);
    text += &report.city.as_ref().map_or_else(String::new, culling);
    text += &growth(&report.growth);
    text + MEASURES
}

fn head(report: &Report<'_>) -> String {
    let args = report.args;
    let [width, height] = report.size;
    let mut state = String::new();
    if !report.complete {
        state += "\n**Not complete: some results are missing.**\n";
    }
    for name in &report.failed {
        state += &format!("\n**{} could not be measured.**\n", escaped(name));
    }
    format!(
        "# binspace report\n{state}\n\
         | | |\n|---|---|\n\
         | commit | {} |\n| machine | {} |\n| pictures | {width}×{height} pixels |\n\
         | sweeps | {} |\n| seed | {} |\n\
         | coplanar tolerance | 0 for the families, 1e-9 of the extent for other scenes |\n",
        machine::commit(),
        machine::describe(),
        if args.quick { "short (`--quick`)" } else { "full" },
        args.seed,
    )
}

const LEGEND: &str = "
*Wrong pixels* is the share of covered pixels, over all steps of all families, that show another
polygon than the nearest, or none, or a polygon where there is none. *Families wrong* counts
families with any such pixel. *Deepest error* and *largest drift* are shares of the extent.
*Vertices misplaced* are those that, by their exact definition, lie on another side of a partition
plane than their piece. *Build* and *picture* (order and drawing) are geometric means.
*Ended* counts the trials that did not run out of a budget; a method's other figures are of these
alone, though those that it gave up are the hardest. – means that a method has no such figure.
";

const METHODS: &str = "
### The methods

- *bsp exact*: the library's tree. *bsp f64 1e-9*, *bsp f32 1e-4*: a textbook tree of rounded numbers
  with an epsilon, in units of half the extent, which tries 16 planes a node.
- *input order*: nothing is removed; *fronts, input order*: only faces whose fronts are seen, which is
  exact for a convex body and wrong where backs can be seen. *Removed by back faces* is the mean share of faces
  that this step leaves out. *Decides in* follows Sutherland, Sproull and Schumacker (1974): among the polygons (object space), in each pixel (image space), or both.
- *centroid*: painted by the depth of the faces' centroids. *newell*: the algorithm of Newell, Newell
  and Sancha in f64, with an epsilon of 1e-10 of half the extent and budgets for pieces and
  comparisons.
- *z 16*, *z 24*: depth buffers of 16 and 24 bits after the perspective divide; *f32*: of floats,
  *reversed*: with 1 at the near plane; *w*: of depths before the divide; *incremental*: scanlines on
  which depth grows by steps, *trapezoids*: by steps that begin anew at each vertex, *integer edges*:
  between edges walked in integers, others by edge functions. *or equal*: of equal depths the later shows;
  *larger nearer cleared*: 1 at the near plane, and cleared to the far one. *z f64* judges, with exact arithmetic where
  two depths are closer than its rounding.
- Near and far planes are fitted to each view, the near one no closer than 2⁻⁴⁴ of the far one. An
  eye that touches a face, as in one view of `lattice`, leaves a buffer of depths after the divide
  hardly any precision.
- What is painted by edge functions, by an exact tree, or by centroids is covered as the judge
  covers it: holes and spills are measured for the others.
- All differences count, however shallow: in `boxes` there are doubled walls, within some roundings
  of each other. The plots show twelve methods, the tables all.
- Times to build are of faces that are prepared already, by all threads; pictures are drawn by one.
";

fn of_family(section: &Section, family: Family) -> String {
    let methods = section.methods();
    format!(
        "\n### {family}\n\n{}. Swept: {}.\n\n{}.\n\n![{family}](error-{family}.svg)\n\n{}\n\
         At the last step:\n\n{}",
        capital(family.description()),
        family.parameter(),
        section.exactness(),
        steps(section, &methods).markdown(),
        details(section, &methods).markdown()
    )
}

fn scenes(sections: &[Section]) -> String {
    let mut text = String::new();
    for section in sections {
        if let Subject::Scene(name) = &section.subject {
            let faces = section.rows.first().map_or(0, |row| row.faces);
            text += &format!(
                "\n## {}\n\n{} faces. {}.\n\n{}",
                escaped(name),
                grouped(faces),
                section.exactness(),
                details(section, &section.methods()).markdown()
            );
        }
    }
    text
}

fn culling(city: &City) -> String {
    let mut table =
        Table::new(&["left out", "polygons left", "share", "time", "pixels drawn", "wrong pixels"]);
    for left in &city.steps {
        table.push(vec![
            left.name.to_owned(),
            grouped(left.polygons),
            share(left.polygons, city.polygons),
            time(left.time.as_secs_f64()),
            grouped(left.drawn as usize),
            grouped(left.wrong),
        ]);
    }
    format!(
        "\n## Culling\n\nA city of {} polygons, seen from above its roofs; its tree has {} fragments and was \
         built in {}. Each step leaves out what those before it do, and more; its time is that of \
         all of them together.\n\n{}",
        grouped(city.polygons),
        grouped(city.fragments),
        time(city.build),
        table.markdown()
    )
}

fn growth(rows: &[Growth]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let mut table = Table::new(&[
        "scene",
        "polygons",
        "tree",
        "fragments",
        "fragments / polygon",
        "depth",
        "build",
        "order",
        "memory",
    ]);
    for row in rows {
        let mut cells = vec![row.scene.clone(), grouped(row.polygons), row.method.to_owned()];
        match &row.found {
            Ok(size) => cells.extend([
                grouped(size.fragments),
                format!("{:.2}", size.fragments as f64 / row.polygons.max(1) as f64),
                grouped(size.depth),
                time(size.build),
                time(size.order),
                bytes(size.bytes),
            ]),
            Err(failure) => {
                cells.push(format!("gave up: {failure}"));
                cells.extend(vec![String::new(); 5]);
            }
        }
        table.push(cells);
    }
    format!(
        "\n## Growth\n\n![Build time](growth-build.svg)\n\n![Fragments](growth-fragments.svg)\n\n{}",
        table.markdown()
    )
}

const MEASURES: &str = "
## What is measured

- **Truth** is a depth buffer that decides every pixel in exact arithmetic. A pixel is *contested*,
  and not wrong, where the painted and the nearest polygon are equally far along its ray, exactly,
  or the tolerance allows for either in front.
- **Wrong order**: a polygon shows that another one hides; **hole**: nothing shows where there is a
  polygon; **spill**: a polygon shows where there is none. The *deepest error* is the largest
  difference between the depths of the painted and the nearest polygon in a wrong pixel.
- **Misplaced vertices** are those of fragments whose definition (corners and planes of the input),
  evaluated exactly, lies on another side of a plane above them than the fragment was put, or off a
  plane that it was put on, by more than the tolerance.
- **Drift** is how far a fragment's vertex is from its exact place, the largest difference of a
  coordinate: in units of the scene's grid (ulp; 2⁻⁵² to 2⁻⁵⁰ of the extent), and as a share of the
  extent. The exact tree's is the one rounding of positions that are handed out; no decision uses
  them.
- **Torn** polygons are not the sum of their pieces: the areas by the vertices' exact definitions,
  compared exactly, differ.
- **Area error** is the largest relative difference between a polygon's area and the sum of its
  pieces', computed in `f64` from rounded vertices: of a polygon that is hardly wider than a unit of
  the grid, rounding alone is much.
- All methods get the same polygons on the scene's grid, centred and scaled to it: offset and scale
  of the whole scene are taken off before any of them begins.
- Depth buffers and Newell's algorithm show nothing nearer than 2⁻⁴⁴ of the furthest depth. The
  judge, `z f64`, has no such limit; its own rows are 0 because all others are compared with it.
- **Times** are wall-clock: of a build, and of each view, the fastest of up to five where that is
  short; of the views the median. Painters draw by exact coverage, so drawing is not what a graphics
  card takes; *order* is the time until it is known what to draw when, which depth buffers need not.
- Figures of errors depend on the seed alone (`errors.csv`); times and memory are in `times.csv`.
";

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars
        .next()
        .map_or(String::new(), |first| first.to_uppercase().collect::<String>() + chars.as_str())
}
