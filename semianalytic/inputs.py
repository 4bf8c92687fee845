"""Checked input of the semi-analytical method."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semianalytic import numbers
from semianalytic.coefficients.response import Response, response


@dataclass(frozen=True)
class Numerics:
    """Numerical parameters; the uncertainty covers those that change a result.

    patches : per side of the finest grid.  tolerance : gap and penetration over the approach.
    conversion : "split", with ``hankel_points``, or "plain".  accuracy : for which patches are refined.
    """

    patches: int = 257
    tolerance: float = 1e-8
    max_iterations: int = 600
    conversion: str = "split"
    threads: int = 1
    accuracy: float | None = None
    hankel_points: int = 4096

    def __post_init__(self) -> None:
        for name in ("patches", "max_iterations", "threads"):
            value = getattr(self, name)
            if not isinstance(value, (int, np.integer)) or isinstance(value, bool):
                raise ValueError(f"{name} = {value!r}; it has to be an integer")
            if value < 1:
                raise ValueError(f"{name} = {value}; it must be at least 1")
        if not _is_number(self.tolerance):
            raise ValueError(f"tolerance = {self.tolerance!r}; it has to be a number")
        if self.patches < numbers.COARSEST:
            raise ValueError(f"patches = {self.patches}; it must be odd and at least {numbers.COARSEST}")
        if not 1e-13 <= self.tolerance < 1:
            raise ValueError(f"tolerance = {self.tolerance:g}; give 1e-13 or more, 1e-8 is the default")
        if self.conversion not in ("split", "plain"):
            raise ValueError(f"conversion = {self.conversion!r}; choose split or plain")


@dataclass(frozen=True)
class Body:
    """The coated half-space and the friction on it, as given to the public functions.

    friction : f of the traction f p in +x.  ball : the elastic body pressed on it, None if that is rigid.
    """

    coatings: tuple[tuple[float, float, float], ...]
    substrate: tuple[float, float]
    friction: float
    ball: "Body | None" = None

    def __post_init__(self) -> None:
        check_finite(friction=self.friction)
        if not isinstance(self.coatings, Sequence) or isinstance(self.coatings, str):
            raise ValueError(f"coatings = {self.coatings!r}; give a tuple of (E, nu, thickness), () for none")
        for k, coating in enumerate(self.coatings, start=1):
            if not isinstance(coating, Sequence) or len(coating) != 3:
                raise ValueError(f"coating {k} = {coating!r}; give (E, nu, thickness)")
            _check_material(f"of coating {k}", *coating[:2])
            check_positive(**{f"thickness of coating {k}": coating[2]})
        if not isinstance(self.substrate, Sequence) or len(self.substrate) != 2:
            raise ValueError(f"substrate = {self.substrate!r}; give (E, nu)")
        _check_material("of the substrate", *self.substrate)

    @classmethod
    def of_ball(cls, ball: Any, friction: float) -> "Body":
        """The elastic ball (E, nu, coatings), on which the traction is -f p.

        Raises ValueError where it is none.
        """
        if not isinstance(ball, Sequence) or len(ball) != 3:
            raise ValueError(f"ball = {ball!r}; give (E, nu, coatings), or None for a rigid one")
        E, nu, coatings = ball
        try:
            return cls(coatings, (E, nu), -friction)
        except ValueError as error:
            raise ValueError(f"ball: {error}") from None

    def with_friction(self, friction: float) -> "Body":
        """The body under the traction f p of another ``friction`` f, the ball under -f p."""
        ball = None if self.ball is None else self.ball.with_friction(-friction)
        return replace(self, friction=friction, ball=ball)

    def named(self, body: str) -> "Body":
        """The flat or the ball by name. Raises ValueError for the ball where it is rigid."""
        if body == "flat":
            return self
        if body == "ball" and self.ball is not None:
            return self.ball
        names = "'flat', the ball is rigid" if self.ball is None else "'flat' or 'ball'"
        raise ValueError(f"body = {body!r}; choose {names}")

    @property
    def pair(self) -> "tuple[Body, ...]":
        """The elastic bodies in contact."""
        return (self,) if self.ball is None else (self, self.ball)

    @property
    def contact_modulus(self) -> float:
        """E* [Pa] of the materials in contact, 1/E* = sum (1 - nu^2)/E of flat and elastic ball."""
        return self.moduli[0] if self.ball is None else 1 / sum(1 / body.moduli[0] for body in self.pair)

    @cached_property
    def response(self) -> Response | None:
        """Response of the surfaces in contact, found once for a solve; None where no body is coated."""
        coated = [(self.contact_modulus / one.moduli[0], one.layers) for one in self.pair if one.coatings]
        return response(coated) if coated else None

    @cached_property
    def tables(self) -> dict[Any, Any]:
        """The last tables of point forces, by what they were made for: planes of one depth share them."""
        return {}

    def __getstate__(self) -> dict[str, Any]:
        # pickled without response and tables, which are found again on use
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @property
    def materials(self) -> tuple[tuple[float, ...], ...]:
        """The coatings from the surface down, then the substrate."""
        return (*self.coatings, self.substrate)

    @property
    def layers(self) -> dict[str, Any]:
        """Coatings and substrate as keywords of `frf`."""
        return {"coatings": self.coatings, "substrate": self.substrate}

    @property
    def moduli(self) -> list[float]:
        """E* = E/(1 - nu^2) of every material from the surface down [Pa]."""
        return [material[0] / (1 - material[1] ** 2) for material in self.materials]

    @property
    def thickness(self) -> list[float]:
        """Thickness of every coating [m]."""
        return [h for _, _, h in self.coatings]

    def layer_of(self, z: ArrayLike, layer: int | NDArray[np.intp] | None) -> NDArray[np.intp]:
        """Index of the layer at each depth; on an interface ``layer``, or the upper one if None.

        Raises ValueError for z < 0, and for a layer that does not contain z.
        """
        z = np.asarray(z, dtype=float)
        if not np.all(z >= 0):
            raise ValueError(f"z = {np.min(z):g} m is above the surface; depth counts down from 0")
        interfaces = np.cumsum(self.thickness)
        slack = 1e-9 * interfaces  # points within rounding of an interface are on it
        above = np.searchsorted(interfaces + slack, z)
        if layer is None:
            return above
        if not np.all((np.asarray(layer) >= 0) & (np.asarray(layer) <= len(self.coatings))):
            raise ValueError(f"layer = {layer}; layers count from 0 to {len(self.coatings)}, the substrate")
        below = np.searchsorted(interfaces - slack, z, side="right")
        outside = (layer < above) | (layer > below)
        if np.any(outside):
            raise ValueError(
                f"layer = {layer} does not hold z = {z[outside].flat[0]:g} m; the interfaces lie at "
                f"{', '.join(f'{i:g}' for i in interfaces) or 'no depth'} m"
            )
        return np.array(np.broadcast_to(layer, z.shape))


def undeformed_gap(name: str, radius: float) -> Callable[[NDArray[Any]], NDArray[Any]]:
    """Gap [m] of r [m]: "parabola" r^2/2R or "sphere" R - sqrt(R^2 - r^2), r^2/R beyond its equator.

    Raises ValueError for another name.
    """
    if name == "parabola":
        return lambda r: r**2 / (2 * radius)
    if name == "sphere":
        return lambda r: r**2 / (radius + np.sqrt(np.maximum(radius**2 - r**2, 0.0)))
    raise ValueError(f"gap = {name!r}; choose parabola or sphere")


def check_finite(**values: float) -> None:
    """Raise ValueError for any value that is not a finite number."""
    for name, value in values.items():
        if not (_is_number(value) and np.isfinite(value)):
            raise ValueError(f"{name} = {value!r}; it has to be a finite number")


def check_odd(patches: int) -> None:
    """Raise ValueError for a grid without a patch in its middle."""
    if patches % 2 == 0:
        raise ValueError(f"patches = {patches}; it must be odd and at least {numbers.COARSEST}")


def check_truth_value(**values: bool) -> None:
    """Raise ValueError for any value that is neither True nor False."""
    for name, value in values.items():
        if not isinstance(value, bool):
            raise ValueError(f"{name} = {value!r}; give True or False")


def check_positive(**values: float) -> None:
    """Raise ValueError for any value that is not a positive, finite number."""
    for name, value in values.items():
        if not (_is_number(value) and np.isfinite(value) and value > 0):
            raise ValueError(f"{name} = {value!r}; it has to be a positive finite number")


def _check_material(where: str, E: float, nu: float) -> None:
    check_positive(**{f"E {where}": E})
    if not (_is_number(nu) and -1 < nu <= 0.5):
        raise ValueError(f"nu {where} = {nu!r}; an isotropic solid has -1 < nu <= 0.5")


def _is_number(value: object) -> bool:
    """Whether a value is a real number, a NumPy scalar included: neither a truth value nor text."""
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


def check_control(load: float | None, approach: float | None) -> None:
    """Raise ValueError unless exactly one of load [N] and approach [m] is given, and positive."""
    if (load is None) == (approach is None):
        raise ValueError("give either load or approach; the other one is a result")
    if load is not None:
        check_positive(load=load)
    if approach is not None:
        check_positive(approach=approach)
