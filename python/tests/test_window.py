"""Tests a window: axes that the mouse turns are painted in exact order, and picking and coordinates work."""

import os
import subprocess
import sys

import pytest

WINDOW = """
import numpy as np
import matplotlib.pyplot as plt
from matplotlib.backends.qt_compat import QtCore, QtGui, QtWidgets
application = QtWidgets.QApplication([])
plt.switch_backend("QtAgg")
import binspace.mpl

figure = plt.figure(figsize=(5, 5), dpi=100)
ax = figure.add_subplot(projection="exact3d")
u = np.linspace(-1, 1, 9)
x, y = np.meshgrid(u, u)
planes = {"#ff0000": 0 * x, "#00ff00": 0.8 * x}
surfaces = [ax.plot_surface(x, y, z, color=color, shade=False, picker=True) for color, z in planes.items()]
ax.set_axis_off()
picked = []
figure.canvas.mpl_connect("pick_event", lambda event: picked.append((event.artist, event.ind)))
plt.show(block=False)
canvas = figure.canvas


def send(kind, x, y, button, held):
    # x and y are pixels from the bottom left corner of the picture.
    at = QtCore.QPointF(x / canvas.device_pixel_ratio, canvas.height() - y / canvas.device_pixel_ratio)
    event = QtGui.QMouseEvent(getattr(QtCore.QEvent.Type, kind), at, canvas.mapToGlobal(at), button, held,
                              QtCore.Qt.KeyboardModifier.NoModifier)
    QtWidgets.QApplication.sendEvent(canvas, event)
    for _ in range(3):
        application.processEvents()


left, none = QtCore.Qt.MouseButton.LeftButton, QtCore.Qt.MouseButton.NoButton


def judge():
    # A point of one plane is hidden if the line to the eye crosses the other plane.
    azim, elev = np.radians([ax.azim, ax.elev])
    aspect = ax._box_aspect
    limits = np.array(ax.get_w_lims()).reshape(3, 2)
    scale = aspect / np.ptp(limits, axis=1)
    towards = np.array([np.cos(elev) * np.cos(azim), np.cos(elev) * np.sin(azim), np.sin(elev)]) * ax._dist
    eye = (towards + aspect / 2) / scale + limits[:, 0]
    image = np.asarray(canvas.buffer_rgba())[..., :3]
    count = 0
    for own, other in ((0, 0.8), (0.8, 0)):
        for px in np.linspace(-0.93, 0.93, 18):
            for py in np.linspace(-0.93, 0.93, 18):
                point = np.array([px, py, own * px])
                step = eye - point
                slope = step[2] - other * step[0]
                t = (other * point[0] - point[2]) / slope if slope else np.inf
                crossing = point + t * step
                near = np.abs(crossing[:2]).max()
                if abs(px) < 0.1 or t > 0 and abs(near - 1) < 0.1:
                    continue
                hidden = t > 0 and near < 1
                homogeneous = ax.M @ [*point, 1]
                column, row = ax.transData.transform(homogeneous[:2] / homogeneous[3])
                red, green, _ = image[image.shape[0] - 1 - int(row), int(column)].astype(int)
                # At borders of faces, the colours of both are mixed.
                is_own = (red > green) == (own == 0)
                assert is_own != hidden, (ax.azim, ax.elev, point, red, green)
                count += 1
    assert count > 300, count


for _ in range(5):
    application.processEvents()
judge()
tree, views = ax._exact_built, set()
send("MouseButtonPress", 250, 250, left, left)
assert ax.button_pressed is not None
for step in range(1, 9):
    send("MouseMove", 250 + 35 * (step if step < 5 else 8 - step), 250 + 20 * step, none, left)
    judge()
    views.add((round(ax.azim, 3), round(ax.elev, 3)))
    assert "=" in ax.format_coord(0.0, 0.0)
send("MouseButtonRelease", 250, 410, left, none)
assert len(views) == 8 and ax._exact_built is tree and ax.button_pressed is None
canvas.draw()
judge()

# A click picks the face below.
def place(point):
    homogeneous = ax.M @ [*point, 1]
    return ax.transData.transform(homogeneous[:2] / homogeneous[3])

for surface, height in zip(surfaces, (0, 0.8)):
    picked.clear()
    at = place([0.9, 0.3, 0.9 * height])
    send("MouseButtonPress", *at, left, left)
    send("MouseButtonRelease", *at, left, none)
    [faces] = [faces for artist, faces in picked if artist is surface]
    assert any(surface.get_paths()[face].contains_point(ax.transData.inverted().transform(at)) for face in faces)
print("right")
"""


def test_turning_with_the_mouse_keeps_the_order():
    try:
        import PySide6.QtWidgets  # noqa: F401
    except ImportError as error:
        pytest.skip(f"windows need Qt, as of PySide6-Essentials: {error}")
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "QT_API": "pyside6"}
    done = subprocess.run([sys.executable, "-c", WINDOW], capture_output=True, text=True, env=environment, timeout=120)
    assert done.returncode == 0 and done.stdout.strip() == "right", done.stdout + done.stderr
