"""Page on which one body rocks under one record: the live simulation alone.

In: a body and a motion of one or two horizontal components. Out: one HTML file with the kernel as WebAssembly;
peaks [g]. Docs: ``docs/report.md``, "The simulation in the page".
"""

import os
from collections.abc import Sequence
from importlib.metadata import version

import numpy as np

from rockfrag.base.errors import InputError
from rockfrag.base.files import write_text
from rockfrag.base.units import GRAVITY
from rockfrag.engines.contract import Request, Support, Wish, wishes
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.live import AMPLITUDES_G, live_kernel
from rockfrag.report.live import live_space as space
from rockfrag.report.page import Page
from rockfrag.report.part import Answer, Finding
from rockfrag.simulation import overturns
from rockfrag.system.blocks import SystemLike, as_system
from rockfrag.system.body import Circle, RigidBody
from rockfrag.system.system import System
from rockfrag.web import in_page
from rockfrag.words.sentences import counted, listed, number, sentence

IN_SPACE = frozenset({Wish.SPACE, Wish.VERTICAL, Wish.HISTORY})
"""What a page's simulation in space knows beside the body itself."""

MOST_SAMPLES = 20_000
"""Times of a record for which the page stays below 400 kB, and below 700 kB with two components."""


def write_play_page(
    body: SystemLike, motion: Motion | GroundMotion, path: str | os.PathLike[str]
) -> None:
    """Write the page of a body that rocks under a motion of at most ``MOST_SAMPLES``.

    It is at most two blocks under one component, or a body in space under both, that nothing holds.

    Parameters
    ----------
    body, motion : what rocks, and what shakes it
    path : file to write

    Raises
    ------
    InputError
        If the simulation in a page does not know what rocks.
    """
    system = as_system(body)
    _check_known(system, motion)
    samples = _samples(motion)
    name = " on ".join(reversed([_sizes(each) for each in system.bodies]))
    if isinstance(motion, GroundMotion):
        amplitudes, peak = np.array(space.AMPLITUDES_G), space.peak_of(motion)
        live = space.live_in_space({name: space.Standing(system)}, [motion])
        rests_on = [
            "A peak is the geometric mean of those of both components; nothing slides."
        ]
    else:
        amplitudes, peak, rests_on = np.array(AMPLITUDES_G), motion.pga, []
        live = live_kernel({name: system}, [motion])
    # at every amplitude, and last as recorded
    found = overturns(
        [system], [motion], scales=np.append(amplitudes * GRAVITY / peak, 1.0)
    )
    *fell, recorded = found.overturned.ravel().tolist()
    page = Page(
        title=f"{name} under {motion.name}",
        lead=(
            f"{counted(samples, 'sample')} of {motion.dt:.4g} s, as recorded with a peak of "
            f"{number(peak / GRAVITY, 3)} g."
        ),
        answer=Answer(
            asked="How strong must this motion be to overturn it?",
            sentences=[
                _strength(amplitudes.tolist(), fell),
                _recorded(recorded, int(found.impacts.flat[-1])),
            ],
            rests_on=rests_on,
        ),
        provenance={
            "Record": motion.name,
            "Body": repr(body),
            "Source": f"rockfrag {version('rockfrag')}",
        },
        live=live,
    )
    write_text(page.html(), path)


def _check_known(system: System, motion: Motion | GroundMotion) -> None:
    """Refuse what the simulation in a page does not know: it would show another body than the sentences are of."""
    found = in_page(system)
    if isinstance(motion, GroundMotion):
        wanted = wishes(system, motion, Request(history=True))
        found = Support(wanted - IN_SPACE)
    if found:
        return
    if Wish.MANY_BODIES in found.missing:
        raise InputError(
            "--pedestal: a page simulates two bodies on each other at most; rockfrag simulate takes more."
        )
    # of a body that stands as no page knows it no wish is missing
    named = listed([wish.value for wish in Wish if wish in found.missing])
    known = "a page does not simulate that; leave it out, or use rockfrag simulate."
    raise InputError(f"body: {found.reason or f'it has {named}'}, and {known}")


def _samples(motion: Motion | GroundMotion) -> int:
    """Count the times of a motion that a page can show."""
    both = (motion.x, motion.y) if isinstance(motion, GroundMotion) else (motion,)
    for component in both:
        if component is not None and component.pga <= 0:
            raise InputError(
                f"{component.name}: the record is zero throughout, so there is nothing to scale."
            )
    samples = both[0].acceleration.size
    if samples > MOST_SAMPLES:
        raise InputError(
            f"{motion.name}: {samples} samples are more than the {MOST_SAMPLES} that a page carries; cut the "
            "record or give it a longer sampling interval."
        )
    return samples


def _sizes(body: RigidBody) -> str:
    """Width, depth of a body in space, and height."""
    sides = [body.width, body.height]
    if not body.planar and not isinstance(body.base, Circle):
        sides.insert(1, body.seen_along(90.0).width)
    before = "round, " if isinstance(body.base, Circle) else ""
    return f"{before}{' × '.join(f'{100 * side:.3g}' for side in sides)} cm"


def _strength(amplitudes: Sequence[float], fell: Sequence[bool]) -> Finding:
    """Amplitudes tried [g] that overturn."""
    apart = 100 * (amplitudes[1] / amplitudes[0] - 1)
    tried = f"amplitudes from {amplitudes[0]:g} to {amplitudes[-1]:g} g, {apart:.1f} % apart"
    if not any(fell):
        return Finding("It does not overturn", f"It survives all {tried}.")
    first = fell.index(True)
    later = len(fell) - first - sum(fell[first:])
    others = "All stronger ones overturn it too."
    if later:
        ones = "one is" if later == 1 else "ones are"
        others = (
            f"{later} stronger {ones} survived again: the response is not monotone."
        )
    return Finding(
        f"It first overturns at a peak of {number(amplitudes[first], 3)} g",
        f"{sentence(tried)} were tried. {others}",
    )


def _recorded(overturned: bool, impacts: int) -> Finding:
    """Outcome of the motion as recorded."""
    if overturned:
        return Finding(
            "The motion as recorded overturns it",
            f"It has {counted(impacts, 'impact')} before its fall is certain.",
        )
    return Finding(
        "The motion as recorded does not overturn it",
        f"It rocks with {counted(impacts, 'impact')}.",
    )
