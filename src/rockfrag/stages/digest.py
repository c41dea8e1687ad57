"""A fingerprint of source, so that an edit makes the workflow compute again what depends on it."""

import ast
import hashlib
import re
from functools import cache
from pathlib import Path

PACKAGE = "rockfrag"
ROOT = Path(__file__).resolve().parents[1]


@cache
def source_digest(module: str) -> str:
    """Return a digest of the source of a module and of all that it imports from this package.

    Parameters
    ----------
    module
        Dotted name, such as ``rockfrag.stages.sweep``.
    """
    digest = hashlib.sha256()
    for path in source_files(module):
        digest.update(path.relative_to(ROOT).as_posix().encode())
        digest.update(b"\0")
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@cache
def package_digest() -> str:
    """Return a digest of the whole package's source and data, which says what made a report."""
    digest = hashlib.sha256()
    for path in sorted(ROOT.rglob("*")):
        # what Python and numba keep there of a run is no source
        if path.is_file() and path.parent.name != "__pycache__":
            digest.update(path.relative_to(ROOT).as_posix().encode())
            digest.update(b"\0")
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@cache
def source_files(module: str) -> tuple[Path, ...]:
    """Files that a module is made of: itself, what it imports at any depth, and data beside them.

    Imports within functions count too. A package's ``__init__`` is among the files, but what it
    imports only where a module imports that from it: loading is lazy there.
    """
    found: set[str] = set()
    waiting = [module]
    while waiting:
        name = waiting.pop()
        if name in found:
            continue
        found.add(name)
        waiting += _imports(name)
    sources = {_file(name) for name in found}
    sources |= {_file(parent) for name in found for parent in _packages(name)}
    folders = {path.parent for path in sources}
    data = {path for folder in folders for path in _data(folder)}
    return tuple(sorted(sources | data))


def _packages(name: str) -> list[str]:
    parts = name.split(".")
    return [".".join(parts[:count]) for count in range(1, len(parts))]


def _file(name: str) -> Path:
    """Return the file of a module, that of a package being its ``__init__``."""
    place = ROOT.joinpath(*name.split(".")[1:])
    return place / "__init__.py" if place.is_dir() else place.with_suffix(".py")


def _data(folder: Path) -> list[Path]:
    """Files beside modules that are not source: schemas, templates, tables."""
    inside = [folder, *(one for one in folder.iterdir() if one.is_dir() and _is_data(one))]
    return [
        path
        for place in inside
        for path in place.iterdir()
        if path.is_file() and path.suffix not in (".py", ".pyc", ".typed")
    ]


def _is_data(folder: Path) -> bool:
    return folder.name != "__pycache__" and not (folder / "__init__.py").is_file()


# a look at each line is enough, and a hundred times as fast as parsing all source at every start
_IMPORT = re.compile(
    rf"^[ \t]*((?:from|import) {PACKAGE}\b[^\n(]*(?:\((?:[^)#]|#[^\n]*)*\))?)", re.MULTILINE
)


@cache
def _import_statements(name: str) -> tuple[ast.Import | ast.ImportFrom, ...]:
    """Statements of a module that import from this package, those within functions too."""
    text = _file(name).read_text(encoding="utf-8")
    nodes = [ast.parse(found[1].rstrip()).body[0] for found in _IMPORT.finditer(text)]
    return tuple(node for node in nodes if isinstance(node, ast.Import | ast.ImportFrom))


@cache
def _imports(name: str) -> tuple[str, ...]:
    """Modules of this package that one imports."""
    found: list[str] = []
    for node in _import_statements(name):
        if isinstance(node, ast.Import):
            found += [one.name for one in node.names]
        else:
            found += [_home(str(node.module), one.name) for one in node.names]
    return tuple(found)


@cache
def _home(module: str, name: str) -> str:
    """Module in which ``from module import name`` finds the name: a package may pass it on."""
    inner = f"{module}.{name}"
    if _file(inner).is_file():
        return inner
    stub = _file(module).with_suffix(".pyi")
    if stub.is_file():
        for node in ast.parse(stub.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ImportFrom) and name in {one.name for one in node.names}:
                return _home(f"{module}.{node.module}", name)
    return module
