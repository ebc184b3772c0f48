#!/usr/bin/env python3
"""Measures the figures, and fills the tables of the documents with them.

    python3 benches/figures.py           # measures, writes benches/figures.md, fills the documents
    python3 benches/figures.py fill      # fills the documents from benches/figures.md
    python3 benches/figures.py check     # fails if a document differs from benches/figures.md

A document has a comment before a table: the title of a table of figures.md, and perhaps some of its columns.

    <!-- figures: Build | scene, polygons, two threads -->
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FIGURES = ROOT / "benches/figures.md"
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), *sorted(ROOT.glob("benches/[A-Z]*.md"))]
BENCHES = ["peers", "memory", "heuristics", "ablation"]
UNITS = {"ns": 1e-9, "µs": 1e-6, "ms": 1e-3, "s": 1.0}

# The work, the peer, the title of their table, the column of the ratio (or the columns of both figures), a column and its
# value that select rows, the columns of our errors and of the peer's errors, and the column of the number of judged
# pixels or points (none if errors are shares already).
PEERS = [
    ("order of a frame", "`radsort`: one depth per polygon", "Order of a frame", "sort ÷ order", None,
     "wrong", "wrong by sort", None),
    ("page of layers", "`plane-split` 0.18", "Page of layers", "its time ÷ ours", None,
     "our wrong", "its wrong", "points"),
    ("SVG of a mesh", "`gl2ps`, its tree", "SVG of a mesh", "its time ÷ ours", ("gl2ps sorts by", "bsp"),
     "our wrong", "its wrong", "pixels"),
    ("SVG of a mesh", "`gl2ps`, sorted depths", "SVG of a mesh", "its time ÷ ours", ("gl2ps sorts by", "simple"),
     "our wrong", "its wrong", "pixels"),
    ("build", "`plane-split` 0.18", "Build against plane-split", "its build ÷ ours", None, None, None, None),
]
# As above, for peers that compute no order or are not tuned.
OTHERS = [
    ("build", "textbook tree, `f64` and epsilon; not tuned", "Exact against epsilon", "epsilon ÷ exact", None, None, None, None),
    ("build", "`bvh`, no order", "Build", "bvh ÷ ours", None, None, None, None),
    ("memory", "`bvh`, no order", "Memory", ("bvh, a polygon", "bytes a polygon"), None, None, None, None),
]
# The work, the title of its table, the column of its figure, the pattern of the rows, and the unit.
SPEEDS = [
    ("order of a frame, for each fragment", "Order of a frame", "ns a fragment", ".*", " ns"),
    ("tree of 100 000 polygons, two threads", "Build", "two threads", ".*:100000", ""),
    ("moving 200 polygons ÷ building a new tree", "Moving polygons", "replace ÷ rebuild", ".*", ""),
    ("reading a saved tree ÷ building it", "Saved trees", "read ÷ build", ".*", ""),
]


class Fault(Exception):
    """A message for the user."""


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def read_tables(text):
    """Returns the tables of figures.md by title: lists of rows, of which the first has the names of the columns."""
    tables = {}
    for title, body in re.findall(r"^## (.+)\n\n((?:\|.*\n)+)", text, re.MULTILINE):
        head, _, *rows = body.splitlines()
        tables[title] = [cells(head), *map(cells, rows)]
    head = ["work", "peer", "peer's time ÷ ours", "our errors", "peer's errors"]
    tables["Peers"] = [head, *(peer(tables, *row) for row in PEERS)]
    tables["Others"] = [["work", "peer", "peer ÷ ours"], *(peer(tables, *row)[:3] for row in OTHERS)]
    tables["Speeds"] = [["work", "measured"], *(speed(tables, *row) for row in SPEEDS)]
    return tables


def table_of(tables, title):
    if title not in tables:
        raise Fault(f"benches/figures.md has no table “{title}”")
    return tables[title]


def column(table, name, rows=None):
    if name not in table[0]:
        raise Fault(f"no column “{name}” among {table[0]}")
    place = table[0].index(name)
    return [row[place] for row in (table[1:] if rows is None else rows)]


def value(cell):
    number, *unit = cell.split()
    return float(number) * UNITS.get(unit[0] if unit else "", 1.0)


def span(found, unit=""):
    """Returns the least and the greatest of some cells."""
    least, greatest = min(found, key=value), max(found, key=value)
    if least == greatest:
        return least + unit
    (_, *of_least), (_, *of_greatest) = least.split(), greatest.split()
    return (least.split()[0] if of_least == of_greatest else least) + "–" + greatest + unit


def shares(table, rows, wrong, judged):
    """The cells of a column of errors, as shares."""
    found = column(table, wrong, rows)
    if not judged:
        return found
    # “0” for no errors, as in the benches.
    percent = [100 * value(cell) / value(count) for cell, count in zip(found, column(table, judged, rows))]
    return [f"{share:.{0 if share >= 10 else 2}{'f' if share >= 10 else 'g'}} %" if share else "0" for share in percent]


def peer(tables, work, name, title, ratio, only, ours, theirs, judged):
    table = table_of(tables, title)
    rows = table[1:]
    if only:
        rows = [row for row, cell in zip(rows, column(table, only[0])) if cell == only[1]]
    errors = [span(shares(table, rows, wrong, judged)) if wrong else "–" for wrong in (ours, theirs)]
    if isinstance(ratio, tuple):
        both = zip(*(map(value, column(table, one, rows)) for one in ratio))
        ratios = [f"{theirs / ours:.2f}" for theirs, ours in both]
    else:
        ratios = column(table, ratio, rows)
    return [work, name, span(ratios), *errors]


def speed(tables, work, title, name, pattern, unit):
    table = table_of(tables, title)
    rows = [row for row in table[1:] if re.fullmatch(pattern, row[0])]
    return [work, span(column(table, name, rows), unit)]


def rendered(tables, title, columns):
    table = table_of(tables, title)
    if columns:
        names = [name.strip() for name in columns.split(",")]
        table = [names, *zip(*(column(table, name) for name in names))]
    lines = [table[0], ["---"] + ["---:"] * (len(table[0]) - 1), *table[1:]]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def filled(tables, text):
    """Returns a document in which each comment is followed by its table of figures.md."""
    return re.sub(r"(<!-- figures: (.+?)(?: \| (.+?))? -->)\n*(?:\|.*\n)*\n*",
                  lambda m: f"{m[1]}\n\n{rendered(tables, m[2], m[3])}\n", text).rstrip("\n") + "\n"


def measure():
    subprocess.run([sys.executable, ROOT / "benches/scenes/fetch.py"], check=True)
    printed = []
    for bench in BENCHES:
        command = ["cargo", "bench", "-p", "binspace-benches", "--bench", bench]
        print(" ".join(command), flush=True)
        printed.append(subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout)
    FIGURES.write_text("\n".join(printed))


def main(job):
    if job == "measure":
        measure()
    tables = read_tables(FIGURES.read_text())
    different = []
    for document in DOCUMENTS:
        text = document.read_text()
        right = filled(tables, text)
        if text != right:
            different.append(str(document.relative_to(ROOT)))
            if job != "check":
                document.write_text(right)
    if job == "check" and different:
        raise Fault(f"{', '.join(different)}: figures differ from benches/figures.md; "
                    "run python3 benches/figures.py fill")


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["fill"], ["check"]):
        sys.exit(__doc__)
    try:
        main(*(sys.argv[1:] or ["measure"]))
    except Fault as fault:
        sys.exit(f"figures.py: {fault}")
