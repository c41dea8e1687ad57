"""Print the lowest version that is allowed of each package, as constraints for pip.

    .venv/bin/python maintenance/oldest_versions.py > oldest.txt

What the weekly checks install, so that a lower bound in ``pyproject.toml`` is one that was tried.
"""

import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
EXTRAS = ("workflow", "test")


def main() -> int:
    """Print a line a package; return 0."""
    print("\n".join(oldest_versions()))
    return 0


def oldest_versions() -> list[str]:
    """Constraints of the packages that have a lower bound, such as ``scipy==1.15``."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project = project["project"]
    extras = project["optional-dependencies"]
    needed = [
        *project["dependencies"],
        *(line for name in EXTRAS for line in extras[name]),
    ]
    found = [re.fullmatch(r"([\w.-]+)>=([\d.]+)", line) for line in needed]
    return [f"{match[1]}=={match[2]}" for match in found if match]


if __name__ == "__main__":
    sys.exit(main())
