"""Sine and its like are accurate, and kernels compute them as Python does, to the last bit."""

import math

import mpmath
import numpy as np
import pytest

from rockfrag.base.elementary import acos, atan2, cos, hypot, sin, sin_cos
from rockfrag.engines.compile.jit import entry_kernel

from ..conftest import printed_alone

COUNT = 3000


@pytest.fixture(autouse=True)
def digits():
    with mpmath.workprec(300):
        yield


def spread(rng, low, high, count=COUNT):
    """Numbers of either sign between 2**low and 2**high."""
    return rng.choice([-1.0, 1.0], count) * 2.0 ** rng.uniform(low, high, count)


def near_multiples(rng):
    """The numbers closest to multiples of π/2, where hardly a digit is left of the rest."""
    for n in [*range(1, 500), *rng.integers(500, 636_000, 1000).tolist()]:
        at = float(n * mpmath.pi / 2)
        yield from (at, -at, math.nextafter(at, 0.0), math.nextafter(at, 2.0 * at))


def angles():
    rng = np.random.default_rng(1)
    return [
        *rng.uniform(-0.8, 0.8, COUNT), *rng.uniform(-7.0, 7.0, COUNT), *rng.uniform(-1e6, 1e6, COUNT),
        *spread(rng, -1070, 0), *near_multiples(rng),
    ]  # fmt: skip


def directions():
    rng = np.random.default_rng(2)
    eighths = rng.integers(0, 9, COUNT) / 8 + spread(rng, -50, -4)
    sizes = rng.choice([1.0, 3.3, 1e300, 1e-300], COUNT)
    return [
        *zip(rng.uniform(-1, 1, COUNT), rng.uniform(-1, 1, COUNT), strict=True),
        *zip(spread(rng, -1070, 1020), spread(rng, -1070, 1020), strict=True),
        *zip(spread(rng, -30, 30), spread(rng, -30, 30), strict=True),
        *zip(eighths * sizes, sizes, strict=True),
        *zip(1 / 16 + spread(rng, -50, -4), np.ones(COUNT), strict=True),
    ]


def cosines():
    rng = np.random.default_rng(3)
    ends = rng.choice([-1.0, 1.0], COUNT) * (1.0 - 2.0 ** rng.uniform(-53, -1, COUNT))
    return [*rng.uniform(-1, 1, COUNT), *ends, *spread(rng, -1000, -1)]


@pytest.mark.parametrize(
    ("function", "exact", "arguments"),
    [
        (sin, mpmath.sin, [(x,) for x in angles()]),
        (cos, mpmath.cos, [(x,) for x in angles()]),
        (acos, mpmath.acos, [(x,) for x in cosines()]),
        (atan2, mpmath.atan2, directions()),
        (hypot, mpmath.hypot, [d for d in directions() if math.hypot(*d) < math.inf]),
    ],
    ids=["sin", "cos", "acos", "atan2", "hypot"],
)
def test_the_error_is_below_one_unit_in_the_last_place(function, exact, arguments):
    for argument in arguments:
        numbers = [float(x) for x in argument]
        right = exact(*map(mpmath.mpf, numbers))
        assert abs(function(*numbers) - right) < math.ulp(float(right)), numbers


INF, NAN = math.inf, math.nan


@pytest.mark.parametrize(
    ("function", "arguments", "right"),
    [
        (sin, (0.0,), 0.0), (sin, (-0.0,), -0.0), (cos, (0.0,), 1.0), (cos, (-0.0,), 1.0),
        (sin, (5e-324,), 5e-324), (sin, (INF,), NAN), (cos, (-INF,), NAN), (sin, (NAN,), NAN), (sin, (1e7,), NAN),
        (acos, (1.0,), 0.0), (acos, (-1.0,), math.pi), (acos, (0.0,), math.pi / 2), (acos, (1.1,), NAN),
        (acos, (NAN,), NAN), (hypot, (INF, NAN), INF), (hypot, (NAN, -INF), INF), (hypot, (NAN, 1.0), NAN),
        (hypot, (-3.0, 4.0), 5.0), (hypot, (0.0, -0.0), 0.0), (hypot, (-0.0, -5e-324), 5e-324),
        (atan2, (NAN, 1.0), NAN), (atan2, (1.0, NAN), NAN),
        *[
            (atan2, (y, x), math.atan2(y, x))
            for y in (0.0, -0.0, 1.0, -1.0, INF, -INF, 5e-324, 1e308)
            for x in (0.0, -0.0, 1.0, -1.0, INF, -INF, 5e-324, -1e308)
        ],
    ],
)  # fmt: skip
def test_zeros_infinities_and_what_is_no_number(function, arguments, right):
    found = function(*arguments)
    assert (found == right and math.copysign(1, found) == math.copysign(1, right)) or (
        math.isnan(found) and math.isnan(right)
    )


@entry_kernel
def fill(ys, xs, found):
    for i in range(len(ys)):
        found[i, 0], found[i, 1] = sin_cos(ys[i])
        found[i, 2], found[i, 3] = atan2(ys[i], xs[i]), hypot(ys[i], xs[i])
        found[i, 4] = acos(ys[i] / max(1.0, abs(ys[i])))


def test_kernels_compute_the_same_bits_as_python():
    rng = np.random.default_rng(4)
    ys = np.array([*angles()[::3], *spread(rng, -20, 2), -0.0, INF, NAN])
    xs = rng.permutation(ys)
    found = np.empty((len(ys), 5))
    fill(ys, xs, found)
    right = [
        (*sin_cos(y), atan2(y, x), hypot(y, x), acos(y / max(1.0, abs(y))))
        for y, x in zip(ys.tolist(), xs.tolist(), strict=True)
    ]
    np.testing.assert_array_equal(found, right)


HISTORIES = """
import hashlib
import numpy as np
from rockfrag import Block, Stack, overturns, simulate

block = Block(0.3, 1.2, 200.0, cg_offset=0.01, lean=0.005)
bodies = [block, Stack(Block(0.4, 0.3, 100.0, lean=0.01), block, offset=0.01)]
motion = 4.0 * np.sin(np.arange(400) * 0.06)
digest = hashlib.sha256()
for body in bodies:
    for linear in (False, True):
        response = simulate(body, motion, 0.01, linear=linear)
        for values in (response.theta, response.omega, response.energy.to_numpy(), response.normal_force):
            digest.update(values.tobytes())
result = overturns(bodies, motion, 0.01, np.linspace(0.3, 2.0, 50))
for values in (result.overturned, result.peak_rotation, result.peak_velocity, result.unstable_distance):
    digest.update(values.tobytes())
print(digest.hexdigest())
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    "processor",
    [
        {
            "NUMBA_CPU_NAME": "generic",
            "NUMBA_CPU_FEATURES": "",
            # nor does the library's function use the processor's multiply-adds
            "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F",
        },
        {"OPENBLAS_CORETYPE": "Prescott"},
        {"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4"},
    ],
    ids=["no FMA", "another BLAS", "numpy without vectors"],
)
def test_another_processor_gives_the_same_bits(processor, tmp_path):
    here = printed_alone("-c", HISTORIES)
    assert (
        printed_alone("-c", HISTORIES, **processor, NUMBA_CACHE_DIR=str(tmp_path))
        == here
    )
