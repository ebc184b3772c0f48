"""Tests the arrays, orders, fragments, rays and pictures of `binspace`."""

import doctest
import itertools
import os
import signal
import subprocess
import sys
import threading
import time

import binspace
import numpy as np
import pytest

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)


def squares(*heights):
    return [SQUARE + [0, 0, z] for z in heights]


def random_triangles(count, seed=1, dtype=float):
    random = np.random.default_rng(seed)
    middles = random.uniform(-1, 1, (count, 1, 3))
    return (middles + random.uniform(-0.5, 0.5, (count, 3, 3))).astype(dtype)


def test_docstrings():
    failed, tried = doctest.testmod(binspace, extraglobs={"binspace": binspace})
    assert tried >= 4 and not failed


@pytest.mark.parametrize("eye, expected", [((0.5, 0.5, 9), [1, 2, 0]), ((0.5, 0.5, -9), [0, 2, 1])])
def test_the_nearest_is_last(eye, expected):
    tree = binspace.Tree(squares(2, 0, 1))
    order = tree.order(eye=eye)
    assert order.dtype == np.uint32
    polygon = tree.fragments.polygon
    assert polygon[order].tolist() == expected
    assert polygon[tree.order(eye=eye, front_to_back=True)].tolist() == expected[::-1]
    direction = [0, 0, -eye[2]]
    assert polygon[tree.order(direction=direction)].tolist() == expected


def test_all_ways_to_give_polygons_are_one():
    vertices = np.concatenate(squares(2, 0, 1))
    faces = np.arange(12).reshape(3, 4)
    offsets = np.arange(0, 13, 4)
    given = [
        squares(2, 0, 1),
        [square.tolist() for square in squares(2, 0, 1)],
        np.stack(squares(2, 0, 1)),
        (vertices, faces),
        (vertices, faces.tolist()),
        (vertices.tolist(), faces.astype(np.uint8)),
        (vertices, [*faces]),
        (vertices, offsets),
        (vertices, offsets.astype(np.uint32)),
    ]
    for polygons in given:
        for kind in (None, np.float32):
            if kind and isinstance(polygons, np.ndarray):
                polygons = polygons.astype(kind)
            tree = binspace.Tree(polygons)
            assert tree.polygons == len(tree) == 3
            assert tree.fragments.polygon[tree.order(eye=(0.5, 0.5, 9))].tolist() == [1, 2, 0]
    assert len(binspace.Tree([SQUARE, SQUARE[:3] + 1])) == 2
    assert len(binspace.Tree((vertices, [[0, 1, 2], [4, 5, 6, 7]]))) == 2


def test_arrays_of_any_layout_are_read():
    polygons = random_triangles(50)
    expected = binspace.Tree(polygons).fragments.points
    frozen = polygons.copy()
    frozen.flags.writeable = False
    wide = np.zeros((50, 3, 6))
    wide[..., ::2] = polygons
    reverse = np.ascontiguousarray(polygons[..., ::-1])
    shifted = np.frombuffer(b"x" + polygons.tobytes(), np.uint8)[1:].view(np.float64)
    layouts = [frozen, np.asfortranarray(polygons), wide[..., ::2], reverse[..., ::-1],
               polygons.astype(">f8"), shifted.reshape(50, 3, 3)]
    assert not shifted.flags.aligned
    for polygons in layouts:
        assert np.array_equal(binspace.Tree(polygons).fragments.points, expected)
        vertices = polygons.reshape(-1, 3)
        faces = np.arange(150).reshape(50, 3)
        assert np.array_equal(binspace.Tree((vertices, faces)).fragments.points, expected)
    # Rows of strided f32 arrays are also read without a copy.
    narrow = wide.astype(np.float32)[..., ::2]
    tree = binspace.Tree((narrow.reshape(-1, 3), faces))
    assert np.allclose(tree.fragments.points.min(0), expected.min(0), atol=1e-6)


def test_fragments_are_parts_of_their_polygons():
    polygons = random_triangles(60)
    tree = binspace.Tree(polygons)
    fragments = tree.fragments
    assert len(tree) > 60 and len(fragments.offsets) == len(tree) + 1
    area = np.zeros(60)
    own_length = np.zeros(60)
    for i, polygon in enumerate(fragments.polygon):
        part = slice(fragments.offsets[i], fragments.offsets[i + 1])
        points = fragments.points[part]
        area[polygon] += 0.5 * np.linalg.norm(np.cross(points - points[0], np.roll(points - points[0], -1, 0)).sum(0))
        steps = np.linalg.norm(np.roll(points, -1, 0) - points, axis=1)
        own_length[polygon] += steps[fragments.edges[part] >= 0].sum()
        # The weighted sums of the corners are the same points.
        for v, point in zip(range(part.start, part.stop), points):
            row = slice(fragments.weight_offsets[v], fragments.weight_offsets[v + 1])
            corners = polygons[polygon][fragments.weight_corners[row]]
            assert np.allclose(fragments.weights[row] @ corners, point, atol=1e-12)
    normals = np.cross(polygons[:, 1] - polygons[:, 0], polygons[:, 2] - polygons[:, 0])
    assert np.allclose(area, 0.5 * np.linalg.norm(normals, axis=1), atol=1e-12)
    around = np.linalg.norm(np.roll(polygons, -1, 1) - polygons, axis=2).sum(1)
    assert np.allclose(own_length, around, atol=1e-12)


def test_orders_are_those_of_depths():
    """Along each random ray, fragments that come later in the order are nearer."""
    polygons = random_triangles(40)
    tree = binspace.Tree(polygons)
    fragments = tree.fragments
    compared = 0
    random = np.random.default_rng(3)
    for _ in range(100):
        eye = random.normal(size=3) * 4
        order = tree.order(eye=eye)
        assert sorted(order) == list(range(len(tree)))
        target = random.uniform(-0.7, 0.7, 3)
        depths = []
        for i in order:
            points = fragments.points[fragments.offsets[i]:fragments.offsets[i + 1]]
            normal = np.cross(points[1] - points[0], points[2] - points[0])
            along = normal @ (target - eye)
            if abs(along) < 1e-9:
                continue
            t = normal @ (points[0] - eye) / along
            at = eye + t * (target - eye)
            sides = np.cross(np.roll(points, -1, 0) - points, at - points) @ normal
            if t > 0 and np.all(sides > 1e-9):
                depths.append(t)
        compared += len(depths)
        assert depths == sorted(depths, reverse=True)
    assert compared > 60


def test_rays():
    tree = binspace.Tree(squares(0, 2, 1))
    hits = tree.hits((0.5, 0.25, 9), (0, 0, -1))
    assert hits.polygon.tolist() == [1, 2, 0] and hits.parameter.tolist() == [7, 8, 9]
    assert hits.points.tolist() == [[0.5, 0.25, z] for z in (2, 1, 0)]
    assert hits.facing.tolist() == [1, 1, 1] and hits.offsets.tolist() == [0, 3]
    assert tree.hits((0.5, 0.25, -9), (0, 0, 1), limit=1).polygon.tolist() == [0]
    many = tree.hits([[0.5, 0.25, 9], [5, 5, 9], [0.5, 0.25, 1.5]], end=(0.5, 0.25, -9))
    assert many.offsets.tolist() == [0, 3, 3, 5]
    assert tree.is_occluded((0.5, 0.5, 3), (0.5, 0.5, 1.5)) is True
    assert tree.is_occluded([[0.5, 0.5, 3], [2, 2, 3]], [[0.5, 0.5, 1.5], [2, 2, 0]]).tolist() == [True, False]


def test_polygons_with_nan_keep_their_number():
    polygons = squares(2, 0, 1)
    polygons[1][2, 0] = np.nan
    tree = binspace.Tree(polygons)
    assert tree.polygons == 3 and tree.dropped.tolist() == [1]
    assert tree.fragments.polygon[tree.order(eye=(0, 0, 9))].tolist() == [2, 0]


def test_polygons_with_masked_numbers_are_left_out():
    polygons = np.ma.array(squares(2, 0, 1))
    polygons[1, 2, 0] = np.ma.masked
    for given in (polygons, list(polygons), (polygons.reshape(-1, 3), np.arange(0, 13, 4))):
        assert binspace.Tree(given).dropped.tolist() == [1]


def test_numbers_of_all_kinds_are_read():
    expected = binspace.Tree([SQUARE]).fragments.points
    for kind in (">f8", np.float16, np.longdouble, np.int8, np.uint64, bool):
        assert np.array_equal(binspace.Tree([SQUARE.astype(kind)]).fragments.points, expected)


def test_extreme_numbers_are_read():
    for factor in (1e300, 1.7e308, 1e-300, 5e-324):
        tree = binspace.Tree([SQUARE * factor, SQUARE * factor + [0, 0, factor]])
        assert tree.order(eye=(0, 0, 1e308)).tolist() in ([0, 1], [0], [])
    tree = binspace.Tree([SQUARE + 1e15, SQUARE + [1e15, 1e15, 1e15 + 4]])
    assert tree.order(direction=(0, 0, -1)).tolist() == [0, 1]


def test_nothing_has_an_order():
    for nothing in ([], np.empty((0, 4, 3)), (np.empty((0, 3)), []), (np.empty((0, 3)), np.array([0]))):
        tree = binspace.Tree(nothing)
        assert len(tree) == 0 and tree.order(eye=(1, 2, 3)).tolist() == []
        assert tree.fragments.points.shape == (0, 3) and tree.bounds is None
        assert len(tree.hits((0, 0, 0), (1, 0, 0)).polygon) == 0


BAD = {
    "two columns": lambda: binspace.Tree([[[0, 0], [1, 0], [1, 1]]]),
    "ragged": lambda: binspace.Tree([[[0, 0, 0], [1, 0], [1, 1, 0]]]),
    "words": lambda: binspace.Tree([[["a", "b", "c"]] * 3]),
    "objects": lambda: binspace.Tree([np.array([[None] * 3] * 3)]),
    "complex": lambda: binspace.Tree([SQUARE * 1j]),
    "structured": lambda: binspace.Tree([np.zeros(4, dtype=[("x", float), ("y", float)])]),
    "dates": lambda: binspace.Tree([SQUARE.astype("M8[s]")]),
    "infinite": lambda: binspace.Tree([SQUARE, np.where(SQUARE == 1, np.inf, SQUARE)]),
    "number": lambda: binspace.Tree(5),
    "nothing": lambda: binspace.Tree(None),
    "text": lambda: binspace.Tree("abc"),
    "progress is a number": lambda: binspace.Tree([SQUARE], progress=3),
    "one polygon": lambda: binspace.Tree(SQUARE),
    "index too large": lambda: binspace.Tree((SQUARE, [[0, 1, 4]])),
    "index of nothing": lambda: binspace.Tree((np.empty((0, 3)), [[0, 1, 2]])),
    "negative index": lambda: binspace.Tree((SQUARE, [[0, 1, -1]])),
    "huge index": lambda: binspace.Tree((SQUARE, np.array([[0, 1, 2**63 - 1]]))),
    "beyond i64": lambda: binspace.Tree((SQUARE, np.array([[0, 1, 2**64 - 1]], np.uint64))),
    "indices are floats": lambda: binspace.Tree((SQUARE, [[0.0, 1.0, 2.0]])),
    "faces of three dimensions": lambda: binspace.Tree((SQUARE, np.zeros((1, 2, 3), int))),
    "offsets begin late": lambda: binspace.Tree((SQUARE, np.array([1, 4]))),
    "offsets end early": lambda: binspace.Tree((SQUARE, np.array([0, 3]))),
    "offsets end late": lambda: binspace.Tree((SQUARE, np.array([0, 2**62]))),
    "offsets decrease": lambda: binspace.Tree((SQUARE, np.array([0, 4, 2, 4]))),
    "negative offsets": lambda: binspace.Tree((SQUARE, np.array([0, -4, 4]))),
    "no offsets": lambda: binspace.Tree((SQUARE, np.array([], int))),
    "vertices of one dimension": lambda: binspace.Tree((SQUARE[0], [[0, 1, 2]])),
    "few opacities": lambda: binspace.Tree([SQUARE], opacity=[0.5, 0.5]),
    "opacity above 1": lambda: binspace.Tree([SQUARE], opacity=[1.5]),
    "opacity NaN": lambda: binspace.Tree([SQUARE], opacity=[np.nan]),
    "opacity is a number": lambda: binspace.Tree([SQUARE], opacity=0.5),
    "negative tolerance": lambda: binspace.Tree([SQUARE], tolerance=-1),
    "tolerance NaN": lambda: binspace.Tree([SQUARE], tolerance=np.nan),
    "bounds": lambda: binspace.Tree([SQUARE], bounds=[0, 1]),
    "bounds NaN": lambda: binspace.Tree([SQUARE], bounds=[[0, 0, np.nan], [1, 1, 1]]),
    "no fragments": lambda: binspace.Tree(squares(1, 2, 3), max_fragments=2),
    "negative budget": lambda: binspace.Tree([SQUARE], max_fragments=-1),
    "no viewpoint": lambda: binspace.Tree([SQUARE]).order(),
    "two viewpoints": lambda: binspace.Tree([SQUARE]).order(eye=(0, 0, 1), direction=(0, 0, 1)),
    "eye of two": lambda: binspace.Tree([SQUARE]).order(eye=(0, 0)),
    "eye NaN": lambda: binspace.Tree([SQUARE]).order(eye=(0, 0, np.nan)),
    "direction of zeros": lambda: binspace.Tree([SQUARE]).order(direction=(0, 0, 0)),
    "ray without direction": lambda: binspace.Tree([SQUARE]).hits((0, 0, 0)),
    "rays that do not pair": lambda: binspace.Tree([SQUARE]).hits(np.zeros((2, 3)), np.ones((3, 3))),
    "negative limit": lambda: binspace.Tree([SQUARE]).hits((0, 0, 0), (0, 0, 1), limit=-1),
    "matrix": lambda: binspace.Camera(np.eye(3), (10, 10)),
    "matrix NaN": lambda: binspace.Camera(np.eye(4) * np.nan, (10, 10)),
    "singular": lambda: binspace.Camera(np.zeros((4, 4)), (10, 10)),
    "mirrored": lambda: binspace.Camera(np.diag([-1.0, 1, -1, 1]), (10, 10)),
    "no size": lambda: binspace.Camera(np.diag([1.0, 1, -1, 1]), (0, 10)),
    "negative size": lambda: binspace.Camera(np.diag([1.0, 1, -1, 1]), (-5, 10)),
    "huge size": lambda: binspace.Camera(np.diag([1.0, 1, -1, 1]), (2**40, 10)),
    "line beyond the grid": lambda: binspace.Tree([SQUARE]).overlay([[[0, 0, 0], [0, 0, 1e9]]]),
    "infinite line": lambda: binspace.Tree([SQUARE]).overlay([[[0, 0, 0], [0, 0, np.inf]]]),
    "flat line": lambda: binspace.Tree([SQUARE]).overlay([[[0, 0], [0, 1]]]),
    "points": lambda: binspace.Tree([SQUARE]).overlay(points=[[0, 0], [0, 1]]),
    "overlay of another tree": lambda: view(squares(0)).lines(binspace.Tree([SQUARE]).overlay()),
    "hidden": lambda: view(squares(0)).edges("some"),
    "colours": lambda: view(squares(0)).to_svg(colors=["red", "red"]),
    "colour": lambda: view(squares(0)).to_svg(colors=[(2, 0, 0)]),
    "background": lambda: view(squares(0)).to_svg(background=(0, 0, np.nan)),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_an_exception(name):
    with pytest.raises((ValueError, TypeError, OverflowError)) as caught:
        BAD[name]()
    assert str(caught.value)


def test_errors_name_the_polygon():
    with pytest.raises(ValueError, match="polygon 1 "):
        binspace.Tree([SQUARE, np.where(SQUARE == 1, np.inf, SQUARE)])


def view(polygons, size=(400, 400), **options):
    """A camera above the unit square that shows it from (100, 100) to (300, 300)."""
    tree = binspace.Tree(polygons, **options)
    matrix = [[1, 0, 0, -0.5], [0, 1, 0, -0.5], [0, 0, -1, 0], [0, 0, 0, 1]]
    return tree.visibility(binspace.Camera(matrix, size))


def test_cameras():
    camera = binspace.Camera([[1, 0, 0, -0.5], [0, 1, 0, -0.5], [0, 0, -1, 0], [0, 0, 0, 1]], (400, 200))
    assert camera.eye is None and camera.direction == [0, 0, -1] and list(camera.size) == [400, 200]
    assert camera.project((1, 1, 5)).tolist() == [300, 50]
    assert camera.project([[0, 0, 0]]).tolist() == [[100, 150]]
    matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0], [0, 0, -1, 3]]
    assert np.allclose(binspace.Camera(matrix, (10, 10)).eye, [0, 0, 3])
    assert np.isnan(binspace.Camera(matrix, (10, 10)).project((0, 0, 4))).all()


def test_what_is_visible():
    large = 2 * SQUARE - [0.5, 0.5, 1]
    seen = view([SQUARE, large, SQUARE - [0, 0, 2]])
    visible = seen.polygons()
    assert visible.polygon.tolist() == [0, 1]
    assert np.allclose(visible.area, [200 * 200, 400 * 400 - 200 * 200])
    drawing = seen.drawing()
    assert drawing.polygon.tolist() == [1, 0] and len(drawing) == 2
    assert drawing.path_offsets.tolist() == [0, 1, 2] and drawing.outline_offsets.tolist() == [0, 4, 8]
    corners = sorted(map(tuple, drawing.corners[4:].round(6).tolist()))
    assert corners == [(100, 100), (100, 300), (300, 100), (300, 300)]
    assert sorted(drawing.edges[4:]) == [0, 1, 2, 3] and not drawing.is_clipped.any()
    assert drawing.items.tolist() == [[0, 0], [0, 1]] and drawing.lines is None
    edges = seen.edges()
    lengths = np.linalg.norm(edges.ends[:, 1] - edges.ends[:, 0], axis=1)
    assert edges.is_visible.all() and np.isclose(lengths[edges.polygon == 0].sum(), 800)
    assert set(edges.kind) == {0} and np.isnan(edges.angle).all() and set(edges.other) == {-1}
    counted = seen.edges("count")
    assert set(counted.layers[counted.polygon == 2]) == {2} and not counted.is_visible.all()


def test_crossings_and_creases():
    upright = [[0.5, 0, -1], [0.5, 1, -1], [0.9, 1, 1], [0.9, 0, 1]]
    crossings = view([SQUARE, upright]).crossings()
    assert set(crossings.kind) == {3} and {*crossings.polygon, *crossings.other} == {0, 1}
    folded = view([SQUARE, [SQUARE[1], [2, 0, 1], [2, 1, 1], SQUARE[2]]]).edges()
    assert np.isclose(folded.angle[folded.kind == 2], np.pi / 4).all() and 2 in folded.kind


def test_lines_and_points():
    # The line runs above the square and through it. After a NaN, it runs below the square.
    line = np.array([[-0.5, 0.5, 1], [0.25, 0.5, 1], [0.75, 0.5, -1], [np.nan] * 3, [0.1, 0.1, -1], [0.9, 0.1, -1],
                     [1.5, 0.1, -1]])
    polygons = [SQUARE]
    seen = view(polygons, bounds=[[-2, -2, -2], [2, 2, 2]])
    tree = binspace.Tree(polygons, bounds=[[-2, -2, -2], [2, 2, 2]])
    seen = tree.visibility(binspace.Camera([[1, 0, 0, -0.5], [0, 1, 0, -0.5], [0, 0, -1, 0], [0, 0, 0, 1]], (400, 400)))
    overlay = tree.overlay([line[:0], line], [[0.5, 0.5, 1], [np.nan, 0, 0], [0.5, 0.5, -1]])
    runs = seen.lines(overlay, "keep")
    assert set(runs.line) == {1}
    expected = [(0, True), (1, True), (1, False), (4, False), (5, False), (5, True)]
    assert list(zip(runs.segment.tolist(), runs.is_visible.tolist())) == expected
    assert np.allclose(runs.ends[1], [[150, 200], [200, 200]])
    markers = seen.markers(overlay)
    assert markers.point.tolist() == [0, 2] and markers.is_visible.tolist() == [True, False]
    order = overlay.order(eye=(0.5, 0.5, 99))
    first = len(tree)
    pieces = overlay.pieces
    behind = order[: order.tolist().index(0)] - first
    assert np.all(pieces.ends[behind].mean(1)[:, 2] < 0) and len(behind) + 1 < len(order)
    front = order[order.tolist().index(0) + 1 :] - first
    assert np.all(pieces.ends[front].mean(1)[:, 2] > 0)
    assert set(pieces.number[pieces.segment < 0]) == {0, 2}
    part = pieces.segment == 1
    assert np.allclose(np.sort(pieces.shares[part].ravel()), [0, 0.5, 0.5, 1])
    drawing = tree.translucent(binspace.Camera([[1, 0, 0, -0.5], [0, 1, 0, -0.5], [0, 0, -1, 0], [0, 0, 0, 1]],
                                               (400, 400)), overlay)
    kinds = drawing.items[:, 0].tolist()
    assert kinds.count(0) == 1 and kinds.count(1) == len(drawing.lines.line) and kinds.count(2) == 2


def test_an_overlay_of_an_empty_tree():
    tree = binspace.Tree([], bounds=[[0, 0, 0], [1, 1, 1]])
    overlay = tree.overlay([[[0, 0, 0], [1, 1, 1]]], [[0.5, 0.25, 0.5]])
    order = overlay.order(eye=(9, 0.5, 0.6))
    assert sorted(order) == list(range(len(overlay))) and len(order) >= 2


def test_pictures(tmp_path):
    seen = view([SQUARE, SQUARE + [0.5, 0.5, 1]], opacity=[1, 0.5])
    svg = seen.to_svg(colors=["#ff0000", (0, 0, 1)], outlines=(1, "#00ff00"), edges=(2, "#123456"), background="#ffffff")
    assert svg.startswith("<svg") and all(color in svg for color in ("#ff0000", "#0000ff", "#00ff00", "#123456"))
    seen.to_svg(tmp_path / "a.svg", colors="#ff0000")
    assert (tmp_path / "a.svg").read_text() == seen.to_svg(colors="#ff0000")
    assert seen.to_pdf(colors=np.array([[1, 0, 0], [0, 1, 0]])).startswith(b"%PDF")
    seen.to_pdf(os.fspath(tmp_path / "a.pdf"))
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")


def test_progress_and_cancel():
    polygons = random_triangles(400) * 5
    calls = []
    tree = binspace.Tree(polygons, progress=lambda done, total: calls.append((done, total)))
    assert calls[-1][0] == calls[-1][1] >= 400 and [done for done, _ in calls] == sorted(done for done, _ in calls)

    def stop(done, total):
        raise InterruptedError("enough")

    with pytest.raises(InterruptedError, match="enough"):
        binspace.Tree(polygons, progress=stop)
    camera = binspace.Camera(np.diag([0.2, 0.2, -0.2, 1]), (400, 400))
    with pytest.raises(InterruptedError, match="enough"):
        tree.visibility(camera, progress=stop)
    seen = tree.visibility(camera)
    with pytest.raises(InterruptedError, match="enough"):
        seen.edges(progress=stop)
    # The map is unchanged.
    assert len(seen.edges().polygon) > 100


ENDLESS = """
import signal
import numpy as np, binspace
# Programs in the background of a shell ignore SIGINT.
signal.signal(signal.SIGINT, signal.default_int_handler)
random = np.random.default_rng(1)
polygons = random.uniform(-1, 1, (3000, 3, 3))
few = binspace.Tree(polygons[:100])
# Arrays of one point, repeated without memory. All these rays would take hours.
eye, far = (np.broadcast_to(np.array(point), (1 << 31, 3)) for point in ((0.01, 0.02, -2.0), (0.02, 0.01, 2.0)))
print("begins", flush=True)
try:
    CALL
except KeyboardInterrupt:
    print("ends", flush=True)
"""


@pytest.mark.parametrize(
    "call", ["binspace.Tree(polygons)", "few.hits(eye, end=far)", "few.is_occluded(eye, far)"]
)
def test_ctrl_c_ends_long_calls(call):
    command = [sys.executable, "-c", ENDLESS.replace("CALL", call)]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "begins\n"
    time.sleep(0.3)
    child.send_signal(signal.SIGINT)
    assert child.communicate(timeout=60)[0] == "ends\n" and child.returncode == 0


def test_other_threads_run_while_a_tree_is_built():
    polygons = random_triangles(400) * 5
    counts = itertools.count()
    done = threading.Event()

    def count():
        while not done.is_set():
            next(counts)

    thread = threading.Thread(target=count)
    thread.start()
    expected = binspace.Tree(polygons).fragments.points
    done.set()
    thread.join()
    assert next(counts) > 1000
    found = [None] * 4

    def build(i):
        tree = binspace.Tree(polygons)
        tree.order(eye=(1, 2, 3))
        found[i] = tree.fragments.points

    threads = [threading.Thread(target=build, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(points, expected) for points in found)


def test_one_map_in_several_threads():
    seen = view(random_triangles(300))
    expected = seen.drawing().corners
    found = []
    threads = [threading.Thread(target=lambda: found.append(seen.drawing().corners)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4 and all(np.array_equal(corners, expected) for corners in found)


FORKS = """
import os, sys, numpy as np, binspace
polygons = np.random.default_rng(1).uniform(-1, 1, (60, 3, 3)) * [[[0.2, 1, 1]]]
expected = binspace.Tree(polygons).fragments.points
child = os.fork()
same = np.array_equal(binspace.Tree(polygons).fragments.points, expected)
if child:
    _, status = os.waitpid(child, 0)
    sys.exit(status != 0 or not same)
os._exit(not same)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this system")
def test_a_fork_builds_trees_too():
    subprocess.run([sys.executable, "-W", "ignore", "-c", FORKS], check=True, timeout=60)
