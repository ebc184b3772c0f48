"""Tests exact axes: pictures are judged pixel by pixel, and everything else is compared with mplot3d's axes."""

import copy
import io
import pickle
import shutil
import subprocess
import sys

import binspace.mpl
import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from binspace import _matplotlib_tests, compare
from binspace._scenes import SCENES
from matplotlib.backend_bases import MouseEvent
from mpl_toolkits.mplot3d import art3d
from mpl_toolkits.mplot3d.axes3d import Axes3D

matplotlib.use("Agg")
VERSION = tuple(map(int, matplotlib.__version__.split(".")[:2]))


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


@pytest.fixture(params=["drawing", "order"])
def way(request, monkeypatch):
    """Chooses how pictures are painted: by a drawing of the view, or in the order of the tree."""
    if request.param == "order":
        monkeypatch.setattr(binspace.mpl, "_MOST_PIXELS", -1)
    return request.param


# Scenes that mplot3d draws right, or nearly right, at the judged pixels.
NEARLY_RIGHT = {"moebius_strip", "arrows_through_plane"}


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.__name__)
def test_no_pixel_is_wrong(scene, way):
    if scene.__name__ == "log_axes" and VERSION < (3, 11):
        pytest.skip("3D axes have scales from matplotlib 3.11 on")
    found = {}
    result = compare.judged(scene, "exact3d", dpi=100, keep=found)
    assert result.wrong_probes == 0
    if way == "order":
        # Without antialiasing, Agg fills each pixel that an area touches. So a part of a polygon that was cut covers up to a
        # pixel of objects in front of the other part.
        assert not compare._spread(found["wrong"], 1, np.minimum).any() and result.percent < 0.1
    else:
        assert result.wrong == 0
    assert result.judged + result.probes > 900


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.__name__)
def test_the_judge_finds_what_mplot3d_draws_wrong(scene):
    if scene.__name__ in NEARLY_RIGHT:
        pytest.skip("mplot3d draws nearly all of it right")
    if scene.__name__ == "log_axes" and VERSION < (3, 11):
        pytest.skip("3D axes have scales from matplotlib 3.11 on")
    assert compare.judged(scene, "3d", dpi=100).percent > 0.5


def test_only_pixels_with_equal_pixels_all_around_are_judged():
    for other in (-1, 1):
        numbers = np.zeros((9, 9), int)
        numbers[4, 4] = other
        expected = np.ones((9, 9), bool)
        expected[2:7, 2:7] = False
        assert (compare._is_alike(numbers) == expected).all()


def picture(draw, projection, **options):
    figure = plt.figure(figsize=(4, 4), dpi=80)
    draw(figure.add_subplot(projection=projection), **options)
    figure.canvas.draw()
    return np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)


def test_removed_surfaces_have_colors_and_paths():
    found = []
    for projection in ("3d", "exact3d"):
        ax = plt.figure().add_subplot(projection=projection)
        x, y = np.meshgrid(range(4), range(4))
        surface, wires = ax.plot_surface(x, y, x * y, cmap="viridis"), ax.plot_wireframe(x, y, x + y)
        ax.figure.canvas.draw()
        surface.remove()
        wires.remove()
        colors = [surface.get_facecolor(), surface.get_edgecolor()]
        found.append(colors + [path.vertices for path in [*surface.get_paths(), *wires.get_paths()]])
        assert surface.axes is None
    for before, ours in zip(*found, strict=True):
        np.testing.assert_array_equal(before, ours)


def test_unknown_scenes_are_refused(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["compare", "moebius_strip", "moebius"])
    with pytest.raises(SystemExit) as refused:
        compare.main()
    assert refused.value.code == 2
    assert "unknown scene: moebius (known: crossing_surfaces, " in capsys.readouterr().err


@pytest.mark.parametrize("text", [None, "def test_a():\n    raise ValueError\n"])
def test_folders_without_tests_that_pass_are_refused(tmp_path, monkeypatch, capsys, text):
    if text:
        (tmp_path / "test_a.py").write_text(text)
    monkeypatch.setattr(sys, "argv", ["compare", "--matplotlib-tests", str(tmp_path)])
    assert compare.main() == 1
    assert "has no tests that pass" in capsys.readouterr().err


def test_only_pictures_that_differ_have_a_reason(tmp_path):
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_a.py").write_text(
        "import pytest\nfrom matplotlib.testing.exceptions import ImageComparisonFailure\n"
        "def test_bar3d():\n    raise ImageComparisonFailure('images not close (RMS 1.5)')\n"
        "@pytest.mark.parametrize('failure', [ValueError, ImageComparisonFailure])\n"
        "def test_stem3d(failure):\n    raise failure('images not close (RMS 1.5)')\n"
        "def test_fancy():\n    pass\n"
    )
    results = _matplotlib_tests.results(str(tmp_path), "exact")
    assert results["test_fancy"] == [] and len(results["test_stem3d"]) == 2
    assert _matplotlib_tests.reason("test_bar3d", results["test_bar3d"]) == _matplotlib_tests.ROUNDING
    assert _matplotlib_tests.reason("test_stem3d", results["test_stem3d"]) is None


def one_surface(ax):
    x, y = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-2, 2, 9))
    ax.plot_surface(x, y, x * y, cmap="viridis", edgecolor="k", lw=0.5)


def two_surfaces(ax):
    x, y = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-2, 2, 9))
    ax.plot_surface(x, y, np.sin(x) * np.cos(y), color="C0")
    ax.plot_surface(x, y, 0.4 * x, color="C1")


def one_line(ax):
    t = np.linspace(0, 9, 40)
    ax.plot(np.cos(t), np.sin(t), t, "r--", marker="o", ms=4, markevery=3)
    ax.plot(np.cos(t) + 1, np.sin(t), t, "bs", ms=4, markevery=(0.05, 0.2))


def one_scatter(ax):
    t = np.linspace(0, 9, 40)
    ax.scatter(np.cos(t), np.sin(t), t, c=t, s=5 * t + 4, marker="^", edgecolors="k")


def three_scatters(ax, count=40):
    t = np.linspace(0, 9, 3 * count)
    styles = [
        {"marker": "o", "s": 20, "color": "C0", "depthshade": False},
        {"marker": "s", "s": 30 + 9 * np.arange(count) % 40, "c": np.arange(count), "edgecolors": "k"},
        {"marker": "^", "s": 60, "facecolors": "none", "edgecolors": "r", "linewidths": [1, 2] * (count // 2)},
    ]
    for i, style in enumerate(styles):
        ax.scatter(np.cos(5 * t[i::3]), np.sin(5 * t[i::3]), t[i::3], **style)


def some_patches(ax, offsets=((0, 0), (1, 1), (0, 1)), zs=(0, 1, 0), **options):
    shapes = [matplotlib.patches.Circle((0, 0), 20), matplotlib.patches.Rectangle((-30, -9), 60, 18, angle=30)]
    options = {"facecolors": ["C1", "C2", "C3"], "edgecolors": "k", "linewidths": 2} | options
    patches = matplotlib.collections.PatchCollection(
        shapes, offsets=offsets, offset_transform=ax.transData, transform=matplotlib.transforms.IdentityTransform(), **options
    )
    ax.add_collection3d(patches, zs=zs)


def one_wireframe(ax):
    x, y = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-2, 2, 9))
    ax.plot_wireframe(x, y, x + y, color="C1")


def bars(ax):
    ax.bar3d([0, 2], [0, 0], [0, 0], 0.5, 0.5, [1, 2], color=["C0", "C1"], shade=True)


def contours(ax):
    x, y = np.meshgrid(np.linspace(-2, 2, 40), np.linspace(-2, 2, 40))
    ax.contour(x, y, np.sin(x) * y, linewidths=[1, 2, 3])


def hatches(ax):
    x, y = np.meshgrid(np.linspace(-2, 2, 40), np.linspace(-2, 2, 40))
    ax.contourf(x, y, np.sin(x) * y, offset=0, levels=6, hatches=["/", "x", None, ".."])
    ax.contourf(x, y, np.sin(x) * y, offset=2, levels=6, hatches=["+", "\\\\"], colors="none")


def noise(ax):
    x, y = np.meshgrid(np.arange(30), np.arange(30))
    ax.contourf(x, y, np.random.default_rng(1).normal(size=x.shape), offset=0, levels=[-9, -0.5, 0.5, 9])


def a_patch(ax):
    patch = matplotlib.patches.Rectangle((0.2, 0.2), 0.5, 0.4, fc="C2", ec="C3", lw=3, hatch="/")
    ax.add_patch(patch)
    art3d.pathpatch_2d_to_3d(patch, z=0.5, zdir="y")


def a_text(ax):
    ax.text(0.4, 0.5, 0.6, "text", zdir="x", color="C3", fontsize=20)
    ax.legend(handles=[matplotlib.lines.Line2D([], [], label="line")])


@pytest.mark.parametrize(
    "draw",
    [
        one_surface, one_line, one_scatter, three_scatters, some_patches, one_wireframe, bars, contours, hatches, noise,
        a_patch, a_text,
    ],
)  # fmt: skip
def test_what_mplot3d_draws_right_is_the_same(draw, way):
    before, ours = picture(draw, "3d"), picture(draw, "exact3d")
    assert (before != 255).any(-1).mean() > 0.1
    different = np.abs(before - ours).max(-1) > 90
    assert different.mean() < 0.004


def turns(a, b, c):
    """Returns a positive number if the lines from `a` to `b` and from there to `c` turn left, and a negative one for right."""
    (x, y), (u, v) = (b - a).T, (c - a).T
    return x * v - y * u


def test_bridges_to_holes_cross_no_sides():
    # Contours of noise have many holes, and many corners with equal y.
    x, y = np.meshgrid(np.arange(20), np.arange(20))
    levels = plt.figure().add_subplot().contourf(x, y, np.random.default_rng(1).normal(size=x.shape))
    count = 0
    for path in levels.get_paths():
        rings, _ = binspace.mpl._rings(np.column_stack([path.vertices, np.zeros(len(path.vertices))]), path.codes)
        for ring, own in binspace.mpl._without_holes(rings):
            a, b = ring[:, :2], np.roll(ring[:, :2], -1, 0)
            for p, q in zip(a[~own], b[~own]):
                of_p, of_q = (turns(a, b, end) for end in (p, q))
                of_a, of_b = (turns(p, q, end) for end in (a, b))
                assert not ((of_p * of_q < 0) & (of_a * of_b < 0)).any()
                # Bridges also pass through no corners.
                is_between = ((a - p) @ (q - p) > 0) & ((a - q) @ (p - q) > 0)
                assert not (is_between & (of_a == 0)).any()
                count += 1
    assert count > 100


def test_areas_are_divided_again_only_after_a_change(monkeypatch):
    calls = []
    divide = binspace.mpl._without_holes
    monkeypatch.setattr(binspace.mpl, "_without_holes", lambda rings: calls.append(rings) or divide(rings))
    ax = plt.figure().add_subplot(projection="exact3d")
    patch = ax.add_patch(matplotlib.patches.Rectangle((0.2, 0.2), 0.5, 0.4))
    art3d.pathpatch_2d_to_3d(patch, z=0.5)
    ax.figure.canvas.draw()
    ax.azim += 20
    ax.figure.canvas.draw()
    assert len(calls) == 1
    before = np.array(ax.figure.canvas.buffer_rgba())
    patch._segment3d = [(x + 0.2, y, z) for x, y, z in patch._segment3d]
    ax.figure.canvas.draw()
    assert len(calls) == 2
    assert (np.array(ax.figure.canvas.buffer_rgba()) != before).any()


@pytest.mark.parametrize("format", ["svg", "pdf", "png"])
def test_files(format, tmp_path):
    figure = plt.figure()
    ax = figure.add_subplot(projection="exact3d")
    two_surfaces(ax)
    some_patches(ax)
    ax.plot([-2, 2], [-2, 2], [-1, 1], "k")
    figure.savefig(tmp_path / f"a.{format}")
    assert (tmp_path / f"a.{format}").stat().st_size > 10_000


def test_svg_has_one_path_a_polygon():
    figure = plt.figure()
    ax = figure.add_subplot(projection="exact3d")
    x, y = np.meshgrid(np.linspace(-2, 2, 11), np.linspace(-2, 2, 11))
    ax.plot_surface(x, y, 0 * x, color="#ff0000", shade=False)
    ax.plot_surface(x, y, x, color="#00ff00", shade=False)
    ax.set_axis_off()
    file = io.StringIO()
    figure.savefig(file, format="svg")
    # Hidden halves are left out, and no polygon is painted twice.
    assert 100 <= file.getvalue().count("fill: #ff0000") + file.getvalue().count("fill: #00ff00") <= 200


class Own(Axes3D):
    pass


def test_existing_axes_become_exact():
    figure, ax = plt.subplots(subplot_kw={"projection": "3d"})
    assert binspace.mpl.exact(ax) is ax and isinstance(ax, binspace.mpl.ExactAxes3D)
    assert type(binspace.mpl.exact(ax)) is binspace.mpl.ExactAxes3D
    two_surfaces(ax)
    figure.canvas.draw()

    own = figure.add_axes(Own(figure))
    binspace.mpl.exact(own)
    assert isinstance(own, Own) and type(own).__name__ == "ExactOwn"
    figure.canvas.draw()
    with pytest.raises(TypeError):
        binspace.mpl.exact(plt.figure().add_subplot())


def test_install_and_uninstall():
    try:
        binspace.mpl.install()
        assert type(plt.figure().add_subplot(projection="3d")) is binspace.mpl.ExactAxes3D
    finally:
        binspace.mpl.uninstall()
    assert type(plt.figure().add_subplot(projection="3d")) is Axes3D
    assert type(plt.figure().add_subplot(projection="exact3d")) is binspace.mpl.ExactAxes3D


def test_picking_and_coordinates_are_as_before():
    found = []
    for projection in ("3d", "exact3d"):
        figure = plt.figure(figsize=(4, 4), dpi=100)
        ax = figure.add_subplot(projection=projection)
        surface = ax.plot_surface(*np.meshgrid(np.linspace(-2, 2, 5), np.linspace(-2, 2, 5)), np.zeros((5, 5)), picker=True)
        [line] = ax.plot([-2, 2], [0, 0], [1, 1], picker=5)
        points = ax.scatter([0, 1], [0, 1], [1.5, 1.5], picker=True)
        figure.canvas.draw()
        events = []
        for x in range(60, 340, 20):
            for y in range(60, 340, 20):
                event = MouseEvent("motion_notify_event", figure.canvas, x, y)
                contains = [artist.contains(event) for artist in (surface, line, points)]
                events.append([(bool(inside), np.sort(np.asarray(what.get("ind", []))).tolist()) for inside, what in contains])
        found.append((events, ax.format_coord(0.01, 0.02)))
    assert found[0] == found[1]
    assert any(inside for event in found[0][0] for inside, _ in event)


def test_orders_of_equals_and_zorders_stay():
    """In one plane, the polygon with the larger zorder is painted above, and at equal zorder the later polygon."""
    square = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]], float)
    for zorders, expected in (((1, 1), (0, 0, 255)), ((2, 1), (255, 0, 0))):
        figure = plt.figure(figsize=(3, 3), dpi=50)
        ax = figure.add_subplot(projection="exact3d")
        artists = []
        for color, zorder in zip(("#ff0000", "#0000ff"), zorders):
            artists.append(ax.add_collection3d(art3d.Poly3DCollection(square, facecolor=color, zorder=zorder)))
        ax.set_zlim(-1, 1)
        for _ in range(2):
            figure.canvas.draw()
            image = np.asarray(figure.canvas.buffer_rgba())[..., :3]
            pixels, _ = compare.View(ax)(np.array([[0.5, 0.5, 0.0]]))
            column, row = np.floor(pixels[0]).astype(int)
            assert tuple(image[row, column]) == expected
        assert tuple(artist.zorder for artist in artists) == zorders


def test_computed_zorder_off_is_left_to_mplot3d():
    images = []
    for projection in ("3d", "exact3d"):
        figure = plt.figure(figsize=(3, 3), dpi=50)
        ax = figure.add_subplot(projection=projection, computed_zorder=False)
        two_surfaces(ax)
        figure.canvas.draw()
        images.append(np.asarray(figure.canvas.buffer_rgba()))
    assert np.array_equal(*images)


def test_the_tree_is_kept_while_data_are_the_same():
    figure = plt.figure(figsize=(3, 3), dpi=50)
    ax = figure.add_subplot(projection="exact3d")
    compare.SCENES[1](ax)
    figure.canvas.draw()
    built = ax._exact_built
    ax.view_init(10, 20)
    figure.canvas.draw()
    assert ax._exact_built is built
    ax.plot([0, 1], [0, 1], [0, 1])
    figure.canvas.draw()
    assert ax._exact_built is not built


def test_nan_empty_and_hidden_artists_draw():
    figure = plt.figure(figsize=(3, 3), dpi=50)
    ax = figure.add_subplot(projection="exact3d")
    figure.canvas.draw()
    x, y = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-2, 2, 9))
    z = x + y
    z[3, 4] = np.nan
    ax.plot_surface(x, y, z)
    ax.plot([0, np.nan, 1, 2], [0, 1, np.nan, 1], [0, 0, 0, 1], "o-")
    ax.plot([], [], [])
    ax.plot([1], [1], [1])
    ax.scatter([], [], [])
    ax.scatter([0, np.nan], [0, 1], [0, 1])
    ax.text(0, 0, np.nan, "nowhere")
    ax.text(0, 0, 0, "")
    ax.add_collection3d(art3d.Poly3DCollection(np.empty((0, 4, 3))))
    ax.plot_surface(x, y, z - 1).set_visible(False)
    figure.canvas.draw()
    # Some corners are behind the eye.
    ax.plot_surface(40 * x, 40 * y, z)
    ax.plot([-90, 90], [-90, 90], [0, 0])
    ax.set_xlim(-1, 1)
    ax.set_ylim(-1, 1)
    figure.canvas.draw()


@pytest.mark.parametrize("view", [{}, {"elev": 0, "azim": 0}, {"elev": 90, "azim": -90}], ids=str)
@pytest.mark.parametrize("z", [1e300, 1e-300, np.inf, np.nan, 0.0], ids=str)
def test_any_numbers_draw(z, view, way):
    figure = plt.figure(figsize=(2, 2), dpi=50)
    ax = figure.add_subplot(projection="exact3d")
    x, y = np.meshgrid(np.arange(-2, 3), np.arange(-2, 3))
    with np.errstate(all="ignore"):
        ax.plot_surface(x, y, np.where(x > 0, z, 1.0) * y)
        ax.plot_surface(x + 10**12, y, np.ma.masked_greater(y, 1))
    ax.set_proj_type("ortho")
    ax.view_init(**view)
    ax.invert_xaxis()
    figure.canvas.draw()


def test_axes_of_very_different_scales(way):
    """The picture depends on the axes' limits, not on the numbers."""

    def draw(ax, scale=(1.0, 1.0, 1.0), shift=(0.0, 0.0, 0.0)):
        x, y = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-2, 2, 9))
        for z in (np.sin(x) * np.cos(y), 0.4 * x):
            ax.plot_surface(*(a * c + b for a, b, c in zip(scale, shift, (x, y, z))), shade=False)
        ax.set_axis_off()

    before = picture(draw, "exact3d")
    other = picture(draw, "exact3d", scale=(1e-9, 1e12, 1.0), shift=(0.0, 0.0, 7.0))
    assert (before != 255).any(-1).mean() > 0.1 and (np.abs(before - other).max(-1) > 8).mean() < 1e-3


def test_overlapping_markers_are_sorted_by_depth(way):
    def draw(ax, azim=0, is_reversed=False):
        part = slice(None, None, -1 if is_reversed else 1)
        ax.scatter([-1, 1][part], [1, -1][part], [0, 0], s=3500, c=["b", "y"][part])
        ax.view_init(elev=0, azim=azim, roll=0)

    for azim in (-50, 130):
        pictures = [picture(draw, "exact3d", azim=azim, is_reversed=is_reversed) for is_reversed in (False, True)]
        assert np.array_equal(*pictures) and np.array_equal(pictures[0], picture(draw, "3d", azim=azim))


def test_patches_are_before_and_behind_surfaces(way):
    """Patches at offsets in space, in one order with a surface between them."""
    figure = plt.figure(figsize=(4, 4), dpi=80)
    ax = figure.add_subplot(projection="exact3d")
    x, y = np.meshgrid(np.linspace(-2, 2, 5), np.linspace(-2, 2, 5))
    ax.plot_surface(x, y, 0 * x, color="#0000ff", shade=False)
    some_patches(ax, [(0.5, 0.5), (-0.5, -0.5)], [0.5, -0.5], facecolors="#ff0000", linewidths=0)
    ax.set_zlim(-1, 1)
    figure.canvas.draw()
    image = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    pixels, _ = compare.View(ax)(np.array([[0.5, 0.5, 0.5], [-0.5, -0.5, -0.5]]))
    columns, rows = np.floor(pixels).astype(int).T
    assert image[rows, columns].tolist() == [[255, 0, 0], [0, 0, 255]]


@pytest.mark.skipif(VERSION < (3, 10), reason="axlim_clip is from matplotlib 3.10 on")
def test_what_is_outside_of_the_limits_is_clipped():
    x, y = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-2, 2, 9))

    def draw(ax):
        ax.plot_surface(x, y, x + y, axlim_clip=True)
        ax.plot([-3, 0, 3, 3], [0, 0, 0, 1], [1, 1, 1, 1], "k", axlim_clip=True)
        ax.set(xlim=(-1.1, 1.1), ylim=(-1.1, 1.1), zlim=(-3, 3))

    different = np.abs(picture(draw, "3d") - picture(draw, "exact3d")).max(-1) > 90
    assert different.mean() < 0.004


FIRST_TRY = """
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import binspace.mpl
ax = plt.figure().add_subplot(projection="exact3d")
x, y = np.meshgrid(np.linspace(-2, 2, 12), np.linspace(-2, 2, 12))
ax.plot_surface(x, y, np.sin(x))
ax.plot_surface(x, y, np.cos(y))
ax.plot([-2, 2], [-2, 2], [-1, 1])
plt.savefig("first.png")
"""


def test_a_first_try(tmp_path):
    subprocess.run([sys.executable, "-c", FIRST_TRY], check=True, cwd=tmp_path)
    assert (tmp_path / "first.png").stat().st_size > 10_000


def test_axes_are_copied_and_pickled():
    figure = plt.figure(figsize=(2, 2))
    two_surfaces(figure.add_subplot(projection="exact3d"))
    own = binspace.mpl.exact(figure.add_axes(Own(figure)))
    two_surfaces(own)
    own.exact_progress = lambda done, total: None
    figure.canvas.draw()
    for again in (copy.deepcopy(figure), pickle.loads(pickle.dumps(figure))):
        assert [type(axes) for axes in again.axes] == [type(axes) for axes in figure.axes]
        again.canvas.draw()
        assert np.array_equal(again.canvas.buffer_rgba(), figure.canvas.buffer_rgba())


def test_pgf_has_one_path_a_polygon(tmp_path):
    if not shutil.which("pdflatex"):
        pytest.skip("matplotlib measures texts with LaTeX for this format")
    figure = plt.figure()
    ax = figure.add_subplot(projection="exact3d")
    x, y = np.meshgrid(np.linspace(-2, 2, 11), np.linspace(-2, 2, 11))
    ax.plot_surface(x, y, 0 * x)
    ax.plot_surface(x, y, x)
    ax.set_axis_off()
    with matplotlib.rc_context({"pgf.texsystem": "pdflatex"}):
        figure.savefig(tmp_path / "a.pgf")
    paths = (tmp_path / "a.pgf").read_text().count(r"\pgfusepath{fill}")
    assert 100 <= paths <= 200
    (tmp_path / "a.tex").write_text(r"\documentclass{article}\usepackage{pgf}\begin{document}\input{a.pgf}\end{document}")
    subprocess.run(["pdflatex", "-interaction=batchmode", "a.tex"], cwd=tmp_path, check=True, stdout=subprocess.DEVNULL)
    assert (tmp_path / "a.pdf").stat().st_size > 10_000


def test_the_build_of_a_tree_reports_and_is_cancelled():
    figure = plt.figure(figsize=(3, 3), dpi=50)
    ax = figure.add_subplot(projection="exact3d")
    two_surfaces(ax)
    calls = []

    def stop(done, total):
        raise InterruptedError("enough")

    ax.exact_progress = stop
    with pytest.raises(InterruptedError, match="enough"):
        figure.canvas.draw()
    ax.exact_progress = lambda done, total: calls.append((done, total))
    figure.canvas.draw()
    assert calls and calls[-1][0] == calls[-1][1]
    count = len(calls)
    ax.view_init(10, 20)
    figure.canvas.draw()
    assert len(calls) == count


def test_legends_avoid_surfaces_while_the_axes_are_drawn():
    x, y = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 9))
    places = []
    for projection in ("3d", "exact3d"):
        figure = plt.figure(figsize=(4, 4), dpi=80)
        ax = figure.add_subplot(projection=projection)
        ax.plot_surface(x, y, x * y, label="surface")
        ax.plot_wireframe(x, y, x, label="wires")
        ax.set(xlim=(0, 2), ylim=(0, 2), zlim=(0, 1))
        ax.set_box_aspect(None, zoom=1.8)
        legend = ax.legend()
        places.append([])
        for azim in (-60, 0, 60, 120, 180, 240):
            ax.view_init(60, azim)
            figure.canvas.draw()
            places[-1].append(tuple(np.round(legend.get_window_extent().bounds)))
    assert places[0] == places[1]
    if VERSION >= (3, 11):
        assert len(set(places[0])) > 1


@pytest.mark.parametrize("draw", [one_surface, one_line, one_scatter])
def test_all_parts_of_a_figure_are_painted(draw, way):
    pictures = []
    for projection in ("3d", "exact3d"):
        figure = plt.figure(figsize=(6, 6), dpi=80)
        for column in figure.subfigures(1, 2):
            for part in column.subfigures(2, 1):
                draw(part.add_subplot(projection=projection))
        figure.canvas.draw()
        pictures.append(np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int))
    for rows in np.split(np.stack(pictures), 2, 1):
        for before, ours in np.split(rows, 2, 2):
            assert (before != 255).any(-1).mean() > 0.1
            assert (np.abs(before - ours).max(-1) > 90).mean() < 0.004


def test_markers_of_several_scatters_are_painted_at_once(monkeypatch, way):
    counts = []
    draw = matplotlib.collections.Collection.draw
    for count in (40, 400):
        figure = plt.figure(figsize=(4, 4), dpi=80)
        ax = figure.add_subplot(projection="exact3d")
        ax.set_axis_off()
        three_scatters(ax, count)
        calls = []
        with monkeypatch.context() as patched:
            patched.setattr(matplotlib.collections.Collection, "draw", lambda *given: calls.append(0) or draw(*given))
            figure.canvas.draw()
        counts.append(len(calls))
    assert counts == [1, 1]
