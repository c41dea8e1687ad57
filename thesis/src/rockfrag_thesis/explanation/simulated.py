"""Ratios P/NP simulated with one factor at a time away from the ideal model.

What is varied: restitution of both interfaces, imperfections, the pedestal's width, mass that was not
counted, the protocol's step, and all tolerances at once in perturbed copies.  The table that results is
what :func:`rockfrag_thesis.explanation.explain.explain` takes.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import radians

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.motions.scaling import factors_to_pga
from rockfrag.records.motion import Motion
from rockfrag.rocking import overturns
from rockfrag.rocking.measured_restitution import LAWS, Law, MeasuredRestitution, Restitution
from rockfrag.system.blocks import Block, Body, Stack
from rockfrag_thesis.explanation.mass_bias import ratio_bias

Floats = NDArray[np.float64]

BATCH = 64
"""Bodies that are shaken at a time, between two lines of progress."""

RUNGS = 8
"""Rungs of a ladder that are climbed at a time: whatever has fallen climbs no further."""

REFERENCE = "ideal"
LARGEST_RESTITUTION = 0.995


@dataclass(frozen=True)
class Case:
    """An object with and without its pedestal at one level of one factor.

    Attributes
    ----------
    factor, level, object, replicate
        What differs, how much, of which object, and the number of the perturbed copy.
    lone, stack
        Bodies without and with the pedestal.
    lone_restitution, stack_restitution
        As :func:`rockfrag.rocking.overturns` takes them; None conserves momentum.
    """

    factor: str
    level: float
    object: str
    lone: Block
    stack: Stack
    lone_restitution: Restitution = None
    stack_restitution: Restitution = None
    replicate: int = 0


def factor_cases(
    object_name: str, stack: Stack, levels: Mapping[str, Sequence[float]]
) -> list[Case]:
    """One case per level of each mechanical factor.

    Parameters
    ----------
    object
        Its name.
    stack
        The ideal stack; its statue is the lone object.
    levels
        Any of ``statue_restitution``, ``interface_restitution``, ``ground_restitution`` (factors on
        the restitution that conserves momentum; once by each law that differs, see `LAW_OF`),
        ``pedestal_lean_deg``, ``statue_offset_mm``, ``statue_cg_offset_mm``, ``pedestal_width_cm``; others
        are left alone.

    Raises
    ------
    InputError
        If a body cannot stand or a restitution would add energy; factor and level are named.
    """
    cases = []
    for factor in DEPARTURES:
        base, law = LAW_OF.get(factor, (factor, LAWS[0]))
        for level in levels.get(base, ()):
            # below what momentum leaves, the law of the couple is that of position
            if law != "couple" or level > 1:
                cases.append(departed_case(object_name, stack, {factor: level}))
    return cases


def departed_case(object_name: str, stack: Stack, departures: Mapping[str, float]) -> Case:
    """Object with and without its pedestal where one or more factors depart from the ideal together.

    Parameters
    ----------
    object_name
        Its name.
    stack
        The ideal stack; its statue is the lone object.
    departures
        Level by factor, of `DEPARTURES`.

    Raises
    ------
    InputError
        If a body cannot stand or a restitution would add energy; factor and level are named.
    """
    setup = Setup(stack.statue, stack)
    for factor, change in DEPARTURES.items():
        if factor not in departures:
            continue
        level = departures[factor]
        try:
            setup = change(setup, level)
        except InputError as error:
            raise InputError(f"explanation.{factor}, {level:g}, {object_name}: {error}") from error
    names = [name for name in DEPARTURES if name in departures]
    return Case(
        " + ".join(names),
        float(departures[names[0]]),
        object_name,
        setup.lone,
        setup.stack,
        setup.alone,
        None
        if setup.ground is None and setup.interface is None
        else MeasuredRestitution((setup.ground, setup.interface), setup.law),
    )


@dataclass(frozen=True)
class Setup:
    """What stands on the table; restitutions of the lone object, the pedestal, the interface; their law."""

    lone: Block
    stack: Stack
    alone: float | None = None
    ground: float | None = None
    interface: float | None = None
    law: Law = LAWS[0]


def _restitution(block: Block, factor: float) -> float:
    value = factor * block.momentum_restitution()
    if not 0 < value < 1:
        raise InputError(
            f"a restitution of {factor:g} times {block.momentum_restitution():.3f} would be "
            f"{value:.3f}; choose a factor that keeps it between 0 and 1."
        )
    return value


def _statue_restitution(setup: Setup, factor: float) -> Setup:
    value = _restitution(setup.lone, factor)
    return replace(setup, alone=value, interface=value)


def _interface_restitution(setup: Setup, factor: float) -> Setup:
    return replace(setup, interface=_restitution(setup.stack.statue, factor))


def _ground_restitution(setup: Setup, factor: float) -> Setup:
    return replace(setup, ground=_restitution(setup.stack.pedestal, factor))


def _pedestal_lean(setup: Setup, degrees: float) -> Setup:
    leaning = replace(setup.stack.pedestal, lean=setup.stack.pedestal.lean + radians(degrees))
    return replace(setup, stack=replace(setup.stack, pedestal=leaning))


def _statue_offset(setup: Setup, millimetres: float) -> Setup:
    offset = setup.stack.offset + millimetres / 1000
    return replace(setup, stack=replace(setup.stack, offset=offset))


def _statue_cg_offset(setup: Setup, millimetres: float) -> Setup:
    statue = replace(setup.lone, cg_offset=setup.lone.cg_offset + millimetres / 1000)
    return replace(setup, lone=statue, stack=replace(setup.stack, statue=statue))


def _pedestal_width(setup: Setup, centimetres: float) -> Setup:
    # of the same material and depth; the inertia follows from the shape
    ideal = setup.stack.pedestal
    width = centimetres / 100
    pedestal = replace(ideal, width=width, mass=ideal.mass * width / ideal.width, inertia=None)
    return replace(setup, stack=replace(setup.stack, pedestal=pedestal))


Change = Callable[[Setup, float], Setup]
"""What a level of a factor does to what stands on the table."""

_RESTITUTIONS: Mapping[str, Change] = {
    "statue_restitution": _statue_restitution,
    "interface_restitution": _interface_restitution,
    "ground_restitution": _ground_restitution,
}

LAW_OF: Mapping[str, tuple[str, Law]] = {
    name if law == LAWS[0] else f"{name}_{law}": (name, law)
    for name in _RESTITUTIONS
    for law in LAWS
}
"""What a factor of restitution varies, and the law by which stacks follow it."""


def _by_law(factor: str) -> Change:
    base, law = LAW_OF[factor]
    return lambda setup, level: replace(_RESTITUTIONS[base](setup, level), law=law)


DEPARTURES: Mapping[str, Change] = {
    # shapes before restitutions, which are factors on what the shapes give
    "pedestal_lean_deg": _pedestal_lean,
    "statue_offset_mm": _statue_offset,
    "statue_cg_offset_mm": _statue_cg_offset,
    "pedestal_width_cm": _pedestal_width,
    **{factor: _by_law(factor) for factor in LAW_OF},
}
"""How each mechanical factor changes what stands on the table, by its name."""


def perturbed_cases(
    object_name: str,
    stack: Stack,
    tolerance: float,
    restitution: float,
    replicates: int,
    rng: np.random.Generator,
) -> list[Case]:
    """Copies with tolerances; the two sides of a pair are drawn apart, as in separate tests.

    Parameters
    ----------
    tolerance
        Standard deviation of every width and height, relative [-].
    restitution
        Standard deviation of every restitution [-].
    replicates
        Number of copies.
    rng
        Source of the random numbers.
    """
    cases = []
    for number in range(1, replicates + 1):
        lone, pedestal, statue = (
            _perturbed(block, tolerance, rng)
            for block in (stack.statue, stack.pedestal, stack.statue)
        )
        values = [
            float(np.clip(b.momentum_restitution() + restitution * z, 0.01, LARGEST_RESTITUTION))
            for b, z in zip((lone, pedestal, statue), rng.standard_normal(3), strict=True)
        ]
        both = (values[1], values[2])
        level = 100 * tolerance
        copy = Stack(pedestal, statue, stack.offset)
        cases.append(Case("tolerances", level, object_name, lone, copy, values[0], both, number))
    return cases


def _perturbed(block: Block, tolerance: float, rng: np.random.Generator) -> Block:
    across, up = np.exp(tolerance * rng.standard_normal(2))
    height = None if block.cg_height is None else block.cg_height * float(up)
    width = block.width * float(across)
    return replace(block, width=width, height=block.height * float(up), cg_height=height)


def ladder_amplitudes(
    bodies: Sequence[Body],
    restitution: Sequence[Restitution],
    motions: Sequence[Motion],
    ladder_g: Floats,
    threads: int = 1,
) -> Floats:
    """Largest amplitude survived before the first overturning, climbing a ladder from rest.

    Parameters
    ----------
    bodies, restitution
        What stands on the table.
    motions
        Motions of the table.
    ladder_g
        Amplitudes, rising [g].
    threads
        Threads to use; the result does not depend on it.

    Returns
    -------
    Amplitudes [g], shape (bodies, motions); NaN where nothing or everything was survived.
    """
    scales = np.array([factors_to_pga(motion, ladder_g) for motion in motions])
    fell = np.zeros((len(bodies), *scales.shape), dtype=bool)
    for rungs in np.array_split(np.arange(len(ladder_g)), np.arange(RUNGS, len(ladder_g), RUNGS)):
        climbing = np.logical_not(fell.any(axis=2))
        here, under = np.flatnonzero(climbing.any(axis=1)), np.flatnonzero(climbing.any(axis=0))
        if not here.size:
            break
        found = overturns(
            [bodies[i] for i in here.tolist()],
            [motions[j].acceleration for j in under.tolist()],
            [motions[j].dt for j in under.tolist()],
            scales[np.ix_(under, rungs)],
            restitution=[restitution[i] for i in here.tolist()],
            threads=threads,
        ).overturned
        # a pair that has fallen already has its first fall below
        fell[np.ix_(here, under, rungs)] = found
    first = fell.argmax(axis=2)
    known = fell.any(axis=2) & (first > 0)
    return np.where(known, ladder_g[np.maximum(first - 1, 0)], np.nan)


def case_ratios(
    cases: Sequence[Case],
    motions: Sequence[Motion],
    ladder_g: Floats,
    threads: int = 1,
    progress: Callable[[int], None] = lambda done: None,
) -> pd.DataFrame:
    """Ratio P/NP of every case under every motion.

    Parameters
    ----------
    cases
        What is tested.
    motions, ladder_g, threads
        As of :func:`ladder_amplitudes`.
    progress
        Called with the number of bodies done.

    Returns
    -------
    One row per case and motion: ``factor``, ``level``, ``reference`` (False), ``object``, ``event``,
    ``floor``, ``motion``, ``replicate``, ``p_g``, ``np_g`` (amplitudes [g]), ``ratio``,
    ``resolution`` (half-width to which its logarithm is known, a step of the ladder [-]).
    """
    wanted: dict[tuple[Body, Restitution], int] = {}
    for case in cases:
        for key in _keys(case):
            wanted.setdefault(key, len(wanted))
    order = list(wanted)
    parts = []
    for first in range(0, len(order), BATCH):
        batch = order[first : first + BATCH]
        bodies, values = [body for body, _ in batch], [value for _, value in batch]
        parts.append(ladder_amplitudes(bodies, values, motions, ladder_g, threads))
        progress(first + len(batch))
    amplitudes = np.concatenate(parts)
    tables = []
    for case in cases:
        lone, stack = (amplitudes[wanted[key]] for key in _keys(case))
        tables.append(_rows(case, motions, stack, lone))
    step = float(np.log(ladder_g[1] / ladder_g[0])) if len(ladder_g) > 1 else 0.0
    return pd.concat(tables, ignore_index=True).assign(resolution=step)


def _keys(case: Case) -> Iterator[tuple[Body, Restitution]]:
    yield case.lone, case.lone_restitution
    yield case.stack, case.stack_restitution


def _rows(case: Case, motions: Sequence[Motion], stack: Floats, lone: Floats) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "factor": case.factor,
            "level": case.level,
            "reference": False,
            "object": case.object,
            "event": [str(one.metadata.get("event") or one.name) for one in motions],
            "floor": [str(one.metadata.get("floor") or "ground") for one in motions],
            "motion": [one.name for one in motions],
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

    Parameters
    ----------
    ideal
        Rows of :func:`case_ratios` for the ideal model.
    stacks
        Stacks by object.
    table_masses
        Moved masses of the table [kg].

    Returns
    -------
    Rows like ``ideal`` with the factors ``pedestal_not_counted`` and ``table_not_counted`` and the
    table's mass as level; see :mod:`rockfrag_thesis.explanation.mass_bias`.
    """
    parts = []
    for mass in table_masses:
        for factor in ("pedestal_not_counted", "table_not_counted"):
            bias = {}
            for object_name, stack in stacks.items():
                statue, pedestal = stack.statue.mass, stack.pedestal.mass
                counted = (
                    (mass + statue, mass + statue)
                    if factor == "pedestal_not_counted"
                    else (statue + pedestal, statue)
                )
                bias[object_name] = ratio_bias(
                    statue, pedestal, mass, counted_with=counted[0], counted_without=counted[1]
                )
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
