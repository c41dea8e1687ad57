"""Taylor series of rates over a step, written out so that the compiler works on several lanes at once.

``rates_of_one`` is for one rotation and ``rates_of_two`` for two; ``taylor.fill_series`` does the same in loops,
for single histories. A series is a tuple of its coefficients so far. Families have a function for each order, and
its number ends their names. The coefficient of order k of a product u w is Σ uⱼ wₖ₋ⱼ; what depends on the newest
rates comes last in every sum, so that the processor need not wait for them.

In: a rotation and the ground as a step begins. Out: coefficients 0 to 6 of its rate by time in steps.
Theory: ``docs/kernels.md``, "Series".
"""

from rockfrag.engines.compile.jit import fma, inlined_kernel


@inlined_kernel
def _product1(u, w):
    """Coefficient 1 of the product of two series."""
    return fma(u[1], w[0], u[0] * w[1])


@inlined_kernel
def _product2(u, w):
    """Coefficient 2 of the product of two series."""
    return fma(u[2], w[0], fma(u[0], w[2], u[1] * w[1]))


@inlined_kernel
def _product3(u, w):
    """Coefficient 3 of the product of two series."""
    return fma(u[3], w[0], fma(u[0], w[3], fma(u[2], w[1], u[1] * w[2])))


@inlined_kernel
def _product4(u, w):
    """Coefficient 4 of the product of two series."""
    inner = fma(u[3], w[1], fma(u[1], w[3], u[2] * w[2]))
    return fma(u[4], w[0], fma(u[0], w[4], inner))


@inlined_kernel
def _turned1(s, c, w):
    """Series s and c with their coefficient 1, where s' = c w and c' = -s w."""
    return (*s, c[0] * w[0]), (*c, -(s[0] * w[0]))


@inlined_kernel
def _turned2(s, c, w):
    """Both series with coefficient 2 too, as of :func:`_turned1`."""
    return (*s, 0.5 * _product1(c, w)), (*c, -0.5 * _product1(s, w))


@inlined_kernel
def _turned3(s, c, w):
    """Both series with coefficient 3 too, as of :func:`_turned1`."""
    return (*s, (1 / 3) * _product2(c, w)), (*c, -(1 / 3) * _product2(s, w))


@inlined_kernel
def _turned4(s, c, w):
    """Both series with coefficient 4 too, as of :func:`_turned1`."""
    return (*s, 0.25 * _product3(c, w)), (*c, -0.25 * _product3(s, w))


@inlined_kernel
def _turned5(s, c, w):
    """Both series with coefficient 5 too, as of :func:`_turned1`."""
    return (*s, 0.2 * _product4(c, w)), (*c, -0.2 * _product4(s, w))


@inlined_kernel
def times_gravity(gravity, now, before):
    """Coefficient k of gravity times a series, from the series' coefficients k (``now``) and k - 1 (``before``).

    ``gravity``: its value as the step begins, what it grows by until its end, and whether it does.
    """
    g, lift, varies = gravity
    return fma(lift, before, g * now) if varies else g * now


@inlined_kernel
def _block_torque(ground, weight, s, c):
    """Newest coefficient of W sin ψ + A cos ψ, from the series ``s`` of the sine and ``c`` of the cosine so far.

    ``ground``: A and its growth over the step; ``weight``: W, its growth and whether it varies.
    """
    (a, rise), (u, lift, varies) = ground, weight
    if varies:
        return fma(u, s[-1], fma(a, c[-1], fma(lift, s[-2], rise * c[-2])))
    return fma(a, c[-1], fma(rise, c[-2], u * s[-1]))


@inlined_kernel
def rates_of_one(turn, w, kappa, ground, weight):
    """Taylor coefficients 0 to 6 of ψ' over a step that begins at sin ψ = s0, cos ψ = c0.

    ψ'' = κ (W sin ψ + A cos ψ) with A = a + rise τ, W = u + lift τ and time in steps (Housner, 1963): a lone
    block with ψ = θc - |θ|, κ = p² h², A the ground acceleration over g, positive where it pushes the block back
    down, and W gravity over g, 1 unless the ground moves vertically.

    Parameters
    ----------
    turn : (s0, c0)
    w : ψ' as the step begins [rad per step]
    kappa : κ of the step's length h [-]
    ground : (a, rise)
    weight : (u, lift, whether it varies)

    Returns
    -------
    The seven coefficients [rad per step].
    """
    s, c = (turn[0],), (turn[1],)
    rates = w, kappa * fma(ground[0], c[0], weight[0] * s[0])
    s, c = _turned1(s, c, rates)
    rates = (*rates, 0.5 * kappa * _block_torque(ground, weight, s, c))
    s, c = _turned2(s, c, rates)
    rates = (*rates, (1 / 3) * kappa * _block_torque(ground, weight, s, c))
    s, c = _turned3(s, c, rates)
    rates = (*rates, 0.25 * kappa * _block_torque(ground, weight, s, c))
    s, c = _turned4(s, c, rates)
    rates = (*rates, 0.2 * kappa * _block_torque(ground, weight, s, c))
    s, c = _turned5(s, c, rates)
    rates = (*rates, (1 / 6) * kappa * _block_torque(ground, weight, s, c))
    return rates


@inlined_kernel
def _square1(w):
    """Coefficient 1 of the square of a series."""
    return 2.0 * w[0] * w[1]


@inlined_kernel
def _square2(w):
    """Coefficient 2 of the square of a series."""
    return fma(2.0 * w[0], w[2], w[1] * w[1])


@inlined_kernel
def _square3(w):
    """Coefficient 3 of the square of a series."""
    return fma(2.0 * w[0], w[3], 2.0 * (w[1] * w[2]))


@inlined_kernel
def _square4(w):
    """Coefficient 4 of the square of a series."""
    return fma(2.0 * w[0], w[4], fma(2.0, w[1] * w[3], w[2] * w[2]))


@inlined_kernel
def _weight_torque(ground, gravity, x, y):
    """Newest coefficient of g Y - a X, from the series ``x`` and ``y`` of X and Y so far (:func:`rates_of_two`).

    ``ground``: a and its growth over the step; ``gravity`` as of :func:`times_gravity`.
    """
    a, rise = ground
    return fma(-a, x[-1], fma(-rise, x[-2], times_gravity(gravity, y[-1], y[-2])))


@inlined_kernel
def _torque1(torque, side, coupling, w):
    """Coefficient 1 of the torque on a body: that of its weight, and what the other body's rotation adds to it.

    With the other's rate w that is ± D w² - (M12 - m₀) w': ``side`` is the sign, -1 for body 1 and 1 for body 2;
    ``coupling`` has the series of M12 and D. The part m₀ w' stands on the left side, in the mass matrix.
    Coefficient n of w' is (n + 1) wₙ₊₁, so that coefficient k of (M12 - m₀) w' is Σ (n + 1) mₖ₋ₙ wₙ₊₁ for n = 0 to
    k - 1; the terms with the newest rate, of both products, are joined in the last line.
    """
    m, d = coupling
    torque = fma(side * d[1], w[0] * w[0], torque)
    return fma(side * (2.0 * d[0] * w[0]) - m[1], w[1], torque)


@inlined_kernel
def _torque2(torque, side, coupling, w):
    """Coefficient 2 of the torque on a body, with all as of :func:`_torque1`."""
    m, d = coupling
    torque = fma(side * d[1], _square1(w), torque)
    torque = fma(side * d[0], w[1] * w[1], torque)
    torque = fma(-m[2], w[1], torque)
    torque = fma(side * d[2], w[0] * w[0], torque)
    return fma(side * (2.0 * d[0] * w[0]) - 2.0 * m[1], w[2], torque)


@inlined_kernel
def _torque3(torque, side, coupling, w):
    """Coefficient 3 of the torque on a body, with all as of :func:`_torque1`."""
    m, d = coupling
    torque = fma(-m[2], 2.0 * w[2], torque)
    torque = fma(side * d[1], _square2(w), torque)
    torque = fma(side * d[2], _square1(w), torque)
    torque = fma(side * d[0], 2.0 * (w[1] * w[2]), torque)
    torque = fma(-m[3], w[1], torque)
    torque = fma(side * d[3], w[0] * w[0], torque)
    return fma(side * (2.0 * d[0] * w[0]) - 3.0 * m[1], w[3], torque)


@inlined_kernel
def _torque4(torque, side, coupling, w):
    """Coefficient 4 of the torque on a body, with all as of :func:`_torque1`."""
    m, d = coupling
    torque = fma(side * d[2], _square2(w), torque)
    torque = fma(-m[2], 3.0 * w[3], torque)
    torque = fma(-m[3], 2.0 * w[2], torque)
    torque = fma(side * d[1], _square3(w), torque)
    torque = fma(side * d[3], _square1(w), torque)
    torque = fma(side * d[0], fma(2.0, w[1] * w[3], w[2] * w[2]), torque)
    torque = fma(-m[4], w[1], torque)
    torque = fma(side * d[4], w[0] * w[0], torque)
    return fma(side * (2.0 * d[0] * w[0]) - 4.0 * m[1], w[4], torque)


@inlined_kernel
def _torque5(torque, side, coupling, w):
    """Coefficient 5 of the torque on a body, with all as of :func:`_torque1`."""
    m, d = coupling
    torque = fma(-m[3], 3.0 * w[3], torque)
    torque = fma(side * d[2], _square3(w), torque)
    torque = fma(side * d[3], _square2(w), torque)
    torque = fma(-m[2], 4.0 * w[4], torque)
    torque = fma(-m[4], 2.0 * w[2], torque)
    torque = fma(side * d[1], _square4(w), torque)
    torque = fma(side * d[4], _square1(w), torque)
    torque = fma(side * d[0], 2.0 * fma(w[1], w[4], w[2] * w[3]), torque)
    torque = fma(-m[5], w[1], torque)
    torque = fma(side * d[5], w[0] * w[0], torque)
    return fma(side * (2.0 * d[0] * w[0]) - 5.0 * m[1], w[5], torque)


@inlined_kernel
def _with_next(rates, inverse, torques, fraction):
    """Series of both rates with their next coefficients, ``fraction`` of the accelerations under both torques.

    ``inverse`` has the entries 11, -12 and 22 of the inverse of the mass matrix.
    """
    (w1, w2), (torque1, torque2) = rates, torques
    i11, i12, i22 = inverse
    next1 = fraction * fma(i11, torque1, -i12 * torque2)
    next2 = fraction * fma(i22, torque2, -i12 * torque1)
    return (*w1, next1), (*w2, next2)


@inlined_kernel
def rates_of_two(mass, weight1, weight2, rates, ground, gravity):
    """Taylor coefficients 0 to 6 of θ1' and θ2' over a step of both rotations.

    M11 θ1'' + M12 θ2'' + D θ2'² + f1 = 0 and M12 θ1'' + M22 θ2'' - D θ1'² + f2 = 0 with M12 = E cos Δ + F sin Δ,
    D = dM12/dΔ, Δ = θ2 - θ1 and fi = a Xi - g Yi, where Xi = Vy cos θi - Vx sin θi and Yi = Vx cos θi + Vy sin θi
    (``equations``).  All satisfy recurrences: M' = D Δ', D' = -M Δ', X' = -Y θ', Y' = X θ'.  So each order does
    the same: it extends M12, D, X and Y, takes the torques on both bodies from them, and from these the next
    coefficients of both rates.  Time is counted in steps: rates and V carry the step's length.

    Parameters
    ----------
    mass : M11, M22, M12 and D at the start of the step
    weight1, weight2 : X and Y of each body there
    rates : θ1' and θ2' there
    ground : its acceleration there, and what that grows by until the end of the step
    gravity : likewise, and whether it varies (:func:`times_gravity`)

    Returns
    -------
    Coefficients of θ1', and of θ2', seven each.
    """
    m11, m22, m0, d0 = mass
    fraction = 1.0 / fma(m11, m22, -m0 * m0)
    inverse = m22 * fraction, m0 * fraction, m11 * fraction
    # series of M12, D, X and Y of both bodies, and of both rates
    m, d = (m0,), (d0,)
    x1, y1 = (weight1[0],), (weight1[1],)
    x2, y2 = (weight2[0],), (weight2[1],)
    w1, w2 = (rates[0],), (rates[1],)

    # order 0
    a, g = ground[0], gravity[0]
    torque1 = fma(-d0, w2[0] * w2[0], fma(-a, x1[0], g * y1[0]))
    torque2 = fma(d0, w1[0] * w1[0], fma(-a, x2[0], g * y2[0]))
    w1, w2 = _with_next((w1, w2), inverse, (torque1, torque2), 1.0)

    # order 1; `turn` is Δ'
    turn = (w2[0] - w1[0],)
    m, d = _turned1(m, d, turn)
    y1, x1 = _turned1(y1, x1, w1)
    y2, x2 = _turned1(y2, x2, w2)
    torque1 = _torque1(_weight_torque(ground, gravity, x1, y1), -1.0, (m, d), w2)
    torque2 = _torque1(_weight_torque(ground, gravity, x2, y2), 1.0, (m, d), w1)
    w1, w2 = _with_next((w1, w2), inverse, (torque1, torque2), 0.5)

    # order 2
    turn = (*turn, w2[1] - w1[1])
    m, d = _turned2(m, d, turn)
    y1, x1 = _turned2(y1, x1, w1)
    y2, x2 = _turned2(y2, x2, w2)
    torque1 = _torque2(_weight_torque(ground, gravity, x1, y1), -1.0, (m, d), w2)
    torque2 = _torque2(_weight_torque(ground, gravity, x2, y2), 1.0, (m, d), w1)
    w1, w2 = _with_next((w1, w2), inverse, (torque1, torque2), 1 / 3)

    # order 3
    turn = (*turn, w2[2] - w1[2])
    m, d = _turned3(m, d, turn)
    y1, x1 = _turned3(y1, x1, w1)
    y2, x2 = _turned3(y2, x2, w2)
    torque1 = _torque3(_weight_torque(ground, gravity, x1, y1), -1.0, (m, d), w2)
    torque2 = _torque3(_weight_torque(ground, gravity, x2, y2), 1.0, (m, d), w1)
    w1, w2 = _with_next((w1, w2), inverse, (torque1, torque2), 0.25)

    # order 4
    turn = (*turn, w2[3] - w1[3])
    m, d = _turned4(m, d, turn)
    y1, x1 = _turned4(y1, x1, w1)
    y2, x2 = _turned4(y2, x2, w2)
    torque1 = _torque4(_weight_torque(ground, gravity, x1, y1), -1.0, (m, d), w2)
    torque2 = _torque4(_weight_torque(ground, gravity, x2, y2), 1.0, (m, d), w1)
    w1, w2 = _with_next((w1, w2), inverse, (torque1, torque2), 0.2)

    # order 5
    turn = (*turn, w2[4] - w1[4])
    m, d = _turned5(m, d, turn)
    y1, x1 = _turned5(y1, x1, w1)
    y2, x2 = _turned5(y2, x2, w2)
    torque1 = _torque5(_weight_torque(ground, gravity, x1, y1), -1.0, (m, d), w2)
    torque2 = _torque5(_weight_torque(ground, gravity, x2, y2), 1.0, (m, d), w1)
    w1, w2 = _with_next((w1, w2), inverse, (torque1, torque2), 1 / 6)
    return w1, w2
