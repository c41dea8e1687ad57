"""Random calls of all commands but ``assess`` of one object, and what their answers may not say.

Each call is made in this process with files of its own. Oracles share nothing with what answers: nothing rocks
below b/h, what falls has rocked, a record written and read again has its peak, and every file of a folder and
every object of a list is in the result or named with a reason; probabilities lie within 0 and 1 and their limits.
"""

import contextlib
import csv
import io
import random
import re
import warnings
from collections.abc import Callable
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from rockfrag.base.errors import InputError
from rockfrag.cli.main import main

from ..conftest import motions_of_noise, write_records
from .damage import Attempt

GRAVITY = 9.81


def called(*words: object) -> tuple[int, str, str]:
    """Status, output and error stream of a call, on which warnings are sentences and no errors."""
    out, err = io.StringIO(), io.StringIO()
    with (
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("default")
        try:
            status = main([str(word) for word in words])
        except SystemExit as error:
            status = int(error.code or 0)
    return status, out.getvalue(), err.getvalue()


def record(rng: random.Random, path: Path) -> float:
    """Write a record of seconds and g, and return its peak [g]."""
    count, dt = rng.randint(200, 900), rng.choice((0.005, 0.01, 0.02))
    time = np.arange(count) * dt
    waves = sum(
        rng.uniform(0.2, 1) * np.sin(2 * np.pi * rng.uniform(0.3, 5) * time + k)
        for k in range(6)
    )
    values = waves * np.sin(np.pi * np.arange(count) / (count - 1)) ** 2
    values *= rng.uniform(0.05, 0.9) / np.abs(values).max()
    rows = [f"{t:.3f} {a:.6f}" for t, a in zip(time, values, strict=True)]
    path.write_text("\n".join(rows) + "\n")
    return float(np.abs(np.round(values, 6)).max())


def simulated(rng: random.Random, folder: Path) -> list[str]:
    """Shake a block or a stack, perhaps with friction; return what its answer contradicts."""
    file = folder / "record.txt"
    record(rng, file)
    width, height = rng.uniform(0.1, 0.8), rng.uniform(0.5, 2.5)
    pga = rng.uniform(0.05, 1.2)
    words = ["simulate", file, "--unit", "g", "--pga", f"{pga:.4f}"]
    words += ["--body", f"{100 * width:.2f}cm", f"{height:.3f}m"]
    stacked = rng.random() < 0.4
    if stacked:
        words += ["--pedestal", f"{1.5 * width:.3f}m", "0.4m"]
    if loose := rng.random() < 0.3:
        words += ["--friction", f"{rng.uniform(0.2, 1.0):.2f}"]
    if drawn := rng.random() < 0.1:
        words += ["--plot", folder / "drawn.png"]
    status, out, err = called(*words)
    if status:
        raise InputError(err.strip())
    wrong = []
    fell = "\noverturned" in out
    never = "it never rocked" in out
    # the pedestal is squatter; with it the statue alone is the most slender of all
    starts = width / height
    if pga < 0.999 * starts and not never and not loose:
        wrong.append(f"rocks at {pga:.4f} g below b/h = {starts:.4f}")
    if fell and never:
        wrong.append("falls without rocking")
    if fell and pga < starts and not loose:
        wrong.append("falls below b/h")
    largest = [
        float(x) for x in re.findall(r"rotation \[rad\]: (.*)", out)[0].split(",")
    ]
    if not fell and max(largest) > np.pi / 2:
        wrong.append("lies on its side and stands")
    if re.search(r"\binf\b|1000000", out):
        wrong.append("prints a number that is none")
    if drawn and (folder / "drawn.png").stat().st_size < 5000:
        wrong.append("draws nothing")
    return wrong


def written_and_read(rng: random.Random, folder: Path) -> list[str]:
    """Write a record in a format and look into it again."""
    file = folder / "record.txt"
    peak = record(rng, file)
    ending = rng.choice(("AT2", "csv", "mseed"))
    form = {"AT2": "AT2", "csv": "CSV", "mseed": "MSEED"}[ending]
    target = folder / f"again.{ending}"
    status, _, err = called("write", file, target, "--unit", "g", "--format", form)
    if status:
        raise InputError(err.strip())
    unit = ["--unit", "m/s2"] if form == "MSEED" else []
    status, out, err = called("info", target, "--format", "csv", *unit)
    if status:
        return [f"cannot read what it wrote: {err.strip()[:200]}"]
    (row,) = csv.DictReader(io.StringIO(out))
    found = next(float(v) for k, v in row.items() if k.startswith("pga"))
    near = abs(found - peak) < 1e-3 * peak or abs(found - peak * GRAVITY) < 1e-2 * peak
    return [] if near else [f"a peak of {peak} g became {found}"]


def listed(rng: random.Random, folder: Path) -> list[str]:
    """Make the catalogue of a folder of records and of things that are none."""
    inside = folder / "mine"
    inside.mkdir()
    for k in range(rng.randint(1, 4)):
        record(rng, inside / f"station{k}.txt")
    others = {
        "notes.txt": "We put the sensor beside the vase.\n",
        "cut.AT2": "PEER\nEvent\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 500, DT= .01 SEC\n 1 2 3\n",
        "paper.pdf": "%PDF-1.4\n",
        "empty.dat": "",
        "site.xml": "<?xml version='1.0'?><a/>",
    }
    for name in rng.sample(sorted(others), rng.randint(0, 3)):
        (inside / name).write_text(others[name])
    target = folder / "list.csv"
    _, _, err = called("catalogue", inside, "--unit", "g", "--output", target)
    text = target.read_text(encoding="utf-8") if target.exists() else ""
    rows = list(csv.DictReader(io.StringIO(text)))
    told = " ".join(row["file"] for row in rows) + err
    return [
        f"{file.name} is lost without a word"
        for file in sorted(inside.iterdir())
        if file.name not in told
    ]


def inventory(rng: random.Random, path: Path) -> dict[str, float]:
    """Write an inventory of blocks on the ground; return b/h of each by its name."""
    slender, rows = {}, ["name,width,height,depth"]
    for k in range(rng.randint(1, 4)):
        width, height = rng.uniform(0.05, 0.6), rng.uniform(0.3, 2.0)
        name = f"object {k}"
        deep = f"{width * rng.uniform(1, 2):.4f}m" if rng.random() < 0.2 else ""
        rows.append(f"{name},{width:.4f} m,{height:.4f} m,{deep}")
        slender[name] = width / height
    path.write_text("\n".join(rows) + "\n")
    return slender


def rows_of(path: Path) -> list[dict[str, str]]:
    """Rows of a table that a command wrote."""
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def lost(rows: list[dict[str, str]], slender: dict[str, float]) -> list[str]:
    """What is wrong where a list has other objects than the inventory."""
    if sorted(row["name"] for row in rows) == sorted(slender):
        return []
    return ["the list has other objects than the inventory"]


def within(row: dict[str, str], name: str) -> bool:
    """Whether a probability of a row lies within 0 and 1, and within its limits."""
    value = float(row[name])
    low, high = float(row[f"{name}_lower"]), float(row[f"{name}_upper"])
    return 0 <= low <= value * (1 + 1e-9) and value <= high * (1 + 1e-9) <= 1 + 2e-9


def after_an_earthquake(rng: random.Random, folder: Path) -> list[str]:
    """List objects after typed levels of shaking."""
    records = write_records(folder, motions_of_noise(6))
    slender = inventory(rng, folder / "list.csv")
    pga = rng.uniform(0.02, 0.8)
    words = ["after", folder / "list.csv", "--pga", f"{pga:.4f}g"]
    if rng.random() < 0.5:
        words += ["--pgv", f"{100 * pga * rng.uniform(0.6, 1.4):.2f}cm/s"]
    status, _, err = called(*words, "--record", records, "--output", folder / "out")
    if status:
        raise InputError(err.strip())
    rows = rows_of(folder / "out" / "after.csv")
    wrong = lost(rows, slender)
    chances = [float(row["probability_fell"]) for row in rows]
    if chances != sorted(chances, reverse=True):
        wrong.append("what fell most probably is not first")
    for row, fell in zip(rows, chances, strict=True):
        both = fell + float(row["probability_rocked_and_stands"])
        if not within(row, "probability_fell") or not both <= 1 + 1e-9:
            wrong.append(f"{row['name']}: probabilities {row}")
        # levels that are typed are known; a property may be a tenth smaller
        if pga < 0.7 * slender[row["name"]] and fell > 0.01:
            wrong.append(f"{row['name']} fell with {fell} far below b/h")
    return wrong


def ranked(rng: random.Random, folder: Path) -> list[str]:
    """Rank an inventory with the probability in 50 years."""
    records = write_records(folder, motions_of_noise(6))
    slender = inventory(rng, folder / "list.csv")
    words = ["assess", folder / "list.csv", "--pga", f"{rng.uniform(0.1, 0.6):.3f}g"]
    words += ["--return-period", rng.choice((72, 475)), "--record", records]
    status, out, err = called(*words, "--output", folder / "out")
    if status:
        raise InputError(err.strip())
    rows = rows_of(folder / "out" / "inventory.csv")
    wrong = lost(rows, slender)
    if any(name not in out for name in slender):
        wrong.append("an object is not on the screen")
    for row in rows:
        if not within(row, "probability") or not within(row, "fraction"):
            wrong.append(f"{row['name']}: {row}")
        if float(row["fraction"]) > float(row["fraction_rocking"]) + 1e-9:
            wrong.append(f"{row['name']} topples more often than it rocks")
    parts = sum(float(row["contribution"] or 0) for row in rows)
    if parts and abs(parts - 1) > 1e-6:
        wrong.append(f"contributions add up to {parts}")
    together = rows_of(folder / "out" / "together.csv")
    rates = [float(row["annual_rate"]) for row in together]
    if rates != sorted(rates, reverse=True):
        wrong.append("more objects topple together oftener than fewer")
    return wrong


def collected(rng: random.Random, folder: Path) -> list[str]:
    """Make an inventory of a museum's export."""
    texts = ["H. 30 cm; W. 12 cm", "30 x 12 x 10 cm", "unknown", "", "Diam. 12 cm"]
    count = rng.randint(1, 12)
    rows = ["Title,Dimensions"]
    rows += [f'"vase {k}","{rng.choice(texts)}"' for k in range(count)]
    export, table, each = (folder / f"{n}.csv" for n in ("export", "list", "each"))
    export.write_text("\n".join(rows) + "\n")
    status, out, err = called(
        "collection", export, "--output", table, "--understood", each
    )
    understood = rows_of(each)
    listed_rows = rows_of(table) if table.exists() else []
    wrong = []
    if len(understood) != count:
        wrong.append(f"of {count} objects {len(understood)} are accounted for")
    asked = [
        row for row in understood if any("give" in (v or "") for v in row.values())
    ]
    if not len(listed_rows) <= count - (0 if not asked else 1):
        wrong.append("what is asked is in the list too")
    names = {row["name"] for row in listed_rows}
    for row in listed_rows:
        if not (float(row["width_m"]) > 0 and float(row["height_m"]) > 0):
            wrong.append(f"{row['name']} has no size")
    if len(names) != len(listed_rows) or status not in (0, 1, 2) or not out + err:
        wrong.append(f"status {status}: {out}{err}")
    return wrong


def played(rng: random.Random, folder: Path) -> list[str]:
    """Write a page in which a body rocks, which loads nothing."""
    file, page = folder / "record.txt", folder / "page.html"
    record(rng, file)
    words = ["play", file, "--unit", "g", "--output", page]
    words += ["--body", f"{rng.uniform(10, 60):.1f}cm", f"{rng.uniform(0.5, 2):.2f}m"]
    if rng.random() < 0.4:
        words += ["--pedestal", "70cm", "0.5m"]
    status, _, err = called(*words)
    if status:
        raise InputError(err.strip())
    text = page.read_text(encoding="utf-8")
    loads = re.findall(r"(?:src|href)=[\"'](?!data:|#|blob:)([^\"']+)", text)
    return [f"loads {loads}"] if loads or "default-src 'none'" not in text else []


CALLS: tuple[Callable[[random.Random, Path], list[str]], ...] = (
    simulated,
    simulated,
    written_and_read,
    listed,
    after_an_earthquake,
    ranked,
    collected,
    played,
)


def commands(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what makes random calls of commands, each in a folder of its own."""

    def draw(rng: random.Random) -> Attempt:
        call, seed = rng.choice(CALLS), rng.random()

        def attempt() -> None:
            wrong = call(random.Random(seed), Path(mkdtemp(dir=folder)))
            assert not wrong, f"{call.__name__} ({seed}): {'; '.join(wrong)}"

        return folder / call.__name__, attempt

    return draw
