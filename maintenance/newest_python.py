"""See that the wheel works with the newest Python that is found, beside the oldest that all else is tested with.

    .venv/bin/python maintenance/newest_python.py

Makes an environment in a temporary folder, installs the wheel alone, asks for an answer from a hazard table, and
runs a few quick tests. Where there is no newer Python, or nothing can be installed for it, it says so and ends
well.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
NEWEST = 13  # minor version that the hosted checks test too
TESTS = (
    "tests/assess/test_hazard.py",
    "tests/fragility/test_lognormal.py",
    "tests/base",
)
HAZARD = "pga_g,annual_rate\n0.05,0.02\n0.1,0.01\n0.2,0.002\n0.4,0.0004\n0.8,0.00005\n"


def main() -> int:
    """Try the newest Python; return 0 unless the wheel fails with it."""
    found = newest_python()
    if found is None:
        print("There is no Python newer than this one here: the wheel was not tried.")
        return 0
    with tempfile.TemporaryDirectory(prefix="newest ") as scratch:
        folder = Path(scratch)
        python = installed(found, folder)
        if python is None:
            print(f"Nothing can be installed for {found}: the wheel was not tried.")
            return 0
        (folder / "hazard.csv").write_text(HAZARD)
        asked = [
            "assess",
            "--width",
            "35cm",
            "--height",
            "120cm",
            "--hazard",
            "hazard.csv",
        ]
        command = [str(python), "-m", "rockfrag", *asked]
        tried = (
            (command, folder),
            ([str(python), "-m", "pytest", "-q", "-m", "not slow", *TESTS], ROOT),
        )
        for each, place in tried:
            done = subprocess.run(
                each, cwd=place, capture_output=True, text=True, check=False
            )
            if done.returncode:
                print(
                    f"{found}: {' '.join(each[1:4])} failed\n{done.stdout[-3000:]}{done.stderr[-3000:]}"
                )
                return 1
    print(
        f"The wheel answers and passes {len(TESTS)} groups of quick tests with {found}."
    )
    return 0


def newest_python() -> Path | None:
    """The newest interpreter that starts, up to the newest that is supported and above this one."""
    for minor in range(NEWEST, sys.version_info.minor, -1):
        name = f"python3.{minor}"
        named = shutil.which(name)
        kept = sorted(Path.home().glob(f".pyenv/versions/3.{minor}.*/bin/{name}"))
        for path in [*([Path(named)] if named else []), *reversed(kept)]:
            said = _said(path, "--version")
            if re.match(rf"Python 3\.{minor}\.", said):
                return path
    return None


def installed(python: Path, folder: Path) -> Path | None:
    """Python of a new environment with the wheel and what its tests need, or None where that cannot be had."""
    project = folder / "project"
    # building leaves files in the folder that it builds
    shutil.copytree(ROOT / "src", project / "src")
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy2(ROOT / name, project)
    own = folder / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python"
    pip = [str(own), "-m", "pip", "--disable-pip-version-check"]
    steps = (
        [str(python), "-m", "venv", str(folder / "venv")],
        [
            *pip,
            "wheel",
            "--quiet",
            "--no-deps",
            "--wheel-dir",
            str(folder),
            str(project),
        ],
        [*pip, "install", "--quiet", "--find-links", str(folder), "rockfrag[test]"],
    )
    for step in steps:
        done = subprocess.run(step, capture_output=True, text=True, check=False)
        if done.returncode:
            print(done.stderr.strip()[-500:])
            return None
    return own


def _said(path: Path, option: str) -> str:
    try:
        done = subprocess.run(
            [str(path), option], capture_output=True, text=True, timeout=60, check=False
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout


if __name__ == "__main__":
    sys.exit(main())
