"""Scenes that matplotlib's 3D axes are known to draw wrong. Each function draws one scene on given axes."""

import numpy as np
from matplotlib.patches import Circle, Rectangle
from matplotlib.tri import Triangulation
from mpl_toolkits.mplot3d import art3d


def _sphere(count, radius=1.0, middle=(0, 0, 0)):
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 2 * count + 1), np.linspace(0, np.pi, count + 1))
    x, y, z = radius * np.cos(u) * np.sin(v), radius * np.sin(u) * np.sin(v), radius * np.cos(v)
    return x + middle[0], y + middle[1], z + middle[2]


def _grid(low, high, count):
    return np.meshgrid(np.linspace(low, high, count), np.linspace(low, high, count))


def crossing_surfaces(ax):
    x, y = _grid(-2, 2, 25)
    ax.plot_surface(x, y, np.sin(x) * np.cos(y), color="C0")
    ax.plot_surface(x, y, 0.4 * x, color="C1")


def line_through_sphere(ax):
    ax.plot_surface(*_sphere(12), color="C0")
    ax.plot([-2, 2], [-1.2, 1.0], [-1.5, 1.3], color="C3", lw=3)
    t = np.linspace(0, 4 * np.pi, 200)
    ax.plot(1.3 * np.cos(t), 1.3 * np.sin(t), np.linspace(-1, 1, 200), color="k", lw=2)


def scatter_inside_surface(ax):
    ax.plot_surface(*_sphere(10), color="C0")
    points = np.random.default_rng(1).uniform(-1.4, 1.4, (3, 80))
    ax.scatter(*points, color="C3", s=25, depthshade=False)


def plane_through_voxels(ax):
    filled = np.random.default_rng(2).random((4, 4, 4)) < 0.4
    ax.voxels(filled, facecolors="C0")
    x, y = _grid(0, 4, 2)
    ax.plot_surface(x, y, 0.6 * x + 0.3 * y + 0.3, color="C1")


def bars_behind_bars(ax):
    x, y = (c.ravel() for c in np.meshgrid(np.arange(4.0), np.arange(4.0)))
    heights = np.random.default_rng(3).uniform(0.5, 4, 16)
    ax.bar3d(x, y, 0 * x, 0.8, 0.5, heights, color="C0")
    ax.bar3d([0.2], [-0.5], [1], [0.2], [5.5], [0.3], color="C1")
    for z, color in ((1.15, "C2"), (3.15, "C3")):
        ax.bar(np.arange(4) + 0.4, np.array([2, 3, 1, 2.5]), zs=z, zdir="y", color=color, width=0.5)


def texts_among_surfaces(ax):
    x, y = _grid(-1, 1, 6)
    ax.plot_surface(x, y, 0 * x, color="C0")
    ax.plot_surface(x, 0 * x, y, color="C1")
    for i, (px, py, pz) in enumerate([(0.5, 0.5, 0.5), (-0.5, -0.5, 0.5), (0.5, -0.5, -0.5), (-0.5, 0.5, -0.5),
                                      (0, 0.6, -0.3), (0, -0.4, 0.2)]):
        ax.text(px, py, pz, "\u2588", color="C3", fontsize=9, ha="center", va="center")


def translucent_shells(ax):
    for radius, color in ((1.0, "C0"), (0.7, "C1"), (0.4, "C2")):
        ax.plot_surface(*_sphere(8, radius), color=color, alpha=0.4)
    x, y = _grid(-1, 1, 2)
    ax.plot_surface(x, 0.3 * x, y, color="C3", alpha=0.5)


def bloch_sphere(ax):
    t = np.linspace(0, 2 * np.pi, 73)
    ax.plot_surface(*_sphere(9), color="C0")
    for circle in ((np.cos(t), np.sin(t), 0 * t), (np.cos(t), 0 * t, np.sin(t)), (0 * t, np.cos(t), np.sin(t))):
        ax.plot(*(1.03 * np.array(circle)), color="k", lw=2)
    for axis in np.eye(3):
        ax.plot(*np.outer(axis, [-1.5, 1.5]), color="C1", lw=2)
    ax.quiver(0, 0, 0, 0.9, -0.7, 0.9, color="C3", lw=3)
    ax.scatter([0, 0], [0, 0], [1.5, -1.5], color="C4", s=30, depthshade=False)


def contourf_with_holes(ax):
    x, y = _grid(-2, 2, 40)
    z = np.sin(2 * x) * np.cos(2 * y)
    ax.contourf(x, y, z, levels=[-0.8, -0.3, 0.3, 0.8], zdir="z", offset=-0.5)
    ax.plot_surface(x[::6, ::6], y[::6, ::6], 0.5 * x[::6, ::6] - 0.2, color="C3")
    ax.set_zlim(-1.5, 1.5)


def wireframe_and_surface(ax):
    x, y = _grid(-2, 2, 13)
    ax.plot_surface(x, y, 0.5 * x + 0.03, color="C0")
    ax.plot_wireframe(x, y, np.cos(x) * np.cos(y), color="C3", lw=2)


def arrows_through_plane(ax):
    x, y = _grid(-1, 1, 5)
    ax.plot_surface(x, y, 0.2 * x, color="C0")
    x, y = _grid(-0.7, 0.7, 3)
    ax.quiver(x.ravel(), y.ravel(), -0.6, 0.3, 0.1, 1.2, color="C3", lw=2)
    ax.set_zlim(-1, 1)


def interlocking_rings(ax):
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 25), np.linspace(0, 2 * np.pi, 13))
    x, y, z = (1 + 0.3 * np.cos(v)) * np.cos(u), (1 + 0.3 * np.cos(v)) * np.sin(u), 0.3 * np.sin(v)
    ax.plot_surface(x, y, z, color="C0", rcount=99, ccount=99)
    ax.plot_surface(x + 1, z, y, color="C1", rcount=99, ccount=99)


def moebius_strip(ax):
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 60), np.linspace(-0.4, 0.4, 6))
    u, v = u.ravel(), v.ravel()
    triangles = Triangulation(u, v).triangles
    x, y, z = (1 + v * np.cos(u / 2)) * np.cos(u), (1 + v * np.cos(u / 2)) * np.sin(u), v * np.sin(u / 2)
    ax.plot_trisurf(x, y, z, triangles=triangles, color="C0")
    ax.plot([-1.5, 1.5], [0.3, -0.2], [0.1, 0.0], color="C3", lw=3)


def log_axes(ax):
    x, y = _grid(0, 3, 12)
    ax.plot_surface(10**x, 10**y, 1 + x + 0 * y, color="C0")
    ax.plot_surface(10**x, 10**y, 1 + y, color="C1")
    t = np.linspace(0, 3, 50)
    ax.plot(10**t, 10 ** (3 - t), 1 + t * (3 - t), color="C3", lw=2)
    ax.set_xscale("log")
    ax.set_yscale("log")


def crossing_triangles(ax):
    random = np.random.default_rng(5)
    triangles = random.uniform(-1, 1, (40, 1, 3)) + random.uniform(-0.8, 0.8, (40, 3, 3))
    colors = [f"C{i % 10}" for i in range(40)]
    ax.add_collection3d(art3d.Poly3DCollection(triangles, facecolors=colors))
    ax.auto_scale_xyz(*triangles.reshape(-1, 3).T)


def steep_parallel_view(ax):
    crossing_surfaces(ax)
    line_through_sphere(ax)
    ax.set_proj_type("ortho")
    ax.view_init(55, -130, 20)
    ax.invert_xaxis()


def close_perspective(ax):
    interlocking_rings(ax)
    wireframe_and_surface(ax)
    ax.set_proj_type("persp", focal_length=0.4)


def discs_on_walls(ax):
    for z, color in ((0.0, "C0"), (0.5, "C1")):
        patch = Circle((0.5, 0.5), 0.4, color=color)
        ax.add_patch(patch)
        art3d.pathpatch_2d_to_3d(patch, z=z, zdir="x")
        patch = Rectangle((0.2, 0.1), 0.6, 0.7, color=f"C{2 + int(2 * z)}")
        ax.add_patch(patch)
        art3d.pathpatch_2d_to_3d(patch, z=z, zdir="y")
    x, y = _grid(0, 1, 3)
    ax.plot_surface(x, y, 0.4 + 0.2 * x, color="C4")


SCENES = [
    crossing_surfaces,
    line_through_sphere,
    scatter_inside_surface,
    plane_through_voxels,
    bars_behind_bars,
    texts_among_surfaces,
    translucent_shells,
    bloch_sphere,
    contourf_with_holes,
    wireframe_and_surface,
    arrows_through_plane,
    interlocking_rings,
    moebius_strip,
    log_axes,
    crossing_triangles,
    steep_parallel_view,
    close_perspective,
    discs_on_walls,
]
