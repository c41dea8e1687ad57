"""The explanation study: which perturbed parameters of the ideal model could produce a pedestal effect."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.stages.job import Job, Results
from rockfrag.stages.tests import protocol_of
from rockfrag.study.study import Study
from rockfrag.system.blocks import Stack
from rockfrag_thesis.settings import settings_of, stacks_of

SIMULATED_PAIRS = 3
"""Closest pairs of perturbed parameters that are simulated together, since adding them up is an approximation."""


def run(job: Job[Study]) -> Results:
    """Yield the ratio P/NP for every perturbed parameter of the ideal model, and effects."""
    settings, motions = settings_of(job.study), job.motions("motions/floors")
    ratios, effects = sensitivity_analysis_tables(
        job.study,
        motions,
        job.threads,
        lambda done, of: job.log.info("%d of at most %d bodies", done, of),
    )
    yield "sensitivity_analysis/ratios", ratios
    yield "sensitivity_analysis/effects", effects
    found = None
    if settings.friction:
        found, means = friction_tables(job.study, motions, job.threads)
        yield "sensitivity_analysis/friction_ratios", found
        yield "sensitivity_analysis/friction", means
    if settings.wanted_percent:
        yield (
            "sensitivity_analysis/inverse_problem",
            inverse_problem_table(job.study, ratios, motions, job.threads, found),
        )
    levels = effects[["factor", "level"]].drop_duplicates()
    job.log.info(
        "ratios: %d, levels: %d, factors: %d", len(ratios), len(levels), effects["factor"].nunique()
    )


def sensitivity_analysis_tables(
    study: Study,
    motions: Sequence[Motion],
    threads: int = 1,
    progress: Callable[[int, int], None] = lambda done, of: None,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Simulate every level of every factor on the laboratory's own series of levels, and estimate effects.

    ``progress`` is called with bodies done and bodies to do.

    Returns ratios and effects. Ratios have one row per factor, level, object and motion: ``factor``, ``level``
    (text), ``reference``, ``object``, ``earthquake``, ``floor``, ``motion``, ``replicate``, ``p_g``, ``np_g``,
    ``ratio``. For effects see :func:`rockfrag_thesis.sensitivity_analysis.explain.explain`, levels in rising
    order; restitution once by each law, and judged only where these agree.
    """
    from rockfrag_thesis.sensitivity_analysis.explain import explain, where_laws_agree
    from rockfrag_thesis.sensitivity_analysis.simulated import (
        LAW_OF,
        case_ratios,
        factor_cases,
        ideal_case,
        mass_error_rows,
        perturbed_cases,
        with_references,
    )

    settings = settings_of(study).sensitivity_analysis
    stacks = tested_stacks(study)
    ideal_cases = [ideal_case(object_name, stack) for object_name, stack in stacks.items()]
    rng = np.random.default_rng(study.seed)
    cases = list(ideal_cases)
    for object_name, stack in stacks.items():
        cases += factor_cases(object_name, stack, settings)
        spread = (settings["tolerance_percent"] / 100, settings["tolerance_restitution"])
        cases += perturbed_cases(object_name, stack, *spread, settings["replicates"], rng)
    intensity_levels = protocol_of(study).amplitudes()
    of = len(cases)
    rows = case_ratios(
        cases, motions, intensity_levels, threads, lambda done: progress(done, 2 * of)
    )
    ideal = rows[rows["factor"] == "ideal"]
    parts = [rows[rows["factor"] != "ideal"]]
    for step in settings["step_percent"]:
        other = protocol_of(study, step).amplitudes()
        table = case_ratios(ideal_cases, motions, other, threads)
        parts.append(table.assign(factor="step_percent", level=step))
    parts.append(mass_error_rows(ideal, stacks, settings["table_mass_kg"]))
    ratios = with_references(pd.concat(parts, ignore_index=True), ideal)
    return ratios, _in_order(where_laws_agree(explain(ratios), LAW_OF))


def friction_tables(
    study: Study, motions: Sequence[Motion], threads: int = 1
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Climb the laboratory's series of levels on surfaces of every friction that the study asks for.

    Returns tables of :func:`rockfrag_thesis.sensitivity_analysis.friction_grid.friction_ratios` and
    ``friction_effects``.
    """
    from rockfrag_thesis.sensitivity_analysis.friction_grid import friction_effects, friction_ratios

    tried = settings_of(study).friction
    ratios = friction_ratios(
        tested_stacks(study),
        motions,
        protocol_of(study).amplitudes(),
        tried["ground"],
        tried["interface"],
        threads,
    )
    return ratios, friction_effects(ratios, study.floors)


def inverse_problem_table(
    study: Study,
    ratios: pd.DataFrame,
    motions: Sequence[Motion],
    threads: int = 1,
    friction: pd.DataFrame | None = None,
) -> pd.DataFrame:
    """Find what would give the wanted effect, and simulate the closest pairs of perturbed parameters together.

    Ratios are as of :func:`sensitivity_analysis_tables`, ``friction`` those of friction where it was tried.

    Returns the table of :func:`rockfrag_thesis.sensitivity_analysis.inverse_problem.invert` with
    ``simulated_ground`` and ``simulated_above``, the ratios when the two perturbed parameters act together in one
    simulation, for the closest pairs and for friction of both interfaces; the others have none.
    """
    from rockfrag.laws import law_names
    from rockfrag_thesis.sensitivity_analysis.inverse_problem import (
        FRICTION,
        NEUTRAL,
        friction_perturbations,
        invert,
    )
    from rockfrag_thesis.sensitivity_analysis.simulated import (
        LAW_OF,
        PERTURBATIONS,
        case_ratios,
        perturbed_case,
    )

    percents = settings_of(study).wanted_percent
    wanted = {name: 1 + percent / 100 for name, percent in percents.items()}
    stacks = tested_stacks(study)
    neutral = dict(NEUTRAL)
    widths = {stack.lower.width for stack in stacks.values()}
    if len(widths) == 1:
        neutral["pedestal_width_cm"] = 100 * widths.pop()
    step = float(np.log1p(study.protocol_step_percent / 100))
    # restitution by the first law; what it finds is judged beside the others
    other_laws = [factor for factor, (_, law) in LAW_OF.items() if law != law_names()[0]]
    ratios = ratios[~ratios["factor"].isin(other_laws)]
    if friction is not None:
        ratios = pd.concat([ratios, friction_perturbations(friction)], ignore_index=True)
    table = invert(ratios, wanted, study.floors, neutral, step)
    together = table[table["factor_1"].isin(PERTURBATIONS) & table["factor_2"].isin(PERTURBATIONS)]
    intensity_levels = protocol_of(study).amplitudes()
    for row in together.index[:SIMULATED_PAIRS]:
        perturbations = {
            str(table.loc[row, f"factor_{k}"]): float(table.loc[row, f"level_{k}"]) for k in (1, 2)
        }
        try:
            cases = [perturbed_case(name, stack, perturbations) for name, stack in stacks.items()]
        except InputError:
            # two perturbed parameters, each possible, may leave no body that stands
            continue
        found = case_ratios(cases, motions, intensity_levels, threads)
        _set_simulated(table, row, found, study.floors)
    if friction is not None:
        both = table["factor_1"].isin(FRICTION) & table["factor_2"].isin(FRICTION)
        for row in table.index[both]:
            level = {table.loc[row, f"factor_{k}"]: table.loc[row, f"level_{k}"] for k in (1, 2)}
            here = [
                friction[n] == level[f]
                for f, n in zip(FRICTION, ("ground", "interface"), strict=True)
            ]
            _set_simulated(table, row, friction[here[0] & here[1]], study.floors)
    return table


def _set_simulated(
    table: pd.DataFrame, row: int, found: pd.DataFrame, floors: Mapping[str, int]
) -> None:
    """Enter the mean ratios of simulated pairs of tests, over earthquakes, into a row of the inverse problem."""
    ground = found["floor"].map(floors).fillna(0) == 0
    for place, here in (("ground", ground), ("above", ~ground)):
        mean = np.log(found.loc[here, "ratio"]).groupby(found["earthquake"]).mean().mean()
        table.loc[row, f"simulated_{place}"] = np.exp(mean)


def tested_stacks(study: Study) -> dict[str, Stack]:
    """Stack of each object that is tested with and without a pedestal; of several the first."""
    lone = {
        configuration.names[-1]
        for configuration in study.configurations
        if configuration.count == 1
    }
    stacks: dict[str, Stack] = {}
    for configuration in study.configurations:
        if configuration.count == 2 and configuration.names[-1] in lone:
            stacks.setdefault(configuration.names[-1], stacks_of(study)[configuration.name])
    return stacks


def _in_order(effects: pd.DataFrame) -> pd.DataFrame:
    """Sort the levels of a factor as numbers, the reference first; factors stay as they are."""
    from rockfrag_thesis.sensitivity_analysis.simulated import REFERENCE

    number = [-np.inf if level == REFERENCE else float(level) for level in effects["level"]]
    table = effects.assign(number=number, place=pd.factorize(effects["factor"])[0])
    table = table.sort_values(["place", "number"], kind="stable", ignore_index=True)
    return table.drop(columns=["number", "place"])
