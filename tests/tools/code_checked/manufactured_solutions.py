"""Manufactured solutions of the axisymmetric operator: observed against design order of convergence.

Two bonded materials on a unit square, harmonics 0 and 1. A displacement field is prescribed, its body forces
are applied, and the error of the computed field has to fall at the design order as the mesh is refined.
"""

from itertools import product

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, MeshTri

from fem_reference.elasticity.axisymmetric import ELEMENTS, Discretisation, elasticity
from fem_reference.elasticity.linear_system import constrained_solve
from fem_reference.meshing.mesh import MeridianMesh
from verification.evidence.code_record import DesignOrder
from verification.problem.array_types import Array

CELLS = (4, 8)  # a side


def design_orders(cells: tuple[int, int] = CELLS) -> tuple[DesignOrder, ...]:
    """Observed orders of elements of order 2, 3, 4 in both harmonics, from meshes of ``cells`` a side."""
    found = []
    span = np.log(cells[1] / cells[0])
    for order, harmonic in product((2, 3, 4), (0, 1)):
        coarse, fine = (galerkin_errors(order, harmonic, n) for n in cells)
        displacement, gradient = (np.log(np.array(coarse) / np.array(fine)) / span).tolist()
        found.append(DesignOrder(order, harmonic, displacement, gradient, (coarse[0], fine[0])))
    return tuple(found)


H = 0.5  # interface of a unit square
MATERIALS = ((3.0, 0.2), (1.0, 0.4))


def unit_square(cells: int, skew: float = 0.0) -> MeridianMesh:
    """Mesh of 0 <= r, z <= 1 with the interface at z = H, inner vertices moved by ``skew`` of a cell."""
    grid = MeshTri.init_tensor(np.linspace(0, 1, cells + 1), np.linspace(0, 1, cells + 1))
    points, triangles = np.ascontiguousarray(grid.p), np.ascontiguousarray(grid.t)
    layer = (points[1, triangles].mean(axis=0) > H).astype(int)
    moved = points.copy()
    inner = np.all((points > 0) & (points < 1), axis=0)
    shift = skew / cells * np.random.default_rng(1).uniform(-1, 1, points.shape)
    moved[0, inner] += shift[0, inner]
    off_interface = inner & (points[1] != H)
    moved[1, off_interface] += shift[1, off_interface]
    return MeridianMesh(moved, triangles, layer, np.array([H]), 0.5, 1.0, 1.0)


def elongation(z: Array) -> tuple[Array, Array]:
    """u_z and its slope for eps_rr = eps_tt = 1 and sigma_zz = 0.7 in both materials."""
    constants = [(E * nu / ((1 + nu) * (1 - 2 * nu)), E / (1 + nu)) for E, nu in MATERIALS]
    slope = np.where(z < H, *((0.7 - 2 * lame) / (lame + two_mu) for lame, two_mu in constants))
    return slope * (z - H), slope


def shear(z: Array) -> tuple[Array, Array]:
    """u_x and its slope for sigma_xz = 0.7 in both materials."""
    slope = np.where(z < H, *(0.7 * 2 * (1 + nu) / E for E, nu in MATERIALS))
    return slope * (z - H), slope


def boundary(d: Discretisation) -> NDArray[np.int_]:
    """Numbers of the nodes on the edge of the square."""
    return np.flatnonzero((d.locations == 0).any(axis=0) | (d.locations == 1).any(axis=0))


def manufactured(harmonic: int, r: Array, z: Array) -> tuple[Array, Array]:
    """Fields and strains, continuous in displacement and traction across z = H.

    The patch state plus (z - H)^2 times a smooth function, another one in each material; the strains are
    derived by hand from u_r, u_theta, u_z, not from the package's operator.
    """
    s = z - H
    w = np.where(z < H, 1.0, -2.0)  # the materials' own amplitudes
    k = np.where(z < H, 2.0, 1.5)
    f, f_z = w * s**2 * np.cos(k * z), w * (2 * s * np.cos(k * z) - k * s**2 * np.sin(k * z))
    if harmonic == 0:
        U, U_r, U_z = r + np.sin(2 * r) * f, 1 + 2 * np.cos(2 * r) * f, np.sin(2 * r) * f_z
        rise, slope = elongation(z)
        Z, Z_r, Z_z = rise + np.cos(2 * r) * f, -2 * np.sin(2 * r) * f, slope + np.cos(2 * r) * f_z
        return np.stack([U, Z]), np.stack([U_r, U / r, Z_z, U_z + Z_r])
    g, g_z = shear(z)
    U, U_r, U_z = g + np.cos(r) * f, -np.sin(r) * f, g_z + np.cos(r) * f_z
    V, V_r, V_z = -g - np.cos(2 * r) * f, 2 * np.sin(2 * r) * f, -g_z - np.cos(2 * r) * f_z
    Z, Z_r, Z_z = np.sin(r) * f, np.cos(r) * f, np.sin(r) * f_z
    strains = [U_r, (U + V) / r, Z_z, U_z + Z_r, -U / r + V_r - V / r, V_z - Z / r]
    return np.stack([U + V, V, Z]), np.stack(strains)


def galerkin_errors(order: int, harmonic: int, cells: int) -> tuple[float, float]:
    """L2 errors of the fields and of their gradients for the manufactured solution, boundary values given."""
    d = Discretisation(unit_square(cells), order)
    basis = Basis(d.triangulation, ELEMENTS[order](), intorder=2 * order)
    r, z = np.asarray(basis.global_coordinates())
    weight = r * basis.dx
    exact, strain = manufactured(harmonic, r, z)
    D = np.stack([elasticity(E, nu, harmonic) for E, nu in MATERIALS])[d.mesh.layer]
    stress = np.einsum("est,teq->seq", D, strain)
    fields = exact.shape[0]
    load = np.zeros((fields, d.N))
    for i, b in enumerate(basis.basis):
        phi, (phi_r, phi_z) = np.asarray(b[0]), b[0].grad
        if harmonic == 0:
            rr, tt, zz, rz = stress
            virtual = [rr * phi_r + tt * phi / r + rz * phi_z, zz * phi_z + rz * phi_r]
        else:
            rr, tt, zz, rz, rt, tz = stress
            U = rr * phi_r + tt * phi / r + rz * phi_z - rt * phi / r
            V = tt * phi / r + rt * (phi_r - phi / r) + tz * phi_z
            # S = U + V with V fixed moves U alone; V with S fixed moves V by 1 and U by -1
            virtual = [U, V - U, zz * phi_z + rz * phi_r - tz * phi / r]
        for field, work in enumerate(virtual):
            np.add.at(load[field], basis.element_dofs[i], np.sum(work * weight, axis=-1))
    fixed = boundary(d)
    r_n, z_n = d.locations
    given, _ = manufactured(harmonic, np.maximum(r_n, 1e-300), z_n)
    numbers = np.concatenate([field * d.N + fixed for field in range(fields)])
    u = constrained_solve(d.stiffness(MATERIALS, harmonic), given.ravel(), numbers, load.ravel()).u
    computed = [basis.interpolate(field) for field in u.reshape(fields, -1)]
    step = 1e-6
    right, _ = manufactured(harmonic, r + step, z)
    left, _ = manufactured(harmonic, r - step, z)

    def norm(difference: Array) -> float:
        return float(sum(np.sum(one**2 * weight) for one in difference) ** 0.5)

    gradients = np.stack([c.grad[0] for c in computed])
    values = np.stack([np.asarray(c) for c in computed])
    return norm(values - exact), norm(gradients - (right - left) / (2 * step))
