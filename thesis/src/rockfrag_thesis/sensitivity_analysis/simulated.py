"""Ratios P/NP simulated with one factor at a time away from the ideal model.

What is varied: restitution of both interfaces, imperfections, the pedestal's width, mass that was not
counted, the protocol's step, and all tolerances at once in perturbed copies.  The table that results is
what :func:`rockfrag_thesis.sensitivity_analysis.explain.explain` takes.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import radians

import numpy as np
import pandas as pd

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.laws import BUILT_IN
from rockfrag.motions.processing import factors_to_pga
from rockfrag.records.motion import Motion
from rockfrag.simulation import overturns
from rockfrag.simulation.options import MeasuredRestitution, system_of
from rockfrag.system.blocks import Block, Stack
from rockfrag.system.system import System

BATCH = 64  # bodies that are shaken at a time, between two lines of progress

LEVELS = 8
"""Levels of a series of levels that are climbed at a time: whatever has fallen climbs no further."""

LAWS = BUILT_IN[1:]  # laws that are tried, the usual one first

REFERENCE = "ideal"
LARGEST_RESTITUTION = 0.995


@dataclass(frozen=True)
class Case:
    """An object with and without its pedestal at one level of one factor."""

    # What differs, how much, of which object, and the number of the perturbed copy
    factor: str
    level: float
    object: str
    # What stands on the table without and with the pedestal
    lone: System
    stack: System
    replicate: int = 0


def ideal_case(object_name: str, stack: Stack) -> Case:
    """Return an object with and without its pedestal as the ideal model has them."""
    return Case(REFERENCE, 0.0, object_name, stack.upper.system(), stack.system())


def factor_cases(
    object_name: str, stack: Stack, levels: Mapping[str, Sequence[float]]
) -> list[Case]:
    """One case per level of each mechanical factor of an ideal stack, whose statue is the lone object.

    Levels are of any of ``statue_restitution``, ``interface_restitution``, ``ground_restitution`` (factors on the
    restitution that conserves momentum; once by each law that differs, see `LAW_OF`), ``pedestal_lean_deg``,
    ``statue_offset_mm``, ``statue_cg_offset_mm``, ``pedestal_width_cm``; others are left alone. A body that cannot
    stand or a restitution that adds energy is an InputError that names factor and level.
    """
    cases = []
    for factor in PERTURBATIONS:
        base, law = LAW_OF.get(factor, (factor, LAWS[0]))
        for level in levels.get(base, ()):
            # below what momentum leaves, the law of the couple is that of position
            if law != "couple" or level > 1:
                cases.append(perturbed_case(object_name, stack, {factor: level}))
    return cases


def perturbed_case(
    object_name: str, stack: Stack, perturbations: Mapping[str, float]
) -> Case:
    """Object with and without its pedestal where factors of `PERTURBATIONS` are off the ideal together.

    A body that cannot stand or a restitution that adds energy is an InputError that names factor and level.
    """
    names = [name for name in PERTURBATIONS if name in perturbations]
    measured: dict[str, float] = {}
    law = LAWS[0]
    for factor in names:
        level = perturbations[factor]
        try:
            if factor in _SHAPES:
                stack = _SHAPES[factor](stack, level)
                continue
            base, law = LAW_OF[factor]
            block, places = _RESTITUTIONS[base]
            measured |= dict.fromkeys(places, _restitution(stack.blocks[block], level))
        except InputError as error:
            raise InputError(
                f"sensitivity_analysis.{factor}, {level:g}, {object_name}: {error}"
            ) from error
    lone = measured.pop("lone", None)
    return Case(
        " + ".join(names),
        float(perturbations[names[0]]),
        object_name,
        system_of(stack.upper, restitution=lone),
        system_of(
            stack, restitution=MeasuredRestitution(measured, law) if measured else None
        ),
    )


def _restitution(block: Block, factor: float) -> float:
    value = factor * block.momentum_restitution()
    if not 0 < value < 1:
        raise InputError(
            f"a restitution of {factor:g} times {block.momentum_restitution():.3f} would be "
            f"{value:.3f}; choose a factor that keeps it between 0 and 1."
        )
    return value


def _pedestal_width(stack: Stack, centimetres: float) -> Stack:
    # of the same material and depth; the inertia follows from the shape
    ideal = stack.lower
    width = centimetres / 100
    mass = ideal.mass * width / ideal.width
    return replace(stack, lower=replace(ideal, width=width, mass=mass, inertia=None))


_SHAPES: Mapping[str, Callable[[Stack, float], Stack]] = {
    "pedestal_lean_deg": lambda stack, degrees: replace(
        stack, lower=replace(stack.lower, lean=stack.lower.lean + radians(degrees))
    ),
    "statue_offset_mm": lambda stack, mm: replace(
        stack, offset=stack.offset + mm / 1000
    ),
    "statue_cg_offset_mm": lambda stack, mm: replace(
        stack, upper=replace(stack.upper, cg_offset=stack.upper.cg_offset + mm / 1000)
    ),
    "pedestal_width_cm": _pedestal_width,
}
"""What a level of a factor does to the shape of a stack."""

_RESTITUTIONS: Mapping[str, tuple[int, tuple[str, ...]]] = {
    "statue_restitution": (1, ("lone", "interface")),
    "interface_restitution": (1, ("interface",)),
    "ground_restitution": (0, ("ground",)),
}
"""Block from below whose restitution a factor multiplies, and the contacts that have it."""

LAW_OF: Mapping[str, tuple[str, str]] = {
    name if law == LAWS[0] else f"{name}_{law}": (name, law)
    for name in _RESTITUTIONS
    for law in LAWS
}
"""What a factor of restitution varies, and the law by which stacks follow it."""

# shapes before restitutions, which are factors on what the shapes give
PERTURBATIONS = (*_SHAPES, *LAW_OF)  # names of the mechanical factors


def perturbed_cases(
    object_name: str,
    stack: Stack,
    *,
    tolerance: float,
    restitution: float,
    replicates: int,
    rng: np.random.Generator,
) -> list[Case]:
    """Copies with tolerances; the two sides of a pair are drawn apart, as in separate tests.

    ``tolerance`` is the standard deviation of every width and height, relative [-], ``restitution`` that of every
    restitution [-].
    """
    cases = []
    for number in range(1, replicates + 1):
        lone = _perturbed(stack.upper, tolerance, rng)
        pedestal = _perturbed(stack.lower, tolerance, rng)
        statue = _perturbed(stack.upper, tolerance, rng)
        values = [
            float(
                np.clip(
                    b.momentum_restitution() + restitution * z,
                    0.01,
                    LARGEST_RESTITUTION,
                )
            )
            for b, z in zip(
                (lone, pedestal, statue), rng.standard_normal(3), strict=True
            )
        ]
        copy = Stack(pedestal, statue, stack.offset)
        cases.append(
            Case(
                "tolerances",
                100 * tolerance,
                object_name,
                system_of(lone, restitution=values[0]),
                system_of(copy, restitution=(values[1], values[2])),
                number,
            )
        )
    return cases


def _perturbed(block: Block, tolerance: float, rng: np.random.Generator) -> Block:
    across, up = np.exp(tolerance * rng.standard_normal(2))
    height = None if block.cg_height is None else block.cg_height * float(up)
    width = block.width * float(across)
    return replace(
        block, width=width, height=block.height * float(up), cg_height=height
    )


def level_amplitudes(
    systems: Sequence[System],
    motions: Sequence[Motion],
    levels_g: Floats,
    threads: int = 1,
) -> Floats:
    """Largest amplitude [g] survived before the first overturning, climbing rising levels from rest.

    Shape (systems, motions); NaN where nothing or everything was survived.
    """
    scales = np.array([factors_to_pga(motion, levels_g) for motion in motions])
    fell = np.zeros((len(systems), *scales.shape), dtype=bool)
    for levels in np.array_split(
        np.arange(len(levels_g)), np.arange(LEVELS, len(levels_g), LEVELS)
    ):
        climbing = np.logical_not(fell.any(axis=2))
        here, under = (
            np.flatnonzero(climbing.any(axis=1)),
            np.flatnonzero(climbing.any(axis=0)),
        )
        if not here.size:
            break
        found = overturns(
            [systems[i] for i in here.tolist()],
            [motions[j] for j in under.tolist()],
            scales=scales[np.ix_(under, levels)],
            threads=threads,
        ).overturned
        # a pair that has fallen already has its first fall below
        fell[np.ix_(here, under, levels)] = found
    first = fell.argmax(axis=2)
    known = fell.any(axis=2) & (first > 0)
    return np.where(known, levels_g[np.maximum(first - 1, 0)], np.nan)


def case_ratios(
    cases: Sequence[Case],
    motions: Sequence[Motion],
    levels_g: Floats,
    threads: int = 1,
    progress: Callable[[int], None] = lambda done: None,
) -> pd.DataFrame:
    """Ratio P/NP of every case under every motion, climbed through ``levels_g`` [g].

    ``progress`` is called with the number of bodies done.

    Returns one row per case and motion: ``factor``, ``level``, ``reference`` (False), ``object``, ``earthquake``,
    ``floor``, ``motion``, ``replicate``, ``p_g``, ``np_g`` (amplitudes [g]), ``ratio``, ``resolution`` (half-width
    to which its logarithm is known, a step of the series of levels [-]).
    """
    order = list(
        dict.fromkeys(name for case in cases for name in (case.lone, case.stack))
    )
    parts = []
    for first in range(0, len(order), BATCH):
        batch = order[first : first + BATCH]
        parts.append(level_amplitudes(batch, motions, levels_g, threads))
        progress(first + len(batch))
    found = dict(zip(order, np.concatenate(parts), strict=True))
    tables = [
        _rows(case, motions, found[case.stack], found[case.lone]) for case in cases
    ]
    step = float(np.log(levels_g[1] / levels_g[0])) if len(levels_g) > 1 else 0.0
    return pd.concat(tables, ignore_index=True).assign(resolution=step)


def motion_columns(motions: Sequence[Motion]) -> dict[str, list[str]]:
    """Earthquake, floor and name of each motion, as columns of a table of tests."""
    return {
        "earthquake": [
            str(motion.metadata.get("earthquake") or motion.name) for motion in motions
        ],
        "floor": [str(motion.metadata.get("floor") or "ground") for motion in motions],
        "motion": [motion.name for motion in motions],
    }


def _rows(
    case: Case, motions: Sequence[Motion], stack: Floats, lone: Floats
) -> pd.DataFrame:
    """Rows of a case, one a motion, with amplitudes of the stack and of the lone object."""
    return pd.DataFrame(
        {
            "factor": case.factor,
            "level": case.level,
            "reference": False,
            "object": case.object,
            **motion_columns(motions),
            "replicate": case.replicate,
            "p_g": stack,
            "np_g": lone,
            "ratio": stack / lone,
        }
    )


def mass_error_rows(
    ideal: pd.DataFrame, stacks: Mapping[str, Stack], table_masses: Sequence[float]
) -> pd.DataFrame:
    """Ratios that a laboratory would report which divides the force by the wrong mass.

    The force (table + blocks) a moves everything. Mass that was moved but not counted scales every acceleration;
    if the pedestal's fraction of it differs, P/NP is biased by the same factor for every motion.

    Masses of the table are moved ones [kg]. Returns rows like ``ideal``, those of :func:`case_ratios` for the
    ideal model, with the factors ``pedestal_not_counted`` and ``table_not_counted`` and the table's mass as level.
    """
    parts = []
    for mass in table_masses:
        for factor in ("pedestal_not_counted", "table_not_counted"):
            bias = {}
            for object_name, stack in stacks.items():
                statue, pedestal = stack.upper.mass, stack.lower.mass
                counted = (mass + statue, mass + statue)
                if factor == "table_not_counted":
                    counted = (statue + pedestal, statue)
                moved = (mass + statue + pedestal, mass + statue)
                bias[object_name] = (moved[0] / counted[0]) / (moved[1] / counted[1])
            ratio = ideal["ratio"] * ideal["object"].map(bias)
            parts.append(ideal.assign(factor=factor, level=float(mass), ratio=ratio))
    return pd.concat(parts, ignore_index=True) if parts else ideal.iloc[:0]


def with_references(rows: pd.DataFrame, ideal: pd.DataFrame) -> pd.DataFrame:
    """Put the ideal model beside the levels of every factor, marked as the reference.

    The level of the reference is NaN-free text ``ideal``; other levels become text too, with a unit
    left to the factor's name.
    """
    parts = []
    for factor, part in rows.groupby("factor", sort=False):
        parts.append(ideal.assign(factor=factor, level=REFERENCE, reference=True))
        parts.append(part.assign(level=[f"{value:g}" for value in part["level"]]))
    return pd.concat(parts, ignore_index=True)
