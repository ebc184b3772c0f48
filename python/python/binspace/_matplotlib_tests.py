"""Runs matplotlib's own tests of 3D axes, also with exact axes: ``python -m binspace.compare --matplotlib-tests FOLDER``."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

SEAMS = "no seams between faces"
ROUNDING = "positions are rounded differently: some pixels differ by at most 5 of 255"
ORDER = "mplot3d's order is wrong, or ignores z-orders"
BENT = "faces of 20 corners that are not flat are divided into triangles"
SLIVERS = "areas thinner than a pixel, without antialiasing"
SNAPPED = "matplotlib moves the path of a collection with one path to whole pixels"
CURVE = "matplotlib projects the control points of a curve instead of the curve"
SIMPLIFIED = "matplotlib simplifies long lines, by up to a ninth of a pixel"
NAME = "the test compares the name of the class"

# Why the pictures of matplotlib 3.11 differ.
REASONS = {
    "test_arc_pathpatch": CURVE,
    "test_axes3d_repr": NAME,
    "test_bar3d": ROUNDING,
    "test_bar3d_notshaded": SEAMS,
    "test_bar3d_shaded": SEAMS,
    "test_computed_zorder": ORDER,
    "test_contour3d": ROUNDING,
    "test_contour3d_extend3d": SEAMS,
    "test_contourf3d": SLIVERS,
    "test_contourf3d_fill": SLIVERS,
    "test_equal_box_aspect": ORDER,
    "test_errorbar3d": ORDER,
    "test_errorbar3d_errorevery": SIMPLIFIED,
    "test_fancy": ORDER,
    "test_fill_between_polygon": ROUNDING,
    "test_fill_between_quad": SEAMS,
    "test_legend_bar": ROUNDING,
    "test_mixedsubplots": SEAMS,
    "test_poly3dcollection_alpha": SNAPPED,
    "test_poly3dcollection_closed": SNAPPED,
    "test_quiver3d": ROUNDING,
    "test_scale3d_artists_log": SLIVERS,
    "test_stem3d": ORDER,
    "test_surface3d": SEAMS,
    "test_surface3d_label_offset_tick_position": BENT,
    "test_surface3d_masked": SEAMS,
    "test_surface3d_masked_strides": SEAMS,
    "test_surface3d_shaded": BENT,
    "test_surface3d_zsort_inf": SEAMS,
    "test_tricontour": SLIVERS,
    "test_trisurf3d": SEAMS,
    "test_trisurf3d_shaded": SEAMS,
    "TestVoxels::test_alpha": SEAMS,
    "TestVoxels::test_edge_style": SEAMS,
    "TestVoxels::test_named_colors": SEAMS,
    "TestVoxels::test_rgb_data": SEAMS,
    "TestVoxels::test_simple": SEAMS,
    "TestVoxels::test_xyz": SEAMS,
}

# The beginnings of the messages of known failures: a differing picture, or the name of the axes' class.
PICTURE = "matplotlib.testing.exceptions.ImageComparisonFailure: images not close"
NAMED = 'assert "<ExactAxes3D'

RUN = """
import sys, pytest
if sys.argv.pop(1) == "exact":
    import binspace.mpl
    binspace.mpl.install()
sys.exit(pytest.main(sys.argv[1:]))
"""


def results(folder, axes):
    """Returns the failures of each test, by name. The list of a test that passes is empty."""
    report = os.path.join(folder, axes + ".xml")
    arguments = [axes, "-q", "-p", "no:cacheprovider", f"--junitxml={report}", "tests"]
    subprocess.run([sys.executable, "-c", RUN, *arguments], cwd=folder, stdout=subprocess.DEVNULL, check=False)
    found = {}
    for case in ElementTree.parse(report).iter("testcase"):
        owner = case.get("classname", "").rpartition(".")[2]
        name = case.get("name").partition("[")[0]
        if owner.startswith("Test"):
            name = f"{owner}::{name}"
        failures = [part.get("message", "") for part in case if part.tag in ("failure", "error")]
        # One name stands for a test with all its parameters.
        found.setdefault(name, []).extend(failures)
    return found


def reason(name, failures):
    """Returns the known reason why a test fails. Returns None if the test is not listed, or if one of its failures does not
    begin with the expected message."""
    why = REASONS.get(name)
    begin = NAMED if why == NAME else PICTURE
    return why if all(failure.startswith(begin) for failure in failures) else None


def main(tests):
    """Prints the tests that fail only with exact axes. `tests` is the folder lib/mpl_toolkits/mplot3d/tests of matplotlib's
    sources, which contains the expected pictures."""
    with tempfile.TemporaryDirectory() as folder:
        # Copied out of the source tree, because the sources in that tree are not built.
        shutil.copytree(tests, os.path.join(folder, "tests"))
        before = results(folder, "mplot3d")
        ours = {} if all(before.values()) else results(folder, "exact")
    if not ours:
        print(f"{tests} has no tests that pass with mplot3d's axes", file=sys.stderr)
        return 1
    own = sorted(name for name, failures in ours.items() if failures and not before.get(name))
    failed = sum(bool(failures) for failures in before.values())
    print(f"{len(ours)} tests; {failed} fail with mplot3d's axes, {len(own)} only with exact ones:\n")
    print("| test | RMS | reason |\n|---|---|---|")
    reasons = [reason(name, ours[name]) for name in own]
    for name, why in zip(own, reasons):
        rms = re.search(r"RMS ([\d.]+)", ours[name][-1])
        print(f"| {name} | {rms.group(1) if rms else ''} | {why or '**unknown**'} |")
    return int(None in reasons)
