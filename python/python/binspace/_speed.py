"""Times pictures of matplotlib's 3D axes and of exact axes: ``python -m binspace.compare --speed``."""

from __future__ import annotations

import io
import os
import platform
import time

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import binspace.mpl  # noqa: F401 - registers the projection

PROJECTIONS = "3d", "exact3d"


def surfaces(axes, n, **options):
    """Draws a wavy surface of n by n quads, and a plane that crosses it."""
    x, y = np.meshgrid(np.linspace(-2, 2, n + 1), np.linspace(-2, 2, n + 1))
    axes.plot_surface(x, y, np.sin(2 * x) * np.cos(2 * y), **options)
    axes.plot_surface(x, y, 0.4 * x, **options)


SCENES = {
    "100 × 100 quads through 100 × 100": lambda axes: surfaces(axes, 100, rstride=1, cstride=1),
    "100 × 100 points, default strides": lambda axes: surfaces(axes, 99),
    "40 × 40 quads through 40 × 40": lambda axes: surfaces(axes, 40, rstride=1, cstride=1),
}


class Timed:
    """A figure, and the shortest processor time of each step."""

    def __init__(self, scene, projection):
        self.scene, self.projection, self.least = scene, projection, {}
        self.figure, self.axes = self._new()

    def _new(self):
        figure = Figure(figsize=(6.4, 4.8), dpi=100)
        FigureCanvasAgg(figure)
        axes = figure.add_subplot(projection=self.projection)
        self.scene(axes)
        return figure, axes

    def _time(self, name, work):
        start = time.process_time()
        work()
        self.least[name] = min(self.least.get(name, np.inf), time.process_time() - start)

    def run(self):
        """Makes each picture once."""
        new, _ = self._new()
        self._time("first PNG", lambda: new.savefig(io.BytesIO(), format="png"))
        self._time("PNG", lambda: self.figure.savefig(io.BytesIO(), format="png"))
        self._time("SVG", lambda: self.figure.savefig(io.BytesIO(), format="svg"))
        # A pressed mouse button turns the axes.
        self.axes.view_init(30, self.axes.azim + 1)
        self.axes.button_pressed = 1
        self._time("turn", self.figure.canvas.draw)
        self.axes.button_pressed = None


def main(rounds):
    """Prints a table. The two kinds of axes draw in turn, and the shortest time of each is reported."""
    cores, threads = os.cpu_count(), os.environ.get("RAYON_NUM_THREADS")
    print(f"matplotlib {matplotlib.__version__}, Python {platform.python_version()}, {platform.machine()}, "
          f"{threads or cores} threads, the least of {rounds} times of all threads together, "
          f"mplot3d / exact in ms (ratio)\n")
    header = None
    for name, scene in SCENES.items():
        before, ours = (Timed(scene, projection) for projection in PROJECTIONS)
        for _ in range(rounds):
            for timed in (before, ours):
                timed.run()
        if header is None:
            header = ["scene", *before.least, "fragments", "tree"]
            print("| " + " | ".join(header) + " |\n" + "|---" * len(header) + "|")
        pairs = [(a, ours.least[what]) for what, a in before.least.items()]
        cells = [f"{1e3 * a:.0f} / {1e3 * b:.0f} ({b / a:.2f})" for a, b in pairs]
        tree = ours.axes._exact_built.tree
        print("| " + " | ".join([name, *cells, str(len(tree)), f"{tree.memory_usage / 1e6:.1f} MB"]) + " |", flush=True)
    return 0
