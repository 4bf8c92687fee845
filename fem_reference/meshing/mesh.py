"""Meridian plane of a coated half-space, meshed by gmsh with grading to the contact edge.

The sizes are by hand: gmsh grades a mesh, but does not know where the stresses of a contact need it.

The mesher works in a stretched plane (xi, zeta) in which the whole problem has one length scale,

    r - a = l sinh(xi),      z = l sinh(zeta),      l = sqrt(a min(a, h)),   h: thickness of the top coating,

so that triangles near the edge r = a, z = 0 are fine, thin coatings far out are resolved by flat triangles
instead of by many, and the outer boundary costs the logarithm of its distance. With l = h the triangles of a
thin film are so flat that twice as many give errors ten times as large. Towards the edge the size
falls in proportion to the distance, down to ``edge_size``. All lengths are in one unit of the caller's
choice.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fem_reference import element_numbers as chosen
from fem_reference.meshing.gmsh_session import session


@dataclass(frozen=True)
class Grading:
    """Sizes of the triangles.

    size      : size of a triangle over its distance from the edge, in the contact and the coatings
    edge_rate : the same ratio in the fan of triangles around the contact edge, at the distance of one unit
        of the stretched plane; it grows towards the edge, see ``FAN_POWER``
    edge_size : smallest triangle, at the edge, over the contact radius
    axis_size : size at the point of first contact, in units of the stretched plane
    far_size  : largest size towards the outer boundary, where one unit is a factor e of distance
    film_size : the same in the coatings
    rows      : triangles across each coating at least, near the contact; fewer where they would be smaller
        than ``LEAST_ROW`` times size
    surface   : size on the surface of the contact over its radius, growing below it; 0 for none of its own
    edges     : radii over the contact's at which the pressure has a root, smaller triangles around each
    """

    size: float = 0.4
    edge_rate: float = 0.5
    edge_size: float = 1e-7
    axis_size: float = 0.2
    far_size: float = 0.8
    film_size: float = 0.8
    rows: float = 2.0
    surface: float = 0.0
    edges: tuple[float, ...] = ()

    @classmethod
    def of(cls, size: float) -> "Grading":
        """All sizes from one; the fan at the edge and the far field need less fine triangles."""
        fan = min(chosen.FAN_SIZE * size, chosen.LARGEST_IN_FAN)
        far = min(chosen.FAR_SIZE * size, chosen.LARGEST_FAR)
        return cls(size, fan, chosen.EDGE_SIZE, chosen.AXIS_SIZE * size, far, far, chosen.ROWS)

    def coarser(self) -> "Grading":
        """With all sizes larger by the factor of a family of meshes."""
        r = chosen.COARSER
        return replace(
            self,
            size=r * self.size,
            edge_rate=r * self.edge_rate,
            edge_size=chosen.EDGE_COARSER * self.edge_size,
            axis_size=r * self.axis_size,
            far_size=r * self.far_size,
            film_size=r * self.film_size,
            rows=self.rows / r,
        )

    def limited(self, share: float) -> "Grading":
        """With sizes at the edge, far away and in the coatings within this ``share`` of the largest ones."""
        return replace(
            self,
            edge_rate=min(self.edge_rate, chosen.LARGEST_IN_FAN * share),
            far_size=min(self.far_size, chosen.LARGEST_FAR * share),
            film_size=min(self.film_size, chosen.LARGEST_IN_FILM * share),
        )


def surface_size(size: float, distance: np.ndarray | float) -> np.ndarray:
    """Size of triangles of a surface of that ``size`` at a ``distance`` from one of its edges."""
    return np.clip(chosen.SURFACE_RATE * size * np.asarray(distance), chosen.SURFACE_LEAST * size, size)


@dataclass(frozen=True, eq=False)
class MeridianMesh:
    """Triangles in (r, z) with a layer number each.

    points    : (2, n) vertices (r, z)
    triangles : (3, m) vertex numbers
    layer     : (m,) layer of each triangle, 0 at the surface, the last is the substrate
    depths    : (number of coatings,) depth of each interface
    contact_radius, far : radius of a vertex on the surface; extent of the solid in r and z
    length, stretch : l of the stretched plane; factor by which all radii were multiplied since
    """

    points: np.ndarray
    triangles: np.ndarray
    layer: np.ndarray
    depths: np.ndarray
    contact_radius: float
    far: float
    length: float
    stretch: float = 1.0

    def stretched(self, factor: float) -> "MeridianMesh":
        """The mesh with all radii multiplied by ``factor``: the contact edge moves, no depth does."""
        points, stretch = self.points * np.array([[factor], [1.0]]), self.stretch * factor
        return replace(self, points=points, contact_radius=self.contact_radius * factor, stretch=stretch)

    def plane(self, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Stretched-plane coordinates (xi, zeta) of the points (r, z); shape (2,) + points."""
        offset = (r - self.contact_radius) / (self.stretch * self.length)
        return np.stack([np.arcsinh(offset), np.arcsinh(z / self.length)])


def meridian_mesh(
    *,
    contact_radius: float,
    thicknesses: tuple[float, ...],
    far: float,
    grading: Grading,
    stacks: tuple[tuple[float, ...], ...] = (),
) -> MeridianMesh:
    """Triangulate 0 <= r, z <= ``far`` with a vertex at r = ``contact_radius`` on the surface.

    stacks : thicknesses of the coatings of all solids in contact, this one alone unless given. The vertices
    of the surface depend on the contact radius, ``far``, ``grading`` and them alone.
    Raises ValueError when the contact or the coatings do not fit into the half-space.
    """
    a = contact_radius
    depths = np.cumsum(np.asarray(thicknesses, dtype=float))
    if depths.size and not depths[-1] < 0.5 * far:
        raise ValueError(f"coatings reach {depths[-1]:g} deep; choose a far boundary beyond {far:g}")
    if not a < 0.1 * far:
        raise ValueError(f"contact radius {a:g}; choose a far boundary farther out than {far:g}")
    stacks = stacks or (thicknesses,)
    length = float(np.sqrt(a * min([a, *(h for stack in stacks for h in stack[:1])])))
    xi = np.array([-np.arcsinh(a / length), 0.0, np.arcsinh((far - a) / length)])
    zeta = np.concatenate([[0.0], np.arcsinh(depths / length), [np.arcsinh(far / length)]])

    bounds = [np.arcsinh(np.cumsum([0.0, *stack]) / length) for stack in stacks]
    films = sorted({pair for levels in bounds for pair in pairwise(levels.tolist())})
    nodes, triangles, layer = _triangulate(xi, zeta, films, a / length, grading)
    # Vertices meant to lie on the axis, the interfaces or the outer boundary lie there exactly.
    r = a + length * np.sinh(nodes[0])
    z = length * np.sinh(nodes[1])
    r[np.isclose(nodes[0], xi[0], rtol=0, atol=1e-9)] = 0.0
    r[np.abs(nodes[0]) < 1e-14] = a
    r[np.isclose(nodes[0], xi[2], rtol=0, atol=1e-9)] = far
    for level, depth in zip(zeta, (0.0, *depths, far), strict=True):
        z[np.isclose(nodes[1], level, rtol=0, atol=1e-12 * zeta[-1])] = depth
    points = np.ascontiguousarray([r, z])
    area = _twice_area(points, triangles)
    if np.any(area <= 0):
        raise ValueError(
            f"{np.count_nonzero(area <= 0)} triangles are inverted when mapped to the meridian plane; "
            f"choose a finer mesh than size = {grading.size:g}, far_size = {grading.far_size:g}"
        )
    return MeridianMesh(points, triangles, layer, depths, a, far, length)


def _twice_area(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Signed doubled area of each triangle, positive when counter-clockwise in (r, z)."""
    (r0, z0), (r1, z1), (r2, z2) = (points[:, corner] for corner in triangles)
    return (r1 - r0) * (z2 - z0) - (r2 - r0) * (z1 - z0)


def _triangulate(
    xi: np.ndarray, zeta: np.ndarray, films: list[tuple[float, float]], scale: float, grading: Grading
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mesh the stretched plane.

    films : upper and lower zeta of the coatings of all bodies.   scale : a / l, converts to units of l
    Returns the nodes (2, n), the triangles (3, m) and their layers (m,).
    """
    with session("coated half-space") as gmsh:
        geo = gmsh.model.geo
        axis = [geo.addPoint(xi[0], level, 0) for level in zeta]
        far = [geo.addPoint(xi[2], level, 0) for level in zeta]
        edge = geo.addPoint(xi[1], 0, 0)
        inner = [geo.addPoint(np.arcsinh((r - 1) * scale), 0, 0) for r in sorted(grading.edges)]
        down_axis = [geo.addLine(p, q) for p, q in pairwise(axis)]
        down_far = [geo.addLine(p, q) for p, q in pairwise(far)]
        across = [[geo.addLine(p, q) for p, q in pairwise([axis[0], *inner, edge, far[0]])]]
        across += [[geo.addLine(p, q)] for p, q in zip(axis[1:], far[1:], strict=True)]
        layers = []
        for k in range(len(zeta) - 1):
            bottom = [-curve for curve in reversed(across[k + 1])]
            loop = geo.addCurveLoop([*across[k], down_far[k], *bottom, -down_axis[k]])
            layers.append(geo.addPlaneSurface([loop]))
        geo.synchronize()

        rho = "Sqrt(x*x+y*y)"
        bare = np.arcsinh(chosen.UNIFORM_DEPTH * scale)
        near = max([bare, *(lower for _, lower in films)])
        growth = f"(1+{_literal(chosen.GROWTH * bare / near)}*Max(0,{rho}-{_literal(near)}))"
        fan = f"{_literal(grading.edge_rate)}*{rho}^{_literal(chosen.FAN_POWER)}"
        origin = f"Sqrt((x-({_literal(xi[0])}))^2+y*y)"
        distant, film_growth = _literal(grading.far_size), _literal(chosen.FILM_GROWTH)
        if grading.surface:
            # fine below the pressure alone; all along the axis, where r dr holds fields least
            origin = f"(x-({_literal(xi[0])}))"
            distant = f"{distant}*(1+{_literal(chosen.SURFACE_BELOW)}*Max(0,{rho}-{_literal(bare)}))"
        sizes = [
            f"{fan}+{_literal(grading.edge_size * scale)}",
            f"Min({distant},{_literal(grading.size)}*{growth})",
            # p(0) has no neighbours on its other side: finer triangles at the point of first contact
            f"{_literal(grading.axis_size)}*{growth}+{_literal(chosen.AXIS_GROWTH)}*{origin}",
        ]
        if grading.surface:  # dr = l cosh(xi) dxi
            even = f"({_literal(grading.surface * scale)}+{_literal(chosen.SURFACE_BELOW)}*y)/Cosh(Min(x,0))"
            sizes.append(f"{even}+{_literal(chosen.SURFACE_BEYOND)}*Max(0,x)")
            least = _literal(chosen.SURFACE_LEAST * grading.surface * scale)
            rate, buried = (
                _literal(one * grading.surface) for one in (chosen.SURFACE_RATE, chosen.BURIED_RATE)
            )
            for r in grading.edges:
                along = f"(Sinh(x)+{_literal((1 - r) * scale)})^2"
                sizes.append(f"Max({least},{rate}*Sqrt({along}+Sinh(y)^2))/Cosh(Min(x,0))")
                for _, lower in films:
                    deep = f"{buried}*Sqrt({along}+Sinh({_literal(lower)})^2)/Cosh(Min(x,0))"
                    sizes.append(f"{deep}+{film_growth}*Abs(y-({_literal(lower)}))")
        for upper, lower in films:
            away = f"Max(0,Max(y-({_literal(lower)}),{_literal(upper)}-y))"
            row = max((lower - upper) / grading.rows, chosen.LEAST_ROW * grading.size)
            sizes.append(f"Min({_literal(grading.film_size)},{_literal(row)}*{growth})+{film_growth}*{away}")
        field = gmsh.model.mesh.field
        for number, size in enumerate(sizes, start=1):
            field.add("MathEval", number)
            field.setString(number, "F", size)
        smallest = field.add("Min")
        field.setNumbers(smallest, "FieldsList", list(range(1, len(sizes) + 1)))
        field.setAsBackgroundMesh(smallest)
        gmsh.model.mesh.generate(2)

        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        order = np.full(int(tags.max()) + 1, -1)
        order[tags.astype(int)] = np.arange(tags.size)
        members = [gmsh.model.mesh.getElementsByType(2, surface)[1].astype(int) for surface in layers]
    nodes = coordinates.reshape(-1, 3).T[:2]
    corners = order[np.concatenate(members)].reshape(-1, 3).T
    layer = np.repeat(np.arange(len(layers)), [corner.size // 3 for corner in members])
    # gmsh returns the surfaces as oriented by their loop; make every triangle counter-clockwise
    flip = _twice_area(nodes, corners) < 0
    corners[1:, flip] = corners[:0:-1, flip]
    return nodes, np.ascontiguousarray(corners), layer


def _literal(value: float) -> str:
    """A number as gmsh's expressions accept it; others, such as "np.float64(1.0)", abort the process.

    Raises ValueError where it is not finite.
    """
    if not np.isfinite(value):
        raise ValueError(f"a size of the mesh is {value}; check the thicknesses against the contact radius")
    return repr(float(value))
