"""NGSolve: axisymmetric elements of third order under a uniform disc; lengths over its radius."""

import ngsolve
import numpy as np
from netgen import geom2d, meshing
from ngsolve import dx, grad, x

FAR, SIDE = 500.0, 1e-6  # size of the solid; distance to the sides of an interface


def mesh_of(depths, size):
    """Layers from the surface down, small elements near the disc and at its rim."""
    shape, count = geom2d.SplineGeometry(), len(depths) - 1
    corner = {at: shape.AppendPoint(*at) for z in depths for at in ((0, z), (FAR, z))}
    rim = shape.AppendPoint(1, 0)
    for k, z in enumerate(depths):
        ends = [corner[0, z], *([] if k else [rim]), corner[FAR, z]]
        names = ["far" if k == count else ""] if k else ["load", ""]
        for *line, name in zip(ends[:-1], ends[1:], names, strict=True):
            shape.Append(["line", *line], bc=name, leftdomain=(k + 1) % (count + 1), rightdomain=k)
        for r, name, left, right in ((0, "axis", 0, k + 1), (FAR, "far", k + 1, 0)) if k < count else ():
            line = ["line", corner[r, z], corner[r, depths[k + 1]]]
            shape.Append(line, bc=name, leftdomain=left, rightdomain=right)
    fine = meshing.MeshingParameters(maxh=FAR / 3, grading=0.3)
    for r, z in np.mgrid[0:1.6:size, 0:1.6:size].reshape(2, -1).T:
        fine.RestrictH(r, z, 0, h=size)
    fine.RestrictH(1, 0, 0, h=size / 8)
    return ngsolve.Mesh(shape.GenerateMesh(mp=fine))


def solve(substrate, coatings=(), pressure=None, load_radius=None, size=0.2, **sphere):
    """The weak form over the section; the stresses of an element on its own side of an interface."""
    if pressure is None:
        raise NotImplementedError("this adapter prescribes the pressure")
    depths = [0.0, *np.cumsum([h / load_radius for *_, h in coatings]).tolist(), FAR]
    mesh = mesh_of(depths, size)
    E, nu = (ngsolve.CF([layer[i] for layer in (*coatings, substrate)]) for i in (0, 1))
    mu, lame = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    space = ngsolve.H1(mesh, order=3, dirichlet="far|axis") * ngsolve.H1(mesh, order=3, dirichlet="far")
    strain = lambda u, w: (grad(u)[0], u / x, grad(w)[1], grad(u)[1] + grad(w)[0])  # noqa: E731
    stress_of = lambda e: [*(lame * sum(e[:3]) + 2 * mu * e[i] for i in range(3)), mu * e[3]]  # noqa: E731
    (u, w), (v, q) = space.TnT()
    form = sum(s * e for s, e in zip(stress_of(strain(u, w)), strain(v, q), strict=True))
    K = ngsolve.BilinearForm(form * x * dx(bonus_intorder=2)).Assemble()
    F = ngsolve.LinearForm(pressure * q * x * ngsolve.ds("load")).Assemble()
    found = ngsolve.GridFunction(space)
    found.vec.data = K.mat.Inverse(space.FreeDofs(), "sparsecholesky") * F.vec
    sigma = stress_of(strain(*found.components))

    def stress(at_x, at_y, z, layer):
        theta, r = np.arctan2(at_y, at_x), np.maximum(np.hypot(at_x, at_y) / load_radius, 1e-9)
        depth = np.clip(z / load_radius, depths[layer] + SIDE, depths[layer + 1] - SIDE)
        rr, tt, zz, rz = np.array(
            [[s(mesh(*place)) for s in sigma] for place in zip(r, depth, strict=True)]
        ).T
        c, s, o = np.cos(theta), np.sin(theta), 0 * r
        Q = np.array([[c, -s, o], [s, c, o], [o, o, 1 + o]])
        return np.einsum("ian,abn,jbn->ijn", Q, np.array([[rr, o, rz], [o, tt, o], [rz, o, zz]]), Q)

    return {"stress": stress}
