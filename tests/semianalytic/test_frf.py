"""Frequency response functions against a direct solve in 60 digits, their limits and the field equations."""

from decimal import Decimal, getcontext

import numpy as np
import pytest

from semianalytic.coefficients.frf import compliance_excess, displacement_frf, stress_frf

SOLIDS = {
    "stiff coating": (((4.0, 0.3, 1.0),), (1.0, 0.3)),
    "soft incompressible film on a rigid base": (((1.0, 0.5, 1.0),), (1e6, 0.2)),
    "hundredfold stiffer, nu 0 on 0.5": (((100.0, 0.0, 1.0),), (1.0, 0.5)),
    "two coatings": (((2.0, 0.2, 0.7), (0.1, 0.45, 0.3)), (1.0, 0.3)),
    "five coatings": (
        ((1.0, 0.1, 0.2), (30.0, 0.2, 0.2), (0.3, 0.5, 0.2), (5.0, 0.0, 0.2), (0.05, 0.3, 0.2)),
        (1.0, 0.3),
    ),
}
solids = pytest.mark.parametrize(("coatings", "substrate"), SOLIDS.values(), ids=SOLIDS.keys())


def compliance(k, coatings, substrate):
    return 1 + compliance_excess(k, coatings, substrate)


def direct_solve(k, coatings, substrate, load):
    """All Airy amplitudes of every layer from one dense system in 60-digit arithmetic.

    f = (A + B k s) e^-ks + (C + D k t) e^-kt in each layer, first two terms in the substrate. Shares with
    the library neither potentials nor unknowns nor arithmetic. Returns a function of (z, layer) ->
    s_zz, s_Lz / i, s_LL, s_TT, 2 G k u_z, 2 G k u_L / i.
    """
    getcontext().prec = 60
    k = Decimal(k)
    layers = [tuple(Decimal(v) for v in layer) for layer in coatings] + [(*map(Decimal, substrate), None)]

    def fields(z_top, z_bottom, nu):
        """Rows of fields by the columns A, B, C, D: with s' = 1 and t' = -1."""
        columns = []
        for sign, x in ((1, k * z_top), (-1, None if z_bottom is None else k * z_bottom)):
            if x is None:
                continue
            e = (-x).exp()
            # derivatives by k z of e^-x and x e^-x, d/dz = sign d/dx
            for f in ([e, -e, e, -e], [x * e, (1 - x) * e, (x - 2) * e, (3 - x) * e]):
                f0, f1, f2, f3 = (value * sign**n for n, value in enumerate(f))
                columns.append(
                    [
                        -f0,  # s_zz / k^2
                        -f1,  # s_xz / (i k^2)
                        f2,  # s_xx
                        nu * (f2 - f0),  # s_yy
                        (1 - nu) * f3 - (2 - nu) * f1,  # 2 G u_z / k
                        -((1 - nu) * f2 + nu * f0),  # 2 G u_x / (i k)
                    ]
                )
        return [list(row) for row in zip(*columns, strict=True)]

    size = 4 * len(coatings) + 2
    matrix, right = [], []

    def add(upper_column, upper, lower_column=0, lower=(), value=0):
        row = [Decimal(0)] * size
        for j, v in enumerate(upper):
            row[upper_column + j] += v
        for j, v in enumerate(lower):
            row[lower_column + j] -= v
        matrix.append(row)
        right.append(Decimal(value))

    zero = Decimal(0)
    top = fields(zero, layers[0][2], layers[0][1])
    add(0, top[0], value=-1 if load == "normal" else 0)
    add(0, top[1], value=1 if load == "in-plane" else 0)
    for j, (E, nu, h) in enumerate(layers[:-1]):
        E2, nu2, h2 = layers[j + 1]
        upper, lower = fields(h, zero, nu), fields(zero, h2, nu2)
        for row in (0, 1, 4, 5):
            scale = (1 + nu) / E if row > 3 else 1
            scale2 = (1 + nu2) / E2 if row > 3 else 1
            add(4 * j, [v * scale for v in upper[row]], 4 * j + 4, [v * scale2 for v in lower[row]])
    for i in range(size):  # Gauss with pivoting
        pivot = max(range(i, size), key=lambda r: abs(matrix[r][i]))
        matrix[i], matrix[pivot], right[i], right[pivot] = matrix[pivot], matrix[i], right[pivot], right[i]
        for r in range(i + 1, size):
            factor = matrix[r][i] / matrix[i][i]
            if factor:
                matrix[r] = [a - factor * b for a, b in zip(matrix[r], matrix[i], strict=True)]
                right[r] -= factor * right[i]
    solution = [zero] * size
    for i in reversed(range(size)):
        known = sum((matrix[i][j] * solution[j] for j in range(i + 1, size)), zero)
        solution[i] = (right[i] - known) / matrix[i][i]

    def at(z, layer):
        above = sum((Decimal(c[2]) for c in coatings[:layer]), zero)
        s = Decimal(z) - above
        h = layers[layer][2]
        rows = fields(s, None if h is None else h - s, layers[layer][1])
        mine = solution[4 * layer : 4 * layer + len(rows[0])]
        return np.array([float(sum((a * b for a, b in zip(row, mine, strict=True)), zero)) for row in rows])

    return at


@solids
@pytest.mark.parametrize("load", ["normal", "in-plane"])
def test_fields_agree_with_a_direct_solve_in_sixty_digits(coatings, substrate, load):
    tops = np.concatenate([[0.0], np.cumsum([c[2] for c in coatings])])
    for k in (1e-6, 1e-2, 0.3, 2.0, 15.0, 200.0):
        exact = direct_solve(k, coatings, substrate, load)
        for layer, top in enumerate(tops):
            thickness = coatings[layer][2] if layer < len(coatings) else 2.0
            z = top + thickness * np.array([0.0, 0.4, 1.0])
            s = stress_frf([k], z, layer, coatings=coatings, substrate=substrate, load=load)[:, :, 0]
            u = displacement_frf([k], z, layer, coatings=coatings, substrate=substrate, load=load)[:, :, 0]
            E, nu = (*coatings, substrate)[layer][:2]
            mine = np.concatenate([s, u * E / (1 + nu)]).T
            theirs = np.array([exact(depth, layer) for depth in z])
            # 1e-11 of the traction: a film 100 times stiffer carries 1e2..1e3 of it, times rounding
            assert np.abs(mine - theirs).max() < 1e-11 * max(1.0, np.abs(theirs).max())


@solids
def test_compliance_is_the_surface_displacement_of_the_direct_solve(coatings, substrate):
    nu = coatings[0][1]
    for k in (1e-6, 1e-3, 0.1, 1.0, 10.0, 100.0):
        exact = direct_solve(k, coatings, substrate, "normal")(0.0, 0)[4] / (2 * (1 - nu))
        assert compliance(k, coatings, substrate) == pytest.approx(exact, rel=1e-9, abs=0)


@pytest.mark.parametrize("ratio", [1e-6, 0.01, 0.25, 4.0, 100.0])
@pytest.mark.parametrize(("nu1", "nu2"), [(0.0, 0.5), (0.3, 0.3), (0.5, 0.0), (0.5, 0.5)])
def test_closed_form_of_one_coating_agrees_with_the_layered_scheme(ratio, nu1, nu2):
    k = np.logspace(-6, 4, 500)  # kh over ten decades
    closed = compliance_excess(k, ((ratio, nu1, 1.0),), (1.0, nu2))
    split = compliance_excess(k, ((ratio, nu1, 0.4), (ratio, nu1, 0.6)), (1.0, nu2))
    # both subtract numbers that differ by 1/ratio only
    assert np.abs(closed - split).max() < 1e-13 * max(1, ratio) * np.abs(closed).max()


@solids
def test_compliance_runs_from_the_substrate_to_the_coating(coatings, substrate):
    E1, nu1, _ = coatings[0]
    E2, nu2 = substrate
    limit = E1 / (1 - nu1**2) * (1 - nu2**2) / E2
    assert compliance(0.0, coatings, substrate) == pytest.approx(limit, rel=1e-9, abs=0)
    # M is smooth at k = 0: over kh = 1e-6 it moves by less than 1e-3 of its own scale
    assert compliance(1e-6, coatings, substrate) == pytest.approx(limit, rel=1e-3, abs=0)
    assert compliance(1e4, coatings, substrate) == 1.0


@solids
@pytest.mark.parametrize("load", ["normal", "in-plane", "anti-plane"])
def test_excess_is_the_response_less_that_of_the_homogeneous_coating(coatings, substrate, load):
    k, z = np.array([1e-3, 0.3, 1.0, 3.0]), np.linspace(0, coatings[0][2], 4)
    whole = stress_frf(k, z, 0, coatings=coatings, substrate=substrate, load=load)
    bare = stress_frf(k, z, 0, coatings=(), substrate=coatings[0][:2], load=load)
    excess = stress_frf(k, z, 0, coatings=coatings, substrate=substrate, load=load, excess=True)
    assert np.abs(excess - (whole - bare)).max() < 1e-12 * max(1, np.abs(whole).max())


@solids
def test_excess_keeps_its_digits_when_it_is_tiny(coatings, substrate):
    # at kh = 60 the difference of the two responses is rounding only; the excess is 1e-40 and smooth
    k = 60 / coatings[0][2] * np.array([1.0, 1.01])
    mean = compliance_excess(k, coatings, substrate)
    assert np.all(mean != 0)
    assert mean[1] / mean[0] == pytest.approx(np.exp(-1.2), rel=0.05)  # (kh)^2 exp(-2kh): 1.01^2 and less


@solids
def test_anti_plane_fields_satisfy_equilibrium_and_hooke(coatings, substrate):
    k = np.array([0.5, 2.0])
    for layer in range(len(coatings) + 1):
        top = sum(c[2] for c in coatings[:layer])
        depth = coatings[layer][2] if layer < len(coatings) else 1.0
        E, nu = (*coatings, substrate)[layer][:2]
        G = E / (2 * (1 + nu))
        step = 1e-3 * depth
        z = top + depth / 2 + step * np.arange(-2, 3)

        def ddz(field, step=step):
            """Five-point derivative at the middle depth, error step^4 k^4."""
            return (field[..., 0, :] - 8 * field[..., 1, :] + 8 * field[..., 3, :] - field[..., 4, :]) / (
                12 * step
            )

        kwargs = {"coatings": coatings, "substrate": substrate, "load": "anti-plane"}
        s = stress_frf(k, z, layer, **kwargs)
        u = displacement_frf(k, z, layer, **kwargs) / k
        ds, du, s, u = ddz(s), ddz(u), s[:, 2], u[:, 2]
        residuals = [ds[0] - k * s[1], s[0] - G * du[0], s[1] - G * k * u[0]]
        scale = np.abs(s).max() * max(1, k.max())
        assert np.abs(residuals).max() < 1e-8 * scale  # differences: 1e-16 / 1e-3 and 1e-12


def test_anti_plane_response_of_one_coating_is_the_closed_form():
    k, h, G1, G2 = np.array([0.1, 1.0, 5.0]), 0.8, 3.0, 1.0
    coatings, substrate = ((2 * G1 * 1.3, 0.3, h),), (2 * G2 * 1.3, 0.3)
    z = np.array([0.0, 0.3, 0.8])
    ks, th = (G1 - G2) / (G1 + G2), np.exp(-2 * k * h)
    decay, image = np.exp(-k * z[:, None]), np.exp(-k * (2 * h - z[:, None]))
    kwargs = {"coatings": coatings, "substrate": substrate, "load": "anti-plane"}
    u_T = displacement_frf(k, z, 0, **kwargs)[0]
    s_Tz, s_LT = stress_frf(k, z, 0, **kwargs)
    np.testing.assert_allclose(u_T, -(decay + ks * image) / (1 - ks * th) / G1, rtol=1e-13)
    np.testing.assert_allclose(s_LT, G1 * u_T, rtol=1e-13)
    np.testing.assert_allclose(s_Tz, (decay - ks * image) / (1 - ks * th), rtol=1e-13)


def test_anti_plane_fields_continue_across_interfaces():
    coatings, substrate = SOLIDS["five coatings"]
    k, depth = np.logspace(-4, 2, 20), 0.0
    for layer, (_, _, h) in enumerate(coatings):
        depth += h
        kwargs = {"coatings": coatings, "substrate": substrate, "load": "anti-plane"}
        for field, row in ((stress_frf, 0), (displacement_frf, 0)):
            above = field(k, [depth], layer, **kwargs)[row]
            below = field(k, [depth], layer + 1, **kwargs)[row]
            np.testing.assert_allclose(above, below, rtol=1e-11, atol=1e-300)


@pytest.mark.parametrize("ratio", [1e-8, 1e-4, 1e4, 1e6, 1e8])
def test_closed_form_keeps_its_digits_at_large_contrast(ratio):
    """Against the layered system in 60 digits; kh where a stiff coating bends among them."""
    solid = ((ratio, 0.3, 1.0),), (1.0, 0.25)
    for k in (1e-9, 1e-6, 1e-3, ratio ** (-1 / 3), 0.1, 1.0, 5.0):
        exact = direct_solve(k, *solid, "normal")(0.0, 0)[4] / (2 * 0.7)
        # 1 + excess is rounded in the last digits of 1.
        assert compliance(k, *solid) == pytest.approx(exact, rel=1e-12, abs=1e-15)
