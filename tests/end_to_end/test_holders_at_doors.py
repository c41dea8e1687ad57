"""Random combinations of what holds a body, at every door: each is answered, or refused in one sentence."""

import json
import random
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml

from rockfrag import Block, overturns
from rockfrag.assess.answer import assess_with
from rockfrag.assess.findings import details_of, lines_of
from rockfrag.assess.inventory import assess_inventory, inventory_lines
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.page import page_of
from rockfrag.assess.request import make_request
from rockfrag.base.errors import InputError
from rockfrag.stages.campaign import trials_of
from rockfrag.study.configurations import read_configurations
from rockfrag.study.holding import read_isolators

from ..assess.random_requests import some_request
from ..conftest import motions_of_noise, write_records
from ..fuzz.commands import called, record
from .studies import Foreign, run_stages, write

LONGEST = 400  # letters of a refusal

MAIN = {
    "wall": {"wall_m", "wall_cm", "wall_left_m"},
    "putty": {"putty_n"},
    "cord": {"cord_n_m"},
    "bracket": {"bracket_n_m"},
}
"""Columns and keys of a study of which one must be there for a holder to hold, by how all of it begin."""


def begun_in(held: dict[str, Any]) -> set[str]:
    """Holders of which columns or keys say anything."""
    return {name.split("_")[0] for name in held} & set(MAIN)


def is_whole(held: dict[str, Any]) -> bool:
    """Whether nothing is said of a holder that is not there."""
    return all(MAIN[name] & set(held) for name in begun_in(held))


def mostly_whole(
    rng: random.Random, held: dict[str, Any], given: dict[str, Any]
) -> dict[str, Any]:
    """What is said of holders, mostly with all that they need; ``given``: all that may be said."""
    if rng.random() < 0.3:
        return held
    needed = [
        name for name in given if any(name in MAIN[each] for each in begun_in(held))
    ]
    return held | {name: given[name] for name in needed}


def some(rng: random.Random, given: dict[str, Any], part: float = 0.3) -> dict:
    """Part of what may be said, one of it at least."""
    found = {name: value for name, value in given.items() if rng.random() < part}
    return found or dict([rng.choice(list(given.items()))])


def simulated(rng: random.Random, folder: Path) -> None:
    """``rockfrag simulate`` with options that hold a block, or one on a pedestal."""
    file = folder / "record.txt"
    record(rng, file)
    width, slender = rng.uniform(0.15, 0.6), rng.uniform(1.5, 4)
    words = ["simulate", file, "--unit", "g", "--pga", f"{rng.uniform(0.1, 0.9):.3f}"]
    words += ["--body", f"{width:.3f}m", f"{slender * width:.3f}m", "80kg"]
    if rng.random() < 0.4:
        words += ["--pedestal", f"{rng.uniform(0.8, 1.8) * width:.3f}m", "0.3m"]
    if rng.random() < 0.15:
        words += ["--depth", f"{rng.uniform(0.2, 0.6):.3f}m"]
    if rng.random() < 0.4:
        words += ["--friction", f"{rng.uniform(0.2, 0.9):.2f}"]
    pull = f"{10 ** rng.uniform(0, 4):.0f}"
    options = {
        "--wall": [f"{rng.uniform(0, 9):.1f}cm", "0.05"][: rng.randint(1, 2)],
        "--kerb": ["1cm", f"{rng.uniform(0, 30):.1f}cm"],
        "--putty": [pull + rng.choice(["", "N", "kgf"]), "300N", "4cm"][
            : rng.randint(1, 3)
        ],
        "--cord": ["50kN/m", "2mm", pull + "N"][: rng.randint(1, 3)],
        "--bracket": ["1e6", "0mm", pull + "N"][: rng.randint(1, 3)],
        "--pendulum": [rng.choice(["2m", "0.5"]), "0.06", "8cm", "20kg"][
            : rng.randint(2, 4)
        ],
        "--springs": [rng.choice(["4kN/m", "900"]), "60N", "8cm", "20kg"][
            : rng.randint(2, 4)
        ],
        "--casters": [rng.choice(["free", "locked"])],
    }
    for option, values in some(rng, options).items():
        words += [option, *values]
    status, out, err = called(*words)
    if status:
        assert status == 2 and not out
        raise InputError(err.strip())
    assert "largest rotation [rad]" in out and "nan" not in out


ISOLATORS = (
    "name,mass_kg,radius_m,friction,stroke_cm,stiffness_n_m,strength_n\n"
    "dish,20,1.5,0.06,9,,\nsprings,20,,,12,4000,60\n"
)


def arranged(rng: random.Random, folder: Path) -> None:
    """A row of ``arrangements.csv``, simulated."""
    (folder / "isolators.csv").write_text(ISOLATORS)
    given = {
        "wall_cm": f"{rng.uniform(0, 9):.1f}",
        "wall_left_m": "0.03",
        "wall_height": f"{rng.uniform(1, 90):.0f} cm",
        "wall_friction": f"{rng.uniform(0, 0.6):.2f}",
        "wall_restitution": f"{rng.uniform(0, 1):.2f}",
        "putty_n": f"{10 ** rng.uniform(0, 4):.0f}",
        "putty_shear": "0.2 kN",
        "putty_spread_cm": "5",
        "cord_n_m": "50000",
        "cord_slack_mm": "3",
        "cord_n": "400",
        "bracket_n_m": "1e6",
        "bracket_slack_mm": "1",
        "bracket_kgf": "60",
        "casters": rng.choice(["free", "locked"]),
    }
    held = mostly_whole(rng, some(rng, given), given)
    stands = rng.choice(["vase", "vase | plinth", "vase|dish", "vase|plinth|springs"])
    table = folder / "arrangements.csv"
    table.write_text(
        ",".join(["name", "object", *held])
        + "\n"
        + ",".join(["case", stands, *held.values()])
        + "\n"
    )
    blocks = {"vase": Block(0.3, 0.9, 80.0), "plinth": Block(0.5, 0.4, 200.0)}
    isolators = read_isolators(folder / "isolators.csv")
    (system,), _ = read_configurations(table, blocks, isolators)
    assert is_whole(held), held
    (motion,) = motions_of_noise(1)
    outcomes = overturns([system], [motion], scales=[1.0, 3.0], friction=0.5)
    assert len(outcomes.table("constraints")) == 2 * len(system.holding)


def trials_held(rng: random.Random, folder: Path) -> None:
    """Trials of an object of a campaign, held, under a motion."""
    given = {
        "wall_m": rng.uniform(0, 0.1),
        "wall_left_m": 0.02,
        "wall_height_m": rng.uniform(0.05, 0.9),
        "wall_friction": 0.4,
        "putty_n": 10 ** rng.uniform(0, 4),
        "putty_spread_m": 0.05,
        "cord_n_m": 5e4,
        "cord_n": 300.0,
        "bracket_n_m": 1e6,
        "casters": rng.choice(["free", "locked"]),
        "isolator": rng.choice(
            [
                {"mass_kg": 9.0, "radius_m": 1.5, "friction": 0.06},
                {"mass_kg": 9.0, "stiffness_n_m": 900.0, "strength_n": 40.0},
                {"mass_kg": 9.0, "radius_m": 1.5, "strength_n": 40.0},
            ]
        ),
    }
    held = mostly_whole(rng, some(rng, given), given)
    unknowns = {"edge_retreat_mm": (0.0, 5.0), "restitution": (0.8, 1.0)}
    if rng.random() < 0.3:
        unknowns = {"edge_retreat_mm": (0.0, 5.0), "friction": (0.3, 0.8)}
    study = SimpleNamespace(object={"held": held}, unknowns=unknowns, seed=1)
    found = trials_of(Block(0.3, 0.9, 80.0), study, 4)
    assert is_whole(held), held
    (motion,) = motions_of_noise(1)
    outcomes = overturns(found.systems, [motion], scales=[2.0])
    assert np.isfinite(outcomes.peak_slip).all()


def some_holders(rng: random.Random) -> dict[str, str]:
    """Keys of ``statue.yaml`` that say what holds an object."""
    # what is known of a holder, which is refused without it
    known = {
        "wall_height": f"{rng.uniform(1, 90):.0f} cm",
        "bracket_slack": "2 mm",
        "cord_slack": "4 mm",
        "isolator_radius": "1.5 m",
        "isolator_friction": "0.07",
        "isolator_stiffness": "900 N/m",
        "isolator_strength": "60 N",
    }
    if rng.random() < 0.7:
        known = {}
    return some(
        rng,
        {
            "wall": f"{rng.uniform(0, 9):.1f} cm",
            "casters": rng.choice(["free", "locked"]),
            "putty": f"{10 ** rng.uniform(0, 4):.0f} N",
            "bracket": f"{rng.uniform(1, 90):.0f} kgf",
            "cord": "0.4 kN",
            "isolator": f"{rng.uniform(1, 25):.0f} cm",
            **known,
        },
    )


def assessed(rng: random.Random, folder: Path) -> None:
    """An object that is held, assessed to its page."""
    made = motions_of_noise(4)
    motions = MotionSet(made, made, ((0, 1), (2, 3)), "made motions")
    given = some_request(rng) | some_holders(rng)
    found = assess_with(make_request(given, "test"), motions)
    words = " ".join([*lines_of(found), *details_of(found), page_of(found)])
    assert "It is held as it stands" in words
    assert 0 <= found.fraction.value <= 1


def listed(rng: random.Random, folder: Path) -> None:
    """Objects of an inventory, each held in its way."""
    write_records(folder, motions_of_noise(4))
    columns = (
        *("wall", "wall_height", "casters", "putty", "bracket", "bracket_slack"),
        *("cord", "cord_slack", "isolator", "isolator_radius", "isolator_friction"),
        *("isolator_stiffness", "isolator_strength"),
    )
    lines = [",".join(["name", "width_cm", "height_cm", "depth_cm", *columns])]
    for name in "AB":
        held = some_holders(rng)
        width = rng.uniform(10, 60)
        depth = f"{0.8 * width:.1f}" if rng.random() < 0.3 else ""
        sizes = [name, f"{width:.1f}", f"{width * rng.uniform(1.5, 5):.1f}", depth]
        lines.append(",".join([*sizes, *(held.get(column, "") for column in columns)]))
    table = folder / "table.csv"
    table.write_text("\n".join(lines) + "\n")
    records = {"paths": [str(folder / "catalogue.csv")]}
    found = assess_inventory(table, {"pga": "0.4 g", "records": records})
    assert len(found.found) == 2
    assert len(inventory_lines(found)) >= 2


HELD = """name,object,wall_cm,putty_n,casters
alone,vase,,,
isolated,vase | plinth | dish,,,
at the wall,vase,3,,
on wax,vase|plinth,,200,
rolling,vase,,,free
"""


@pytest.mark.slow
def test_a_study_of_what_holds_an_object_goes_on_to_its_report(tmp_path):
    """It ended at forces, at slips, at a state that not all reach, and at tests that were the same."""
    blocks = {"vase": (30, 90, 80), "plinth": (50, 40, 200)}
    records = {"one": "First", "two": "Second"}
    path = write(Foreign(blocks, {}, records), tmp_path)
    (tmp_path / "isolators.csv").write_text(ISOLATORS)
    (tmp_path / "configurations.csv").write_text(HELD)
    content = yaml.safe_load(path.read_text())
    content["bodies"]["isolators"] = "isolators.csv"
    content["amplitudes"] |= {"lowest_g": 0.3, "step_percent": 40}
    content["protocol"] = {"step_percent": 40}
    path.write_text(yaml.safe_dump(content))
    results = run_stages(path)
    tables = {
        name: pd.read_csv(next(results.rglob(f"{name}.csv")))
        for name in ("validity", "sliding", "pairs")
    }
    # forces of every arrangement, and slips of the one that rolls
    assert tables["validity"]["friction_demand"].notna().any()
    assert set(tables["sliding"]["configuration"]) == {"rolling"}
    # each is compared with the vase that nothing holds
    others = ("isolated", "at the wall", "on wax", "rolling")
    assert set(tables["pairs"]["object"]) == {
        f"{name} against alone" for name in others
    }
    page = (results / "report.html").read_text(encoding="utf-8")
    assert "on wax" in page and not re.search(r">\s*nan\s*<", page)
    # what is held is not said to stand free, for other programs neither
    notes = (each.read_text("utf-8") for each in results.rglob("exports/*.json"))
    said = {
        about["Description"]
        for known in map(json.loads, notes)
        for about in known.values()
    }
    assert "on wax, with bond 2" in said and "Free-standing alone" in said
    assert not any("Free-standing" in each for each in said - {"Free-standing alone"})


DOORS = (simulated, arranged, trials_held, assessed, listed)


def count_answers(door, draws: int, folder: Path, seed: int) -> int:
    """How many of random combinations are answered; a refusal is one sentence."""
    rng, answered = random.Random(seed), 0
    for number in range(draws):
        place = folder / str(number)
        place.mkdir()
        try:
            door(rng, place)
        except InputError as error:
            said = str(error)
            assert len(said) < LONGEST and "\n" not in said, said
            assert said.rstrip()[-1] in ".)" and "Traceback" not in said, said
            continue
        answered += 1
    return answered


@pytest.mark.parametrize("door", [simulated, arranged, trials_held])
def test_a_few_combinations_are_answered_or_refused_in_a_sentence(door, tmp_path):
    assert count_answers(door, 6, tmp_path, 53) >= 2


@pytest.mark.slow
@pytest.mark.parametrize("door", DOORS)
def test_many_combinations_are_answered_or_refused_in_a_sentence(door, tmp_path):
    draws = 60 if door in (assessed, listed) else 300
    assert count_answers(door, draws, tmp_path, 54) >= draws / 3
