"""Exact back-to-front orders of polygons from one BSP tree.

Build a `Tree` once. The tree cuts crossing polygons into parts, called fragments. For any viewpoint, the tree returns the
order in which to paint the fragments:

>>> import binspace
>>> square = [[0, 0], [1, 0], [1, 1], [0, 1]]
>>> tree = binspace.Tree([[[x, y, z] for x, y in square] for z in (2.0, 0.0, 1.0)])
>>> tree.fragments.polygon[tree.order(eye=(0.5, 0.5, 9.0))].tolist()
[1, 2, 0]

`binspace.mpl` contains 3D axes for matplotlib that paint in such an order.
"""

from __future__ import annotations

import os
from functools import cached_property

import numpy as np

from . import _binspace
from ._binspace import (
    Drawing,
    EdgeRuns,
    Fragments,
    Hits,
    LineRuns,
    Markers,
    Overlay,
    Pieces,
    VisiblePolygons,
)

__all__ = [
    "Camera",
    "Drawing",
    "EdgeRuns",
    "Fragments",
    "Hits",
    "LineRuns",
    "Markers",
    "Overlay",
    "Pieces",
    "Tree",
    "Visibility",
    "VisiblePolygons",
]

__version__ = "0.1.0"


def _points(array, name="points"):
    """Returns points as rows of three f64 or f32. Such rows are not copied. Masked numbers become NaN."""
    try:
        if isinstance(array, np.ma.MaskedArray):
            array = np.ma.filled(array.astype(float), np.nan)
        array = np.asarray(array)
    except ValueError as error:
        raise ValueError(f"{name} must be an array of shape (n, 3): {error}") from None
    if array.size == 0 and array.ndim < 2:
        return np.empty((0, 3))
    if array.dtype.kind not in "fiub":
        raise ValueError(f"{name} must be real numbers, not {array.dtype}")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} must have the shape (n, 3), not {array.shape}")
    kind = np.float32 if array.dtype == np.float32 else np.float64
    return np.require(array, kind, "A")


def _integers(array, name):
    array = np.asarray(array)
    if array.size == 0 and array.dtype.kind == "f":
        array = array.astype(np.int64)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name} must be integers, not {array.dtype}")
    if array.dtype == np.uint64 and array.size and array.max() > np.iinfo(np.int64).max:
        raise ValueError(f"{name} has numbers beyond 64 bits with a sign")
    return np.require(array, np.int64, "A")


def _lists(lists, name):
    """Concatenates arrays of points. Also returns the row where each array begins."""
    if isinstance(lists, np.ndarray) and lists.ndim == 3:
        count, length, _ = lists.shape
        flat = lists.reshape(-1, lists.shape[2])
        return _points(flat, name), np.arange(count + 1, dtype=np.int64) * length
    lists = [_points(item, f"{name}[{i}]") for i, item in enumerate(lists)]
    lengths = np.fromiter(map(len, lists), np.int64, len(lists))
    offsets = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
    return (np.concatenate(lists) if lists else np.empty((0, 3))), offsets


class Tree(_binspace.Tree):
    """A binary space partition of polygons.

    Parameters
    ----------
    polygons
        One of these:

        - a list of polygons, each an array of shape (n, 3);
        - one array of shape (polygons, n, 3);
        - a tuple ``(vertices, faces)``: an array of shape (n, 3), and the indices of the corners of each face, as an array
          with a row for each face, or as a list of lists;
        - a tuple ``(flat, offsets)``: polygon `i` has the rows of `flat` from ``offsets[i]`` to ``offsets[i + 1]``.

        A tuple of two is never read as a list of two polygons. Arrays of f64 and f32 are read without a copy. A polygon with
        NaN or masked numbers is left out, but keeps its number.
    opacity : array of float, optional
        The opacity of each polygon, from 0 to 1. By default all polygons are opaque.
    tolerance : float, optional
        A polygon counts as lying on a plane if no corner is further from the plane than this distance. The default depends
        on the precision of the numbers.
    bounds : array of shape (2, 3), optional
        Two opposite corners of a box that contains all lines and points of later overlays.
    max_fragments : int, optional
        The largest number of fragments. By default 2**25.
    progress : callable, optional
        A function that is called several times a second with the finished and the total work. An exception in this
        function cancels the build.

    Raises
    ------
    ValueError
        If an argument has a wrong shape or type, or a coordinate is infinite.
    MemoryError
        If the tree does not fit into memory.

    Examples
    --------
    >>> import numpy as np
    >>> vertices = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, -1], [1, 1, 1], [1, 3, 0.0]])
    >>> tree = binspace.Tree((vertices, [[0, 1, 2, 3], [4, 5, 6]]))
    >>> tree.polygons
    2
    """

    def __new__(
        cls, polygons, *, opacity=None, tolerance=None, bounds=None, max_fragments=None, progress=None
    ):
        indices = None
        if isinstance(polygons, tuple) and len(polygons) == 2:
            points, second = polygons
            points = _points(points, "vertices")
            if not isinstance(second, np.ndarray) and len(second) and np.ndim(second[0]) == 1:
                faces = [_integers(face, "faces") for face in second]
                if any(face.ndim != 1 for face in faces):
                    raise ValueError("faces must be lists of indices")
                lengths = np.fromiter(map(len, faces), np.int64, len(faces))
                indices = np.concatenate(faces)
                offsets = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
            else:
                if not isinstance(second, np.ndarray) and not len(second):
                    second = np.empty((0, 3), np.int64)
                second = _integers(second, "faces or offsets")
                if second.ndim == 2:
                    count, length = second.shape
                    indices = second.reshape(-1)
                    offsets = np.arange(count + 1, dtype=np.int64) * length
                elif second.ndim == 1:
                    offsets = second
                else:
                    raise ValueError(f"faces must have the shape (n, corners), not {second.shape}")
        else:
            points, offsets = _lists(polygons, "polygons")
        if opacity is not None:
            opacity = np.asarray(opacity, np.float64)
            if opacity.ndim != 1:
                raise ValueError(f"opacity must have one dimension, not {opacity.ndim}")
            if len(opacity) != len(offsets) - 1:
                raise ValueError(f"{len(opacity)} opacities are given for {len(offsets) - 1} polygons")
            opacity = opacity.tolist()
        if tolerance is not None:
            tolerance = float(tolerance)
        if bounds is not None:
            bounds = np.asarray(bounds, np.float64)
            if bounds.shape != (2, 3):
                raise ValueError(f"bounds must have the shape (2, 3), not {bounds.shape}")
            bounds = bounds.tolist()
        if max_fragments is not None and max_fragments < 0:
            raise ValueError(f"max_fragments is {max_fragments}, but must be 0 or more")
        return super().__new__(
            cls, points, indices, offsets, opacity, tolerance, bounds, max_fragments, progress
        )

    @cached_property
    def fragments(self) -> Fragments:
        """All fragments as arrays.

        A fragment is a convex part of a polygon. Fragment `i` is a part of polygon number ``polygon[i]``. The vertices of
        fragment `i` are the rows of `points` from ``offsets[i]`` to ``offsets[i + 1]``. ``edges[v]`` belongs to the side
        that leads from vertex `v` to the next vertex of its fragment. ``edges[v]`` is the number of the polygon's edge
        that contains this side, or -1 if the side is a cut. A polygon's edge `k` begins at its corner `k`.

        Vertex `v` is a weighted sum of corners of its polygon. The entries from ``weight_offsets[v]`` to
        ``weight_offsets[v + 1]`` of `weight_corners` are the numbers of these corners, and the same entries of `weights`
        are the weights of the corners.
        """
        return self._fragments()

    def hits(self, start, direction=None, *, end=None, limit=None) -> Hits:
        """Finds the polygons that rays or segments hit, the nearest first.

        Parameters
        ----------
        start : array of shape (3,) or (n, 3)
            The start of each ray.
        direction, end : array of the same shape
            The direction of each ray, or the point where each segment ends.
        limit : int, optional
            The largest number of hits for each ray. By default all hits are returned.

        Returns
        -------
        Hits
            The hits of ray `i` are the entries from ``offsets[i]`` to ``offsets[i + 1]`` of these arrays:

            - `polygon`: the number of the polygon that is hit;
            - `parameter`: the place along the ray, 0 at its start, and 1 at the end of a segment or at start + direction;
            - `points`: the position of the hit;
            - `facing`: 1 if the ray hits the front, -1 if it hits the back, 0 if it lies in the polygon's plane.
        """
        if (direction is None) == (end is None):
            raise ValueError("give either a direction or an end")
        start, other, _ = _pair(start, end if direction is None else direction)
        if limit is not None and limit < 0:
            raise ValueError(f"limit is {limit}, but must be 0 or more")
        return self._hits(start, other, direction is None, limit)

    def is_occluded(self, start, end):
        """Returns whether a polygon lies between two points. Given two arrays of points, returns an array with a result for
        each pair of points."""
        start, end, is_single = _pair(start, end)
        occluded = self._is_occluded(start, end)
        return bool(occluded[0]) if is_single else occluded

    def overlay(self, lines=(), points=(), *, progress=None) -> Overlay:
        """Returns an overlay: lines and points that are ordered together with the tree.

        Parameters
        ----------
        lines : list of arrays of shape (n, 3), or a tuple (flat, offsets)
            Polylines. In a tuple, line `i` has the rows of `flat` from ``offsets[i]`` to ``offsets[i + 1]``. A line is divided
            at each point with NaN.
        points : array of shape (n, 3)
            Points. A point with NaN is left out.
        progress : callable, optional
            As for `Tree`.
        """
        if isinstance(lines, tuple) and len(lines) == 2 and np.ndim(lines[1]) == 1:
            corners, offsets = _points(lines[0], "lines"), _integers(lines[1], "offsets")
        else:
            corners, offsets = _lists(lines, "lines")
        return Overlay(self, corners, offsets, _points(points), progress)

    def visibility(
        self, camera, *, front_faces_only=False, least_area=0.0, progress=None
    ) -> Visibility:
        """Computes the visible parts of the polygons for a camera.

        Parameters
        ----------
        camera : Camera
        front_faces_only : bool
            Whether polygons seen from behind are left out.
        least_area : float
            The least visible area of a polygon, in square pixels. Drawings leave out polygons with a smaller visible area.
        progress : callable, optional
            As for `Tree`.
        """
        return Visibility(_binspace.Visibility(self, camera, front_faces_only, least_area, progress))

    def translucent(self, camera, overlay=None, *, front_faces_only=False, progress=None) -> Drawing:
        """Returns a drawing of all polygons, and of all lines and points of an overlay, in one painting order. Hidden polygons
        are not left out.

        A polygon is split only where no painting order of whole polygons exists.
        """
        return Drawing(self, camera, overlay, front_faces_only, progress)


def _pair(start, end):
    start, end = np.asarray(start), np.asarray(end)
    is_single = start.ndim == 1 and end.ndim == 1
    start, end = np.atleast_2d(start), np.atleast_2d(end)
    start, end = _points(start), _points(end)
    try:
        start, end = np.broadcast_arrays(start, end)
    except ValueError:
        raise ValueError(f"{len(start)} points are given with {len(end)}") from None
    return np.require(start, requirements="A"), np.require(end, requirements="A"), is_single


class Camera(_binspace.Camera):
    """A camera, given by a view-projection matrix.

    Parameters
    ----------
    matrix : array of shape (4, 4)
        The matrix from points to clip coordinates, both column vectors. A point with clip coordinates (x, y, z, w)
        appears at ``((0.5 + 0.5 * x / w) * width, (0.5 - 0.5 * y / w) * height)``. In a parallel projection, z / w must
        increase away from the viewer.
    size : (int, int)
        The width and the height of the picture in pixels.

    Raises
    ------
    ValueError
        If the matrix is not the matrix of a camera, or mirrors the picture.
    """

    def __new__(cls, matrix, size):
        matrix = np.asarray(matrix, np.float64)
        if matrix.shape != (4, 4):
            raise ValueError(f"the matrix must have the shape (4, 4), not {matrix.shape}")
        width, height = (int(side) for side in size)
        if not (0 <= width < 2**32 and 0 <= height < 2**32):
            raise ValueError(f"a picture of {width} times {height} pixels is not possible")
        return super().__new__(cls, matrix.tolist(), [width, height])

    def project(self, points):
        """Returns where points appear, in pixels from the top left corner. Points behind the eye become NaN."""
        points = np.asarray(points)
        places = self._project(_points(np.atleast_2d(points)))
        return places[0] if points.ndim == 1 else places


def _color(color):
    """Converts a colour to red, green and blue from 0 to 255. The colour is three numbers from 0 to 1, ``#rrggbb``, or a name
    that matplotlib knows."""
    if isinstance(color, str):
        if len(color) == 7 and color[0] == "#":
            return [int(color[i : i + 2], 16) for i in (1, 3, 5)]
        from matplotlib.colors import to_rgb

        color = to_rgb(color)
    color = np.asarray(color, float)
    if color.shape != (3,) or not np.all((color >= 0) & (color <= 1)):
        raise ValueError("a colour must be a name, #rrggbb, or three numbers from 0 to 1")
    return np.rint(255 * color).astype(int).tolist()


def _stroke(stroke):
    if stroke is None:
        return None
    width, color = stroke
    return float(width), _color(color)


class Visibility:
    """The visible parts of polygons, edges, lines and points for a camera. `Tree.visibility` computes them."""

    def __init__(self, map):
        self._map = map

    @property
    def size(self):
        """The width and the height of the picture in pixels."""
        return tuple(self._map.size)

    def polygons(self) -> VisiblePolygons:
        """Returns, for each visible polygon, its number as `polygon`, its visible `area` in square pixels, and a `point` in
        the picture where the polygon is visible."""
        return self._map.polygons()

    def drawing(self, *, progress=None) -> Drawing:
        """Returns one path for each visible polygon, in painting order."""
        return self._map.drawing(progress=progress)

    def edges(self, hidden="skip", *, progress=None) -> EdgeRuns:
        """Returns the visible parts of edges. If `hidden` is "keep", also returns the hidden parts. If `hidden` is "count",
        also returns the number of polygons in front of each hidden part."""
        return self._map.edges(hidden, progress=progress)

    def crossings(self, hidden="skip", *, progress=None) -> EdgeRuns:
        """Returns parts of the lines along which polygons cross; `hidden` as for `edges`."""
        return self._map.crossings(hidden, progress=progress)

    def lines(self, overlay, hidden="skip", *, progress=None) -> LineRuns:
        """Returns the visible parts of an overlay's lines; `hidden` as for `edges`."""
        return self._map.lines(overlay, hidden, progress=progress)

    def markers(self, overlay, *, progress=None) -> Markers:
        """Returns the points of an overlay that are in the picture, and whether each point is visible."""
        return self._map.markers(overlay, progress=progress)

    def to_svg(self, path=None, **options):
        """Returns the picture as SVG, or writes the SVG to a file.

        Parameters
        ----------
        path : path, optional
            The file to write.
        colors : a colour, or a list with a colour for each polygon
            Names, ``#rrggbb``, or three numbers from 0 to 1.
        outlines, edges : (width, colour), optional
            The strokes of two kinds of lines. `outlines` lie along the edges of each polygon, and are painted with the
            polygon. `edges` lie along visible edges and crossings, and are painted above all polygons.
        lines : Overlay, optional
            An overlay. The visible parts of its lines are painted above everything else.
        line : (width, colour)
            The stroke of the overlay's lines. The default is 1 pixel and black.
        background : colour, optional

        Returns
        -------
        str or None
            The file's text, if no path is given.
        """
        return self._write("svg", path, **options)

    def to_pdf(self, path=None, **options):
        """Returns the picture as PDF in bytes, or writes the PDF to a file. For the options see `to_svg`."""
        return self._write("pdf", path, **options)

    def _write(
        self,
        format,
        path,
        *,
        colors="#c0c0c0",
        outlines=None,
        edges=None,
        lines=None,
        line=(1.0, "#000000"),
        background=None,
        progress=None,
    ):
        is_number = [isinstance(color, (int, float, np.number)) for color in colors]
        if isinstance(colors, str) or is_number and all(is_number):
            colors = [_color(colors)]
        elif isinstance(colors, np.ndarray) and colors.ndim == 2:
            if colors.shape[1] != 3 or not np.all((colors >= 0) & (colors <= 1)):
                raise ValueError("colours must have the shape (n, 3), from 0 to 1")
            colors = np.rint(255 * colors).astype(int).tolist()
        else:
            colors = [_color(color) for color in colors]
        background = None if background is None else _color(background)
        file = self._map._picture(
            format, colors, _stroke(outlines), _stroke(edges), lines, _stroke(line), background, progress
        )
        if path is not None:
            with open(os.fspath(path), "wb") as out:
                out.write(file)
            return None
        return file.decode() if format == "svg" else file
