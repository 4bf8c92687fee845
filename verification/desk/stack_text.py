"""A contact in words: the stack in one line, each body and coating in a line of its own."""

from dataclasses import dataclass
from itertools import accumulate, pairwise, product

from verification.cases.case_file import Case
from verification.cases.drawn_ranges import (
    CLOSE_RATIO,
    ELLIPSE_POISSON,
    ELONGATION,
    FILM_RATIO,
    FILM_THICKNESS,
    FRICTION,
    MOST_COATINGS,
    MOST_FILMS,
    OF_SHORT_AXIS,
    OVER_INTERLAYER,
    POISSON,
    RATIO,
    SLIDING,
    THICKNESS,
)
from verification.problem.coated_contact import CoatedContact
from verification.problem.display_units import Units, prefixed, radii_text
from verification.problem.point_answers import BALL, FLAT
from verification.sources.load_of_approach import own_radius
from verification.sources.references.hertz_ellipse import pressed_ellipsoid

FILMS = (FILM_THICKNESS[0], OVER_INTERLAYER[1])


def stack(case: Case) -> str:
    """The layers from the ball to the substrate: "ball / DLC 2 um / Cr 0.2 um / steel"."""
    problem = case.problem
    found = [case.names.get(BALL, ("",))[-1]]
    kind = "ball" if problem.indenter is None else "indenter"
    found = [f"{found[0]} {kind}".strip() if problem.ball else f"rigid {kind}"]
    if problem.ball:
        found += reversed(_layers(case, BALL))
    base = case.names.get(FLAT, ("",))[-1]
    base = base or f"substrate {prefixed(problem.substrate[0], 'Pa')}"
    return " / ".join(_repeats([*found, *_layers(case, FLAT), base]))


def _repeats(words: list[str]) -> list[str]:
    """``words`` with what recurs three times or more in a row said once: "10 x (TiN 1 um / CrN 1 um)"."""
    for begin, period in product(range(len(words)), range(1, 5)):
        part, count = words[begin : begin + period], 1
        while words[begin + count * period : begin + (count + 1) * period] == part:
            count += 1
        if count >= 3:
            said = f"{count} x ({' / '.join(part)})"
            return [*words[:begin], said, *_repeats(words[begin + count * period :])]
    return words


def _layers(case: Case, body: str) -> list[str]:
    """Each coating of ``body`` with its thickness, from its surface inwards."""
    names, found, units = case.names.get(body, ()), [], units_of(case.problem)
    for i, layers in enumerate(_coatings(case.problem.seen_from(body), case.layers.get(body))):
        name = names[i] if i < len(names) else ""
        E = _course(case, body, i) or prefixed(layers[0][0], "Pa")
        found.append(_thickness(layers, name, units) + ("" if name else f" of {E.partition(',')[0]}"))
    return found


def described(case: Case, *, every: bool = True) -> list[str]:
    """The problem, a line for each body, load and coating; of equal coatings the first, unless ``every``."""
    problem, units = case.problem, units_of(case.problem)
    kind = "rigid" if problem.ball is None else _solid(*problem.ball[:2])
    size = f"indenter    {radii_text(problem)}"
    if not problem.elliptical:
        size = f"ball        {radii_text(problem)} (diameter {prefixed(2 * problem.radius, 'm')})"
    lines = [f"{size}, {kind}; {_pressed(problem, units)}"]
    if case.approach is not None:
        lines.append(
            f"            W is the load of the given approach of {units.shown_length(case.approach)}"
        )
    told: dict[str, set[str]] = {body: set() for body in problem.bodies}
    for body in problem.bodies:
        seen, names, begin = problem.seen_from(body), case.names.get(body, ()), 0
        for i, layers in enumerate(_coatings(seen, case.layers.get(body)), start=1):
            on, n = "coating" if body == FLAT else f"on the {BALL}", len(layers)
            stress = sorted(case.residual[body][begin : begin + n]) if case.residual else [0.0]
            E, nu, _ = layers[0]
            given = _course(case, body, i - 1)
            solid = f"E = {given}, as {n} sub-layers, nu = {nu:g}" if given else _solid(E, nu)
            ends = " to ".join(dict.fromkeys(f"{one / units.pascal:.4g}" for one in (stress[0], stress[-1])))
            more = f", residual stress {ends} {units.stress}" if any(stress) else ""
            thickness = _thickness(layers, names[i - 1] if names else "", units)
            text = f"{thickness}, {solid}{more}"
            begin += n
            if every or text not in told[body]:
                lines.append(f"{on} {i}   "[:12] + text)
            elif not lines[-1].endswith("repeated"):
                lines.append("            repeated")
            told[body].add(text)
        if body == FLAT:
            lines.append(f"substrate   {_solid(*seen.substrate)}")
    return lines


def conditions(problem: CoatedContact) -> str:
    """Ball, load and friction in one line."""
    return f"{radii_text(problem)}, {_pressed(problem, units_of(problem))}"


def units_of(problem: CoatedContact) -> Units:
    """The units of every answer to ``problem``."""
    return Units.of_contact(problem, own_radius(problem))


def _pressed(problem: CoatedContact, units: Units) -> str:
    return f"W = {units.shown_force(problem.load)}, f = {problem.friction:g}"


def body_label(problem: CoatedContact, body: str, where: str) -> str:
    """A place with its body: "coating 1", "ball, coating 1", "ball" of a ball without coatings."""
    if body == FLAT:
        return where
    return body if not problem.seen_from(body).coatings and where == "substrate" else f"{body}, {where}"


@dataclass(frozen=True)
class _Ranges:
    """Ranges of the random problems of a kind.

    thickness : over any of ``lengths`` [m], the first called ``unit``.   coatings : most on a body
    """

    lengths: tuple[float, ...]
    unit: str
    thickness: tuple[float, float]
    ratio: tuple[float, float]
    on_ball: tuple[float, float]
    poisson: tuple[float, float] = POISSON
    friction: float = FRICTION[1]
    coatings: int = MOST_COATINGS

    @classmethod
    def of(cls, problem: CoatedContact) -> "_Ranges":
        if problem.indenter is not None and problem.elliptical:
            (R_x, R_y), ball = problem.indenter[1], problem.ball and problem.ball[:2]
            bare = pressed_ellipsoid(R_x, R_y, problem.load, *problem.substrate, ball)
            drawn = problem.a_h * (min(R_x, R_y) / max(R_x, R_y)) ** (1 / 3)  # about as long
            low, high = CLOSE_RATIO
            return cls(
                lengths=(bare.b, drawn),
                unit="of the short half axis",
                thickness=OF_SHORT_AXIS,
                ratio=CLOSE_RATIO,
                on_ball=(low / high, high / low),
                poisson=ELLIPSE_POISSON,
                friction=SLIDING[-1],
                coatings=1,
            )
        lengths = own_radius(problem), problem.a_h
        # a film as thin as those of the random problems of films, alone or below another
        thin = any(h < THICKNESS[0] * problem.a_h for *_, h in problem.coatings)
        films = thin and len(problem.coatings) <= MOST_FILMS and not (problem.ball and problem.ball[2])
        thickness, ratio = (FILMS, FILM_RATIO) if films else (THICKNESS, RATIO)
        return cls(lengths, "a", thickness, ratio, ratio)


def _elongation(problem: CoatedContact) -> float:
    """Length over width of a contact, about, from the radii of an ellipsoid; 1 below other indenters."""
    if problem.indenter is None or not problem.elliptical:
        return 1.0
    R_x, R_y = problem.indenter[1]
    return float((max(R_x, R_y) / min(R_x, R_y)) ** (2 / 3))


def outside_verified(case: Case) -> str:
    """Names of the inputs outside the ranges of the random problems of both methods; "" for none.

    Their thicknesses are over a_h of the bare bodies; on a film of another modulus the contact's own radius a
    counts too. Those under an ellipse are over its short half axis b between the bare bodies.
    """
    problem, found = case.problem, []
    ranges = _Ranges.of(problem)
    if problem.friction > ranges.friction:
        found.append((f"friction f = {problem.friction:g}", f"outside {_between((0, ranges.friction))}"))
    coated = any(problem.seen_from(body).coatings for body in problem.bodies)
    if coated and (elongation := _elongation(problem)) > ELONGATION[1] * (1 + 1e-3):
        told = f"outside {_between((1.0, ELONGATION[1]))}"
        found.append((f"half axes about {elongation:.2g} to 1", told))
    for body in problem.bodies:
        seen, of = problem.seen_from(body), "" if body == FLAT else f" on the {body}"
        coatings = _coatings(seen, case.layers.get(body))
        if len(coatings) > ranges.coatings:
            found.append((f"{len(coatings)} coatings{of}", f"outside {_between((0, ranges.coatings))}"))
        solids = [(f"coating {i}{of}", layers[0][1]) for i, layers in enumerate(coatings, start=1)]
        for name, nu in (*solids, ("substrate" if body == FLAT else body, seen.substrate[1])):
            if not ranges.poisson[0] <= nu <= ranges.poisson[1]:
                found.append((name, f"nu = {nu:g}, outside {_between(ranges.poisson)}"))
        for i, layers in enumerate(coatings, start=1):
            h = sum(h for *_, h in layers)
            low, high = ranges.thickness[0] * (1 - 1e-3), ranges.thickness[1] * (1 + 1e-3)
            if not any(low <= h / length <= high for length in ranges.lengths):
                told = f"h = {h / ranges.lengths[0]:.2g} {ranges.unit}, outside {_between(ranges.thickness)}"
                found.append((f"coating {i}{of}", told))
            ratios = [E / seen.substrate[0] for E, _, _ in layers]
            ratio = ranges.ratio if body == FLAT else ranges.on_ball
            if not ratio[0] <= min(ratios) <= max(ratios) <= ratio[1]:
                told = f"E = {ratios[0]:.2g} of the substrate's, outside {_between(ratio)}"
                found.append((f"coating {i}{of}", told))
    alike: dict[str, list[str]] = {}
    for name, told in found:
        alike.setdefault(told, []).append(name)
    return "; ".join(
        f"{names[0]}{f' and {len(names) - 1} more' * (len(names) > 1)}, {told}"
        for told, names in alike.items()
    )


def _between(bounds: tuple[float, float]) -> str:
    return f"{bounds[0]:g} to {bounds[1]:g}"


def _coatings(
    seen: CoatedContact, layers: tuple[int, ...] | None
) -> list[tuple[tuple[float, float, float], ...]]:
    """The sub-layers of each coating."""
    ends = accumulate(layers or (1,) * len(seen.coatings), initial=0)
    return [seen.coatings[begin:end] for begin, end in pairwise(ends)]


def _thickness(layers: tuple[tuple[float, float, float], ...], name: str, units: Units) -> str:
    """The thickness of a coating after its name: "DLC 2 um"."""
    return f"{name} {units.shown_length(sum(h for *_, h in layers))}".strip()


def _course(case: Case, body: str, coating: int) -> str:
    """E of a graded coating as it was given; "" of any other."""
    return case.courses.get(body, ("",) * (coating + 1))[coating]


def _solid(E: float, nu: float) -> str:
    return f"E = {prefixed(E, 'Pa')}, nu = {nu:g}"
