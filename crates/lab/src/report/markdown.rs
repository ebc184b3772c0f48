//! Writes the report as Markdown.

use binspace_evidence::Family;

use super::culling::City;
use super::figures::{Section, Subject};
use super::growth::Growth;
use super::tables::{Table, details, escaped, grouped, share, steps};
use super::{Report, machine, summary};
use binspace_cli::units::{bytes, time};

/// The whole report.
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
            "\nIn the table above, a method that gave up is compared over easier trials than the other \
             methods. The next table compares all methods over the trials that every method finished:\n\n{}",
            table.markdown()
        );
    }
    text += METHODS;
    text += "\n### All methods, all families\n\n";
    text += &summary::everything(&report.sections).markdown();
    text += "\n## The families, one by one\n\n`f64` and `f32` trees are the trees with an epsilon. The \
             exact depth buffer judges all methods and is not counted among the depth buffers here.\n";
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
*Wrong pixels* is the share of covered pixels, over all steps of all families, that show a polygon other
than the nearest, no polygon, or a polygon where none exists. *Families wrong* is the number of families
with at least one such pixel. *Deepest error* and *largest drift* are shares of the extent. *Vertices
misplaced* counts vertices that, by their exact definition, lie on another side of a partition plane than
their piece. *Build* and *picture* (order and drawing) are geometric means. *Ended* counts the trials that
did not exhaust a budget. The other figures of a method include only these trials, although the trials that
it gave up are the hardest. – means that a method has no such figure.
";

const METHODS: &str = "
### The methods

- *bsp exact*: the library's tree. *bsp f64 1e-9*, *bsp f32 1e-4*: a textbook tree of rounded numbers. It
  uses an epsilon, in units of half the extent, and tries 16 planes per node.
- *input order*: no hidden surfaces are removed. *fronts, input order*: only front faces are painted. This
  is exact for a convex body, and wrong where back faces are visible. *Removed by back faces* is the mean
  share of faces that this step leaves out. *Decides in* follows Sutherland, Sproull and Schumacker (1974):
  among the polygons (object space), in each pixel (image space), or both.
- *centroid*: faces are painted by the depth of their centroids. *newell*: the algorithm of Newell, Newell
  and Sancha in f64, with an epsilon of 1e-10 of half the extent and budgets for pieces and comparisons.
- *z 16*, *z 24*: depth buffers of 16 and 24 bits after the perspective divide. *f32*: floating-point
  numbers. *reversed*: 1 at the near plane. *w*: depths before the divide. *incremental*: on each scanline,
  depth grows by steps. *trapezoids*: the steps start again at each vertex. *integer edges*: edges are walked
  in integers. The others use edge functions. *or equal*: of equal depths, the later one shows. *larger
  nearer cleared*: 1 at the near plane, and cleared to the far plane. *z f64* judges all methods; it uses
  exact arithmetic where two depths are closer than its rounding.
- Near and far planes are fitted to each view. The near plane is no closer than 2⁻⁴⁴ of the far one. If an
  eye touches a face, as in one view of `lattice`, a buffer of depths after the divide has almost no
  precision.
- Edge functions, exact trees and centroids cover the same pixels as the judge. Holes and spills are
  therefore measured for the other methods only.
- All differences count, however small. In `boxes`, walls that touch are only a few rounding
  errors apart. The plots show twelve methods; the tables show all.
- Build times are for prepared faces, with all threads. Pictures are drawn by one thread.
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
        "\n## Culling\n\nA city of {} polygons is seen from above its roofs. The tree of the city \
         has {} fragments and was built in {}. Each step leaves out everything that the steps before \
         it leave out, and more. The time of a step includes the earlier steps.\n\n{}",
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
## Measures

- **Truth** is a depth buffer that decides every pixel in exact arithmetic. A pixel is *contested*, and not
  wrong, if the painted and the nearest polygon have exactly the same depth in it, or if the tolerance
  allows either in front.
- **Wrong order**: a hidden polygon shows. **Hole**: no polygon shows, although one covers the pixel.
  **Spill**: a polygon shows, although none covers the pixel. The *deepest error* is the largest difference
  between the depths of the painted and the nearest polygon in a wrong pixel.
- **Misplaced vertices** are vertices of fragments that are on a wrong side of a plane. The definition of
  the vertex (corners and planes of the input) is evaluated exactly. The vertex is misplaced if, by more than
  the tolerance, it lies on the wrong side of the plane of a node above its fragment, or off the plane that
  contains the fragment.
- **Drift** is the distance of a fragment's vertex from its exact position: the largest difference of a
  coordinate, in units of the scene's grid (ulp; 2⁻⁵² to 2⁻⁵⁰ of the extent) and as a share of the extent.
  The drift of the exact tree is the single rounding of positions that it returns; no decision uses them.
- A polygon is **torn** if its area differs from the sum of the areas of its pieces. The areas are computed
  exactly, from the definitions of the vertices.
- **Area error** is the largest relative difference between a polygon's area and the sum of the areas of its
  pieces, computed in `f64` from rounded vertices. For a polygon that is hardly wider than a unit of the grid,
  rounding alone causes a large error.
- All methods get the same polygons on the scene's grid. The grid is centred and scaled to the scene, so
  offset and scale of the whole scene are removed before any method starts.
- Depth buffers and Newell's algorithm show nothing nearer than 2⁻⁴⁴ of the furthest depth. The judge,
  `z f64`, has no such limit. Its own rows are 0 because all other methods are compared with it.
- **Times** are wall-clock times. Short builds and views are repeated up to five times, and the fastest
  counts. The time of a method is the median of its views. Painters draw by exact coverage, so the time to
  draw is not the time of a graphics card. *order* is the time until the paint order is known; depth buffers
  need none.
- Errors depend only on the seed (`errors.csv`). Times and memory are in `times.csv`.
";

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars
        .next()
        .map_or(String::new(), |first| first.to_uppercase().collect::<String>() + chars.as_str())
}
