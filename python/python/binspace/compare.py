"""Judges pictures of matplotlib's 3D axes and of exact axes, pixel by pixel.

``python -m binspace.compare`` draws each scene on both kinds of axes without antialiasing, and prints how many pixels
are wrong. Each polygon has its own colour, so the colour of a pixel tells which polygon was painted last. The judge is a
depth buffer of the same view in float64. The judge shares no arithmetic with the library. Pixels next to a visible
edge, and pixels where two depths are almost equal, are doubtful and not judged.

Lines, markers and texts are judged at single points on them. The depth buffer decides which of these points must be visible.
"""

from __future__ import annotations

import argparse

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.path import Path
from mpl_toolkits.mplot3d import art3d

import binspace.mpl  # noqa: F401 - registers the projection

from . import _matplotlib_tests, _speed
from ._scenes import SCENES

# Depths that differ by less than this share of the scene's depth count as equal.
_CLOSE = 1e-6


class View:
    """Computes where points of the scene appear, and their depths."""

    def __init__(self, axes):
        self.axes = axes
        self.matrix = np.asarray(axes.M, float)
        self.height = int(axes.figure.bbox.height)
        self.width = int(axes.figure.bbox.width)
        self.is_parallel = np.allclose(self.matrix[3, :3], 0, atol=1e-12)

    def scaled(self, points):
        """Applies the scales of the axes, such as logarithms. matplotlib has scales in 3D from 3.11 on."""
        from mpl_toolkits.mplot3d import proj3d

        points = np.array(points, float)
        if hasattr(proj3d, "_apply_scale_transforms"):
            for i, axis in enumerate((self.axes.xaxis, self.axes.yaxis, self.axes.zaxis)):
                points[..., i] = axis.get_transform().transform(points[..., i].ravel()).reshape(points.shape[:-1])
        return points

    def __call__(self, points):
        """Returns positions in pixels from the top left corner, and depths. The depth is z in a parallel view, and -1 / w in
        a perspective view: over each plane, it is a linear function of the position in the picture."""
        points = self.scaled(points)
        homogeneous = np.concatenate([points, np.ones((*points.shape[:-1], 1))], -1) @ self.matrix.T
        w = homogeneous[..., 3]
        display = self.axes.transData.transform(homogeneous[..., :2] / w[..., None])
        pixels = np.stack([display[..., 0], self.height - display[..., 1]], -1)
        return pixels, homogeneous[..., 2] / w if self.is_parallel else -1 / w


class Faces:
    """The polygons of a scene. Each polygon has a list of outlines and a colour; an outline is a list of points."""

    def __init__(self):
        self.outlines, self.colors = [], []


def _faces_of(artist):
    """Returns the outlines of each polygon of an artist."""
    if isinstance(artist, art3d.Poly3DCollection):
        if hasattr(artist, "_faces"):
            valid = ~np.broadcast_to(artist._invalid_vertices, artist._faces.shape[:2])
            return [[face[keep]] for face, keep in zip(artist._faces, valid)]
        return [[artist._vec[:3, part].T] for part in artist._segslices]
    if isinstance(artist, art3d.Patch3D):
        points, codes = np.array(artist._segment3d, float), getattr(artist, "_code3d", None)
        return [_flattened(points, codes)]
    if hasattr(artist, "_3dverts_codes"):
        return [_flattened(points, codes) for points, codes in artist._3dverts_codes]
    return []


def _flattened(points, codes):
    """Returns the outlines of a path in a plane perpendicular to an axis. Curves become many short lines."""
    axis = int(np.argmin(np.ptp(points, axis=0)))
    others = [i for i in range(3) if i != axis]
    # `Path` divides curves by a length in pixels: enlarged paths get short lines.
    enlarged = 1e5 / np.ptp(points[:, others])
    polygons = Path(points[:, others] * enlarged, codes).to_polygons(closed_only=False)
    outlines = []
    for polygon in polygons:
        outline = np.full((len(polygon), 3), points[0, axis])
        outline[:, others] = polygon / enlarged
        outlines.append(outline[:-1] if np.array_equal(outline[0], outline[-1]) else outline)
    return outlines


def _recolored(axes, keeps_colors):
    """Gives each polygon, line, marker and text its own colour. Returns the polygons, and the other artists as probes."""
    faces, probes = Faces(), []
    count = 0

    def colors(number):
        nonlocal count
        numbers = np.arange(count + 1, count + 1 + number)
        count += number
        # A permutation of all colours, in which consecutive numbers have very different colours.
        codes = numbers * 7919 % (1 << 24)
        return np.stack([codes >> 16, codes >> 8 & 255, codes & 255], -1) / 255

    for artist in list(axes._children):
        outlines = _faces_of(artist)
        if outlines:
            if keeps_colors:
                artist.do_3d_projection()
                own = np.asarray(getattr(artist, "_facecolor3d", artist.get_facecolor())).reshape(-1, 4)
                new = np.resize(own, (len(outlines), 4))
            else:
                new = np.column_stack([colors(len(outlines)), np.ones(len(outlines))])
                if hasattr(artist, "set_array"):
                    artist.set_array(None)
            artist.set_facecolor(new if len(new) > 1 or not isinstance(artist, art3d.Patch3D) else new[0])
            artist.set_edgecolor("none")
            artist.set_linewidth(0)
            artist.set_antialiased(keeps_colors)
            faces.outlines += outlines
            faces.colors += list(new)
            continue
        [color] = colors(1)
        lines, points, radius = [], np.empty((0, 3)), 0.0
        if isinstance(artist, art3d.Line3D):
            artist.set_color(color)
            artist.set_antialiased(False)
            lines, radius = [np.stack(artist._verts3d, -1)], artist.get_linewidth() / 2
        elif isinstance(artist, art3d.Line3DCollection):
            artist.set_color([color])
            artist.set_antialiased(False)
            lines, radius = [np.array(line) for line in artist._segments3d], artist.get_linewidth()[0] / 2
        elif isinstance(artist, art3d.Path3DCollection):
            artist.set_facecolor([color])
            artist.set_edgecolor([color])
            artist.set_antialiased(False)
            points, radius = np.stack(artist._offsets3d, -1), np.sqrt(artist.get_sizes()[0]) / 2 + 0.75
        elif isinstance(artist, art3d.Text3D):
            artist.set_color(color)
            points, radius = np.array([[artist._x, artist._y, artist._z]]), artist.get_fontsize() * 0.6
        else:
            continue
        probes.append((np.rint(255 * color).astype(int), lines, points, radius))
    return faces, probes


class Depths:
    """For each pixel, the polygons that may be nearest, with bounds of their depths."""

    def __init__(self, view, faces):
        shape = view.height, view.width
        self.view, self.faces = view, faces
        self.best = np.full(shape, np.inf)
        self.number = np.full(shape, -1)
        self.low = np.full((2, *shape), np.inf)
        self.low_number = np.full(shape, -1)
        self.edge = np.full(shape, np.inf)
        self.layers = []
        self.edges = [(np.empty((0, 2)), np.empty((0, 2)), np.empty(0), np.empty(0))]
        for number, outlines in enumerate(faces.outlines):
            self._add(number, [outline for outline in outlines if len(outline) > 2])
        self._mark_edges()
        finite = self.best[np.isfinite(self.best)]
        self.margin = _CLOSE * (np.ptp(finite) + np.abs(finite).max(initial=0)) if len(finite) else 0.0

    def _add(self, number, outlines):
        places, depths = zip(*map(self.view, outlines))
        every, depth = np.concatenate(places), np.concatenate(depths)
        if not np.isfinite(every).all():
            return
        for place, d in zip(places, depths):
            self.edges.append((place, np.roll(place, -1, 0), d, np.roll(d, -1)))
        low = np.maximum(np.floor(every.min(0)).astype(int), 0)
        high = np.minimum(np.ceil(every.max(0)).astype(int) + 1, [self.view.width, self.view.height])
        if (high <= low).any():
            return
        x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
        if len(outlines) == 1 and len(every) in (3, 4):
            # Either diagonal may divide a bent quad into two triangles.
            ways = [[(0, 1, 2)]] if len(every) == 3 else [[(0, 1, 2), (0, 2, 3)], [(0, 1, 3), (1, 2, 3)]]
            found = []
            for way in ways:
                nearest = np.full(x.shape, np.inf)
                for corners in way:
                    inside, at = _triangle(every[list(corners)], depth[list(corners)], x, y)
                    nearest = np.where(inside & (at < nearest), at, nearest)
                found.append(nearest)
        else:
            columns = np.column_stack([every, np.ones(len(every))])
            plane, *_ = np.linalg.lstsq(columns, depth, rcond=None)
            assert np.abs(columns @ plane - depth).max() <= 1e-9 * np.abs(depth).max(), "the polygon is not flat"
            centres = np.column_stack([x.ravel(), y.ravel()])
            inside = np.zeros(x.size, bool)
            for place in places:
                # A point in a hole is inside two outlines.
                inside ^= Path(np.append(place, place[:1], 0)).contains_points(centres)
            inside = inside.reshape(x.shape)
            found = [np.where(inside, plane[0] * x + plane[1] * y + plane[2], np.inf)]
        nearest, furthest = np.minimum.reduce(found), np.maximum.reduce(found)
        part = slice(low[1], high[1]), slice(low[0], high[0])
        best, numbers = self.best[part], self.number[part]
        nearer = furthest < best
        best[nearer], numbers[nearer] = furthest[nearer], number
        first, second, names = self.low[0][part], self.low[1][part], self.low_number[part]
        is_first = nearest < first
        is_second = ~is_first & (nearest < second)
        second[is_first] = first[is_first]
        first[is_first], names[is_first] = nearest[is_first], number
        second[is_second] = nearest[is_second]
        rows, columns = np.nonzero(np.isfinite(nearest))
        pixels = (rows + low[1]) * self.view.width + columns + low[0]
        self.layers.append((pixels, nearest[rows, columns], furthest[rows, columns], np.full(len(rows), number)))

    def _mark_edges(self):
        """Computes for each pixel the least depth of the edges next to the pixel."""
        a, b, d, e = (np.concatenate(part) for part in zip(*self.edges))
        counts = np.minimum(np.ceil(np.hypot(*(b - a).T) * 2).astype(int) + 1, 20_000)
        owner = np.repeat(np.arange(len(a)), counts)
        t = (np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)) / np.maximum(counts - 1, 1)[owner]
        at = np.floor(a[owner] + t[:, None] * (b - a)[owner]).astype(int)
        depth = d[owner] + t * (e - d)[owner]
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                x, y = at[:, 0] + dx, at[:, 1] + dy
                inside = (x >= 0) & (y >= 0) & (x < self.view.width) & (y < self.view.height)
                np.minimum.at(self.edge, (y[inside], x[inside]), depth[inside])

    def certain(self):
        """Returns the mask of pixels whose nearest polygon is certain."""
        other = np.where(self.low_number == self.number, self.low[1], self.low[0])
        # Next to a crossing, another polygon may be as near: the pixels around it are uncertain too.
        is_apart = _spread(other > self.best + self.margin, 1, np.minimum)
        return is_apart & (self.edge > self.best + self.margin) & _is_alike(self.number)

    def blended(self, background):
        """Blends the colours of all layers. Also returns the mask of pixels where the result is certain."""
        shape = self.best.shape
        pixels, near, far, number = (np.concatenate(part) for part in zip(*self.layers))
        order = np.lexsort([-near, pixels])
        pixels, near, far, number = pixels[order], near[order], far[order], number[order]
        colors = np.array(self.faces.colors)
        image = np.tile(np.asarray(background, float), (shape[0] * shape[1], 1))
        starts = np.flatnonzero(np.append(True, pixels[1:] != pixels[:-1]))
        rank = np.arange(len(pixels)) - np.repeat(starts, np.diff(np.append(starts, len(pixels))))
        certain = np.isinf(self.edge).ravel()
        close = (pixels[1:] == pixels[:-1]) & (near[:-1] - far[1:] <= self.margin)
        certain[pixels[1:][close]] = False
        certain[pixels[np.isinf(far)]] = False
        certain = _spread(certain.reshape(shape), 1, np.minimum).ravel()
        names = np.zeros(len(image), np.uint64)
        for level in range(rank.max(initial=-1) + 1):
            at = rank == level
            names[pixels[at]] = names[pixels[at]] * np.uint64(1_000_003) + number[at].astype(np.uint64) + np.uint64(1)
            rgba = colors[number[at]]
            image[pixels[at]] += rgba[:, 3:] * (255 * rgba[:, :3] - image[pixels[at]])
        return image.reshape(*shape, 3), certain.reshape(shape) & _is_alike(names.reshape(shape))


def _triangle(corners, depths, x, y):
    (ax, ay), (bx, by), (cx, cy) = corners
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if area == 0:
        return np.zeros(x.shape, bool), np.full(x.shape, np.inf)
    b = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
    c = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
    inside = (b >= 0) & (c >= 0) & (b + c <= 1)
    return inside, depths[0] + b * (depths[1] - depths[0]) + c * (depths[2] - depths[0])


def _is_alike(numbers):
    """Returns for each pixel whether all pixels within two pixels of it have the same number. One pixel is not enough, because
    Agg fills each pixel that an area touches."""
    return _spread(numbers, 2, np.minimum) == _spread(numbers, 2, np.maximum)


def _spread(image, radius, combine):
    """Combines each pixel with the pixels around it: `combine` is the minimum or the maximum."""
    for axis in (0, 1):
        result = image.copy()
        for shift in range(1, radius + 1):
            ahead = [slice(None)] * 2
            back = [slice(None)] * 2
            ahead[axis], back[axis] = slice(shift, None), slice(None, -shift)
            result[tuple(back)] = combine(result[tuple(back)], image[tuple(ahead)])
            result[tuple(ahead)] = combine(result[tuple(ahead)], image[tuple(back)])
        image = result
    return image


def _samples(view, lines):
    """Returns points along lines, about two pixels apart, and the depths of these points."""
    places, depths = [np.empty((0, 2))], [np.empty(0)]
    for line in lines:
        at, depth = view(line)
        for a, b, d, e in zip(at[:-1], at[1:], depth[:-1], depth[1:]):
            # Caps and joins are at the ends.
            count = max(int(np.hypot(*(b - a)) / 2), 1)
            t = (np.arange(count) + 0.5) / count
            places.append(a + t[:, None] * (b - a))
            depths.append(d + t * (e - d))
    return np.concatenate(places), np.concatenate(depths)


class Result:
    """The numbers of wrong, judged and doubtful pixels, and the same numbers of probes."""

    def __init__(self, wrong, judged, doubtful, wrong_probes, probes, doubtful_probes):
        self.wrong, self.judged, self.doubtful = wrong, judged, doubtful
        self.wrong_probes, self.probes, self.doubtful_probes = wrong_probes, probes, doubtful_probes

    @property
    def percent(self):
        """The share of wrong pixels and probes among those judged, in percent."""
        return 100 * (self.wrong + self.wrong_probes) / max(self.judged + self.probes, 1)


def drawn(scene, projection, dpi):
    """Draws a scene in a new figure. Returns the figure's canvas and axes."""
    figure = Figure(figsize=(4, 4), dpi=dpi)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1), projection=projection)
    scene(axes)
    axes.set_axis_off()
    return canvas, axes


def judged(scene, projection="exact3d", dpi=300, keep=None):
    """Draws a scene and judges the picture.

    Parameters
    ----------
    scene : callable
        A function that draws on axes.
    projection : str
    dpi : int
    keep : dict, optional
        Receives the picture, the depths, and the masks of wrong and of certain pixels.
    """
    canvas, axes = drawn(scene, projection, dpi)
    canvas.draw()
    alphas = [np.asarray(artist.get_facecolor()).reshape(-1, 4)[:, 3] for artist in axes._children if _faces_of(artist)]
    is_translucent = bool(alphas) and np.concatenate(alphas).min() < 1
    faces, probes = _recolored(axes, is_translucent)
    canvas.draw()
    image = np.asarray(canvas.buffer_rgba())[..., :3].astype(int)
    view = View(axes)
    depths = Depths(view, faces)
    if is_translucent:
        expected, certain = depths.blended([255, 255, 255])
        # Without antialiasing, Agg fills each pixel that an area touches, so both sides of a cut fill a pixel. With
        # antialiasing, each side covers a part of the pixel, and both together cover up to a sixteenth too little. A wrong
        # order changes pixels by more.
        is_wrong = np.abs(expected - image).max(-1) > 16
    else:
        certain = depths.certain() | np.isinf(np.minimum(depths.low[0], depths.edge))
        colors = np.rint(255 * np.array([color[:3] for color in faces.colors] + [[1, 1, 1]])).astype(int)
        is_wrong = (colors[depths.number] != image).any(-1)
    covered, counts = _judge_probes(view, depths, probes, image, dpi, keep)
    inside = np.ones(image.shape[:2], bool)
    inside[:2], inside[-2:], inside[:, :2], inside[:, -2:] = False, False, False, False
    certain &= ~covered & inside
    is_object = np.isfinite(np.minimum(depths.low[0], depths.edge)) | is_wrong
    certain &= is_object
    if keep is not None:
        keep.update(image=image.astype(np.uint8), wrong=is_wrong & certain, certain=certain, faces=faces, depths=depths)
    doubtful = np.count_nonzero(is_object & ~certain)
    return Result(np.count_nonzero(is_wrong & certain), np.count_nonzero(certain), doubtful, *counts)


def _judge_probes(view, depths, probes, image, dpi, keep):
    """Returns the mask of pixels that lines, markers and texts may cover. Also returns the numbers of wrong, judged and
    doubtful points of lines, markers and texts."""
    shape = image.shape[:2]
    covers, found = [], []
    for color, lines, points, radius in probes:
        radius = int(np.ceil(radius * dpi / 72)) + 2
        places, depth = _samples(view, lines)
        if len(points):
            at, more = view(points)
            places, depth = np.concatenate([places, at]), np.concatenate([depth, more])
        inside = np.isfinite(places).all(1) & (places > radius).all(1) & (places < [shape[1] - radius, shape[0] - radius]).all(1)
        places, depth = np.floor(places[inside]).astype(int), depth[inside]
        x, y = places.T
        nearest = _spread(np.minimum(depths.low[0], depths.edge), radius, np.minimum)[y, x]
        furthest = _spread(depths.best, radius, np.maximum)[y, x]
        is_visible, is_hidden = depth < nearest - depths.margin, depth > furthest + depths.margin
        cover = np.zeros(shape, bool)
        cover[y[~is_hidden], x[~is_hidden]] = True
        covers.append(_spread(cover, 2 * radius, np.maximum))
        found.append((color, x, y, is_visible, is_hidden))
    wrong = count = doubtful = 0
    for i, (color, x, y, is_visible, is_hidden) in enumerate(found):
        others = np.zeros(shape, bool)
        for j, cover in enumerate(covers):
            if j != i:
                others |= cover
        is_painted = (image[y, x] == color).all(-1)
        shall = is_visible & ~others[y, x]
        shall_not = is_hidden & ~covers[i][y, x]
        if keep is not None:
            bad = shall & ~is_painted | shall_not & is_painted
            keep.setdefault("wrong_probes", []).extend(zip(x[bad], y[bad], shall[bad], [tuple(color)] * bad.sum()))
        wrong += np.count_nonzero(shall & ~is_painted) + np.count_nonzero(shall_not & is_painted)
        count += np.count_nonzero(shall | shall_not)
        doubtful += np.count_nonzero(~(shall | shall_not))
    return np.logical_or.reduce(covers) if covers else np.zeros(shape, bool), (wrong, count, doubtful)


def write_picture(file, scenes):
    """Writes a picture of scenes side by side. The first row is drawn by mplot3d, the second by exact axes."""
    figure = Figure(figsize=(3 * len(scenes), 6), dpi=72)
    FigureCanvasAgg(figure)
    for row, (projection, title) in enumerate((("3d", "matplotlib"), ("exact3d", "with binspace"))):
        for column, scene in enumerate(scenes):
            axes = figure.add_subplot(2, len(scenes), row * len(scenes) + column + 1, projection=projection)
            scene(axes)
            axes.set(xticklabels=[], yticklabels=[], zticklabels=[])
            if column == 0:
                axes.set_title(title, y=0.97)
    figure.subplots_adjust(0, 0, 1, 0.98, 0, 0)
    figure.savefig(file, metadata={"Software": None})


def main():
    """Runs the command."""
    parser = argparse.ArgumentParser(prog="python -m binspace.compare", description=__doc__)
    parser.add_argument("--dpi", type=int, default=300)
    parser.add_argument("--picture", metavar="FILE", help="write the scenes as both draw them, and judge nothing")
    parser.add_argument("scenes", nargs="*", help="names of scenes; by default all")
    parser.add_argument("--speed", action="store_true", help="time pictures, and judge nothing")
    parser.add_argument("--rounds", type=int, default=7, help="number of times that each picture is timed (default: 7)")
    parser.add_argument("--matplotlib-tests", metavar="FOLDER",
                        help="run matplotlib's tests on both; FOLDER is lib/mpl_toolkits/mplot3d/tests of its sources")
    options = parser.parse_args()
    if options.matplotlib_tests:
        return _matplotlib_tests.main(options.matplotlib_tests)
    if options.speed:
        return _speed.main(options.rounds)
    known = [scene.__name__ for scene in SCENES]
    for name in options.scenes:
        if name not in known:
            parser.error(f"unknown scene: {name} (known: {', '.join(known)})")
    scenes = [scene for scene in SCENES if not options.scenes or scene.__name__ in options.scenes]
    if options.picture:
        write_picture(options.picture, scenes)
        return 0
    print("| scene | mplot3d: wrong | binspace: wrong | pixels judged | doubtful | probes judged | doubtful |")
    print("|---|---|---|---|---|---|---|")
    is_right = True
    for scene in scenes:
        before, ours = (judged(scene, projection, options.dpi) for projection in ("3d", "exact3d"))
        is_right &= ours.percent == 0
        name = scene.__name__.replace("_", " ")
        percent = f"{ours.percent:.3g} %" if ours.percent else "0"
        print(f"| {name} | {before.percent:.1f} % | {percent} | {ours.judged} | {ours.doubtful} | {ours.probes} | "
              f"{ours.doubtful_probes} |", flush=True)
    return 0 if is_right else 1


if __name__ == "__main__":
    raise SystemExit(main())
