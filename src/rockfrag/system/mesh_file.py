"""Files of meshes: read within limits of size, and for their shape alone.

What a mesh does not need for its shape (textures, materials, files outside of its folder) is not looked at.
"""

import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, cast
from urllib.parse import unquote

from rockfrag.base.errors import InputError

MESH_ENDINGS = (".obj", ".ply", ".stl", ".glb", ".gltf")
Y_UP = (".glb", ".gltf")  # formats whose specification says so (glTF 2.0, section 3.4)
MOST_BYTES = 200_000_000
"""Of a mesh's file, and of each file that it names."""

MOST_TRIANGLES = 2_000_000
"""Below 2 GiB of memory; mass properties of a scan do not change beyond some hundred thousand."""

MOST_NODES = 1000  # of the scene of a glTF file, counted as often as they are placed
DEEPEST_NODE = 100  # nodes in one another

_SIZE = "make it coarser: a scan of some hundred thousand triangles has the same mass and base."
_HEADER = 100_000  # bytes in which the header of a PLY file ends
_GLB_JSON = 0x4E4F534A  # type of a chunk (glTF 2.0, section 4.4.3)
_EACH_A_TRIANGLE = (5, 6)  # modes of primitives: strip and fan (glTF 2.0, section 5.24)
_STL_HEADER, _STL_TRIANGLE = 84, 50  # bytes


@dataclass(frozen=True)
class Beside:
    """Regular files in the folder of a mesh, by the name that it gives them; trimesh asks it for buffers."""

    folder: Path

    def get(self, name: str) -> bytes:
        """Read a file of the folder; a name that leads out of it, to a device or a pipe is refused."""
        path = self.folder / unquote(name)
        if not path.resolve().is_relative_to(self.folder.resolve()):
            raise InputError(
                f"{path}: lies outside of the folder of the mesh; put it there."
            )
        return read_bytes(path)

    __getitem__ = get


def read_bytes(path: Path) -> bytes:
    """Read a regular file of limited size."""
    if not path.is_file():
        raise InputError(f"{path}: there is no such file; correct the path.")
    size = path.stat().st_size
    if size > MOST_BYTES:
        raise InputError(
            f"{path}: has {size / 1e6:.0f} MB, and a mesh of at most {MOST_BYTES / 1e6:.0f} MB is read; {_SIZE}"
        )
    return path.read_bytes()


def load_mesh(path: Path) -> Any:
    """Read a mesh or a cloud of points as trimesh has it, without textures and materials.

    A file that is too large for this machine is refused before its triangles are made.
    """
    import trimesh

    ending = path.suffix.lower()
    if ending not in MESH_ENDINGS:
        raise InputError(
            f"{path}: a mesh is read from {', '.join(MESH_ENDINGS)} files."
        )
    content = read_bytes(path)
    try:
        _check_count(path, _triangles(path, content))
        loaded: Any = trimesh.load(
            BytesIO(content),
            file_type=ending[1:],
            resolver=cast("Any", Beside(path.parent)),
            process=False,
            skip_materials=True,
        )
        mesh = loaded.to_mesh() if isinstance(loaded, trimesh.Scene) else loaded
    except InputError:
        raise
    except (Exception, RecursionError) as error:
        raise InputError(
            f"{path}: cannot be read as a mesh ({type(error).__name__})."
        ) from error
    _check_count(path, len(getattr(mesh, "faces", ())))
    return mesh


def files_of_mesh(path: Path) -> list[Path]:
    """The file of a mesh, and those with its vertices and triangles that a glTF file names.

    Parameters
    ----------
    path : of the mesh

    Returns
    -------
    The paths, whether or not there are such files.
    """
    if path.suffix.lower() != ".gltf":
        return [path]
    try:
        buffers = json.loads(read_bytes(path)).get("buffers", ())
        names = [buffer.get("uri", "data:") for buffer in buffers]
    except (InputError, ValueError, AttributeError, TypeError, RecursionError):
        # it is refused where it is read
        return [path]
    return [path, *(path.parent / unquote(name) for name in names if ":" not in name)]


def _check_count(path: Path, triangles: int) -> None:
    """Refuse a mesh of more triangles or points than are read."""
    if triangles > MOST_TRIANGLES:
        raise InputError(
            f"{path}: has {triangles} triangles or points, and a mesh of at most {MOST_TRIANGLES} is read; {_SIZE}"
        )


def _triangles(path: Path, content: bytes) -> int:
    """Number of triangles, or of points if there are more, that a file says it has."""
    ending = path.suffix.lower()
    if ending == ".stl":
        if content[:5].lower() == b"solid" and b"facet" in content[:_HEADER]:
            return content.count(b"endfacet")
        return (len(content) - _STL_HEADER) // _STL_TRIANGLE
    if ending == ".obj":
        return max(content.count(b"\nf "), content.count(b"\nv "))
    if ending == ".ply":
        words = [line.split() for line in content[:_HEADER].splitlines()]
        counts = (word[2] for word in words if word[:1] == [b"element"] and word[2:])
        return max((int(count) for count in counts if count.isdigit()), default=0)
    tree = json.loads(_json_of(ending, content))
    accessors: Sequence[Mapping[str, Any]] = tree.get("accessors", ())
    if any("sparse" in accessor for accessor in accessors):
        raise InputError(
            f"{path}: has a sparse accessor, which changes its shape and is not read; write it as PLY or STL."
        )
    longest = max((int(accessor["count"]) for accessor in accessors), default=0)
    placed = sum(
        _triangles_of(primitive, accessors)
        for node in _placed_nodes(tree, path)
        if "mesh" in node
        for primitive in tree["meshes"][node["mesh"]]["primitives"]
    )
    return max(placed, longest // 3)


def _json_of(ending: str, content: bytes) -> bytes:
    """The JSON of a glTF file, which is the first chunk of a binary one."""
    if ending == ".gltf":
        return content
    length, kind = struct.unpack_from("<2I", content, 12)
    if kind != _GLB_JSON:
        raise ValueError("the first chunk is no JSON")
    return content[20 : 20 + length]


def _placed_nodes(tree: Mapping[str, Any], path: Path) -> list[Mapping[str, Any]]:
    """Nodes of a glTF file, each as often as it is placed; refuse many of them, or deep ones."""
    nodes: Sequence[Mapping[str, Any]] = tree.get("nodes", ())
    children = {child for node in nodes for child in node.get("children", ())}
    roots = {
        root for scene in tree.get("scenes", ()) for root in scene.get("nodes", ())
    }
    roots |= {number for number in range(len(nodes)) if number not in children}
    waiting = [(root, 1) for root in roots]
    placed: list[Mapping[str, Any]] = []
    while waiting:
        number, depth = waiting.pop()
        placed.append(nodes[number])
        waiting += [(child, depth + 1) for child in nodes[number].get("children", ())]
        if len(placed) + len(waiting) > MOST_NODES or depth > DEEPEST_NODE:
            raise InputError(
                f"{path}: places more than {MOST_NODES} nodes, or more than {DEEPEST_NODE} in one another; "
                "join its parts into one mesh."
            )
    return placed


def _triangles_of(
    primitive: Mapping[str, Any], accessors: Sequence[Mapping[str, Any]]
) -> int:
    """Number of triangles of a primitive of a glTF file."""
    corners = primitive.get("indices", primitive["attributes"]["POSITION"])
    count = int(accessors[corners]["count"])
    return count if primitive.get("mode") in _EACH_A_TRIANGLE else count // 3
