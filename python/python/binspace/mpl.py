"""Axes for matplotlib that paint 3D plots in exact order.

Importing this module registers the projection ``"exact3d"``:

>>> import matplotlib.pyplot as plt
>>> import binspace.mpl
>>> ax = plt.figure().add_subplot(projection="exact3d")

`exact` makes existing 3D axes paint in exact order. `install` does so for all later axes with the projection ``"3d"``.

Polygons are cut where two polygons cross. Lines are cut where a line passes through a polygon. Polygons in one plane, and
lines and points on this plane, are painted in the order of their `zorder`. Items with equal `zorder` are painted in the order
in which they were added.
"""

from __future__ import annotations

import functools
import itertools
import weakref
from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib import artist as martist
from matplotlib import collections as mcoll
from matplotlib import colors as mcolors
from matplotlib import lines as mlines
from matplotlib import patches as mpatches
from matplotlib import projections as mprojections
from matplotlib import transforms as mtransforms
from matplotlib.path import Path
from mpl_toolkits.mplot3d import art3d, proj3d
from mpl_toolkits.mplot3d.axes3d import Axes3D

import binspace

__all__ = ["ExactAxes3D", "exact", "install", "uninstall"]

_IDENTITY = mtransforms.IdentityTransform()
# Polygons are clipped at this distance from the eye's plane, as a share of the distance of the furthest corner. Too small:
# corners far outside the picture overflow. Too large: parts near the eye are missing.
_NEAR = 1e-6
# The number of lines that replace a Bézier curve.
_CURVE = 16
# Limits of fragments, for raster pictures and for vector pictures. Pictures with more fragments are painted in the order of
# the tree. Too small: seams at cuts, and large files. Too large: pictures that take one or many seconds.
_MOST_PIXELS = 10_000
_MOST_VECTORS = 200_000
# The number of pairs of a corner and an edge that are compared at once. Too small: slow. Too large: much memory.
_MOST_PAIRS = 1_000_000
# Ends of lines in a picture count as one point up to this distance, in pixels.
_JOINED = 1e-5


# The polygons, lines and points of artists.


def _placed(axes, artist, points):
    """Returns points in scaled data coordinates. Invalid and clipped points become NaN."""
    mask = np.ma.getmaskarray(points).any(-1) if isinstance(points, np.ma.MaskedArray) else False
    points = np.array(np.ma.getdata(points), float)
    x, y, z = points[..., 0], points[..., 1], points[..., 2]
    if getattr(artist, "_axlim_clip", False):
        mask = mask | art3d._viewlim_mask(x, y, z, axes)
    if hasattr(proj3d, "_apply_scale_transforms") and any(axis.get_scale() != "linear" for axis in axes._axis_map.values()):
        mask = mask | art3d._scale_invalid_mask(x, y, z, axes)
        with np.errstate(all="ignore"):
            points = np.stack(proj3d._apply_scale_transforms(x, y, z, axes), -1)
    is_finite = np.isfinite(points)
    if not is_finite.all():
        mask = mask | ~is_finite.all(-1)
    if np.any(mask):
        points[mask] = np.nan
    return points


class _Polygons:
    """Polygons of an artist. `points` are the corners of all polygons, and `lengths` are the numbers of corners of the
    polygons. ``rows[i]`` is the row of polygon `i` in the artist's colours. ``own[k]`` is true if the edge that begins at
    corner `k` is an edge of the artist."""

    def __init__(self, points, lengths, rows, own):
        self.points, self.lengths, self.rows, self.own = points, lengths, rows, own


def _flat_polygons(points, lengths):
    return _Polygons(points, lengths, np.arange(len(lengths)), np.ones(len(points), bool))


def _joined_polygons(polygons):
    """Makes polygons of a list of (points, row, own)."""
    if not polygons:
        return _Polygons(np.empty((0, 3)), np.empty(0, int), np.empty(0, int), np.empty(0, bool))
    points, rows, own = zip(*polygons)
    lengths = np.array([len(corners) for corners in points])
    return _Polygons(np.concatenate(points), lengths, np.array(rows), np.concatenate(own))


def _rings(points, codes):
    """Returns the closed outlines of a path, and the path's lines that are not closed. Curves become lines."""
    if codes is None:
        return [points] if len(points) > 1 else [], []
    rings, lines, ring = [], [], []

    def end(is_closed):
        if len(ring) > 1:
            (rings if is_closed else lines).append(np.array(ring))
        ring.clear()

    i = 0
    while i < len(codes):
        code = codes[i]
        if code == Path.MOVETO:
            end(False)
            ring.append(points[i])
        elif code == Path.CLOSEPOLY:
            end(True)
        elif code == Path.LINETO:
            ring.append(points[i])
        elif code in (Path.CURVE3, Path.CURVE4):
            count = 2 if code == Path.CURVE3 else 3
            control = np.concatenate([ring[-1:], points[i : i + count]])
            t = np.linspace(0, 1, _CURVE + 1)[1:, None]
            while len(control) > 1:
                # De Casteljau's algorithm for all parameters at once.
                control = [(1 - t) * a + t * b for a, b in zip(control[:-1], control[1:])]
            ring.extend(control[0])
            i += count - 1
        elif code == Path.STOP:
            break
        i += 1
    end(False)
    return rings, lines


def _nested(rings):
    """Finds all pairs of rings in a plane where the first corner of one ring is inside the other ring. Returns the number of
    the inner ring of each pair, and the number of the outer ring. A corner is inside a ring if a ray to the right crosses the
    ring an odd number of times."""
    lengths = np.array([len(ring) for ring in rings])
    starts = np.cumsum(lengths) - lengths
    a = np.concatenate(rings)
    following = np.arange(1, len(a) + 1)
    following[starts + lengths - 1] = starts
    b, ring = a[following], np.repeat(np.arange(len(rings)), lengths)
    least = np.minimum.reduceat(a[:, 0], starts)
    # Sorted by y, the first corners beside an edge form a range.
    sorting = np.argsort(a[starts, 1])
    x, y = a[starts[sorting]].T
    low, high = (np.searchsorted(y, ends) for ends in (np.minimum(a[:, 1], b[:, 1]), np.maximum(a[:, 1], b[:, 1])))
    part = np.cumsum(high - low) // _MOST_PAIRS
    keys = [np.empty(0, np.int64)]
    for edges in np.split(np.arange(len(a)), np.flatnonzero(np.diff(part)) + 1):
        beside, owner = _ranges(low[edges], (high - low)[edges])
        edge = edges[owner]
        # Most rings lie far from most corners.
        near = (x[beside] >= least[ring[edge]]) & (x[beside] < np.maximum(a[edge, 0], b[edge, 0]))
        beside, edge = beside[near], edge[near]
        from_, to = a[edge], b[edge]
        at = from_[:, 0] + (y[beside] - from_[:, 1]) / (to[:, 1] - from_[:, 1]) * (to[:, 0] - from_[:, 0])
        inner, outer = sorting[beside], ring[edge]
        keys.append((inner * len(rings) + outer)[(at > x[beside]) & (inner != outer)])
    keys, counts = np.unique(np.concatenate(keys), return_counts=True)
    return np.divmod(keys[counts % 2 == 1], len(rings))


def _without_holes(rings):
    """Converts rings in one plane to polygons without holes: a bridge joins each hole to the outline around the hole. Returns
    each polygon with an array of booleans: whether each edge belongs to a ring.

    Bridges go from the rightmost corner of a hole to a corner visible from there (D. Eberly, "Triangulation by ear
    clipping", 2002). Areas inside an odd number of rings are filled.
    """
    rings = [ring[:-1] if len(ring) > 1 and np.array_equal(ring[0], ring[-1]) else ring for ring in rings]
    rings = [ring for ring in rings if len(ring) > 2 and not np.isnan(ring).any()]
    if len(rings) < 2:
        return [(ring, np.ones(len(ring), bool)) for ring in rings]
    lengths = np.array([len(ring) for ring in rings])
    ends = np.cumsum(lengths)
    normal = np.abs(_planes(np.concatenate(rings), ends - lengths, ends, np.arange(len(rings)))[:3]).sum(1)
    axes = [axis for axis in range(3) if axis != np.argmax(normal)]
    flat = [ring[:, axes] for ring in rings]
    areas = [_area(ring) for ring in flat]
    inner, outer = _nested(flat)
    depth = np.bincount(inner, minlength=len(rings))
    holes_of = [[] for _ in rings]
    is_next = depth[inner] == depth[outer] + 1
    for i, j in zip(outer[is_next].tolist(), inner[is_next].tolist()):
        holes_of[i].append(j)
    polygons = []
    for i, holes in enumerate(holes_of):
        if depth[i] % 2:
            continue
        holes.sort(key=lambda j: -flat[j][:, 0].max())
        ring, plane, own = rings[i], flat[i], np.ones(len(rings[i]), bool)
        if areas[i] < 0:
            ring, plane, own = ring[::-1], plane[::-1], own[::-1]
        for j in holes:
            hole, of_hole = rings[j], flat[j]
            if areas[j] > 0:
                hole, of_hole = hole[::-1], of_hole[::-1]
            start = int(np.argmax(of_hole[:, 0]))
            at = _seen_corner(plane, of_hole[start])
            turned = np.roll(np.arange(len(hole)), -start)
            # The outline up to the corner, the bridge, the hole, the bridge back, and the rest of the outline.
            order = np.concatenate([turned, turned[:1]])
            ring = np.concatenate([ring[: at + 1], hole[order], ring[at:]])
            plane = np.concatenate([plane[: at + 1], of_hole[order], plane[at:]])
            around_hole = np.ones(len(order), bool)
            around_hole[-1] = False
            own = np.concatenate([own[:at], [False], around_hole, own[at:]])
        polygons.append((ring, own))
    return polygons


def _area(ring):
    x, y = (ring - ring[0]).T
    return float(np.sum(x[:-1] * y[1:] - y[:-1] * x[1:]))


def _seen_corner(ring, point):
    """Returns a corner of a counter-clockwise ring that is visible from a point inside the ring."""
    y = ring[:, 1]
    numbers = np.flatnonzero((y <= point[1]) & (np.append(y[1:], y[:1]) > point[1]))
    if not len(numbers):
        return int(np.argmin(np.hypot(*(ring - point).T)))
    a, b = ring[numbers], ring[(numbers + 1) % len(ring)]
    x = a[:, 0] + (point[1] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    right = np.where(x >= point[0], x, np.inf)
    nearest = int(np.argmin(right))
    side = numbers[nearest]
    ends = [side, (side + 1) % len(ring)]
    corner = max(ends, key=lambda i: ring[i, 0])
    # The triangle has three vertices: the point, the place to the right of the point, and the corner. Other corners in
    # this triangle may hide the corner.
    place = np.array([right[nearest], point[1]])
    triangle = np.array([point, place, ring[corner]])
    if _area(triangle) < 0:
        triangle = triangle[::-1]
    edges = triangle[[1, 2, 0]] - triangle
    # If the triangle has no area, all corners on the triangle's line count as inside. The bounds of the triangle exclude
    # corners beyond its ends.
    low, high = triangle.min(0), triangle.max(0)
    x, y = ring.T
    candidates = np.flatnonzero((x >= low[0]) & (x <= high[0]) & (y >= low[1]) & (y <= high[1]))
    offsets = ring[candidates, None] - triangle
    inside = (edges[:, 0] * offsets[..., 1] - edges[:, 1] * offsets[..., 0] >= 0).all(1)
    candidates = candidates[inside & (ring[candidates] != ring[corner]).any(1)]
    if len(candidates):
        steps = ring[candidates] - point
        slopes = np.abs(steps[:, 1]) / np.maximum(steps[:, 0], 1e-300)
        return int(candidates[np.lexsort([steps[:, 0], slopes])[0]])
    return int(corner)


# The filled paths of each artist, by number: points, codes, and polygons without holes.
_areas_of = weakref.WeakKeyDictionary()


class _Source:
    """An artist's polygons, lines and points in scaled data coordinates, and the artist's style."""

    def __init__(self, artist):
        self.artist = artist
        self.polygons = None
        self.lines, self.line_rows = [], []
        self.points = np.empty((0, 3))
        self.point_rows = np.empty(0, int)
        self.face = self.edge = np.empty((0, 4))
        self.widths, self.dashes, self.smooth = [0.0], [(0, None)], [True]
        # Filled contours have a hatch for each level.
        self.hatches = list(getattr(artist, "hatches", None) or [artist.get_hatch() if hasattr(artist, "get_hatch") else None])

    def set_style(self, face, edge):
        artist = self.artist
        self.face, self.edge = np.asarray(face, float).reshape(-1, 4), np.asarray(edge, float).reshape(-1, 4)
        self.widths = np.atleast_1d(np.asarray(artist.get_linewidth(), float))
        if isinstance(artist, mcoll.Collection):
            self.dashes = artist._linestyles or [(0, None)]
            self.smooth = np.atleast_1d(artist.get_antialiased())
        else:
            self.dashes = [artist._dash_pattern]
            self.smooth = np.array([artist.get_antialiased()])
        if not len(self.widths):
            self.widths = np.zeros(1)

    def is_filled(self, rows):
        filled = np.array([bool(hatch) for hatch in self.hatches])[rows % len(self.hatches)]
        return filled | (self.face[rows % len(self.face), 3] > 0) if len(self.face) else filled

    def is_stroked(self, rows):
        if not len(self.edge):
            return np.zeros(len(rows), bool)
        return (self.edge[rows % len(self.edge), 3] > 0) & (self.widths[rows % len(self.widths)] > 0)

    def set_areas(self, polygons):
        """Sets the filled polygons. Polygons without a fill become lines along the polygon's edges."""
        filled = self.is_filled(polygons.rows)
        if filled.all():
            self.polygons = polygons
            return
        stroked = self.is_stroked(polygons.rows)
        ends = np.cumsum(polygons.lengths)
        for i in np.flatnonzero(~filled & stroked):
            corners = slice(ends[i] - polygons.lengths[i], ends[i])
            for line in _own_lines(polygons.own[corners]):
                self.lines.append(polygons.points[corners][line])
                self.line_rows.append(polygons.rows[i])
        keep = np.repeat(filled, polygons.lengths)
        self.polygons = _Polygons(
            polygons.points[keep], polygons.lengths[filled], polygons.rows[filled], polygons.own[keep]
        )

    def set_paths(self, axes, paths):
        """Sets polygons and lines from paths of (points, codes)."""
        areas = []
        before = _areas_of.get(self.artist, {})
        kept = _areas_of[self.artist] = {}
        for row, (points, codes) in enumerate(paths):
            points = _placed(axes, self.artist, np.asarray(points, float).reshape(-1, 3))
            rows = np.array([row])
            if not self.is_filled(rows)[0]:
                if self.is_stroked(rows)[0]:
                    rings, open_lines = _rings(points, codes)
                    closed = [] if codes is None else [np.concatenate([ring, ring[:1]]) for ring in rings]
                    for line in (rings if codes is None else closed) + open_lines:
                        self.lines.append(line)
                        self.line_rows.append(row)
                continue
            known = before.get(row)
            if known is None or not _are_equal(known[:2], (points, codes)):
                rings, open_lines = _rings(points, codes)
                codes = None if codes is None else np.array(codes)
                known = points, codes, _without_holes(rings + open_lines)
            kept[row] = known
            areas += [(corners, row, own) for corners, own in known[2]]
        self.polygons = _joined_polygons(areas)


def _own_lines(own):
    """Returns the lines along those edges of an outline that are the outline's own, as numbers of corners."""
    count = len(own)
    if own.all():
        return [np.append(np.arange(count), 0)]
    first = int(np.flatnonzero(~own)[0]) + 1
    lines, line = [], []
    for i in range(first, first + count):
        if own[i % count]:
            line = line or [i % count]
            line.append((i + 1) % count)
        elif line:
            lines.append(np.array(line))
            line = []
    return lines + [np.array(line)] if line else lines


def _of_polygons(axes, artist):
    source = _Source(artist)
    if artist.get_array() is not None:
        artist.update_scalarmappable()
        if artist._face_is_mapped:
            artist._facecolor3d = artist._facecolors
        if artist._edge_is_mapped:
            artist._edgecolor3d = artist._edgecolors
    source.set_style(artist._facecolor3d, artist._edgecolor3d)
    if len(source.edge) and len(source.edge) not in (1, len(source.face)) and len(source.face):
        source.edge = source.edge[:1]
    if hasattr(artist, "_faces"):
        faces, invalid = artist._faces, artist._invalid_vertices
        count, most = faces.shape[:2] if faces.ndim == 3 else (0, 0)
        if np.any(invalid):
            valid = ~np.broadcast_to(invalid, (count, most))
            lengths, points = valid.sum(1), faces[valid]
        else:
            lengths, points = np.full(count, most), faces.reshape(-1, 3) if count else np.empty((0, 3))
    else:
        points = artist._vec[:3].T
        lengths = np.array([part.stop - part.start for part in artist._segslices], int)
    codes = artist._codes3d
    if codes is not None and len(codes):
        ends = np.cumsum(lengths)
        source.set_paths(axes, [(points[e - n : e], c) for e, n, c in zip(ends, lengths, codes)])
        return source
    points = _placed(axes, artist, points)
    polygons = _flat_polygons(points, lengths)
    if not artist._closed and len(lengths):
        polygons.own[np.cumsum(lengths)[lengths > 0] - 1] = False
    source.set_areas(polygons)
    return source


def _of_paths(axes, artist):
    """Reads contours: `Collection3D` in matplotlib 3.8 and later."""
    source = _Source(artist)
    artist.update_scalarmappable()
    source.set_style(artist.get_facecolor(), artist.get_edgecolor())
    source.set_paths(axes, artist._3dverts_codes)
    return source


def _of_patch(axes, artist):
    source = _Source(artist)
    face = [artist.get_facecolor()] if artist.get_fill() else np.empty((0, 4))
    source.set_style(face, [artist.get_edgecolor()])
    points = np.asarray(artist._segment3d, float)
    codes = getattr(artist, "_code3d", None)
    if codes is None and len(points):
        # A patch is drawn as a path that is not closed.
        codes = np.full(len(points), Path.LINETO, np.uint8)
        codes[0] = Path.MOVETO
    source.set_paths(axes, [(points, codes)])
    return source


def _of_segments(axes, artist):
    source = _Source(artist)
    artist.update_scalarmappable()
    source.set_style(np.empty((0, 4)), artist.get_edgecolor())
    rows = np.arange(len(artist._segments3d))
    lengths = np.array([len(segment) for segment in artist._segments3d], int)
    rows = rows[source.is_stroked(rows) & (lengths > 1)]
    if len(rows):
        segments = [np.ma.asarray(artist._segments3d[row], float) for row in rows.tolist()]
        placed = _placed(axes, artist, np.ma.concatenate(segments))
        source.lines = np.split(placed, np.cumsum(lengths[rows])[:-1])
        source.line_rows = rows.tolist()
    return source


def _of_line(axes, artist):
    source = _Source(artist)
    vertices = np.broadcast_arrays(*(np.ma.asarray(c, float) for c in artist._verts3d), subok=True)
    points = _placed(axes, artist, np.ma.stack([np.ma.atleast_1d(c).ravel() for c in vertices], -1))
    source.set_style(np.empty((0, 4)), [mcolors.to_rgba(artist.get_color(), artist.get_alpha())])
    if artist.get_linestyle() not in ("None", "none", " ", "", None) and source.widths[0] > 0 and len(points) > 1:
        source.lines, source.line_rows = [points], [0]
    if artist.get_marker() not in ("None", "none", " ", "", None):
        source.point_rows = _marked(axes, artist, points)
        source.points = points[source.point_rows]
    # Picking and `get_data` use these positions.
    projected = _projected(axes.M, points)
    artist.set_data(projected[:, 0], projected[:, 1])
    return source


def _marked(axes, artist, points):
    """Returns the numbers of a line's vertices that have markers."""
    every = artist.get_markevery()
    numbers = np.arange(len(points))
    if every is None:
        return numbers
    if isinstance(every, (int, np.integer)):
        return numbers[::every]
    if isinstance(every, tuple) and all(isinstance(number, (int, np.integer)) for number in every):
        return numbers[every[0] :: every[1]]
    if isinstance(every, (float, tuple)):
        # `every` is a distance in the picture.
        places = _projected(axes.M, points)
        chosen = mlines._mark_every_path(every, Path(places), axes.transData, axes).vertices
        return np.array([np.flatnonzero((places == place).all(1))[0] for place in chosen], int)
    return numbers[every]


def _of_scatter(axes, artist):
    source = _Source(artist)
    offsets = [np.ma.asarray(np.ma.atleast_1d(c), float) for c in artist._offsets3d]
    offsets = np.broadcast_arrays(*offsets, subok=True)
    source.points = _placed(axes, artist, np.ma.stack(offsets, -1).reshape(-1, 3))
    source.point_rows = np.arange(len(source.points))
    return source


def _of_patches(axes, artist):
    source = _of_scatter(axes, artist)
    if len(source.points):
        source.point_rows = np.arange(max(len(source.points), len(artist.get_paths())))
        source.points = source.points[source.point_rows % len(source.points)]
    return source


def _of_text(axes, artist):
    source = _Source(artist)
    if artist.get_text():
        source.points = _placed(axes, artist, np.array([[artist._x, artist._y, artist._z]], float))
        source.point_rows = np.zeros(1, int)
    return source


_KINDS = [
    (art3d.Poly3DCollection, _of_polygons),
    (art3d.Line3DCollection, _of_segments),
    (art3d.Path3DCollection, _of_scatter),
    (art3d.Patch3DCollection, _of_patches),
    (art3d.Line3D, _of_line),
    (art3d.Patch3D, _of_patch),
    (art3d.Text3D, _of_text),
]
if hasattr(art3d, "Collection3D"):
    _KINDS.append((art3d.Collection3D, _of_paths))
_SCATTERS = art3d.Path3DCollection, art3d.Patch3DCollection


def _kind(artist):
    if isinstance(artist, art3d.Patch3DCollection) and artist.get_offset_transform() != artist.axes.transData:
        # The patches are not at points in space.
        return None
    return next((gather for kind, gather in _KINDS if isinstance(artist, kind)), None)


class _Late(Sequence):
    """A list that replaces the projected paths of a collection, or the colours of these paths. The collection is projected
    when this list is first read. Picking reads the list; painting does not. A collection is also projected after it was removed
    from the axes."""

    def __init__(self, artist, name):
        self._artist, self._axes, self._name = artist, artist.axes, name

    def _values(self):
        artist = self._artist
        if getattr(artist, self._name) is self:
            is_removed = artist.axes is None
            if is_removed:
                artist.axes = self._axes
            try:
                # While the axes are drawn, the artist's own attribute only makes lists like this one.
                type(artist).do_3d_projection(artist)
            finally:
                if is_removed:
                    artist.axes = None
        return getattr(artist, self._name)

    def __len__(self):
        return len(self._values())

    def __getitem__(self, number):
        return self._values()[number]

    def __array__(self, dtype=None, copy=None):
        return np.array(self._values(), dtype)


def _may_be_late(artist):
    """Returns whether an artist is projected by mplot3d's own method, so that the projection can wait."""
    if "do_3d_projection" in vars(artist):
        return False
    project = getattr(type(artist), "do_3d_projection", None)
    return project in (art3d.Poly3DCollection.do_3d_projection, art3d.Line3DCollection.do_3d_projection)


def _project_late(artist):
    """Replaces `do_3d_projection`. Legends read the paths while the axes are drawn, and others read them later. Returns a depth
    that is equal for all artists."""
    names = ["_paths"]
    if isinstance(artist, art3d.Poly3DCollection):
        names += ["_facecolors2d", "_edgecolors2d"]
    for name in names:
        setattr(artist, name, _Late(artist, name))
    return 0.0


# The view.


def _size(axes):
    """Returns the size of the whole picture in pixels, also for axes in a part of a figure."""
    figure = axes.figure.get_figure(root=True) if matplotlib.__version_info__ >= (3, 10) else axes.figure.figure
    return [int(np.ceil(side)) for side in (figure.bbox.width, figure.bbox.height)]


def _projected(matrix, points):
    """Returns x and y of points in the plane of the projection."""
    result = np.empty((*points.shape[:-1], 2))
    # One column at a time, which is faster than a matrix product.
    depth = _times(matrix[3], points)
    with np.errstate(all="ignore"):
        for axis in range(2):
            np.divide(_times(matrix[axis], points), depth, result[..., axis])
    return result


def _times(row, points):
    """Returns the products of points with a row of a matrix."""
    result = points[..., 0] * row[0]
    for axis in (1, 2):
        result += points[..., axis] * row[axis]
    result += row[3]
    return result


def _to_pixels(matrix, to_display):
    """Returns the matrix that projects points to display coordinates."""
    result = matrix.copy()
    result[:2] = to_display[[0, 1], [0, 1], None] * matrix[:2] + to_display[:2, 2:] * matrix[3]
    return result


def _viewpoint(matrix):
    """Returns the eye of a matrix, where x, y and w are 0. For a parallel projection, returns the direction of view."""
    rows = matrix[[0, 1, 3]]
    rows = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    null = np.linalg.svd(rows)[2][3]
    if abs(null[3]) > 1e-12 * np.linalg.norm(null[:3]) and np.linalg.norm(matrix[3, :3]) > 0:
        return {"eye": null[:3] / null[3]}
    # Depth increases away from the viewer.
    direction = null[:3] * np.sign(matrix[2, :3] @ null[:3] * matrix[3, 3])
    return {"direction": direction}


def _camera(matrix, to_display, size):
    """Returns the camera of a picture, and whether x is mirrored."""
    clip = _to_pixels(matrix, to_display)
    clip[:2] = 2 / np.array(size)[:, None] * clip[:2] - matrix[3]
    # Inverted axes mirror a picture.
    volume = np.linalg.det(clip[[0, 1, 3]][:, :3])
    direction = _viewpoint(matrix).get("direction")
    if direction is not None:
        volume = np.linalg.det(np.stack([clip[0, :3], clip[1, :3], direction * matrix[3, 3]]))
    is_mirrored = volume > 0
    if is_mirrored:
        clip[0] = -clip[0]
    return binspace.Camera(clip, size), is_mirrored


# Painting.


class _Built:
    """A tree of polygons, with an overlay of lines and points. The tree is reused while polygons, lines and points are
    unchanged."""

    def __init__(self, points, lengths, own, opacity, lines, line_lengths, markers, progress):
        self.given = points, lengths, own, opacity, lines, line_lengths, markers
        everything = np.concatenate([points, lines, markers])
        # The tree has coordinates from -1 to 1, because axes may have very different scales. NaN are ignored.
        low, high = (
            np.nan_to_num([ends.reduce(everything[:, axis], initial=np.nan) for axis in range(3)])
            for ends in (np.fmin, np.fmax)
        )
        self.middle, self.scale = low + (high - low) / 2, np.where(high > low, (high - low) / 2, 1.0)
        points, lines, markers = ((part - self.middle) / self.scale for part in (points, lines, markers))
        offsets = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
        # A little larger, because quotients are rounded.
        bounds = [np.full(3, -1.001), np.full(3, 1.001)]
        self.tree = binspace.Tree((points, offsets), opacity=opacity, bounds=bounds, progress=progress)
        line_offsets = np.concatenate([[0], np.cumsum(line_lengths)]).astype(np.int64)
        self.overlay = self.tree.overlay((lines, line_offsets), markers, progress=progress)
        self.pieces = self.overlay.pieces
        fragments = self.tree.fragments
        self.points, self.polygon = fragments.points, fragments.polygon.astype(np.int64)
        offsets_of_fragments = fragments.offsets.astype(np.int64)
        self.starts, self.ends = offsets_of_fragments[:-1], offsets_of_fragments[1:]
        edges = fragments.edges.astype(np.int64)
        self.own = edges >= 0
        first = np.repeat(offsets[self.polygon], np.diff(offsets_of_fragments))
        self.own[self.own] = own[(first + edges)[self.own]]
        self.outlines = np.asfortranarray(points)
        self.offsets = offsets
        self.counts = np.bincount(self.polygon, minlength=len(lengths))
        self.paths, self.corners, self.places = _views(offsets)
        self.is_own = _are_all(own, offsets[:-1], lengths)
        # The fragments of polygons that have several fragments, and the planes that tell which side a view shows.
        self.several = np.flatnonzero(self.counts[self.polygon] > 1)
        self.planes = _planes(self.points, self.starts, self.ends, self.several)

    def matrix(self, matrix):
        """Converts a matrix of data coordinates to a matrix of the tree's coordinates."""
        placed = np.diag([*self.scale, 1.0])
        placed[:3, 3] = self.middle
        return matrix @ placed

    def is_of(self, *given):
        return _are_equal(self.given, given)


def _are_equal(some, others):
    """Returns whether each array (or None) equals the array at the same place in the other list."""
    return all(
        a is b
        or (a is not None and b is not None)
        # The first comparison is fast, and enough without NaN.
        and (np.array_equal(a, b) or np.array_equal(a, b, equal_nan=True))
        for a, b in zip(some, others)
    )


def _are_all(values, starts, lengths):
    """Returns for each range, given by its start and length, whether all values in the range are true."""
    wrong = np.append(0, np.cumsum(~values))
    return wrong[starts] == wrong[starts + lengths]


def _planes(points, starts, ends, numbers):
    """Returns the planes of the outlines with these numbers: the normals of the planes, and the scalar product of each normal
    with a corner of its outline."""
    starts, lengths = starts[numbers], (ends - starts)[numbers]
    corners, owner = _ranges(starts, lengths)
    last = np.cumsum(lengths) - 1
    # One coordinate after the other, to save memory. Steps lead from the first corner to each corner.
    steps = [points[corners, axis] - points[starts, axis][owner] for axis in range(3)]
    following = [np.roll(step, -1) for step in steps]
    for step in following:
        step[last] = 0
    planes = np.zeros((4, len(numbers)))
    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        products = steps[i] * following[j] - steps[j] * following[i]
        planes[axis] = np.bincount(owner, products, len(numbers))
        planes[3] += planes[axis] * points[starts, axis]
    return planes


def _ranges(starts, lengths):
    """Concatenates ranges of numbers, given their starts and lengths. Also returns the index of each number's range."""
    owner = np.repeat(np.arange(len(starts)), lengths)
    before = np.cumsum(lengths) - lengths
    return np.arange(len(owner)) + (starts - before)[owner], owner


def _closed(offsets):
    """Closes outlines by repeating the first corner of each outline at its end. Returns the numbers of all corners, the path
    code of each corner, and the place where each outline begins."""
    count = len(offsets) - 1
    closed = offsets + np.arange(count + 1)
    corners = np.arange(closed[-1]) - np.repeat(np.arange(count), np.diff(closed))
    corners[closed[1:] - 1] = offsets[:-1]
    codes = np.full(len(corners), Path.LINETO, np.uint8)
    codes[closed[:-1]] = Path.MOVETO
    codes[closed[1:] - 1] = Path.CLOSEPOLY
    return corners, codes, closed


def _without_repeats(places, offsets):
    """Removes corners of outlines that repeat the previous corner. Returns the remaining corners, and the place where each
    outline begins."""
    is_other = (np.abs(np.diff(places, axis=0)) > _JOINED).any(1)
    keep = np.append(True, is_other)[: len(places)]
    keep[offsets[:-1][offsets[:-1] < len(keep)]] = True
    return places[keep], np.append(0, np.cumsum(keep))[offsets]


class _Outline(Path):
    """A path with plain attributes instead of properties. Plain attributes are faster, and renderers read them for each path
    of a collection."""

    __slots__ = ("vertices", "codes")
    should_simplify = _should_simplify = False
    simplify_threshold = _simplify_threshold = 0.0
    _interpolation_steps = 1
    _readonly = False

    def __init__(self, vertices, codes):
        self.vertices, self.codes = vertices, codes


def _views(offsets):
    """Makes closed paths of outlines. Returns the paths, the numbers of all corners of the paths, and an array for the
    positions of these corners. The paths are views of this array."""
    lengths = np.diff(offsets)
    places = np.zeros((offsets[-1] + len(lengths), 2))
    corners, paths, start = [np.empty(0, int)], np.empty(len(lengths), object), 0
    # Outlines of one length are rows of a matrix, which is faster than slicing one by one.
    for length in np.unique(lengths):
        chosen = np.flatnonzero(lengths == length)
        around = np.append(np.arange(length), 0 if length else [])
        corners.append((offsets[chosen, None] + around.astype(int)).ravel())
        end = start + len(corners[-1])
        codes = np.full(len(around), Path.LINETO, np.uint8)
        codes[:1], codes[1:][-1:] = Path.MOVETO, Path.CLOSEPOLY
        rows = places[start:end].reshape(len(chosen), len(around), 2)
        paths[chosen] = np.fromiter([_Outline(row, codes) for row in rows], object, len(chosen))
        start = end
    return paths, np.concatenate(corners), places[:start]


def _paths(places, codes, offsets):
    offsets = offsets.tolist()
    return [_Outline(places[a:b], codes[a:b]) for a, b in zip(offsets[:-1], offsets[1:])]


def _stroked(starts, lengths, own):
    """Makes lines along those edges of each outline that `own` marks. Returns the numbers of the lines' corners, the path
    code of each corner, and the place where the lines of each outline begin."""
    corners, owner = _ranges(starts, lengths)
    first = np.cumsum(lengths) - lengths
    # Each line begins after an edge that is not its outline's own.
    at = np.arange(len(corners)) - first[owner]
    turn = np.full(len(starts), len(corners))
    np.minimum.at(turn, owner, np.where(own[corners], len(corners), at + 1))
    is_ring = turn == len(corners)
    turn[is_ring] = 0
    from_, to = (starts[owner] + (at + step + turn[owner]) % lengths[owner] for step in (0, 1))
    is_own = own[from_]
    begins = is_own & np.append(True, ~is_own[:-1] | (owner[1:] != owner[:-1]))[: len(is_own)]
    chosen = np.stack([begins, is_own], -1)
    corners = np.stack([from_, to], -1)[chosen]
    codes = np.where(is_ring[owner] & (at == lengths[owner] - 1), Path.CLOSEPOLY, Path.LINETO).astype(np.uint8)
    codes = np.stack([np.full(len(codes), Path.MOVETO, np.uint8), codes], -1)[chosen]
    counts = np.bincount(owner, begins.astype(int) + is_own, len(starts)).astype(int)
    return corners, codes, np.append(0, np.cumsum(counts))


class _Shown:
    """The items of a picture in painting order. Kind 0 is an area, kind 1 a part of a line, and kind 2 a point. The
    number of an item is its index in the lists of its kind below. Positions are in display coordinates."""

    def __init__(self, kinds, numbers):
        self.kinds, self.numbers = kinds, numbers
        self.polygon = self.line = self.segment = self.marker = np.empty(0, int)
        self.ends = np.empty((0, 2, 2))
        self.at = np.empty((0, 2))
        # The path of each area, and whether all sides of the area are edges of the area's polygon.
        self.fills, self.is_whole = np.empty(0, object), np.empty(0, bool)

    def sort_markers(self, depths):
        """Sorts consecutive markers by depth, because markers in one plane with the eye can overlap too."""
        is_marker = self.kinds == 2
        if not is_marker.any():
            return
        run = np.cumsum(np.append(True, ~(is_marker[1:] & is_marker[:-1]))[: len(is_marker)])
        depth = np.zeros(len(run))
        depth[is_marker] = depths[self.marker[self.numbers[is_marker]]]
        order = np.lexsort([-depth, run])
        self.kinds, self.numbers = self.kinds[order], self.numbers[order]

    def strokes(self, numbers):
        """Returns the paths of those sides of each area that are edges of its polygon."""
        raise NotImplementedError


def _runs(built, order, view, may_join):
    """Divides an order into runs, and returns where the runs begin. Consecutive fragments of a polygon form a run if
    `may_join` is true for the polygon, and the same side of these fragments is visible. (Outlines of different sides may
    overlap.) Each other fragment, each part of a line, and each point is a run by itself."""
    *normals, shift = built.planes
    eye, shift = (view["eye"], shift) if "eye" in view else (-view["direction"], 0)
    # The polygon and the side of each fragment.
    shown = 2 * built.polygon
    shown[built.several] += sum(normal * part for normal, part in zip(normals, eye)) > shift
    shown = np.append(shown, np.full(len(built.pieces.number), -1))[order]
    joined = np.append(may_join, False)[shown >> 1]
    continues = joined[1:] & (shown[1:] == shown[:-1])
    return np.flatnonzero(np.append(True, ~continues)[: len(order)])


class _Ordered(_Shown):
    """The fragments of a tree in the tree's order, which is fast to compute for any view. Consecutive fragments of a polygon
    form one area. If an area is a whole polygon, the path of the area is the polygon's outline."""

    def __init__(self, built, matrix, to_display):
        view = _viewpoint(matrix)
        order = built.overlay.order(**view).astype(np.int64)
        count = len(built.polygon)
        to_pixels = _to_pixels(matrix, to_display)

        def place(points):
            return _projected(to_pixels, points)

        self.built, self.place = built, place
        depth = _times(matrix[3], built.outlines)
        self.least = _NEAR * np.nanmax(np.abs(depth), initial=0)
        is_near = ~_are_all(~(depth <= self.least), built.offsets[:-1], built.given[1])
        first = _runs(built, order, view, ~is_near)
        is_area = order[first] < count
        lengths = np.diff(np.append(first, len(order)))
        self.order, self.first_of_area, self.length_of_area = order, first[is_area], lengths[is_area]
        pieces = order[first] - count
        is_point = built.pieces.segment < 0
        kinds = np.zeros(len(first), int)
        kinds[~is_area] = np.where(is_point, 2, 1)[pieces[~is_area]]
        super().__init__(kinds, np.where(is_area, np.cumsum(is_area) - 1, pieces))
        self.polygon = built.polygon[order[self.first_of_area]]
        self.line = self.marker = built.pieces.number.astype(np.int64)
        self.segment = built.pieces.segment

        is_complete = (self.length_of_area == built.counts[self.polygon]) & ~is_near[self.polygon]
        np.take(place(built.outlines), built.corners, 0, built.places)
        self.fills = np.empty(len(self.polygon), object)
        self.fills[is_complete] = built.paths[self.polygon[is_complete]]
        self.is_whole = is_complete & built.is_own[self.polygon]
        self.near = {}
        for area in np.flatnonzero(is_near[self.polygon]).tolist():
            self.near[area] = self._before_eye(order[self.first_of_area[area]], matrix)
            self.fills[area] = self.near[area][0]
        parts = np.flatnonzero(~is_complete & ~is_near[self.polygon])
        self.fills[parts] = np.fromiter(self._parts(parts), object, len(parts))
        ends = built.pieces.ends
        self.ends = place(ends.reshape(-1, 3)).reshape(-1, 2, 2)
        self.at = self.ends[:, 0]
        behind = (ends @ matrix[3, :3] + matrix[3, 3] <= 0).any(1)
        if behind.any():
            keep = (self.kinds == 0) | ~behind[np.where(self.kinds == 0, 0, self.numbers)]
            self.kinds, self.numbers = self.kinds[keep], self.numbers[keep]

    def _parts(self, areas):
        """Returns the paths of areas that are parts of polygons."""
        built = self.built
        numbers, owner = _ranges(self.first_of_area[areas], self.length_of_area[areas])
        fragments = self.order[numbers]
        lengths = (built.ends - built.starts)[fragments]
        corners, _ = _ranges(built.starts[fragments], lengths)
        closed_corners, codes, closed = _closed(np.append(0, np.cumsum(lengths)))
        places = self.place(built.points[corners])[closed_corners]
        ends = np.append(0, np.cumsum(np.bincount(owner, minlength=len(areas)))) if len(areas) else np.zeros(1, int)
        return _paths(places, codes, closed[ends])

    def _before_eye(self, fragment, matrix):
        """Clips a fragment in front of the eye. Returns the clipped outline, and the path to stroke."""
        part = slice(self.built.starts[fragment], self.built.ends[fragment])
        points, own = self.built.points[part], self.built.own[part]
        return _before_eye(points, own, points @ matrix[3, :3] + matrix[3, 3], self.least, self.place)

    def strokes(self, numbers):
        built = self.built
        rows, owner = _ranges(self.first_of_area[numbers], self.length_of_area[numbers])
        fragments = self.order[rows]
        corners, codes, offsets = _stroked(built.starts[fragments], (built.ends - built.starts)[fragments], built.own)
        ends = np.append(0, np.cumsum(np.bincount(owner, minlength=len(numbers))))
        paths = _paths(self.place(built.points[corners]), codes, offsets[ends])
        return [self.near[number][1] if number in self.near else path for number, path in zip(numbers.tolist(), paths)]


def _before_eye(points, own, depth, near, place):
    """Clips an outline in front of the eye. Returns the clipped outline, and the path to stroke."""
    corners, edges = [], []
    for i in range(len(points)):
        j = (i + 1) % len(points)
        if depth[i] > near:
            corners.append(points[i])
            edges.append(own[i])
        if (depth[i] > near) != (depth[j] > near):
            t = (near - depth[i]) / (depth[j] - depth[i])
            corners.append(points[i] + t * (points[j] - points[i]))
            edges.append(own[i] and depth[i] <= near)
    places = place(np.array(corners).reshape(-1, 3))
    line = np.append(np.arange(len(places)), 0) if len(places) > 2 else np.empty(0, int)
    codes = np.full(len(line), Path.LINETO, np.uint8)
    codes[:1], codes[-1:] = Path.MOVETO, Path.CLOSEPOLY
    corners, stroke_codes, _ = _stroked(np.zeros(1, int), np.array([len(places)]), np.array(edges, bool))
    return Path(places[line].reshape(-1, 2), codes), Path(places[corners].reshape(-1, 2), stroke_codes)


class _Drawn(_Shown):
    """A drawing of one view. Each polygon is one path if a painting order exists."""

    def __init__(self, built, matrix, to_display, size, is_opaque, traps, are_texts):
        camera, is_mirrored = _camera(matrix, to_display, size)
        has_overlay = bool(len(built.overlay))
        seen = built.tree.visibility(camera) if is_opaque else None
        if seen is not None and not has_overlay:
            drawing = seen.drawing()
        else:
            drawing = built.tree.translucent(camera, built.overlay if has_overlay else None)
        items = drawing.items.astype(np.int64)
        super().__init__(items[:, 0], items[:, 1])

        def place(points):
            x, y = points[..., 0], points[..., 1]
            return np.stack([size[0] - x if is_mirrored else x, size[1] - y], -1)

        self.polygon = drawing.polygon.astype(np.int64)
        self.of_paths, self.of_outlines = drawing.path_offsets.astype(np.int64), drawing.outline_offsets.astype(np.int64)
        self.corners, edges = place(drawing.corners), drawing.edges.astype(np.int64)
        own = built.given[2]
        offsets = np.concatenate([[0], np.cumsum(built.given[1])]).astype(np.int64)
        starts = self.of_outlines[self.of_paths]
        first = np.repeat(offsets[self.polygon], np.diff(starts))
        self.own = edges >= 0
        self.own[self.own] = own[(first + edges)[self.own]]
        self.is_whole = _are_all(self.own, starts[:-1], np.diff(starts))
        if traps.any():
            # Polygons below would show through seams between faces.
            filled = drawing._trapped(traps.tolist())
            places, of_outlines = _without_repeats(place(filled.corners), filled.outline_offsets.astype(np.int64))
            corners, codes, closed = _closed(of_outlines)
            paths = _paths(places[corners], codes, closed[filled.path_offsets])
            self.is_whole[traps[self.polygon]] = False
        else:
            corners, codes, closed = _closed(self.of_outlines)
            paths = _paths(self.corners[corners], codes, closed[self.of_paths])
        self.fills = np.fromiter(paths, object, len(paths))
        if drawing.lines is not None:
            self.line = drawing.lines.line.astype(np.int64)
            self.segment = drawing.lines.segment.astype(np.int64)
            self.ends = place(drawing.lines.ends)
            self.marker = drawing.markers.point.astype(np.int64)
            self.at = place(drawing.markers.at)
            if seen is not None:
                self._leave_out_hidden(seen, built.overlay, place, are_texts)

    def _leave_out_hidden(self, seen, overlay, place, are_texts):
        """Leaves out hidden polygons and hidden parts of lines, which would show through seams of the polygons in front. Also
        leaves out markers whose middle is hidden: otherwise the marker's visible margin would cover the polygon in front."""
        is_visible = np.zeros(self.polygon.max(initial=-1) + 1, bool)
        visible = seen.polygons().polygon
        is_visible[visible[visible < len(is_visible)]] = True
        markers = seen.markers(overlay)
        is_shown = are_texts.copy()
        is_shown[markers.point[markers.is_visible]] = True
        is_line = self.kinds == 1
        keep = is_line.copy()
        is_area, is_marker = self.kinds == 0, self.kinds == 2
        keep[is_area] = is_visible[self.polygon[self.numbers[is_area]]]
        keep[is_marker] = is_shown[self.marker[self.numbers[is_marker]]]
        self.kinds, self.numbers, is_line = self.kinds[keep], self.numbers[keep], is_line[keep]
        # Intersects each part of a line with each visible part of the part's segment.
        runs = seen.lines(overlay)
        most = 1 + max(runs.segment.max(initial=0), self.segment.max(initial=0))
        keys = runs.line.astype(np.int64) * most + runs.segment
        sorting = np.argsort(keys, kind="stable")
        parts = self.numbers[is_line]
        own_keys = self.line[parts] * most + self.segment[parts]
        low, high = (np.searchsorted(keys[sorting], own_keys, side) for side in ("left", "right"))
        pairs, owner = _ranges(low, high - low)
        visible = place(runs.ends)[sorting[pairs]]
        start = self.ends[parts[owner], 0]
        step = self.ends[parts[owner], 1] - start
        square = np.maximum((step * step).sum(-1), np.finfo(float).tiny)
        shares = np.clip(((visible - start[:, None]) * step[:, None]).sum(-1) / square[:, None], 0, 1)
        chosen = shares[:, 1] > shares[:, 0]
        self.ends = (start[:, None] + shares[..., None] * step[:, None])[chosen]
        counts = np.ones(len(self.kinds), int)
        counts[is_line] = np.bincount(owner[chosen], minlength=len(parts))
        self.kinds, self.numbers = np.repeat(self.kinds, counts), np.repeat(self.numbers, counts)
        origin = parts[owner[chosen]]
        self.line, self.segment = self.line[origin], self.segment[origin]
        self.numbers[self.kinds == 1] = np.arange(len(origin))

    def strokes(self, numbers):
        outlines, owner = _ranges(self.of_paths[numbers], np.diff(self.of_paths)[numbers])
        corners, codes, offsets = _stroked(self.of_outlines[outlines], np.diff(self.of_outlines)[outlines], self.own)
        ends = np.append(0, np.cumsum(np.bincount(owner, minlength=len(numbers))))
        return _paths(self.corners[corners], codes, offsets[ends])


class _Looks:
    """The styles of polygons: a row for each polygon."""

    def __init__(self, parts, hatches):
        def rows(values):
            chosen = [np.asarray(v)[r % len(v)] if len(v) else np.zeros((len(r), *np.shape(v)[1:])) for v, r in values]
            return np.concatenate(chosen) if chosen else None

        count = sum(len(r) for _, r in parts)
        self.face = rows([(s.face, r) for s, r in parts]) if count else np.empty((0, 4))
        self.edge = rows([(s.edge, r) for s, r in parts]) if count else np.empty((0, 4))
        self.widths = rows([(s.widths, r) for s, r in parts]) if count else np.empty(0)
        self.smooth = rows([(s.smooth, r) for s, r in parts]).astype(bool) if count else np.empty(0, bool)
        self.is_stroked = (self.edge[:, 3] > 0) & (self.widths > 0)
        self.hatch = rows([([hatches.index(hatch) for hatch in s.hatches], r) for s, r in parts]) if count else np.empty(0, int)
        self.widths = np.where(self.is_stroked, self.widths, 0.0)
        self.dashes = None
        if any(pattern is not None for s, _ in parts for _, pattern in s.dashes):
            self.dashes = [s.dashes[row % len(s.dashes)] for s, r in parts for row in r]


class _LineLooks:
    """The styles of lines: a row for each line."""

    def __init__(self, sources, owners, rows):
        sources = [sources[owner] for owner in owners.tolist()]
        looks = list(zip(sources, rows.tolist()))
        self.edge = np.array([s.edge[row % len(s.edge)] for s, row in looks]).reshape(-1, 4)
        self.widths = np.array([s.widths[row % len(s.widths)] for s, row in looks], float)
        self.smooth = np.array([s.smooth[row % len(s.smooth)] for s, row in looks], bool)
        self.dashes = [s.dashes[row % len(s.dashes)] for s, row in looks]
        self.is_solid = np.array([pattern is None for _, pattern in self.dashes], bool)
        self.has_one_color = np.array([len(s.edge) == 1 for s in sources], bool)
        # Butt ends do not extend beyond the line.
        is_butt = np.array([_cap_and_join(s.artist)[0] in (None, "butt") for s in sources], bool)
        self.is_extended = self.is_solid & is_butt & (self.edge[:, 3] >= 1)


class _MarkerLooks:
    """The styles of the markers of scatters and patch collections. `row` has the row of each marker in the other arrays. An
    artist whose markers are alike has one row."""

    def __init__(self, sources, rows, starts):
        self.row = np.zeros(starts[-1], int)
        looks, count = [], 0
        for source, start, end in zip(sources, starts[:-1], starts[1:]):
            if isinstance(source.artist, _SCATTERS) and end > start:
                looks.append(_marker_looks(source.artist, rows[start:end]))
                length = len(looks[-1][0])
                self.row[start:end] = count if length == 1 else np.arange(count, count + end - start)
                count += length
        empty = [], np.empty((0, 3, 3)), np.empty((0, 4)), np.empty((0, 4)), np.empty(0), np.empty(0, bool), []
        paths, *parts, dashes = zip(empty, *looks)
        self.paths, self.dashes = (list(itertools.chain.from_iterable(part)) for part in (paths, dashes))
        self.transforms, self.face, self.edge, self.widths, self.smooth = map(np.concatenate, parts)


def _marker_looks(artist, rows):
    """Returns the styles of the markers in these rows of an artist, or one style if all its markers are alike: paths,
    transforms, colours of faces, colours of edges, widths, antialiasing, and dashes."""
    count = len(artist._offsets3d[0])
    is_sorted = isinstance(artist, art3d.Path3DCollection)

    def unsorted(colors):
        """Returns colours in the order of the points. mplot3d has sorted the colours by depth."""
        if len(colors) != count or count < 2 or not is_sorted:
            return colors
        result = np.empty_like(colors)
        result[artist._z_markers_idx] = colors
        return result

    paths = artist.get_paths()
    if is_sorted:
        # As in `PathCollection.set_sizes`.
        sides = np.sqrt(np.atleast_1d(artist._sizes3d)) * artist._factor * artist.figure.dpi / 72
        transforms = np.eye(3) * np.stack([sides, sides, np.ones(len(sides))], -1)[:, None]
    else:
        transform = artist.get_transform()
        paths = [transform.transform_path_non_affine(path) for path in paths]
        transforms = artist.get_transforms()
        transforms = transform.get_affine().get_matrix() @ (transforms if len(transforms) else np.eye(3)[None])
    face, edge = unsorted(artist.get_facecolor()), unsorted(artist.get_edgecolor())
    widths = np.atleast_1d(artist._linewidths3d if is_sorted else artist.get_linewidth())
    smooth, dashes = np.atleast_1d(artist.get_antialiased()), list(artist._linestyles)
    values = paths, transforms, face, edge, widths, smooth, dashes
    if all(len(part) < 2 for part in values):
        rows = rows[:1]
    nothing = Path(np.empty((0, 2))), np.eye(3), np.zeros(4), np.zeros(4), 0.0, True, (0, None)

    def of_rows(values, missing):
        values = values if len(values) else [missing]
        if isinstance(values, np.ndarray):
            return values[rows % len(values)]
        return [values[row % len(values)] for row in rows.tolist()]

    paths, transforms, face, edge, widths, smooth, dashes = map(of_rows, values, nothing)
    face, edge = (np.reshape(colors, (-1, 4)) for colors in (face, edge))
    return paths, transforms, face, edge, widths, np.asarray(smooth, bool), dashes


class _Composite(martist.Artist):
    """Paints all artists of exact axes in one order."""

    def __init__(self, axes, sources):
        super().__init__()
        self.set_figure(axes.figure)
        self.axes = axes
        self.sources = sources
        self.zorder = max(axis.get_zorder() for axis in axes._axis_map.values()) + 1

    def draw(self, renderer):
        axes = self.axes
        sources = [_kind(artist)(axes, artist) for artist in self.sources]
        areas = [(i, source.polygons) for i, source in enumerate(sources) if source.polygons is not None]
        self.owner = np.concatenate([np.full(len(p.lengths), i) for i, p in areas] + [np.empty(0, int)]).astype(int)
        points = np.concatenate([p.points for _, p in areas] + [np.empty((0, 3))])
        lengths = np.concatenate([p.lengths for _, p in areas] + [np.empty(0, int)]).astype(np.int64)
        own = np.concatenate([p.own for _, p in areas] + [np.empty(0, bool)]).astype(bool)
        lines = [line for source in sources for line in source.lines]
        self.lines = lines
        self.line_owner = np.repeat(np.arange(len(sources)), [len(source.lines) for source in sources])
        self.line_row = np.array([row for source in sources for row in source.line_rows], int)
        markers = np.concatenate([source.points for source in sources] + [np.empty((0, 3))])
        self.marker_owner = np.repeat(np.arange(len(sources)), [len(source.points) for source in sources])
        self.marker_row = np.concatenate([source.point_rows for source in sources] + [np.empty(0, int)]).astype(int)
        self.hatches = list(dict.fromkeys(hatch for source in sources for hatch in source.hatches))
        self.looks = _Looks([(sources[i], p.rows) for i, p in areas if len(p.rows)], self.hatches)
        self.line_looks = _LineLooks(sources, self.line_owner, self.line_row)
        starts = np.cumsum([0] + [len(source.points) for source in sources])
        self.marker_looks = _MarkerLooks(sources, self.marker_row, starts)
        alpha = self.looks.face[:, 3]
        is_opaque = bool((alpha >= 1).all())
        # Areas that have only a hatch are painted too.
        opacity = None if is_opaque else np.clip(alpha, 0.01, 1)
        given = (
            points,
            lengths,
            own,
            opacity,
            np.concatenate(lines + [np.empty((0, 3))]),
            np.array([len(line) for line in lines], np.int64),
            markers,
        )
        built = getattr(axes, "_exact_built", None)
        if built is None or not built.is_of(*given):
            copies = (None if array is None else array.copy() for array in given)
            built = axes._exact_built = _Built(*copies, axes.exact_progress)
        to_display = axes.transData.get_matrix()
        size = _size(axes)
        matrix = np.asarray(axes.M, float)
        shown = None
        if not _is_quick(axes, built, renderer):
            traps = self.looks.smooth & (alpha >= 1)
            texts = np.array([isinstance(artist, art3d.Text3D) for artist in self.sources] + [False])
            are_texts = texts[self.marker_owner]
            try:
                shown = _Drawn(built, built.matrix(matrix), to_display, size, is_opaque, traps, are_texts)
            except ValueError:
                # The view is too narrow or too skewed for a drawing. Orders have no such limits.
                pass
        if shown is None:
            shown = _Ordered(built, built.matrix(matrix), to_display)
        homogeneous = markers @ matrix[2:, :3].T + matrix[2:, 3]
        shown.sort_markers(homogeneous[:, 0] / homogeneous[:, 1])
        to_pixels = _to_pixels(matrix, to_display)
        self._paint(renderer, sources, shown, lambda points: _projected(to_pixels, points))
        for artist in self.sources:
            artist.stale = False
        self.stale = False

    def _paint(self, renderer, sources, shown, place):
        kinds, numbers = shown.kinds, shown.numbers
        owners = np.empty(len(kinds), int)
        tables = [(self.owner, shown.polygon), (self.line_owner, shown.line), (self.marker_owner, shown.marker)]
        for kind, (owner, given) in enumerate(tables):
            chosen = kinds == kind
            owners[chosen] = owner[given[numbers[chosen]]]
        groups = {}
        group = np.array([groups.setdefault(_group(source.artist), len(groups)) for source in sources] + [0])
        # Areas and lines of one group are painted at once, also markers of scatters, and other items by artist.
        has_gaps = np.array([_has_gaps(source.artist) for source in sources] + [False])
        is_scatter = np.array([isinstance(source.artist, _SCATTERS) for source in sources] + [False])
        is_marker = kinds == 2
        alone = np.where(is_marker, ~is_scatter[owners], has_gaps[owners])
        # Areas without strokes have no caps and joins, so they may be painted in any style.
        styles = {}
        style = np.array([styles.setdefault(_style(source.artist), len(styles)) for source in sources] + [0])[owners]
        is_plain = kinds == 0
        is_plain[is_plain] = ~self.looks.is_stroked[shown.polygon[numbers[is_plain]]]
        last = np.maximum.accumulate(np.where(is_plain, 0, np.arange(len(kinds))))
        style = np.where(alone, 0, style[last])
        hatch = np.array([self.hatches.index(source.hatches[0]) for source in sources] + [0])[owners]
        hatch[kinds == 0] = self.looks.hatch[shown.polygon[numbers[kinds == 0]]]
        key = np.where(alone, 2 * len(groups) + 3 * owners + kinds, group[owners] + len(groups) * is_marker)
        key += (2 * len(groups) + 3 * len(sources) + 3) * (hatch + len(self.hatches) * style)
        starts = np.flatnonzero(np.append(True, key[1:] != key[:-1])) if len(key) else []
        for start, end in zip(starts, np.append(starts[1:], len(key))):
            source = sources[owners[start]]
            chosen = numbers[start:end]
            if not alone[start] and is_marker[start]:
                batch = self._markers(source.artist, shown.marker[chosen], shown.at[chosen])
                batch.set_hatch(self.hatches[hatch[start]])
                batch.draw(renderer)
            elif not alone[start]:
                template = sources[owners[start + np.argmin(is_plain[start:end])]].artist
                batch = self._paths(template, shown, kinds[start:end], chosen, owners[start:end], place)
                batch.set_hatch(self.hatches[hatch[start]])
                if not batch.get_hatch():
                    # matplotlib would check a colour for each path.
                    batch._hatchcolors = np.empty((0, 4))
                batch.draw(renderer)
            elif kinds[start] == 1:
                self._paint_line(renderer, source, shown, chosen, place)
            elif isinstance(source.artist, mlines.Line2D):
                copy = mlines.Line2D(*shown.at[chosen].T)
                _take_style(copy, source.artist, mlines.Line2D)
                copy.set_linestyle("None")
                copy.set_markevery(None)
                copy.draw(renderer)
            else:
                source.artist.draw(renderer)

    def _paths(self, template, shown, kinds, numbers, owners, place):
        """Makes a collection of areas and lines."""
        is_area = kinds == 0
        batches = [self._areas(shown, numbers[is_area], np.flatnonzero(is_area))]
        if not is_area.all():
            # Consecutive parts of lines of one artist form a run.
            run = np.cumsum(np.append(True, is_area[1:] | is_area[:-1] | (owners[1:] != owners[:-1])))
            batches.append(self._lines(shown, numbers[~is_area], np.flatnonzero(~is_area), run[~is_area], place))
        position, paths, face, edge, widths, smooth, dashes = (list(part) for part in zip(*batches))
        order = np.argsort(np.concatenate(position), kind="stable")
        paths = np.concatenate(paths)[order].tolist()
        is_dashed = any(part is not None for part in dashes)
        if is_dashed:
            dashes = [part or [(0, None)] * len(at) for part, at in zip(dashes, position)]
            dashes = [dash for part in dashes for dash in part]
            dashes = [dashes[i] for i in order.tolist()]
        face, edge, widths, smooth = (np.concatenate(part)[order] for part in (face, edge, widths, smooth))
        batch = mcoll.Collection()
        batch._paths = paths
        _take_style(batch, template)
        _take_cap_and_join(batch, template)
        batch.set_facecolor(face)
        batch.set_edgecolor(edge if widths.any() else "none")
        batch._linewidths, batch._antialiaseds = widths, smooth
        batch._linestyles = dashes if is_dashed else [(0, None)]
        # With one URL, matplotlib paints a single path as a marker: at whole pixels, and always antialiased.
        batch._urls = [None, None]
        return batch

    def _markers(self, template, numbers, at):
        """Makes a collection of markers of scatters."""
        looks = self.marker_looks
        rows = looks.row[numbers]
        if (rows == rows[0]).all():
            # Agg rounds the positions of markers if all are alike, as matplotlib does for one scatter. A second row prevents
            # this rounding where other markers differ.
            rows = rows[:1] if len(looks.paths) == 1 else rows[[0, 0]]
        paths, transforms = [looks.paths[row] for row in rows.tolist()], looks.transforms[rows]
        if all(path is paths[0] for path in paths) and (transforms == transforms[0]).all():
            # Files define this shape once.
            paths, transforms = paths[:1], transforms[:1]
        face, edge = looks.face[rows], looks.edge[rows]
        batch = mcoll.Collection()
        batch._paths, batch._transforms = paths, transforms
        _take_style(batch, template)
        _take_cap_and_join(batch, template)
        batch.set_facecolor(face if face[:, 3].any() else "none")
        batch.set_edgecolor(edge if edge[:, 3].any() else "none")
        batch._linewidths, batch._antialiaseds = looks.widths[rows], looks.smooth[rows]
        batch._linestyles = [looks.dashes[row] for row in rows.tolist()]
        batch.set_offsets(at)
        batch.set_offset_transform(_IDENTITY)
        return batch

    def _areas(self, shown, areas, position):
        """Returns these lists for areas: positions in the order, paths, colours of faces, colours of edges, widths,
        antialiasing, and dashes."""
        look, polygon = self.looks, shown.polygon[areas]
        is_apart = look.is_stroked[polygon] & ~shown.is_whole[areas]
        fills = shown.fills[areas]
        face, edge, widths = look.face[polygon], look.edge[polygon], look.widths[polygon]
        if is_apart.any():
            # First a fill without a stroke, then the stroke without a fill.
            edge[is_apart], widths[is_apart] = 0, 0
            second = np.flatnonzero(is_apart)
            strokes = shown.strokes(areas[second])
            fills = np.concatenate([fills, np.fromiter(strokes, object, len(strokes))])
            polygon = np.concatenate([polygon, polygon[second]])
            face = np.concatenate([face, np.zeros((len(second), 4))])
            edge, widths = (np.concatenate([a, b[polygon[len(a) :]]]) for a, b in ((edge, look.edge), (widths, look.widths)))
            position = np.concatenate([position, position[second]])
        dashes = None if look.dashes is None else [look.dashes[i] for i in polygon.tolist()]
        return position, fills, face, edge, widths, look.smooth[polygon], dashes

    def _lines(self, shown, numbers, position, run, place):
        """Returns lines, in the form of `_areas`."""
        look = self.line_looks
        first, line, segment, corners, offsets = _chains(shown, numbers, run, look.has_one_color)
        self._overlap(line, corners, offsets, place)
        codes = np.full(len(corners), Path.LINETO, np.uint8)
        codes[offsets[:-1]] = Path.MOVETO
        paths = _paths(corners, codes, offsets)
        paths = np.fromiter(paths, object, len(paths))
        dashes = None
        if not look.is_solid[line].all():
            parts = zip(line.tolist(), segment.tolist(), corners[offsets[:-1]])
            dashes = [self._dash(line, segment, start, look.dashes[line], place) for line, segment, start in parts]
        face = np.zeros((len(line), 4))
        return position[first], paths, face, look.edge[line], look.widths[line], look.smooth[line], dashes

    def _dash(self, line, segment, start, dash, place):
        """Returns the dashes of a part of a line, with the dash offset of the part's start within the whole line."""
        offset, pattern = dash
        if pattern is None:
            return dash
        places = place(self.lines[line])
        before = np.hypot(*np.diff(places[: segment + 1], axis=0).T)
        length = np.nansum(before) + np.hypot(*(start - places[segment]))
        return offset + length * 72 / self.axes.figure.dpi, pattern

    def _overlap(self, line, corners, offsets, place):
        """Extends the ends of parts of lines by half the line's width into the parts before and after, so that no notch
        remains between two parts. Parts of translucent lines are not extended, because the overlap would be visible."""
        reach = 0.5 * self.line_looks.widths[line] * self.axes.figure.dpi / 72
        for end, inner, own in ((offsets[:-1], offsets[:-1] + 1, 0), (offsets[1:] - 1, offsets[1:] - 2, -1)):
            step = corners[end] - corners[inner]
            length = np.hypot(*step.T)
            own = place(np.array([self.lines[i][own] for i in line.tolist()]).reshape(-1, 3))
            is_own = np.abs(corners[end] - own).max(1, initial=0) <= _JOINED
            moved = self.line_looks.is_extended[line] & (length > 0) & ~is_own
            corners[end[moved]] += (step * (reach / np.maximum(length, 1e-300))[:, None])[moved]

    def _paint_line(self, renderer, source, shown, numbers, place):
        artist = source.artist
        run = np.zeros(len(numbers), int)
        _, line, segment, corners, offsets = _chains(shown, numbers, run, self.line_looks.has_one_color)
        starts = corners[offsets[:-1]]
        for i in range(len(line)):
            copy = mlines.Line2D(*corners[offsets[i] : offsets[i + 1]].T)
            _take_style(copy, artist, mlines.Line2D)
            copy.set_marker("None")
            copy._dash_pattern = self._dash(line[i], segment[i], starts[i], artist._dash_pattern, place)
            copy.draw(renderer)


def _chains(shown, numbers, run, may_sort):
    """Joins consecutive parts of lines of one run to chains. Returns for each chain the number of its first part, its line,
    and the segment where the chain begins. Also returns the corners of all chains, and the place where each chain begins."""
    line, segment, ends = shown.line[numbers], shown.segment[numbers], shown.ends[numbers]
    # The position of each part along its segment. All parts of a segment have the same direction.
    step = ends[:, 1] - ends[:, 0]
    along = (ends[:, 0] * step).sum(-1) / np.maximum(np.hypot(*step.T), 1e-300)
    is_sorted = may_sort[line]
    order = np.lexsort([np.where(is_sorted, part, 0) for part in (along, segment, line)] + [run])
    line, segment, ends, run = line[order], segment[order], ends[order], run[order]
    follows = (run[1:] == run[:-1]) & (line[1:] == line[:-1])
    follows &= (segment[1:] - segment[:-1] <= 1) & (segment[1:] >= segment[:-1])
    follows &= np.abs(ends[1:, 0] - ends[:-1, 1]).max(1, initial=0) <= _JOINED
    begins = np.append(True, ~follows)[: len(line)]
    # The second corner of each part, and the first corner of each part that begins a chain.
    corners = ends[np.stack([begins, np.ones(len(begins), bool)], -1)]
    first = np.flatnonzero(begins)
    offsets = np.append(first, len(line)) + np.arange(len(first) + 1)
    return order[first], line[first].astype(np.int64), segment[first].astype(np.int64), corners, offsets


def _group(artist):
    """Returns a key that is equal for artists that may be painted together."""
    clip, box = artist.get_clip_path(), artist.get_clip_box()
    key = (artist.get_clip_on(), box and tuple(box.bounds), artist.get_sketch_params(), artist.get_snap(),
           artist.get_url(), artist.get_gid(), bool(artist.get_path_effects()) and id(artist))
    clip = id(getattr(clip, "_patch", clip))
    if isinstance(artist, (mcoll.Collection, mpatches.Patch)):
        key += (artist.get_hatch(), bool(artist.get_hatch()) and id(artist))
    return key + (clip,)


def _style(artist):
    """Returns a key that is equal for artists whose lines may be painted together."""
    return _cap_and_join(artist) if isinstance(artist, (mcoll.Collection, mpatches.Patch, mlines.Line2D)) else ()


def _cap_and_join(artist):
    """Returns the cap style and the join style of an artist's lines."""
    if not isinstance(artist, mlines.Line2D):
        return artist.get_capstyle(), artist.get_joinstyle()
    if artist.is_dashed():
        return artist.get_dash_capstyle(), artist.get_dash_joinstyle()
    return artist.get_solid_capstyle(), artist.get_solid_joinstyle()


def _take_cap_and_join(batch, artist):
    cap, join = _cap_and_join(artist)
    if cap:
        batch.set_capstyle(cap)
    if join:
        batch.set_joinstyle(join)


def _has_gaps(artist):
    """Returns whether an artist is a dashed line whose gaps have a colour."""
    return isinstance(artist, mlines.Line2D) and artist.is_dashed() and artist.get_gapcolor() is not None


def _take_style(copy, artist, kind=martist.Artist):
    if kind is martist.Artist:
        martist.Artist.update_from(copy, artist)
        copy._alpha = None
    else:
        copy.update_from(artist)
        copy.set_alpha(artist.get_alpha())
    copy.set_figure(artist.figure)
    copy.set_transform(_IDENTITY)
    copy.set_clip_box(artist.get_clip_box())
    copy.set_clip_path(artist.get_clip_path())
    copy.set_clip_on(artist.get_clip_on())
    copy.set_path_effects(artist.get_path_effects())
    copy.set_visible(True)
    copy.set_gid(artist.get_gid())
    copy.set_url(artist.get_url())


def _is_quick(axes, built, renderer):
    """Returns whether the order of the tree is used: while the view is turned, or if a drawing would take long."""
    most = _MOST_PIXELS if hasattr(renderer, "buffer_rgba") else _MOST_VECTORS
    return axes.button_pressed is not None or len(built.polygon) > most


# The axes.


class _Exact:
    """The differences between exact axes and mplot3d's axes."""

    _exact_composite = None
    # A function that is called with the finished and the total work while a tree is built. An exception in this function
    # cancels the drawing.
    exact_progress = None

    def __getstate__(self):
        # The next drawing builds the tree again.
        left_out = "_exact_built", "exact_progress"
        return {name: value for name, value in super().__getstate__().items() if name not in left_out}

    def get_children(self):
        children = super().get_children()
        if self._exact_composite is None:
            return children
        taken = set(map(id, self._exact_composite.sources))
        return [child for child in children if id(child) not in taken] + [self._exact_composite]

    def draw(self, renderer):
        """Draws the axes. If `computed_zorder` is true, the contents of the axes are painted in one exact order."""
        if not self.get_visible() or not self.computed_zorder:
            return super().draw(renderer)
        taken = [
            child for child in self._children if child.get_visible() and not child.get_animated() and _kind(child)
        ]
        zorders = [(artist, artist.zorder) for artist in taken]
        taken.sort(key=lambda artist: artist.zorder)
        self._exact_composite = _Composite(self, taken)
        late = []
        # mplot3d computes a depth of each artist to compare it with the depths of other artists.
        others = [child for child in self._children if isinstance(child, (mcoll.Collection, mpatches.Patch))]
        if all(_kind(child) for child in others if child.get_visible()):
            late = [artist for artist in taken if _may_be_late(artist)]
        for artist in late:
            artist.do_3d_projection = functools.partial(_project_late, artist)
        try:
            super().draw(renderer)
        finally:
            for artist in late:
                del artist.do_3d_projection
            self._exact_composite = None
            for artist, zorder in zorders:
                artist.zorder = zorder
        return None


class ExactAxes3D(_Exact, Axes3D):
    """3D axes that paint their contents in exact order, with the projection ``"exact3d"``. Derived from
    `mpl_toolkits.mplot3d.axes3d.Axes3D`.

    Set the attribute `exact_progress` to a function that is called with the finished and the total work while a tree of many
    polygons is built. An exception in this function, or Ctrl-C, cancels the drawing.
    """

    name = "exact3d"


mprojections.register_projection(ExactAxes3D)
# matplotlib treats axes with the name "3d" differently, for instance their ticks.
ExactAxes3D.name = Axes3D.name


def exact(axes):
    """Makes existing 3D axes paint in exact order. The axes are changed in place.

    Parameters
    ----------
    axes : Axes3D

    Returns
    -------
    Axes3D
        The same axes.
    """
    if not isinstance(axes, Axes3D):
        raise TypeError(f"3D axes are needed, not {type(axes).__name__}")
    if not isinstance(axes, _Exact):
        axes.__class__ = _exact_class(type(axes))
    return axes


@functools.cache
def _exact_class(own):
    """Returns the class of exact axes for a class of axes."""
    if own is Axes3D:
        return ExactAxes3D

    def reduce(self, protocol):
        # Pickles name the given class, because no module contains the new class.
        make, arguments, *state = super(exact_class, self).__reduce_ex__(protocol)
        return _unpickled, (own, make, arguments[1:]), *state

    exact_class = type("Exact" + own.__name__, (_Exact, own), {"__reduce_ex__": reduce})
    return exact_class


def _unpickled(own, make, arguments):
    return make(_exact_class(own), *arguments)


def install():
    """Makes the projection ``"3d"`` exact, for packages that draw on mplot3d."""
    mprojections.register_projection(ExactAxes3D)


def uninstall():
    """Registers mplot3d's axes as the projection ``"3d"`` again."""
    mprojections.register_projection(Axes3D)
