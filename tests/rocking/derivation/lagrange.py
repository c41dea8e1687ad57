"""Two blocks from the positions of their centres alone: sympy derives all that the tests compare with.

Nothing here knows the formulas of the code or of the thesis.  Pivots s1, s2 = ±1 stay symbols, so one
derivation serves all patterns; what is derived is turned into numpy functions of arrays.
"""

from collections.abc import Callable
from functools import cache

import numpy as np
import sympy as sp

Array = np.ndarray

B1, H1, M1, I1, B2, H2, M2, I2, G = sp.symbols("b1 h1 m1 I1 b2 h2 m2 I2 g", positive=True)
S1, S2 = sp.symbols("s1 s2", real=True)
TH1, TH2, W1, W2, Q1, Q2, XG, VG, A = sp.symbols(
    "theta1 theta2 omega1 omega2 q1 q2 xg vg a", real=True
)
BODY = (B1, H1, M1, I1, B2, H2, M2, I2, G)
STATE = (TH1, TH2, W1, W2, Q1, Q2, XG, VG, A)


def turned(angle: sp.Expr, x: sp.Expr, y: sp.Expr) -> sp.Matrix:
    """Turn a vector clockwise."""
    return sp.Matrix(
        [x * sp.cos(angle) + y * sp.sin(angle), -x * sp.sin(angle) + y * sp.cos(angle)]
    )


def rate(expression: sp.Expr) -> sp.Expr:
    """Time derivative: θ' = ω, ω' = q, x_g' = v_g, v_g' = a."""
    steps = ((TH1, W1), (TH2, W2), (W1, Q1), (W2, Q2), (XG, VG), (VG, A))
    return sum((sp.diff(expression, x) * x_dot for x, x_dot in steps), sp.Integer(0))


@cache
def derived() -> dict[str, Callable[..., Array]]:
    """Functions of (body, pivots, state), all with arrays in and out; derived once."""
    pivot1 = sp.Matrix([XG + S1 * B1, 0])
    centre1 = pivot1 + turned(TH1, -S1 * B1, H1)
    pivot2 = pivot1 + turned(TH1, -S1 * B1 + S2 * B2, 2 * H1)
    centre2 = pivot2 + turned(TH2, -S2 * B2, H2)
    velocity1, velocity2 = centre1.applyfunc(rate), centre2.applyfunc(rate)
    kinetic = (
        M1 * velocity1.dot(velocity1) + I1 * W1**2 + M2 * velocity2.dot(velocity2) + I2 * W2**2
    ) / 2
    potential = G * (M1 * centre1[1] + M2 * centre2[1])
    # Lagrange's equations (2.26); what is left of them are the moments of the contact forces
    motion = sp.Matrix(
        [
            rate(sp.diff(kinetic, w)) - sp.diff(kinetic, th) + sp.diff(potential, th)
            for th, w in ((TH1, W1), (TH2, W2))
        ]
    )
    # small rotations: first order in θ, θ'', a together, products dropped
    small = sp.Symbol("epsilon")
    scaled = motion.subs(
        {TH1: small * TH1, TH2: small * TH2, W1: small * W1, W2: small * W2}, simultaneous=True
    ).subs({Q1: small * Q1, Q2: small * Q2, A: small * A}, simultaneous=True)
    linear = scaled.subs(small, 0) + sp.diff(scaled, small).subs(small, 0)

    def function(expressions: sp.Matrix | sp.Expr) -> Callable[..., Array]:
        entries = list(expressions) if isinstance(expressions, sp.MatrixBase) else [expressions]
        compiled = [
            sp.lambdify((*BODY, S1, S2, *STATE), entry, "numpy", cse=True) for entry in entries
        ]

        def evaluate(*arguments: object) -> Array:
            values = np.broadcast_arrays(*[f(*arguments) for f in compiled], arguments[0])[:-1]
            return np.array(values) if len(values) > 1 else values[0]

        return evaluate

    found = {
        "pivot1": pivot1, "pivot2": pivot2, "centre1": centre1, "centre2": centre2,
        "velocity1": velocity1, "velocity2": velocity2,
        "acceleration1": velocity1.applyfunc(rate), "acceleration2": velocity2.applyfunc(rate),
        "kinetic": kinetic, "potential": potential, "motion": motion, "linear_motion": linear,
    }  # fmt: skip
    return {name: function(expressions) for name, expressions in found.items()}
