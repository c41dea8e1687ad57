"""Many bodies × motions × amplitudes at once.

In: systems, motions [m/s²] and scales [-]. Out: :class:`rockfrag.outcomes.Outcomes`. Theory: ``docs/rocking.md``,
``docs/definitions.md``; who answers: :mod:`rockfrag.engines.contract`.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import TypedDict, Unpack

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from rockfrag.base.arrays import Floats
from rockfrag.base.input_checks import (
    number_from_zero,
    positive_number,
    whole_number,
)
from rockfrag.base.keywords import named_keywords
from rockfrag.base.units import GRAVITY
from rockfrag.engines.contract import Cases, Request, run_cases
from rockfrag.engines.steps import STEP
from rockfrag.outcomes.outcomes import Outcomes
from rockfrag.simulation import inputs
from rockfrag.simulation.inputs import SystemsInput
from rockfrag.simulation.options import (
    FrictionInput,
    Restitution,
    StartInput,
    systems_of,
)
from rockfrag.system import geometry
from rockfrag.system.system import System, rocking_shapes

Index = NDArray[np.int64]

LIGHT = 0.5
"""Minimum effective gravity ratio below which a body that the ground drops may leave it, so that pure rocking is
no answer: 64 of 3000 random outcomes of pure rocking are wrong below, and 1 of 5000 above
(``docs/contact.md``) [-]."""

LIFTING = 0.7
"""Fraction of the horizontal acceleration that takes all weight off a pivot at the moment of uplift, from which
on a warning is given: rocking adds to it (19 of 27 blocks of h/b 0.5 to 1.2 at 1.2 to 4 times their uplift lost
contact, while slender ones need several g)."""


# acceleration over g below which no uniform block both rocks and is warned of
LEAST_LIFTING = 0.8


class LightBodies(UserWarning):
    """Bodies are nearly weightless at times, and pure rocking holds them on the ground."""


class Options(TypedDict, total=False):
    """What every door takes beside bodies and motions, as :func:`overturns` does."""

    restitution: Sequence[Restitution] | None
    friction: FrictionInput | None
    vertical: inputs.MotionLike | Sequence[inputs.MotionLike] | None
    theta0: Sequence[StartInput] | None
    omega0: Sequence[StartInput] | None
    linear: bool
    g: float
    step: float
    threads: int | None


@named_keywords
def overturns(
    bodies: SystemsInput,
    motions: inputs.MotionLike | Sequence[inputs.MotionLike],
    dt: float | Sequence[float] | None = None,
    scales: ArrayLike = (1.0,),
    *,
    theta0: Sequence[StartInput] | None = None,
    omega0: Sequence[StartInput] | None = None,
    restitution: Sequence[Restitution] | None = None,
    linear: bool = False,
    friction: FrictionInput | None = None,
    vertical: inputs.MotionLike | Sequence[inputs.MotionLike] | None = None,
    forces: bool = False,
    spread: float = 0.0,
    seed: int = 0,
    g: float = GRAVITY,
    step: float = STEP,
    threads: int | None = None,
) -> Outcomes:
    """Say for every body × motion × scale whether it overturns.

    Parameters
    ----------
    bodies : blocks, stacks, columns and systems: one, a list, or a mapping of names to them
    motions
        Motions, ground motions, or horizontal accelerations [m/s²], each of shape (n,), linear between samples and
        zero one sample after the last.
    dt : sampling interval of accelerations [s], one or one per motion; a Motion has its own
    scales : factors on the accelerations, shape (scales,) for all motions or (motions, scales)
    theta0, omega0
        A list with one entry per body: rotations [rad] and angular velocities [rad/s] at the start, as in
        :func:`simulate`; None starts all at rest.
    restitution : a list with one entry per body, each as in :func:`simulate`; None conserves momentum in all
    linear : use the linearised equations of motion (Housner, 1963; Psycharis, 1990)
    friction
        A list with one entry per body, each as in :func:`simulate`; or one number, one ``Friction`` or one mapping
        ``{"ground": …, "interface": …}`` for all; None: nothing slides.
    vertical
        Vertical accelerations, upwards [m/s²], one for each motion and sampled as it; they are scaled with it.
    forces : also tell the friction that the responses asked, and least normal forces
    spread, seed
        In space: largest displacement of each vertex of the base over its extent [-], and largest angle by which
        the body is turned about the vertical [rad], drawn from the seed anew for each system and motion. An ideal
        base has outcomes that no real one has.
    g : acceleration of gravity [m/s²]
    step
        Largest p h of a step, of which a stack takes 0.35 while both its blocks rotate: smaller is more accurate
        and slower.
    threads : threads to use; all cores if None.  Results do not depend on it.

    Returns
    -------
    Outcomes
        Arrays of shape (bodies, motions, scales), and four tidy tables; who answered stands in ``engine``.

    Warns
    -----
    LightBodies
        If pure rocking holds bodies on the ground that may leave it: the ground takes more than half of their
        weight, or they are squat and rock; with neither ``friction`` nor ``forces``.
    UserWarning
        If a number looks as if it were given in another unit.

    Examples
    --------
    A statue alone and on a pedestal, under a sine of one second at three amplitudes [m/s²]:

    >>> from rockfrag import Block, Stack, overturns
    >>> from rockfrag.motions import one_sine
    >>> upper = Block(width=0.3, height=1.2, mass=180.0)
    >>> stack = Stack(Block(width=0.6, height=0.4, mass=300.0), upper)
    >>> overturns([upper, stack], one_sine(1.0, period=1.0), scales=[2.0, 3.0, 5.0]).overturned.shape
    (2, 1, 3)
    """
    cases = prepared(
        bodies,
        motions,
        dt,
        scales,
        forces=forces,
        spread=spread,
        seed=seed,
        restitution=restitution,
        friction=friction,
        vertical=vertical,
        theta0=theta0,
        omega0=omega0,
        linear=linear,
        g=g,
        step=step,
        threads=threads,
    )
    inputs.check_case_count(len(cases.systems) * cases.scales.size)
    return shaken(cases)


def prepared(
    bodies: SystemsInput,
    motions: inputs.MotionLike | Sequence[inputs.MotionLike],
    dt: float | Sequence[float] | None,
    scales: ArrayLike,
    *,
    forces: bool = False,
    spread: float = 0.0,
    seed: int = 0,
    **options: Unpack[Options],
) -> Cases:
    """Return the checked cases of ``overturns`` and its like.

    Parameters
    ----------
    bodies, motions, dt, scales, options : as these take them
    forces : whether forces are asked for
    spread, seed : of bases in space
    """
    body_list = inputs.listed_bodies(bodies)
    shaking = inputs.listed_motions(motions, dt, options.get("vertical"))
    factors = inputs.checked_scales(scales, shaking)
    g = options.get("g", GRAVITY)
    positive_number("g", g, "m/s²")
    systems = systems_of(body_list, dict(options))
    request = Request(
        forces=inputs.checked_switch("forces", forces),
        linear=inputs.checked_switch("linear", options.get("linear", False)),
        g=g,
        step=positive_number("step", options.get("step", STEP)),
        spread=number_from_zero("spread", spread),
        seed=whole_number("seed", seed),
    )
    threads = inputs.checked_threads(options.get("threads"))
    cases = Cases(systems, tuple(shaking), factors, request, threads)
    if shaking:
        # refused before anything is computed
        _ = cases.answering
    inputs.warn_of_units(cases, motions)
    return cases


def shaken(cases: Cases) -> Outcomes:
    """Run cases, add the least part of gravity that is left, and warn where pure rocking may be no answer."""
    outcomes = replace(
        run_cases(cases),
        systems=tuple(system.name for system in cases.systems),
        motions=tuple(motion.name for motion in cases.motions),
        peaks=tuple(motion.x.pga for motion in cases.motions),
    )
    if not outcomes.overturned.size:
        return outcomes
    if any(motion.z is not None for motion in cases.motions):
        outcomes.minimum_gravity_ratio[:] = 1.0 + _least_upward(cases) / cases.request.g
    # a body that is answered in space leaves the ground where it has to, and so do more than two bodies
    in_space = any(motion.y is not None for motion in cases.motions)
    held = [not system.loose and system.count < 3 for system in cases.systems]
    stuck = np.array(held) & np.array(
        [system.planar or not in_space for system in cases.systems]
    )
    if stuck.any() and not cases.request.forces:
        for words in _light_words(cases, outcomes, stuck):
            # at the caller's line: past this function, ``overturns`` and the wrapper of its keywords
            warnings.warn(words, LightBodies, stacklevel=4)
    return outcomes


def _least_upward(cases: Cases) -> Floats:
    """Least upward acceleration of the ground [m/s²], zero or less, shape (motions, scales)."""
    ups = [
        motion.z.acceleration if motion.z else np.zeros(1) for motion in cases.motions
    ]
    # both extremes, as scales may be negative, shape (motions, 2)
    ends = np.array([(up.min(initial=0.0), up.max(initial=0.0)) for up in ups])
    scaled = ends[:, np.newaxis, :] * cases.scales[..., np.newaxis]
    return np.asarray(scaled.min(axis=2))


def overturned_cases(
    cases: Cases, system: Index, motion: Index, scale: Floats
) -> NDArray[np.bool_]:
    """Whether system ``system[i]`` overturns under ``scale[i]`` times motion ``motion[i]``, for each case i.

    Parameters
    ----------
    cases : systems, motions and settings; its scales are not used
    system, motion, scale : of each case, shape (n,)

    Returns
    -------
    Outcomes, shape (n,).
    """
    overturned = np.zeros(len(system), dtype=bool)

    def run(number: int) -> None:
        """Simulate the cases of one system, those of a motion side by side."""
        mine = np.flatnonzero(system == number)
        used, row = np.unique(motion[mine], return_inverse=True)
        # the cases of a motion side by side; what is left over is a scale of zero, which costs nothing
        column = pd.Series(row).groupby(row).cumcount().to_numpy()
        scales = np.zeros((used.size, column.max() + 1))
        scales[row, column] = scale[mine]
        systems = (cases.systems[number],)
        motions = tuple(cases.motions[m] for m in used)
        some = replace(
            cases, systems=systems, motions=motions, scales=scales, threads=1
        )
        overturned[mine] = run_cases(some).overturned[0, row, column]

    with ThreadPoolExecutor(cases.threads) as pool:
        list(pool.map(run, np.unique(system).tolist()))
    return overturned


def _light_words(
    cases: Cases, outcomes: Outcomes, stuck: NDArray[np.bool_]
) -> Iterator[str]:
    """Warn of cases in which bodies may leave the ground, because it drops or because they rock so strongly.

    ``stuck`` says which systems pure rocking holds to the ground, shape (systems,); cases are counted over the
    shape (systems, motions, scales).
    """
    yield from _words_of_drops(outcomes, stuck)
    yield from _words_of_squat_bodies(cases, outcomes, stuck)


def _words_of_drops(outcomes: Outcomes, stuck: NDArray[np.bool_]) -> Iterator[str]:
    """Say in how many cases the ground drops so fast that little is left of gravity; ``stuck``: which systems."""
    ratio = outcomes.minimum_gravity_ratio[stuck]
    light, none = int((ratio < LIGHT).sum()), int((ratio <= 0).sum())
    if light:
        yield (
            f"vertical: in {light} of {ratio.size} cases the ground drops so fast that a body keeps less than "
            f"half of its weight, in {none} of them none at all; pure rocking holds it on the ground there. "
            "Give friction= to let it fly, or forces=True to see when contact is lost."
        )


def _words_of_squat_bodies(
    cases: Cases, outcomes: Outcomes, stuck: NDArray[np.bool_]
) -> Iterator[str]:
    """Say in how many cases a squat body rocks so strongly that it may lift itself; ``stuck``: which systems."""
    unscaled = np.array([motion.x.pga for motion in cases.motions])
    # peak ground accelerations [m/s²], shape (motions, scales)
    peaks = unscaled[:, np.newaxis] * np.abs(cases.scales)
    # of weaker motions it need not be asked: a body that rocks at less is too slender or too squat to lift itself
    if not (peaks > LEAST_LIFTING * cases.request.g).any():
        return
    least = np.array(
        [lifting_acceleration(system, cases.request.g) for system in cases.systems]
    )
    strong = (peaks > LIFTING * least[:, np.newaxis, np.newaxis]) & stuck[
        :, np.newaxis, np.newaxis
    ]
    # without an outcome the peak rotation is NaN, and it is none that rocked
    with np.errstate(invalid="ignore"):
        found = int((strong & (outcomes.peak_rotation > 0).any(axis=-1)).sum())
    if found:
        yield (
            f"in {found} {'case' if found == 1 else 'cases'} a squat body rocks so fast that its own motion may "
            "take the weight off a contact, which pure rocking holds shut. Give friction= to let it leave, or "
            "forces=True to see when contact is lost."
        )


def lifting_acceleration(system: System, g: float) -> float:
    """Least horizontal acceleration that takes all weight off a pivot about which a body at rest turns [m/s²].

    The centre of gravity falls with b θ'' where θ'' = m (a h + g b) / I_O brakes the rocking: at g it is free.
    """
    found = np.inf
    for shape in rocking_shapes(system):
        for pivot in (+1, -1):
            x, y = geometry.arm(shape, pivot)
            if x:
                needed = geometry.pivot_inertia(shape, pivot) / (
                    shape.mass * abs(x)
                ) - abs(x)
                found = min(found, g * needed / y)
    return float(found)
