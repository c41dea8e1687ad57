"""Figures and times of random questions, beside those of another version of the package.

``python benchmarks/questions.py 40 --in-space > before.csv`` answers as many questions in one process and writes a
line for each; the same with ``--beside before.csv`` says how the figures and the times differ from those.
"""

import argparse
import csv
import random
import statistics
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from rockfrag.assess.answer import RECORDS, assess_with  # noqa: E402
from rockfrag.assess.motions import motion_set  # noqa: E402
from rockfrag.assess.request import make_request  # noqa: E402
from tests.assess.random_requests import some_request  # noqa: E402

FIGURES = ("value", "lower", "upper", "half", "half_lower", "half_upper")


def answers(count: int, *, in_space: bool, seed: int = 54) -> list[dict[str, str]]:
    """Figures of so many questions, and seconds of processor and wall that each took."""
    rng, rows = random.Random(seed), []
    for number in range(count + 1):
        keys = some_request(rng, in_space=1.0 if in_space else 0.3)
        request = make_request(keys, "question")
        motions = motion_set(request.records, request.place, Path(RECORDS))
        begun = time.process_time(), time.perf_counter()
        found = assess_with(request, motions)
        spent = time.process_time() - begun[0], time.perf_counter() - begun[1]
        main, half = found.main, found.amplitudes[0.5]
        figures = [main.value, main.lower, main.upper]
        figures += [half.value, half.lower, half.upper]
        row = {name: f"{x:.4g}" for name, x in zip(FIGURES, figures, strict=True)}
        row |= {"processor_s": f"{spent[0]:.2f}", "wall_s": f"{spent[1]:.2f}"}
        if number > 0:
            # the first one loads and compiles
            rows.append(
                {"question": ", ".join(f"{k}={v}" for k, v in keys.items()), **row}
            )
    return rows


def compare(rows: list[dict[str, str]], others: list[dict[str, str]]) -> None:
    """Print figures beside those of the other version, then medians and worst of what differs."""
    off: list[float] = []
    for row, other in zip(rows, others, strict=True):
        if row["question"] != other["question"]:
            raise SystemExit("the other file answers other questions")
        pairs = [(float(row[name]), float(other[name])) for name in FIGURES]
        off += [abs(x - y) / max(abs(y), 1e-3) for x, y in pairs]
        print(
            " | ".join(f"{y:.3g} > {x:.3g}" for x, y in pairs),
            f"| {other['processor_s']} > {row['processor_s']} s",
        )
    print(
        f"figures differ by {statistics.median(off):.2g} (median), {max(off):.2g} (most) of themselves"
    )
    for name in ("processor_s", "wall_s"):
        ours, theirs = ([float(row[name]) for row in each] for each in (rows, others))
        print(
            f"{name}: median {statistics.median(theirs):.2f} > {statistics.median(ours):.2f}, "
            f"worst {max(theirs):.2f} > {max(ours):.2f}, sum {sum(theirs):.1f} > {sum(ours):.1f}"
        )


def main() -> None:
    """Answer, and write or compare."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int)
    parser.add_argument("--in-space", action="store_true")
    parser.add_argument("--beside", type=Path)
    given = parser.parse_args()
    rows = answers(given.count, in_space=given.in_space)
    if given.beside:
        with given.beside.open(encoding="utf-8", newline="") as file:
            compare(rows, list(csv.DictReader(file)))
        return
    written = csv.DictWriter(sys.stdout, rows[0].keys())
    written.writeheader()
    written.writerows(rows)


if __name__ == "__main__":
    main()
