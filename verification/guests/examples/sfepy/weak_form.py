"""Elements of second order by sfepy: r the first coordinate, z the second, into the solid.

sfepy has no axisymmetric elasticity: both displacements are scalar fields, whose terms carry r as a weight.
"""

import numpy as np
from grid import grid  # type: ignore[import-not-found]
from sfepy.discrete import Equation, Equations, FieldVariable, Integral, Material, Problem
from sfepy.discrete.conditions import Conditions, EssentialBC
from sfepy.discrete.fem import Field
from sfepy.solvers.ls import ScipyDirect
from sfepy.solvers.nls import Newton
from sfepy.terms import Term


def weights_of(layers, bounds):
    """Moduli times r at the quadrature points, as a function of a material."""

    def weights(ts, at, mode=None, **_):
        if mode != "qp":
            return None
        (E, nu), x = layers[np.searchsorted(bounds, at[:, 1])].T, at[:, 0]
        mu, la = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
        o, full = 0 * x, la + 2 * mu
        pairs = {"vu": (full, o, o, mu), "vw": (o, la, mu, o), "qu": (o, mu, la, o), "qw": (mu, o, o, full)}
        found = {name: (np.stack(c, -1) * x[:, None]).reshape(-1, 2, 2) for name, c in pairs.items()}
        found |= {"r": np.stack([la, o], -1)[..., None], "z": np.stack([o, la], -1)[..., None]}
        return found | {"hoop": (full / x)[:, None, None], "load": x[:, None, None]}

    return weights


def displaced(layers, bounds, far, size):
    """Fields u and w under pressure 1 on the disc of radius 1."""
    domain, solid = (found := grid(bounds, far, size)), found.create_region("solid", "all")
    disc = domain.create_region("disc", "vertices in (y < 1e-9) & (x < 1.000001)", "facet")
    away = domain.create_region("far", f"vertices in (x > {far - 1}) | (y > {far - 1})", "facet")
    axis = domain.create_region("axis", "vertices in (x < 1e-9)", "facet")
    field = Field.from_args("f", np.float64, "scalar", solid, approx_order=2)
    u, w = (FieldVariable(name, "unknown", field) for name in "uw")
    v, q = (FieldVariable(name, "test", field, primary_var_name=of) for name, of in ("vu", "qw"))
    given = {"m": Material("m", function=weights_of(layers, bounds)), "u": u, "w": w, "v": v, "q": q}
    texts = [f"dw_diffusion(m.{name}, {name[0]}, {name[1]})" for name in ("vu", "vw", "qu", "qw")]
    # lambda times the hoop strain of one field and the gradient of the other
    mixed = ("r, v, u", "z, v, w", "r, u, v", "z, u, q")
    texts += ["dw_dot(m.hoop, v, u)", *(f"dw_s_dot_mgrad_s(m.{names})" for names in mixed)]
    order = Integral("i", order=4)
    first, *rest = (Term.new(text, order, solid, **given) for text in texts)
    load = Term.new("dw_integrate(m.load, q)", order, disc, **given)
    problem = Problem("p", equations=Equations([Equation("balance", sum(rest, first) - load)]))
    fixed = [EssentialBC("far", away, {"u.0": 0.0, "w.0": 0.0}), EssentialBC("axis", axis, {"u.0": 0.0})]
    problem.set_bcs(ebcs=Conditions(fixed))
    problem.set_solver(Newton({}, lin_solver=ScipyDirect({})))
    problem.solve()
    return u, w
