"""A page in which one body rocks under one record: the live simulation alone."""

import os
from collections.abc import Sequence
from importlib.metadata import version

from rockfrag.errors import InputError
from rockfrag.files import write_text
from rockfrag.records.motion import Motion
from rockfrag.report.live import AMPLITUDES_G, live_kernel, swept
from rockfrag.report.page import render
from rockfrag.report.part import Answer, Finding
from rockfrag.report.wording import counted, number, sentence
from rockfrag.rocking import simulate
from rockfrag.rocking.browser import in_page
from rockfrag.system.blocks import SystemLike, as_system
from rockfrag.system.system import System
from rockfrag.units import GRAVITY

_STEP = 100 * (AMPLITUDES_G[1] / AMPLITUDES_G[0] - 1)

MOST_SAMPLES = 20_000
"""Samples of a record for which the page stays below 400 kB."""


def write_play_page(body: SystemLike, motion: Motion, path: str | os.PathLike[str]) -> None:
    """Write the page of at most two blocks that rock under a motion of at most ``MOST_SAMPLES``."""
    system = as_system(body)
    if not in_page(system):
        raise InputError(
            "--pedestal: a page simulates two bodies on each other at most; rockfrag simulate takes more."
        )
    samples = motion.acceleration.size
    if samples > MOST_SAMPLES:
        raise InputError(
            f"{motion.name}: {samples} samples are more than the {MOST_SAMPLES} that a page carries; cut the "
            "record or give it a longer sampling interval."
        )
    if motion.pga <= 0:
        raise InputError(f"{motion.name}: the record is zero throughout, so nothing would rock.")
    sizes = [f"{100 * body.width:.3g} × {100 * body.height:.3g} cm" for body in system.bodies]
    name = " on ".join(reversed(sizes))
    outcomes = swept({name: system}, [motion])
    page = render(
        title=f"{name} under {motion.name}",
        lead=f"{counted(samples, 'sample')} of {motion.dt:.4g} s, as recorded with a peak of "
        f"{number(motion.pga / GRAVITY, 3)} g.",
        answer=Answer(
            asked="How strong must this motion be to overturn it?",
            sentences=[_strength(outcomes["overturned"].tolist()), _recorded(system, motion)],
        ),
        sections=[],
        pictures={},
        provenance={
            "Record": motion.name,
            "Body": repr(body),
            "Source": f"rockfrag {version('rockfrag')}",
        },
        live=live_kernel({name: system}, [motion]),
    )
    write_text(page, path)


def _strength(fell: Sequence[bool]) -> Finding:
    """Say which of the amplitudes tried overturn."""
    outcomes = list(fell)
    tried = f"amplitudes from {AMPLITUDES_G[0]:g} to {AMPLITUDES_G[-1]:g} g, {_STEP:.1f} % apart"
    if not any(outcomes):
        return Finding("It does not overturn", f"It survives all {tried}.")
    first = outcomes.index(True)
    later = len(outcomes) - first - sum(outcomes[first:])
    resurrections = (
        f" {later} stronger {'one is' if later == 1 else 'ones are'} survived again: the response is not monotone."
        if later
        else " All stronger ones overturn it too."
    )
    return Finding(
        f"It first overturns at a peak of {number(AMPLITUDES_G[first], 3)} g",
        f"{sentence(tried)} were tried.{resurrections}",
    )


def _recorded(system: System, motion: Motion) -> Finding:
    """Say what the motion does as it was recorded."""
    response = simulate(system, motion)
    words = "overturns it" if response.overturned else "does not overturn it"
    return Finding(
        f"The motion as recorded {words}",
        f"It has {counted(response.impacts, 'impact')} before."
        if response.overturned
        else f"It rocks with {counted(response.impacts, 'impact')}.",
    )
