"""Tests that the README's code runs, and that the stubs describe the module."""

import pathlib
import re
import subprocess
import sys

import binspace
import pytest

README = pathlib.Path(__file__).parents[1] / "README.md"
BLOCKS = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.split("\n")[0])
def test_code_of_the_readme(block, tmp_path):
    # A quarter of the faces: the tests' wheel is not optimized.
    code = "import matplotlib; matplotlib.use('Agg')\n" + block.replace("-2, 2, 40", "-2, 2, 20")
    subprocess.run([sys.executable, "-c", code], check=True, cwd=tmp_path)
    for file in re.findall(r'"(\w+\.(?:svg|pdf))"', block):
        assert (tmp_path / file).stat().st_size > 500


def test_there_is_code_to_run():
    assert len(BLOCKS) == 3


ARRAYS = ["Drawing", "EdgeRuns", "Fragments", "Hits", "LineRuns", "Markers", "Pieces", "VisiblePolygons"]


@pytest.mark.parametrize("name", binspace.__all__)
def test_public_items_are_documented(name):
    item = getattr(binspace, name)
    assert item.__doc__, name
    for attribute in (attribute for attribute in dir(item) if not attribute.startswith("_")):
        documented = item.__doc__ if name in ARRAYS else getattr(item, attribute).__doc__
        assert documented and (name not in ARRAYS or f"`{attribute}" in documented), f"{name}.{attribute}"


def test_stubs():
    pytest.importorskip("mypy")
    subprocess.run([sys.executable, "-m", "mypy.stubtest", "binspace._binspace"], check=True)
