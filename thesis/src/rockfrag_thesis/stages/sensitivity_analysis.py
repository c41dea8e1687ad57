"""The explanation study: which perturbed parameters of the ideal model could produce a pedestal effect."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.stages.job import Job, Results
from rockfrag.stages.tests import protocol_of
from rockfrag.study.study import Study
from rockfrag_thesis.settings import settings_of, tested_stacks

SIMULATED_PAIRS = 3
"""Closest pairs of perturbed parameters that are simulated together, since adding them up is an approximation."""


def run(job: Job[Study]) -> Results:
    """Yield the ratio P/NP for every perturbed parameter of the ideal model, and effects."""
    from rockfrag_thesis.sensitivity_analysis import friction_grid

    study, settings = job.study, settings_of(job.study)
    motions = job.motions("motions/floors")
    ratios, effects = _one_at_a_time(job, motions)
    yield "sensitivity_analysis/ratios", ratios
    yield "sensitivity_analysis/effects", effects
    found = None
    if tried := settings.friction:
        found = friction_grid.friction_ratios(
            tested_stacks(study),
            motions,
            protocol_of(study).amplitudes(),
            ground=tried["ground"],
            interface=tried["interface"],
            threads=job.threads,
        )
        yield "sensitivity_analysis/friction_ratios", found
        means = friction_grid.friction_effects(found, study.floors)
        yield "sensitivity_analysis/friction", means
    if settings.wanted_percent:
        inverse_problem = _inverse_problem(study, ratios, motions, job.threads, found)
        yield "sensitivity_analysis/inverse_problem", inverse_problem
    levels = effects[["factor", "level"]].drop_duplicates()
    job.log.info(
        "ratios: %d, levels: %d, factors: %d",
        len(ratios),
        len(levels),
        effects["factor"].nunique(),
    )


def _one_at_a_time(
    job: Job[Study], motions: Sequence[Motion]
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Simulate every level of every factor on the laboratory's own series of levels, and estimate effects.

    Returns ratios and effects. Ratios have one row per factor, level, object and motion: ``factor``, ``level``
    (text), ``reference``, ``object``, ``earthquake``, ``floor``, ``motion``, ``replicate``, ``p_g``, ``np_g``,
    ``ratio``. For effects see :func:`rockfrag_thesis.sensitivity_analysis.explain.explain`, levels in rising
    order; restitution once by each law, and judged only where these agree.
    """
    from rockfrag_thesis.sensitivity_analysis import explain, simulated

    study, threads = job.study, job.threads
    settings, stacks = settings_of(study).sensitivity_analysis, tested_stacks(study)
    ideal_cases = [simulated.ideal_case(name, stack) for name, stack in stacks.items()]
    rng = np.random.default_rng(study.seed)
    cases = list(ideal_cases)
    for name, stack in stacks.items():
        cases += simulated.factor_cases(name, stack, settings)
        cases += simulated.perturbed_cases(
            name,
            stack,
            tolerance=settings["tolerance_percent"] / 100,
            restitution=settings["tolerance_restitution"],
            replicates=settings["replicates"],
            rng=rng,
        )

    def progress(done: int) -> None:
        job.log.info("%d of at most %d bodies", done, 2 * len(cases))

    levels_g = protocol_of(study).amplitudes()
    rows = simulated.case_ratios(cases, motions, levels_g, threads, progress)
    ideal = rows[rows["factor"] == "ideal"]
    parts = [rows[rows["factor"] != "ideal"]]
    for step in settings["step_percent"]:
        other = protocol_of(study, step).amplitudes()
        table = simulated.case_ratios(ideal_cases, motions, other, threads)
        parts.append(table.assign(factor="step_percent", level=step))
    parts.append(simulated.mass_error_rows(ideal, stacks, settings["table_mass_kg"]))
    ratios = simulated.with_references(pd.concat(parts, ignore_index=True), ideal)
    effects = explain.where_laws_agree(explain.explain(ratios), simulated.LAW_OF)
    # levels of a factor as numbers, the reference first; factors stay as they are
    number = [
        -np.inf if level == simulated.REFERENCE else float(level)
        for level in effects["level"]
    ]
    ordered = effects.assign(number=number, place=pd.factorize(effects["factor"])[0])
    ordered = ordered.sort_values(["place", "number"], kind="stable", ignore_index=True)
    return ratios, ordered.drop(columns=["number", "place"])


def _inverse_problem(
    study: Study,
    ratios: pd.DataFrame,
    motions: Sequence[Motion],
    threads: int,
    friction: pd.DataFrame | None,
) -> pd.DataFrame:
    """Find what would give the wanted effect, and simulate the closest pairs of perturbed parameters together.

    Ratios are those of one parameter at a time, ``friction`` those of friction where it was tried.

    Returns the table of :func:`rockfrag_thesis.sensitivity_analysis.inverse_problem.invert` with
    ``simulated_ground`` and ``simulated_above``, the ratios when the two perturbed parameters act together in one
    simulation, for the closest pairs and for friction of both interfaces; the others have none.
    """
    from rockfrag.laws import law_names
    from rockfrag_thesis.sensitivity_analysis import inverse_problem, simulated

    percents = settings_of(study).wanted_percent
    wanted = {name: 1 + percent / 100 for name, percent in percents.items()}
    stacks = tested_stacks(study)
    neutral = dict(inverse_problem.NEUTRAL)
    widths = {stack.lower.width for stack in stacks.values()}
    if len(widths) == 1:
        neutral["pedestal_width_cm"] = 100 * widths.pop()
    step = float(np.log1p(study.protocol_step_percent / 100))
    # restitution by the first law; what it finds is judged beside the others
    other_laws = [
        factor for factor, (_, law) in simulated.LAW_OF.items() if law != law_names()[0]
    ]
    ratios = ratios[~ratios["factor"].isin(other_laws)]
    if friction is not None:
        by_friction = inverse_problem.friction_perturbations(friction)
        ratios = pd.concat([ratios, by_friction], ignore_index=True)
    table = inverse_problem.invert(ratios, wanted, study.floors, neutral, step)
    levels_g = protocol_of(study).amplitudes()
    for row in _of_both(table, simulated.PERTURBATIONS)[:SIMULATED_PAIRS]:
        perturbations = {
            str(table.loc[row, f"factor_{k}"]): float(table.loc[row, f"level_{k}"])
            for k in (1, 2)
        }
        try:
            cases = [
                simulated.perturbed_case(name, stack, perturbations)
                for name, stack in stacks.items()
            ]
        except InputError:
            # two perturbed parameters, each possible, may leave no body that stands
            continue
        found = simulated.case_ratios(cases, motions, levels_g, threads)
        _set_simulated(table, row, found, study.floors)
    if friction is not None:
        ground, interface = inverse_problem.FRICTION
        for row in _of_both(table, inverse_problem.FRICTION):
            level = {
                table.loc[row, f"factor_{k}"]: table.loc[row, f"level_{k}"]
                for k in (1, 2)
            }
            here = friction["ground"] == level[ground]
            here &= friction["interface"] == level[interface]
            _set_simulated(table, row, friction[here], study.floors)
    return table


def _of_both(table: pd.DataFrame, factors: Sequence[str]) -> Any:
    """Rows of pairs of perturbed parameters that are both among some."""
    return table.index[
        table["factor_1"].isin(factors) & table["factor_2"].isin(factors)
    ]


def _set_simulated(
    table: pd.DataFrame, row: int, found: pd.DataFrame, floors: Mapping[str, int]
) -> None:
    """Enter the mean ratios of simulated pairs of tests, over earthquakes, into a row of the inverse problem."""
    ground = found["floor"].map(floors).fillna(0) == 0
    for place, here in (("ground", ground), ("above", ~ground)):
        mean = (
            np.log(found.loc[here, "ratio"]).groupby(found["earthquake"]).mean().mean()
        )
        table.loc[row, f"simulated_{place}"] = np.exp(mean)
