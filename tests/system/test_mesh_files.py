"""Files of meshes that are large, deep or ask for what lies elsewhere: read within limits, or refused."""

import base64
import json
import os
import struct
import subprocess
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from rockfrag.base.errors import InputError
from rockfrag.system.mesh import read_shape
from rockfrag.system.mesh_file import (
    DEEPEST_NODE,
    MOST_BYTES,
    MOST_NODES,
    MOST_TRIANGLES,
    files_of_mesh,
)

ON_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="memory is read in /proc")
BOX = trimesh.creation.box((0.4, 1.0, 0.6))


def gltf_of_a_box(**changes: Any) -> dict[str, Any]:
    """A box of 0.24 m³ as a glTF tree, its buffer inside."""
    points = BOX.vertices.astype("<f4").tobytes()
    corners = BOX.faces.astype("<u4").tobytes()
    data = base64.b64encode(points + corners).decode()
    tree = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": len(BOX.vertices),
                "type": "VEC3",
                "min": [-0.2, -0.5, -0.3],
                "max": [0.2, 0.5, 0.3],
            },
            {
                "bufferView": 1,
                "componentType": 5125,
                "count": BOX.faces.size,
                "type": "SCALAR",
            },
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(points)},
            {"buffer": 0, "byteOffset": len(points), "byteLength": len(corners)},
        ],
        "buffers": [
            {
                "byteLength": len(points) + len(corners),
                "uri": f"data:application/octet-stream;base64,{data}",
            }
        ],
    }
    return tree | changes


def written(folder: Path, tree: dict[str, Any]) -> Path:
    (folder / "box.gltf").write_text(json.dumps(tree))
    return folder / "box.gltf"


def test_a_box_in_gltf_has_its_volume(tmp_path: Path):
    path = written(tmp_path, gltf_of_a_box())
    assert read_shape(path, density=1000.0).volume == pytest.approx(0.24, rel=1e-6)
    assert files_of_mesh(path) == [path]
    # and as a binary file
    BOX.export(tmp_path / "box.glb")
    shape = read_shape(tmp_path / "box.glb", density=1000.0)
    assert shape.volume == pytest.approx(0.24, rel=1e-6)


def test_a_mesh_weighs_what_is_stated_or_what_its_density_gives(tmp_path: Path):
    path = tmp_path / "box.stl"
    BOX.export(path)
    for stated in ({"mass": 480.0}, {"density": 2000.0}):
        assert read_shape(path, **stated).mass == pytest.approx(480.0)


def test_a_cloud_of_points_is_called_one(tmp_path: Path):
    path = tmp_path / "cloud.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n")
    with pytest.raises(InputError, match="cloud of 4 points without triangles"):
        read_shape(path, mass=1.0)


def test_a_sheet_with_two_sides_encloses_nothing(tmp_path: Path):
    """Its surface is closed, and its volume is exactly zero."""
    path = tmp_path / "sheet.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 2\n")
    with pytest.raises(InputError, match="encloses no volume"):
        read_shape(path, mass=1.0)


def test_a_buffer_is_read_from_the_folder_of_the_mesh_and_belongs_to_its_files(
    tmp_path: Path,
):
    tree = gltf_of_a_box()
    data = base64.b64decode(tree["buffers"][0]["uri"].split(",")[1])
    tree["buffers"][0]["uri"] = "a%20box.bin"
    path = written(tmp_path, tree)
    (tmp_path / "a box.bin").write_bytes(data)
    assert read_shape(path, density=1000.0).volume == pytest.approx(0.24, rel=1e-6)
    assert files_of_mesh(path) == [path, tmp_path / "a box.bin"]


def chain(length: int) -> list[dict[str, Any]]:
    """Nodes in one another, the mesh in the last."""
    return [{"children": [k + 1]} for k in range(length - 1)] + [{"mesh": 0}]


def doubled(levels: int) -> list[dict[str, Any]]:
    """Nodes that place the next one twice each."""
    return [{"children": [k + 1, k + 1]} for k in range(levels)] + [{"mesh": 0}]


@pytest.mark.parametrize(
    "nodes",
    [
        chain(DEEPEST_NODE + 1),
        chain(20_000),
        [{"mesh": 0}] * (MOST_NODES + 1),
        doubled(60),
        [{"children": [1]}, {"children": [0]}],
    ],
    ids=["deep", "deeper", "many", "placed again and again", "in a circle"],
)
def test_nodes_that_are_many_or_deep_are_refused(tmp_path: Path, nodes: list[Any]):
    path = written(tmp_path, gltf_of_a_box(nodes=nodes))
    with pytest.raises(InputError, match=r"box\.gltf: places more than .* nodes"):
        read_shape(path, mass=100.0)


def test_nodes_within_the_limit_place_what_they_hold(tmp_path: Path):
    path = written(tmp_path, gltf_of_a_box(nodes=chain(DEEPEST_NODE)))
    assert read_shape(path, density=1000.0).volume == pytest.approx(0.24, rel=1e-6)


def test_a_sparse_accessor_is_refused_as_the_shape_would_be_another(tmp_path: Path):
    tree = gltf_of_a_box()
    tree["accessors"][0]["sparse"] = {"count": 1}
    with pytest.raises(InputError, match="sparse accessor"):
        read_shape(written(tmp_path, tree), mass=100.0)


def test_an_accessor_of_a_billion_zeros_is_refused(tmp_path: Path):
    tree = gltf_of_a_box()
    tree["accessors"].append({"componentType": 5126, "count": 10**9, "type": "VEC3"})
    with pytest.raises(InputError, match="triangles or points"):
        read_shape(written(tmp_path, tree), mass=100.0)


def test_each_three_corners_of_an_accessor_are_one_triangle(tmp_path: Path):
    tree = gltf_of_a_box()
    unused = {"componentType": 5121, "count": 0, "type": "SCALAR"}
    tree["accessors"].append(unused)
    unused["count"] = 3 * MOST_TRIANGLES + 2
    assert read_shape(written(tmp_path, tree), mass=100.0).mass == 100.0
    unused["count"] += 1
    with pytest.raises(InputError, match=f"has {MOST_TRIANGLES + 1} triangles"):
        read_shape(written(tmp_path, tree), mass=100.0)


@pytest.mark.parametrize("name", ["/dev/zero", "../outside.bin", "pipe", "link"])
def test_a_buffer_elsewhere_or_that_is_no_file_is_refused(tmp_path: Path, name: str):
    folder = tmp_path / "meshes"
    folder.mkdir()
    (tmp_path / "outside.bin").write_bytes(b"\0" * 1000)
    (folder / "link").symlink_to(tmp_path / "outside.bin")
    os.mkfifo(folder / "pipe")
    tree = gltf_of_a_box()
    tree["buffers"][0]["uri"] = name
    with pytest.raises(InputError, match=r"outside of the folder|no such file"):
        read_shape(written(folder, tree), mass=100.0)


@pytest.mark.parametrize("name", ["/dev/zero", "../../etc/passwd", "pipe", "huge.mtl"])
def test_materials_are_not_looked_at(tmp_path: Path, name: str):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "huge.mtl").write_text("newmtl a\nmap_Kd pipe\n")
    BOX.export(tmp_path / "box.obj")
    path = tmp_path / "box.obj"
    path.write_text(f"mtllib {name}\nusemtl a\n{path.read_text()}")
    assert read_shape(path, density=1000.0).volume == pytest.approx(0.24, rel=1e-6)


def png(side: int) -> bytes:
    """A black picture of that many pixels on each side, in some kilobytes."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data))
            + kind
            + data
            + struct.pack(">I", zlib.crc32(kind + data))
        )

    packer = zlib.compressobj(9)
    rows = b"".join(packer.compress(bytes(side + 1)) for _ in range(side))
    head = struct.pack(">2I5B", side, side, 8, 0, 0, 0, 0)
    return b"".join(
        (
            b"\x89PNG\r\n\x1a\n",
            chunk(b"IHDR", head),
            chunk(b"IDAT", rows + packer.flush()),
            chunk(b"IEND", b""),
        )
    )


MEASURED = """
import resource, sys
from rockfrag.base.errors import InputError
from rockfrag.system.mesh import read_shape
try:
    print(read_shape(sys.argv[1], density=1000.0).volume)
except InputError as error:
    print(error)
used = resource.getrusage(resource.RUSAGE_SELF)
# ru_maxrss would count the tests' own process, of which this one is a fork at first
with open("/proc/self/status") as status:
    most = next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))
print(most / 2**20, used.ru_utime + used.ru_stime)
"""


def read_alone(path: Path) -> tuple[str, float, float]:
    """Read a mesh in a process of its own: what it said, most memory [GiB] and time of the processor [s]."""
    if sys.platform != "linux":
        pytest.skip("what a process took at most is read as Linux tells it")
    import resource

    done = subprocess.run(
        [sys.executable, "-c", MEASURED, str(path)],
        capture_output=True,
        text=True,
        check=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (120, 120)),
    )
    said, used = done.stdout.splitlines()
    memory, seconds = map(float, used.split())
    return said, memory, seconds


@ON_LINUX
def test_a_texture_is_not_decoded(tmp_path: Path):
    (tmp_path / "wall.png").write_bytes(png(13_000))
    tree = gltf_of_a_box(
        images=[{"uri": "wall.png"}],
        textures=[{"source": 0}],
        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    )
    tree["meshes"][0]["primitives"][0]["material"] = 0
    said, memory, _ = read_alone(written(tmp_path, tree))
    assert float(said) == pytest.approx(0.24, rel=1e-6)
    # a picture of that size takes half a gibibyte and more
    assert memory < 0.45


def stl(path: Path, triangles: int) -> Path:
    """As many triangles as wanted, of which only their number is of interest."""
    with path.open("wb") as file:
        file.write(bytes(80) + struct.pack("<I", triangles))
        file.truncate(84 + 50 * triangles)
    return path


@ON_LINUX
def test_too_many_triangles_are_refused_before_they_are_read(tmp_path: Path):
    said, memory, _ = read_alone(stl(tmp_path / "scan.stl", 10**7))
    assert "scan.stl: has 500 MB" in said and "make it coarser" in said
    assert memory < 0.3


def test_a_file_of_more_triangles_than_are_read_is_refused(tmp_path: Path):
    path = stl(tmp_path / "less.stl", MOST_TRIANGLES + 1)
    with path.open("r+b") as file:
        # its length counts, whatever its head says
        file.seek(80)
        file.write(struct.pack("<I", 1))
    with pytest.raises(InputError, match="has 2000001 triangles"):
        read_shape(path, mass=1.0)
    assert MOST_BYTES > 50 * MOST_TRIANGLES
    for ending, content in (
        (".ply", f"ply\nformat ascii 1.0\nelement face {10**8}\nend_header\n"),
        (".obj", "v 0 0 0\n" + "f 1 1 1\n" * (MOST_TRIANGLES + 1)),
        (".stl", "solid x\nfacet\n" + "endfacet\n" * (MOST_TRIANGLES + 1)),
    ):
        (tmp_path / f"many{ending}").write_text(content)
        with pytest.raises(InputError, match="triangles or points"):
            read_shape(tmp_path / f"many{ending}", mass=1.0)


@ON_LINUX
@pytest.mark.slow
@pytest.mark.parametrize("ending", [".stl", ".ply", ".obj", ".glb"])
def test_as_many_triangles_as_are_read_fit_into_two_gibibytes(
    tmp_path: Path, ending: str
):
    half = 577  # 12 side² triangles of a cube's faces, nearly as many as may be
    side = np.linspace(-0.5, 0.5, int(half / np.sqrt(2)) + 1)
    n = len(side)
    u, v = (grid.ravel() for grid in np.meshgrid(side, side, indexing="ij"))
    first = (np.arange(n - 1)[:, np.newaxis] * n + np.arange(n - 1)).ravel()
    quads = np.column_stack([first, first + n, first + n + 1, first + 1])
    faces = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    points, corners = [], []
    for k, axis in enumerate((0, 1, 2) * 2):
        end = np.full_like(u, 0.5 if k < 3 else -0.5)
        columns = {axis: end, (axis + 1) % 3: u, (axis + 2) % 3: v}
        points.append(np.column_stack([columns[i] for i in range(3)]))
        corners.append((faces if k < 3 else faces[:, ::-1]) + k * n * n)
    cube = trimesh.Trimesh(np.vstack(points), np.vstack(corners), process=False)
    cube.merge_vertices()
    assert 0.9 * MOST_TRIANGLES < len(cube.faces) <= MOST_TRIANGLES
    cube.export(tmp_path / f"cube{ending}")
    said, memory, seconds = read_alone(tmp_path / f"cube{ending}")
    assert float(said) == pytest.approx(1.0, rel=1e-5)
    print(f"{ending}: {memory:.2f} GiB, {seconds:.1f} s of the processor")
    assert memory < 2.0
    assert seconds < 20.0
