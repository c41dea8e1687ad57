"""The explanation study: which departures from the ideal model could produce a pedestal effect."""

from collections.abc import Callable, Sequence
from dataclasses import asdict

import numpy as np
import pandas as pd

from rockfrag.records.motion import Motion
from rockfrag.rocking.bodies import Stack
from rockfrag.stages.protocol import protocol_of
from rockfrag.stages.stage import Job, Results, Stage
from rockfrag.study.study import Study


def run(job: Job[Study]) -> Results:
    """Yield the ratio P/NP for every departure from the ideal model, and effects."""
    ratios, effects = explanation_tables(
        job.study,
        job.motions("motions/floors"),
        job.threads,
        lambda done, of: job.log.info("%d of at most %d bodies", done, of),
    )
    yield "explanation/ratios", ratios
    yield "explanation/effects", effects
    levels = effects[["factor", "level"]].drop_duplicates()
    job.log.info(
        "%d ratios at %d levels of %d factors",
        len(ratios),
        len(levels),
        effects["factor"].nunique(),
    )


def explanation_tables(
    study: Study,
    motions: Sequence[Motion],
    threads: int = 1,
    progress: Callable[[int, int], None] = lambda done, of: None,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Simulate every level of every factor on the laboratory's own ladder, and estimate effects.

    Parameters
    ----------
    study
        A study with pairs and the key ``explanation``.
    motions
        Motions that shake the bodies.
    threads
        Threads to use; the result does not depend on it.
    progress
        Called with bodies done and bodies to do.

    Returns
    -------
    ratios
        One row per factor, level, object and motion: ``factor``, ``level`` (text), ``reference``,
        ``object``, ``event``, ``floor``, ``motion``, ``replicate``, ``p_g``, ``np_g``, ``ratio``.
    effects
        See :func:`rockfrag.pedestal.explanation.explain`, levels in rising order.
    """
    from rockfrag.pedestal.explanation import explain
    from rockfrag.pedestal.simulated_explanation import (
        Case,
        case_ratios,
        factor_cases,
        mass_error_rows,
        perturbed_cases,
        with_references,
    )

    settings = study.more.explanation
    if settings is None:
        raise ValueError("the study asks for no explanation")
    stacks = tested_stacks(study)
    ideal_cases = [
        Case("ideal", 0.0, object_name, s.statue, s) for object_name, s in stacks.items()
    ]
    rng = np.random.default_rng(study.seed)
    cases = list(ideal_cases)
    for object_name, stack in stacks.items():
        cases += factor_cases(object_name, stack, asdict(settings))
        cases += perturbed_cases(
            object_name,
            stack,
            settings.tolerance_percent / 100,
            settings.tolerance_restitution,
            settings.replicates,
            rng,
        )
    ladder = protocol_of(study).amplitudes()
    of = len(cases)
    rows = case_ratios(cases, motions, ladder, threads, lambda done: progress(done, 2 * of))
    ideal = rows[rows["factor"] == "ideal"]
    parts = [rows[rows["factor"] != "ideal"]]
    for step in settings.step_percent:
        other = protocol_of(study, step).amplitudes()
        table = case_ratios(ideal_cases, motions, other, threads)
        parts.append(table.assign(factor="step_percent", level=step))
    parts.append(mass_error_rows(ideal, stacks, settings.table_mass_kg))
    ratios = with_references(pd.concat(parts, ignore_index=True), ideal)
    return ratios, _in_order(explain(ratios))


def tested_stacks(study: Study) -> dict[str, Stack]:
    """Stack of each object that is tested with and without a pedestal; of several the first."""
    lone = {one.object for one in study.configurations if one.label == "NP"}
    stacks: dict[str, Stack] = {}
    for one in study.configurations:
        if isinstance(one.body, Stack) and one.object in lone:
            stacks.setdefault(one.object, one.body)
    return stacks


def _in_order(effects: pd.DataFrame) -> pd.DataFrame:
    """Sort the levels of a factor as numbers, the reference first; factors stay as they are."""
    from rockfrag.pedestal.simulated_explanation import REFERENCE

    number = [-np.inf if level == REFERENCE else float(level) for level in effects["level"]]
    table = effects.assign(number=number, place=pd.factorize(effects["factor"])[0])
    table = table.sort_values(["place", "number"], kind="stable", ignore_index=True)
    return table.drop(columns=["number", "place"])


STAGE = Stage(
    name="explanation",
    run=run,
    wanted=lambda study: study.more.explanation is not None,
    inputs=("motions/floors.parquet",),
    files=lambda study: study.body_files,
    outputs=("explanation/ratios", "explanation/effects"),
    settings=("explanation", "bodies", "amplitudes", "protocol", "seed"),
    parallel=True,
)
