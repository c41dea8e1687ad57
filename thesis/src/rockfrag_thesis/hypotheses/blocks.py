"""C1, C3 to C8 and C20: the single block.

In: the setting of the thesis. Out: an outcome a hypothesis. Theory: ``docs/hypotheses.md``, ``docs/rocking.md``.
"""

import itertools
import math

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.units import GRAVITY
from rockfrag.motions.processing import factors_to_pga
from rockfrag.records.motion import Motion
from rockfrag.simulation import overturns, simulate
from rockfrag.simulation.restitution import quarter_period
from rockfrag.simulation.rocking_spectra import uniform_block
from rockfrag.system.blocks import Block
from rockfrag_thesis.hypotheses.hypothesis import (
    Finding,
    Result,
    Undecidable,
    hypothesis,
)
from rockfrag_thesis.hypotheses.outcomes import SEEN, most
from rockfrag_thesis.hypotheses.setting import (
    EXACT,
    Setting,
    below,
    bisect,
    jump,
    listed,
    require_thesis_specimens,
    starts_at,
)
from rockfrag_thesis.printed_tables import FOLDER, TABLE_3_1, compare


@hypothesis(1)
def c1(setting: Setting) -> Result:
    """The closed form, and simulations on either side of it."""
    agree = [
        starts_at(block, setting.alone[name]) for name, block in setting.blocks.items()
    ]
    return Result(
        Finding.FOR if all(agree) else Finding.AGAINST,
        f"{listed(setting.alone)} m/s²; {sum(agree)} of {len(agree)} simulated blocks start there",
    )


@hypothesis(3)
def c3(setting: Setting) -> Result:
    """Critical angle, radius and frequency parameter from the dimensions."""
    require_thesis_specimens(setting)
    assert setting.pedestal is not None
    bodies = {**setting.blocks, "P": setting.pedestal}
    table = compare(bodies, TABLE_3_1, FOLDER / "table_3_1.csv")
    asked = (table["printed"] != "") & (table["quantity"] != "H/B")
    printed = table[asked].to_dict("records")
    wrong = [
        f"{row['name']}: {row['computed']:.5g} against {row['printed']}"
        for row in printed
        if not row["agrees"]
    ]
    total = len(printed)
    return Result(
        Finding.AGAINST if wrong else Finding.FOR,
        f"{total - len(wrong)} of {total} figures agree"
        + "".join(f"; {figure}" for figure in wrong),
        (total - len(wrong)) / total,
    )


@hypothesis(4)
def c4(setting: Setting) -> Result:
    """Restitution of simulated impacts over sizes, speeds and slendernesses."""
    law = {
        name: 1 - 1.5 * math.sin(block.alpha) ** 2
        for name, block in setting.blocks.items()
    }
    worst = 0.0
    for name, period, start in itertools.product(law, (0.5, 6.0), (0.1, 0.9)):
        alpha = setting.blocks[name].alpha
        uniform = uniform_block(alpha, period)
        response = simulate(uniform, np.zeros(64), period / 32, theta0=start * alpha)
        row = response.contact_events.query("kind == 'impact'").iloc[0]
        found = row["omega_after"][0] / row["omega_before"][0]
        worst = max(worst, abs(found / law[name] - 1))
    return Result(
        Finding.FOR if worst < EXACT else Finding.AGAINST,
        f"e = {listed(law)}; largest relative difference of a simulated impact {below(worst)}",
    )


@hypothesis(5)
def c5(setting: Setting) -> Result:
    """Restitution fitted to measured free rocking, of which a study has none."""
    raise Undecidable("there is no measured history of free rocking")


def _first_impact(block: Block, theta0: float, linear: bool = False) -> float:
    """Time of the first impact after a release from rest [s]."""
    dt = 0.002
    seconds = 4 / block.frequency()
    response = simulate(
        block, np.zeros(int(seconds / dt)), dt, theta0=theta0, linear=linear
    )
    return float(response.contact_events.query("kind == 'impact'")["time"].iloc[0])


@hypothesis(6)
def c6(setting: Setting) -> Result:
    """Period of free rocking over amplitude."""
    ratios, law = {}, 0.0
    for name, block in setting.blocks.items():
        small, large = 0.2 * block.critical_angle(1), 0.9 * block.critical_angle(1)
        ratios[name] = _first_impact(block, large) / _first_impact(block, small)
        for theta0 in (small, large):
            exact = quarter_period(block, theta0, linear=True)
            law = max(law, abs(_first_impact(block, theta0, linear=True) / exact - 1))
    return Result(
        Finding.FOR if min(ratios.values()) > 1 and law < 1e-6 else Finding.AGAINST,
        f"period from 0.9 over that from 0.2: {listed(ratios, '.2f')}; largest difference from eq. 2.20 "
        f"{below(law, 1e-6)}",
        min(ratios.values()),
    )


def _least_half_sine(block: Block, linear: bool) -> float:
    """Least overturning peak of a half-sine pulse of ωp = 3 p, over g tan α [-]."""
    duration = math.pi / (3 * block.frequency())
    shape = np.sin(np.linspace(0, math.pi, 101))
    unit = block.alpha * GRAVITY
    return bisect(
        lambda x: (
            simulate(
                block, Motion(x * unit * shape, duration / 100), linear=linear
            ).overturned
        ),
        1.0,
        8.0,
        1e-3,
    )


@hypothesis(7)
def c7(setting: Setting) -> Result:
    """What the linearisation changes for blocks of H/B of 3 and more."""
    slender = {
        k: block for k, block in setting.blocks.items() if block.slenderness >= 3 - 1e-9
    }
    if not slender:
        raise Undecidable("no specimen has H/B of 3 or more")
    period, pulse = {}, {}
    for name, block in slender.items():
        theta0 = block.critical_angle(1) / 2
        period[name] = 100 * abs(
            _first_impact(block, theta0, True) / _first_impact(block, theta0) - 1
        )
        pulse[name] = 100 * (
            _least_half_sine(block, True) / _least_half_sine(block, False) - 1
        )
    worst = max(*period.values(), *(abs(value) for value in pulse.values()))
    return Result(
        Finding.FOR if worst < 100 * SEEN else Finding.AGAINST,
        f"error of the quarter period {listed(period, '.2f')} %, of the least overturning pulse "
        f"{listed(pulse, '+.1f')} %",
        worst,
        unit="%",
    )


DRAWS = 20  # copies of each block within its tolerances (C8)
AMPLITUDES_G = np.geomspace(0.1, 2.0, 301)
"""1 % steps in which the least overturning amplitude is sought (C8)."""


def perturbed(block: Block, rng: np.random.Generator) -> tuple[Block, float]:
    """Copy of a block within ±1 % of width and ±0.5 % of height, and a restitution within ±0.02."""
    width = block.width * (1 + rng.uniform(-0.01, 0.01))
    height = block.height * (1 + rng.uniform(-0.005, 0.005))
    changed = Block(
        width, height, block.mass * width * height / (block.width * block.height)
    )
    return changed, min(1.0, changed.momentum_restitution() + rng.uniform(-0.02, 0.02))


def least_overturning_amplitudes(
    setting: Setting, bodies: list[Block], restitution: list[float]
) -> Floats:
    """Least overturning amplitude of `AMPLITUDES_G`, shape (bodies, motions); NaN if none does [g]."""
    motions, threads = setting.sample, setting.threads
    scales = np.array([factors_to_pga(motion, AMPLITUDES_G) for motion in motions])
    found = overturns(
        bodies, motions, scales=scales, restitution=restitution, threads=threads
    )
    first = found.overturned.argmax(axis=2)
    return np.where(found.overturned.any(axis=2), AMPLITUDES_G[first], np.nan)


@hypothesis(8, draws=DRAWS)
def c8(setting: Setting) -> Result:
    """Scatter of ln a when size and restitution change a little, over that of the static limit."""
    rng = np.random.default_rng(setting.seed)
    spread, ratio = [], []
    for block in setting.blocks.values():
        changed = [perturbed(block, rng) for _ in range(DRAWS)]
        bodies = [body for body, _ in changed]
        amplitude = np.log(
            least_overturning_amplitudes(setting, bodies, [e for _, e in changed])
        )
        static = float(
            np.std([math.log(math.tan(body.alpha)) for body in bodies], ddof=1)
        )
        for column in amplitude.T:
            if np.isfinite(column).all():
                spread.append(float(np.std(column, ddof=1)))
                ratio.append(spread[-1] / static)
    if not ratio:
        raise Undecidable(f"no specimen overturns below {AMPLITUDES_G[-1]:g} g")
    more = int(np.sum(np.array(ratio) > 1))
    return Result(
        most(more, len(ratio)),
        f"blocks and motions that scatter more: {more} of {len(ratio)}; standard deviation of ln a "
        f"{np.median(spread):.3f} (median; {min(spread):.3f} to {max(spread):.3f}), "
        f"{np.median(ratio):.1f} times that of ln(b/h)",
        float(np.median(ratio)),
        min(ratio),
        max(ratio),
        remark="limits: range over blocks and motions; amplitudes in steps of 1 %, the first overturning "
        "of a rising IDA curve",
    )


@hypothesis(20)
def c20(setting: Setting) -> Result:
    """Rotation below the threshold, and slope of the restoring moment above it."""
    moved, slope, law = 0.0, -math.inf, 0.0
    fractions = np.linspace(0.01, 0.99, 5)
    for name, block in setting.blocks.items():
        rest = jump(block, 0.999999 * setting.alone[name])
        moved = max(moved, float(np.abs(rest.theta).max()))
        alpha = block.critical_angle(1)
        unit = block.mass * GRAVITY * block.radius()
        moments = []
        for fraction in fractions:
            response = simulate(block, np.zeros(2), 0.001, theta0=fraction * alpha)
            moments.append(-block.pivot_inertia() * float(response.alpha[0, 0]) / unit)
        slope = max(slope, float((np.diff(moments) / np.diff(fractions * alpha)).max()))
        law = max(law, float(np.abs(moments - np.sin(alpha * (1 - fractions))).max()))
    return Result(
        Finding.FOR if moved == 0 and slope < 0 and law < EXACT else Finding.AGAINST,
        f"largest rotation below the threshold {moved:g} rad; slope at most {slope:.3f} m g R per rad; "
        f"difference from the law {below(law)} m g R",
        slope,
        unit="m g R/rad",
    )
