"""Plausibility of a problem: one warning for each number that is possible but unlikely.

A warning blocks nothing. Where a bare SI number looks like one in the unit that people write it in, the line
names that unit: E = 210 is meant in GPa.
"""

import sys
from collections.abc import Iterator, Mapping

from verification.cases.toml_file import spoken
from verification.cases.unit_numbers import InSI
from verification.problem.coated_contact import CoatedContact
from verification.problem.display_units import Units, prefixed
from verification.problem.point_answers import BALL
from verification.sources.load_of_approach import own_radius

MODULI = (1e6, 2e12)  # Pa
SMALL_BALL, SOFTEST = 1e-3, 10.0  # m, which indents gels and cells, down to this modulus [Pa]
USUAL_MODULI = (1e9, 1.3e12)  # Pa, polymers to diamond
USUAL_THICKNESSES = (1e-8, 2e-4)  # m
LARGEST_RADIUS = 1.0  # m
WIDEST = 0.1  # contact radius over that of the ball
THICKEST = 20.0  # thickness over contact radius; beyond it the substrate has no part in the contact
COATING = 1e-3  # m, thicker than coatings are
BALLS = (1, 2, 3, 4, 5, 6, 6.35, 8, 9.525, 10, 12.7)  # mm, usual diameters in tribometers
STRAIN = 0.05  # of a layer, beyond which strains are not small
THINNER = 0.2  # of the layer below it: an interlayer, that hardly lies at the surface
RESIDUAL = (1e6, 2e10)  # Pa, magnitude of a residual stress
LIKELY = "looks like"
BARE = 1e3  # Pa; a bare modulus below it is meant in GPa, whatever the ball
_MODULUS_UNITS = {"GPa": 1e9, "MPa": 1e6, "kPa": 1e3}
_LENGTH_UNITS = {"um": 1e-6, "mm": 1e-3, "nm": 1e-9}

Limits = Mapping[str, float]


def warnings_of(problem: CoatedContact) -> tuple[str, ...]:
    """A line for each implausible number of ``problem``, before it is solved."""
    return (*_numbers(problem), *_thick(problem), *_order(problem), *_wide(problem))


def refused(problem: CoatedContact) -> tuple[str, ...]:
    """Those lines of ``warnings_of`` that name a number of another unit, or beyond any material or ball."""
    return (*_numbers(problem), *(line for line in _thick(problem) if LIKELY in line))


def beyond_limits(p0: float, limits: Limits) -> tuple[str, ...]:
    """A line for each hardness that the peak pressure ``p0`` [Pa] of a solved contact exceeds."""
    return tuple(
        f"peak pressure {as_stress(p0)} is beyond {spoken(key)} = {as_stress(value)}: not elastic"
        for key, value in limits.items()
        if key.endswith("hardness") and p0 > value
    )


def strain_warning(name: str, strain: float) -> tuple[str, ...]:
    """A line where the ``strain`` of a solved layer, called ``name``, is not small."""
    if strain <= STRAIN:
        return ()
    return (
        f"{name} is strained by {100 * strain:.2g} %, above {100 * STRAIN:g} %: beyond small strains and "
        "most materials; check load, radius, E",
    )


def diameter_remark(radius: float | None) -> tuple[str, ...]:
    """A line where a ``radius`` given with a unit is a usual diameter of balls, but its double is none."""
    usual = [any(abs(1e3 * size - one) < 1e-6 for one in BALLS) for size in (radius or 0, 2 * (radius or 0))]
    if not isinstance(radius, InSI) or usual != [True, False]:
        return ()
    size = f"{1e3 * radius:g} mm"
    return (f'{size} is a usual diameter of balls; if it is yours, give "d = {size}", in a file diameter',)


def small_limits(limits: Limits) -> Iterator[str]:
    """A line for each strength or hardness [Pa] below 1 MPa."""
    for key, value in limits.items():
        if value < RESIDUAL[0]:
            given = f"{value:g} {'GPa' if value < 100 else 'MPa'}"
            slip = f'{value:g} looks like {given[-3:]}, give "{given}"'
            slip = "check its unit" if isinstance(value, InSI) else slip
            yield f"{key} = {value:g} Pa is below 1 MPa; {slip}"


def stress_warnings(
    residual: Mapping[str, tuple[float, ...]], limits: Limits, change: float | None = None
) -> tuple[str, ...]:
    """A line for each residual stress [Pa] below 1 MPa or above 20 GPa in magnitude, or from heating.

    limits : strengths and hardness [Pa], for each below 1 MPa.   change : of the temperature since deposition
    [K].
    """
    found = [*small_limits({spoken(key): value for key, value in limits.items()})]
    worst = max((one for stresses in residual.values() for one in stresses), key=abs, default=0.0)
    if change is not None and change > 0 and worst:
        state = f"{as_stress(abs(worst))} of {'tension' if worst > 0 else 'compression'}"
        found.append(
            f"temperature_change = {change:g} K, a heating since deposition, gives the coating {state}; "
            f"cooling from deposition is negative, {-change:g}"
        )
    for body, stresses in residual.items():
        for i, value in enumerate(stresses):
            if value and not RESIDUAL[0] <= abs(value) <= RESIDUAL[1]:
                key = spoken(f"{before(body)}coatings.{i}.residual_stress")
                slip = "; check its unit"
                if not isinstance(value, InSI) and abs(value) < 1e5:
                    slip = f"; {key} = {value:g} looks like {'GPa' if abs(value) < 50 else 'MPa'}"
                shown = f"{'-' if value < 0 else ''}{prefixed(abs(value), 'Pa')}"
                found.append(f"{key} = {shown} is not between 1 MPa and 20 GPa{slip}")
    return tuple(found)


def likely_slips(problem: CoatedContact) -> str:
    """ "KEY = NUMBER looks like UNIT" for what a refusal may come from; "" where nothing looks so."""
    slips = [line.split("; ")[-1] for line in (*_numbers(problem), *_thick(problem)) if LIKELY in line]
    if isinstance(problem.load, InSI) and problem.load.unit == "MN":
        slips.insert(0, "load in MN, meganewtons, looks like mN")
    return "; ".join(slips[:2])


def _numbers(problem: CoatedContact) -> Iterator[str]:
    """Lines for the numbers of the materials by themselves."""
    radius = min(problem.indenter[1]) if problem.indenter and problem.elliptical else problem.radius
    if radius > LARGEST_RADIUS:
        yield f"radius = {prefixed(radius, 'm')} is above {LARGEST_RADIUS:g} m" + _slip(
            "radius", radius, _LENGTH_UNITS, (1e-5, LARGEST_RADIUS), prefer="mm"
        )
    for body in problem.bodies:
        seen, of = problem.seen_from(body), before(body)
        moduli = {f"{of}coatings.{i}.E": E for i, (E, _, _) in enumerate(seen.coatings)}
        base = f"{of}E" if body == BALL else "substrate.E"
        for key, E in {base: seen.substrate[0], **moduli}.items():
            low = MODULI[0] if problem.radius > SMALL_BALL else SOFTEST if isinstance(E, InSI) else BARE
            key = spoken(key)
            if not low <= E <= MODULI[1]:
                which = f"below {prefixed(low, 'Pa')}" if low > E else "above 2 TPa"
                yield f"{key} = {prefixed(E, 'Pa')} is {which}" + _slip(key, E, _MODULUS_UNITS, USUAL_MODULI)
    for key, h, slip in _thicknesses(problem):
        if h > max(problem.radius, COATING):
            sizes = prefixed(h, "m"), prefixed(problem.radius, "m")
            yield "{} = {} is beyond the radius of the ball, {}".format(key, *sizes) + slip


def _thicknesses(problem: CoatedContact) -> Iterator[tuple[str, float, str]]:
    """Key and thickness [m] of each coating, with what it looks like."""
    for body in problem.bodies:
        for i, (_, _, h) in enumerate(problem.seen_from(body).coatings):
            key = spoken(f"{before(body)}coatings.{i}.thickness")
            yield key, h, _slip(key, h, _LENGTH_UNITS, USUAL_THICKNESSES)


def _thick(problem: CoatedContact) -> Iterator[str]:
    """Lines for coatings below which nothing takes part in the contact."""
    # before it is refused a contact may be of any size, and of none
    a = own_radius(problem) if 0 < problem.a_h < float("inf") else sys.float_info.min
    for key, h, slip in _thicknesses(problem):
        if min(THICKEST * a, COATING) < h <= max(problem.radius, COATING):
            reason = f"is {h / a:.3g} contact radii; what lies below has no part"
            if h <= THICKEST * a:
                reason = f"is above {prefixed(COATING, 'm')}, thick for a coating"
            yield f"{key} = {Units.of_contact(problem, a).shown_length(h)} {reason}" + slip


def _order(problem: CoatedContact) -> Iterator[str]:
    """A line where the surface layer is by far the thinnest: a stack given from the substrate up."""
    for body in problem.bodies:
        coatings = problem.seen_from(body).coatings
        if len(coatings) != 2:
            continue
        (E, _, h), (E_below, _, h_below) = coatings
        ratio = h / h_below
        if ratio < THINNER and E_below != E:
            of = "ball, " if body == BALL else ""
            yield (
                f"{of}coating 1, at the surface, has {ratio:.2g} of the thickness of {of}coating 2 below "
                "it; coatings are listed from the surface down"
            )


def _wide(problem: CoatedContact) -> Iterator[str]:
    """A line for a contact that is wide on its ball."""
    ratio = own_radius(problem) / problem.radius
    if ratio > WIDEST:
        sphere = 1 - (1 - min(ratio, 1.0) ** 2) ** 0.5
        cost = 100 * (sphere / (ratio**2 / 2) - 1)
        yield (
            f"contact radius a = {ratio:.2g} R is above {WIDEST:g} R: at the contact edge the sphere is "
            f"{cost:.2g} % higher than the parabola that is solved; check load, radius, E"
        )


def _slip(
    key: str, value: float, units: Mapping[str, float], usual: tuple[float, float], prefer: str = ""
) -> str:
    """ "; KEY = VALUE looks like UNIT, give ..." of a bare SI number; "; check its unit" of any other."""
    if isinstance(value, InSI) or usual[0] <= value <= usual[1]:
        return "; check its unit"
    for unit in sorted(units, key=lambda unit: unit != prefer):
        if usual[0] <= value * units[unit] <= usual[1]:
            return f'; {key} = {value:g} looks like {unit}, give "{value:g} {unit}"'
    return "; check its unit"


def before(body: str) -> str:
    """Beginning of the dotted keys of a body."""
    return f"{BALL}." if body == BALL else ""


def as_stress(value: float) -> str:
    """A stress [Pa] of at least 0 with its prefix, three digits."""
    return prefixed(value, "Pa", 3) if value else "0 Pa"
