"""Checks of the input; each failure raises ValueError with a message of one line."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from fem_reference import element_numbers as chosen
from fem_reference.elasticity.line_quadrature import gauss_legendre


def check_positive(**quantities: float) -> None:
    """Raise ValueError naming the first quantity that is not a positive finite number."""
    for name, value in quantities.items():
        if not (_is_number(value) and value > 0):
            raise ValueError(f"{name} = {value!r}; it has to be a positive finite number")


def check_choice(name: str, value: object, choices: Sequence[object]) -> None:
    """Raise ValueError when ``value`` is not one of ``choices``."""
    if value not in choices:
        raise ValueError(f"{name} = {value!r}; choose one of {', '.join(map(repr, choices))}")


def check_friction(friction: float) -> None:
    """Raise ValueError when ``friction`` is not a finite number."""
    if not _is_number(friction):
        raise ValueError(f"friction = {friction!r}; it has to be a finite number")


def check_materials(
    coatings: Sequence[tuple[float, float, float]], substrate: tuple[float, float], friction: float
) -> None:
    """Raise ValueError for moduli, Poisson ratios, thicknesses or friction that make no elastic solid.

    nu = 0.5 is refused: displacements leave the pressure of an incompressible solid undetermined.
    """
    check_friction(friction)
    if not isinstance(coatings, Sequence) or isinstance(coatings, str):
        raise ValueError(f"coatings = {coatings!r}; give a tuple of (E, nu, thickness), () for none")
    if len(coatings) > chosen.MAX_COATINGS:
        raise ValueError(
            f"{len(coatings)} coatings; at most {chosen.MAX_COATINGS} can be meshed, merge thin ones into one"
        )
    if not isinstance(substrate, Sequence) or len(substrate) != 2:
        raise ValueError(f"substrate = {substrate!r}; give (E, nu)")
    for k, coating in enumerate(coatings, start=1):
        if not isinstance(coating, Sequence) or len(coating) != 3:
            raise ValueError(f"coating {k} = {coating!r}; give (E, nu, thickness)")
        _check_material(f"of coating {k}", coating[0], coating[1])
        check_positive(**{f"thickness of coating {k}": coating[2]})
        contrast = coating[0] / substrate[0] if _is_number(substrate[0]) and substrate[0] > 0 else 1.0
        if not 1 / chosen.MAX_CONTRAST <= contrast <= chosen.MAX_CONTRAST:
            raise ValueError(
                f"E of coating {k} is {contrast:g} times that of the substrate; the solver supports ratios "
                f"between {1 / chosen.MAX_CONTRAST:g} and {chosen.MAX_CONTRAST:g}, change one of the moduli"
            )
    _check_material("of the substrate", *substrate)


def check_ball(ball: tuple[float, float, Sequence[tuple[float, float, float]]]) -> None:
    """Raise ValueError unless ``ball`` is (E, nu, coatings) of an elastic solid."""
    if not isinstance(ball, Sequence) or len(ball) != 3:
        raise ValueError(f"ball = {ball!r}; give (E, nu, coatings), or None for a rigid one")
    try:
        check_materials(ball[2], ball[:2], 0.0)
    except ValueError as error:
        raise ValueError(f"ball: {error}") from None


def check_proportions(thicknesses: Sequence[float], unit: str, of: str = "") -> None:
    """Raise ValueError for coatings too thin or too thick to mesh beside a contact of radius 1 ``unit``."""
    for k, h in enumerate(thicknesses, start=1):
        if not 1 / chosen.MAX_THICKNESS <= h <= chosen.MAX_THICKNESS:
            what = "thin; leave it out" if h < 1 else "thick; use its material for the substrate"
            raise ValueError(
                f"thickness of {of}coating {k} is {h:.3g} {unit}, too {what}, or keep it between "
                f"{1 / chosen.MAX_THICKNESS:g} and {chosen.MAX_THICKNESS:g} {unit}"
            )


def check_radius(contact_radius: float, radius: float) -> None:
    """Raise ValueError for a contact as wide as the sphere, of which the gap is not a parabola."""
    if contact_radius > chosen.LARGEST_RADIUS * radius:
        share = contact_radius / radius
        raise ValueError(
            f"contact radius a = {contact_radius:g} m is {share:.2g} of the sphere's radius; the parabolic "
            f"gap and small strains hold below {chosen.LARGEST_RADIUS:g}, and well below 0.1"
        )


@dataclass(frozen=True)
class GivenPressure:
    """A prescribed pressure over ``scale`` as a function of r over ``radius``; zero beyond the load."""

    given: Callable[[np.ndarray], np.ndarray]
    radius: float
    scale: float

    def __call__(self, r: np.ndarray) -> np.ndarray:
        r = np.asarray(r, dtype=float)
        inside = r <= 1 + 1e-12
        values = np.zeros(r.shape)
        # a callable need not be defined beyond the load
        values[inside] = self.given(self.radius * np.minimum(r[inside], 1.0))
        return values / self.scale

    @property
    def singular_radii(self) -> tuple[float, ...]:
        """The rim [m] where the pressure jumps to zero there; () where it does not."""
        return (self.radius,) if abs(self(np.array([1.0]))[0]) > chosen.LARGEST_STEP else ()

    def check_inside(self) -> None:
        """Raise ValueError where the pressure jumps inside the load, which the mesh is not made for.

        Between 32 further radii the largest step becomes ever smaller unless it is a jump.
        """
        r, step = np.linspace(0.005, 1.0, 1000)[:-1], np.inf
        for _ in range(12):
            steps = np.abs(np.diff(self(r)))
            k, step = int(np.argmax(steps)), float(steps.max())
            r = np.linspace(r[k], r[k + 1], 33)
        if step > chosen.LARGEST_STEP:
            at = r[-1] * self.radius
            raise ValueError(
                f"pressure(r) jumps at r = {at:g} m, inside load_radius = {self.radius:g} m; solve two loads "
                f"and add them: one without that jump, and the rest with load_radius = {at:g} m"
            )


def prescribed_pressure(
    pressure: float | Callable[[np.ndarray], np.ndarray], load_radius: float
) -> GivenPressure:
    """The pressure scaled by its mean modulus.

    Raises ValueError when a callable does not return finite numbers in the shape of its argument, or is zero.
    """
    if not callable(pressure):
        check_positive(pressure=pressure)
        pressure = partial(np.full_like, fill_value=pressure)
    r, weight = gauss_legendre(40, 0.0, load_radius)
    r, weight = np.concatenate([[0.0], r, [load_radius]]), np.concatenate([[0.0], weight, [0.0]])
    try:
        values = np.asarray(pressure(r), dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"pressure(r) fails on an array of radii ({error}); write it with numpy") from error
    if values.shape != r.shape or not np.all(np.isfinite(values)):
        raise ValueError("pressure(r) has to return one finite number per radius on 0 <= r <= load_radius")
    scale = float(np.sum(weight * np.abs(values) * r) / np.sum(weight * r))
    if not scale > 0:
        raise ValueError("pressure(r) is zero everywhere; there is nothing to solve")
    found = GivenPressure(pressure, load_radius, scale)
    found.check_inside()
    return found


def _check_material(where: str, E: float, nu: float) -> None:
    check_positive(**{f"E {where}": E})
    if not (_is_number(nu) and -1 < nu <= 0.5):
        raise ValueError(f"nu {where} = {nu!r}; an isotropic solid has -1 < nu <= 0.5")
    if nu == 0.5:
        raise ValueError(
            f"nu {where} = {nu!r}; elements need -1 < nu < 0.5; solve with 0.5 - s and 0.5 - 2 s and "
            "extrapolate, s = 1e-3, for a thin film on a stiff base no more than 0.01 (h/a)^2"
        )


def _is_number(value: object) -> bool:
    """Whether a value is a finite real number, a NumPy scalar included: neither a truth value nor text."""
    if not isinstance(value, (int, float, np.integer, np.floating)) or isinstance(value, bool):
        return False
    return bool(np.isfinite(value))
