"""Give the package damaged configurations, tables and numbers, and see that each is used or refused.

    python benchmarks/fuzz_inputs.py --mutations 100000 --seed 1

Each must be taken or refused with an :class:`InputError` of one line and at most 500 characters, within five
seconds of processor time and one gibibyte. Prints the counts; exit status 1 if anything went wrong. Records are
damaged by ``fuzz_records.py``.
"""

import argparse
import copy
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import yaml

sys.path.insert(0, str(Path(__file__).resolve().parent))
from fuzz_records import damage

from rockfrag import Block, Stack, overturns, simulate
from rockfrag.errors import LONGEST_MESSAGE, InputError
from rockfrag.fragility.tests_file import read_tests
from rockfrag.guests import study_stages
from rockfrag.records.catalogue import read_catalogue
from rockfrag.shaketable.laboratory_table import read_measured
from rockfrag.study.configurations import read_configurations, read_specimens
from rockfrag.study.loading import load_any

ROOT = Path(__file__).resolve().parents[1]
MOST_SECONDS = 5.0
MOST_BYTES = 2**30
VALUES: tuple[Any, ...] = (
    None, True, False, 0, 1, -1, 2**31, 10**400, 0.0, -0.0, 1.0, 1e-300, 1e308, -1e308, float("nan"),
    float("inf"), "", " ", "x", "a\nb", "=1+1", "../x", "/etc/passwd", "x" * 3000, "1e3", "35 cm", "像",
    "\x07", "${HOME}", "{x}", "1976-13-45", [], {}, [[]], [1, 2], ["pga_g"], {"a": 1}, {1: 2}, [None],
    [0.9, "b"], "motions.csv", "study.yaml", ".", "specimens.csv",
)  # fmt: skip
NUMBERS: tuple[Any, ...] = (
    0, 1, -1, 0.5, 1e-12, 1e12, 1e300, -1e300, float("nan"), float("inf"), None, "1", "x", True, 2j,
    [], [1.0], (0.9, 0.8), np.float32(0.3), np.array(0.2), np.array([0.2, np.nan]), {}, object(),
)  # fmt: skip


class _TooSlow(BaseException):
    """An input took longer than :data:`MOST_SECONDS`."""


def main() -> int:
    """Run the harness; return 0 if nothing went wrong."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mutations", type=int, default=100_000, help="how many damaged inputs")
    parser.add_argument("--seed", type=int, default=1, help="seed of the damage")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    signal.signal(signal.SIGPROF, _alarm)
    # kernels are compiled once, before anything is timed
    for body in (BLOCKS["T1"], Stack(BLOCKS["P"], BLOCKS["T1"])):
        simulate(body, np.zeros(9), 0.01)
        overturns([body], [np.ones(9)], [0.01], [1.0])
    fates: Counter[str] = Counter()
    wrong: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        os.chdir(folder)
        shutil.copytree(ROOT / "config", folder, dirs_exist_ok=True)
        kinds = [_configuration, _configuration, _text, _table, _table, _numbers]
        sources = {path.name: path.read_bytes() for path in _files(folder)}
        for number in range(options.mutations):
            kind = kinds[number % len(kinds)]
            name, attempt = kind(folder, sources, rng)
            fate = _outcome(attempt)
            fates[fate.split(":")[0]] += 1
            if fate not in ("taken", "refused"):
                wrong[f"{name}: {fate}"] += 1
                if wrong.total() <= 20:
                    kept = Path(tempfile.gettempdir()) / f"fuzz-{options.seed}-{number}-{name}"
                    if (folder / name).is_file():
                        shutil.copy(folder / name, kept)
                    print(f"{kept}: {fate}", file=sys.stderr)
        os.chdir(ROOT)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    if peak > MOST_BYTES:
        wrong[f"memory: {peak / 2**20:.0f} MiB"] += 1
    print(
        f"{options.mutations} damaged configurations, tables and numbers (seed {options.seed}): "
        f"{fates['taken']} taken, {fates['refused']} refused, {wrong.total()} wrong; "
        f"at most {peak / 2**20:.0f} MiB"
    )
    for what, count in wrong.most_common():
        print(f"{count:6d}  {what}")
    return 1 if wrong else 0


def _alarm(*_: object) -> None:
    raise _TooSlow


def _outcome(attempt: Callable[[], object]) -> str:
    signal.setitimer(signal.ITIMER_PROF, MOST_SECONDS)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            attempt()
        return "taken"
    except InputError as error:
        text = str(error)
        return "refused" if len(text) <= LONGEST_MESSAGE and text.isprintable() else "message"
    except _TooSlow:
        return "slow"
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return f"uncaught: {type(error).__name__} in {Path(place.filename).name}:{place.lineno}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


Attempt = tuple[str, Callable[[], object]]
Sources = dict[str, bytes]


def _files(folder: Path) -> Iterator[Path]:
    yield from (path for path in sorted(folder.rglob("*")) if path.suffix in (".yaml", ".csv"))


def _load(path: Path) -> None:
    study = load_any(path)
    for stage in study_stages(study):
        assert stage.output_files(study)


def _configuration(folder: Path, sources: Sources, rng: random.Random) -> Attempt:
    """A configuration, building or table of a shaker with values exchanged, removed and added."""
    name = rng.choice([one for one in sources if one.endswith(".yaml")])
    content = yaml.safe_load(sources[name])
    for _ in range(rng.randint(1, 3)):
        content = _changed(content, rng)
    path = folder / "damaged.yaml"
    path.write_text(yaml.safe_dump(content, allow_unicode=True, sort_keys=False), encoding="utf-8")
    return path.name, lambda: _load(_used(folder, name, path))


def _text(folder: Path, sources: Sources, rng: random.Random) -> Attempt:
    """A configuration with damaged bytes."""
    name = rng.choice([one for one in sources if one.endswith(".yaml")])
    path = folder / "damaged.yaml"
    path.write_bytes(damage(sources[name], sources["thesis.yaml"], rng))
    return path.name, lambda: _load(_used(folder, name, path))


def _used(folder: Path, name: str, damaged: Path) -> Path:
    """The study that a damaged file belongs to: itself, or one that names it."""
    key = {
        "building.yaml": "building",
        "building-cracked.yaml": "building",
        "shaker.yaml": "shaker",
    }
    if name not in key:
        return damaged
    study = yaml.safe_load((ROOT / "config" / "smoke.yaml").read_text())
    path = folder / "whole.yaml"
    path.write_text(yaml.safe_dump({**study, key[name]: damaged.name}))
    return path


def _changed(content: Any, rng: random.Random) -> Any:
    content = copy.deepcopy(content)
    places: list[tuple[Any, Any]] = []

    def walk(node: Any) -> None:
        if isinstance(node, dict):
            for key, value in node.items():
                places.append((node, key))
                walk(value)
        elif isinstance(node, list):
            for index, value in enumerate(node):
                places.append((node, index))
                walk(value)

    walk(content)
    if not places:
        return rng.choice(VALUES)
    node, key = rng.choice(places)
    kind = rng.randrange(5)
    if kind == 0:
        del node[key]
    elif kind == 1 and isinstance(node, dict):
        word = str(rng.choice(VALUES))
        node[word[:100]] = node.pop(key)
    elif kind == 2:
        other, inner = rng.choice(places)
        value = other[inner] if not isinstance(other, list) or inner < len(other) else None
        node[key] = copy.deepcopy(value)
    else:
        node[key] = copy.deepcopy(rng.choice(VALUES))
    return content


BLOCKS = {"T1": Block(0.124, 0.372, 2.172), "P": Block(0.184, 0.208, 2.3)}
TABLES: dict[str, Callable[[Path], object]] = {
    "specimens.csv": read_specimens,
    "configurations.csv": lambda path: read_configurations(path, dict(BLOCKS)),
    "thesis.csv": read_catalogue,
    "tests-template.csv": read_measured,
    "campaign-template.csv": lambda path: read_tests(
        path, ["pga_g"], overturned="overturned", motion="test"
    ),
}


def _table(folder: Path, sources: Sources, rng: random.Random) -> Attempt:
    """A table with damaged bytes."""
    name = rng.choice([one for one in TABLES if one in sources])
    path = folder / "damaged.csv"
    path.write_bytes(damage(sources[name], sources["thesis.csv"], rng))
    return path.name, lambda: TABLES[name](path)


def _numbers(folder: Path, sources: Sources, rng: random.Random) -> Attempt:
    """A body, a motion and what else a simulation takes, some of it unusable."""
    good = np.random.default_rng(1).normal(size=200)

    def some(usual: Any) -> Any:
        return rng.choice(NUMBERS) if rng.random() < 0.2 else usual

    def attempt() -> None:
        statue = Block(some(0.2), some(0.6), some(30.0))
        body = (
            Stack(Block(some(0.4), some(0.3), some(50.0)), statue) if rng.random() < 0.5 else statue
        )
        acceleration = some(good * 10.0 ** rng.randint(-3, 3))
        if rng.random() < 0.5:
            simulate(body, acceleration, some(0.01), theta0=some(None), omega0=some(None))
        else:
            overturns([some(body)], [acceleration], [some(0.01)], some([0.5, 1.0]), threads=some(1))

    return "numbers", attempt


if __name__ == "__main__":
    sys.exit(main())
