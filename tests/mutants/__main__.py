"""Change one line of what computes, and say whether the quick tests notice.

    python -m tests.mutants --number 100 --seed 1
    python -m tests.mutants --only fragility/lognormal.py --number 20

Lines are drawn at random of the engines, laws, bodies, the statistics of ``assess`` and fragility. What nothing
notices lacks a test, or is as good as what stood there.
"""

import argparse
import os
import random
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import groupby

from .changes import changes_of
from .plain import load_libraries
from .trials import SOURCE, Group, Mutant, Trials

GROUPS = (
    Group(
        ("engines/planar",),
        plain=(
            "engines/planar/test_routh.py",
            "engines/planar/test_search.py",
            "engines/planar/test_short_analyses.py",
            "engines/planar/test_statements.py",
        ),
        compiled=("engines/planar", "engines/test_contract.py"),
    ),
    Group(
        ("engines/spatial", "engines/algebra"),
        plain=(
            "engines/spatial/test_events.py",
            "engines/spatial/test_short_analyses.py",
            "engines/spatial/test_statements.py",
            "engines/spatial/test_stepping.py",
            "engines/spatial/test_steps_and_cones.py",
        ),
        compiled=(
            "engines/spatial/test_balance.py",
            "engines/spatial/test_doors.py",
            "engines/spatial/test_figure.py",
            "engines/spatial/test_holding.py",
            "engines/spatial/test_impacts.py",
            "engines/spatial/test_meshes.py",
            "engines/spatial/test_physics.py",
            "engines/spatial/test_spin.py",
            "engines/spatial/test_wall_impacts.py",
        ),
    ),
    Group(
        ("engines/pure_rocking",),
        plain=(
            "engines/pure_rocking/test_lanes.py",
            "engines/pure_rocking/test_short_analyses.py",
            "engines/pure_rocking/test_statements.py",
            "engines/pure_rocking/test_taylor.py",
        ),
        compiled=(
            "engines/pure_rocking/test_balance.py",
            "engines/pure_rocking/test_properties.py",
            "engines/pure_rocking/test_restitution_laws.py",
            "engines/pure_rocking/test_velocity_steps.py",
            "engines/pure_rocking/test_vertical.py",
            "engines/test_contract.py",
            "simulation/test_closed_forms.py",
            "simulation/test_ensemble.py",
            "simulation/test_response.py",
            "simulation/test_shapes.py",
            "simulation/test_thresholds.py",
        ),
    ),
    Group(
        ("laws", "system"),
        plain=(
            "system",
            "engines/planar/test_laws.py",
            "engines/pure_rocking/test_statements.py",
        ),
        compiled=(
            "engines/pure_rocking/test_restitution_laws.py",
            "engines/test_contract.py",
            "simulation/test_closed_forms.py",
            "simulation/test_shapes.py",
        ),
    ),
    Group(("assess",), plain=("assess/core",), compiled=("assess",)),
    Group(("fragility",), plain=(), compiled=("fragility",)),
)
"""What is changed, and the tests that are asked: of kernels first those that are quick as plain Python."""

WORDS_ALONE = {
    # words, pages and figures are not statistics
    *("words.py", "page.py", "gallery.py", "assumed.py", "commands.py", "export.py"),
    *("writing.py", "contents.py", "_describe.py", "response_figure.py", "__init__.py"),
    *("form.py", "build.py", "page_list.py"),
}


def mutants_of(group: Group, only: str) -> list[list[Mutant]]:
    """All mutants of a group, those of a line together."""
    paths = [
        path
        for name in group.files
        for path in sorted((SOURCE / name).rglob("*.py"))
        if path.name not in WORDS_ALONE
        and path.relative_to(SOURCE).as_posix().startswith(only)
    ]
    return [
        [Mutant(path, change) for change in changes]
        for path in paths
        for _, each in groupby(
            changes_of(path.read_text(encoding="utf-8")), lambda change: change.line
        )
        if (changes := list(each))
    ]


def drawn(number: int, seed: int, only: str) -> dict[Group, list[Mutant]]:
    """Mutants drawn at random, a line as often as another, by group."""
    rng = random.Random(seed)
    lines = [(group, line) for group in GROUPS for line in mutants_of(group, only)]
    chosen = rng.sample(lines, min(number, len(lines)))
    return {
        group: [rng.choice(line) for owner, line in chosen if owner is group]
        for group in GROUPS
        if any(owner is group for owner, _ in chosen)
    }


def trials(
    mutants: dict[Group, list[Mutant]], processes: int
) -> Iterator[tuple[Mutant, str]]:
    """Each mutant, and what noticed it, as soon as that is known."""
    with ThreadPoolExecutor(processes) as pool:
        for group, own in mutants.items():
            asked = Trials.of(group)
            print(
                f"{', '.join(group.files)}: {len(asked.plain.seconds)} quick tests in plain Python, "
                f"{len(asked.compiled.seconds)} in machine code",
                flush=True,
            )
            yield from zip(own, pool.map(asked.noticed_by, own), strict=True)


def main() -> int:
    """Draw mutants, print what became of each, and return 1 if too few were noticed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--number", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", metavar="PATH", help="under src/rockfrag")
    parser.add_argument("--processes", type=int, default=os.cpu_count())
    parser.add_argument("--least", type=float, default=0.0, metavar="PERCENT")
    options = parser.parse_args()
    load_libraries()
    start = time.monotonic()
    kept: list[Mutant] = []
    count = 0
    for mutant, found in trials(
        drawn(options.number, options.seed, options.only), options.processes
    ):
        count += 1
        print(f"{'noticed' if found else 'NOT NOTICED'} {mutant}  {found}", flush=True)
        kept += [] if found else [mutant]
    noticed = 100 * (count - len(kept)) / max(count, 1)
    took = (time.monotonic() - start) / max(count, 1)
    print(f"{count} mutants, {noticed:.0f} % noticed, {took:.1f} s each; not noticed:")
    for mutant in kept:
        print(f"  {mutant}")
    return int(noticed < options.least)


if __name__ == "__main__":
    sys.exit(main())
