"""Errors of the influence coefficients by conversion from the Fourier domain."""

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from verification.judging.invariants.influence_error import ConversionError
from verification.page.number_text import factor, plain, scientific
from verification.page.page_parts import Cell, Gallery, Panel, Part, Table, number, row
from verification.page.svg_loglog import DASHES, DOTS, MIXED, UNKNOWN, Plot, Trail, panels
from verification.report.figures.line_panels import swatch
from verification.sources.source_record import Style

_CONVERSIONS = {
    ("split", 0): ("split, no domain", Style("semi")),
    ("split-fft", 2): ("split, by FFT", Style("hertz", DASHES)),
    ("plain", 0): ("plain, no aliases", Style("other", DOTS)),
    ("plain", 2): ("plain, 2 aliases a side", Style("pair", MIXED)),
}
_DOMAIN_SHOWN = 4  # of the curves over distance; the default of the solver


def conversion_part(found: Sequence[ConversionError]) -> Part:
    """Every conversion against direct quadrature, side by side."""
    groups = {
        name: list(some)
        for name, some in groupby(sorted(found, key=_kind), key=_kind)  # by conversion and aliases
    }
    return Part(
        _summary(found),
        [_table(found)],
        Gallery(
            [(swatch(_look(kind)[1]), _look(kind)[0]) for kind in sorted(groups, key=_rank)],
            _panels(groups),
            "First the error of the influence coefficients of the displacement over the distance of the "
            f"patch; conversions that need a domain use one of {_DOMAIN_SHOWN} times the grid. Then the "
            "error at three patches over the size of the domain; the split conversion needs none and is a "
            "level line. Reference: direct quadrature around the edge of the patch.",
        ),
    )


def _kind(one: ConversionError) -> tuple[str, int]:
    return one.conversion, one.aliases


def _look(kind: tuple[str, int]) -> tuple[str, Style]:
    return _CONVERSIONS.get(kind, (f"{kind[0]}, {kind[1]} aliases", UNKNOWN))


def _rank(kind: tuple[str, int]) -> int:
    return list(_CONVERSIONS).index(kind) if kind in _CONVERSIONS else len(_CONVERSIONS)


def _panels(groups: dict[tuple[str, int], list[ConversionError]]) -> list[Panel]:
    widths = sorted({one.enlarge for some in groups.values() for one in some} - {0})
    any_one = next(iter(groups.values()))[0]
    # the loaded patch, the patch beside it, the corner of the grid
    places = {"at the loaded patch": 0, "at the next patch": 1, "at the far corner": len(any_one.error) - 1}

    def over_distance(name: tuple[str, int]) -> Trail:
        some = groups[name]
        one = next((o for o in some if o.enlarge == _DOMAIN_SHOWN), some[0])
        pairs = [(d, e) for d, e in zip(one.distance, one.error, strict=True) if d > 0]
        return Trail(tuple(d for d, _ in pairs), tuple(e for _, e in pairs), _look(name)[1])

    def over_domain(name: tuple[str, int], place: int) -> Trail:
        errors = {one.enlarge: one.error[place] for one in groups[name]}
        level = {float(w): errors[0] for w in widths} if 0 in errors else errors
        return Trail(tuple(float(w) for w in level), tuple(level.values()), _look(name)[1])

    known = sorted(groups, key=_rank)
    near, wide = (0.1, 0.2, 0.5, 1, 2), (1, 2, 4, 8, 16, 32)
    drawn = [
        ("over distance", "distance / a", near, [over_distance(name) for name in known]),
        *(
            (title, "domain / grid", wide, [over_domain(n, at) for n in known])
            for title, at in places.items()
        ),
    ]
    return panels(
        [
            Plot(
                title,
                f"error of influence coefficients {title}, logarithmic",
                "error over the coefficient itself",
                coordinate,
                ticks,
                trails,
            )
            for title, coordinate, ticks, trails in drawn
        ]
    )


def _summary(found: Sequence[ConversionError]) -> str:
    split = next((one for one in found if one.conversion == "split"), None)
    paper = [one for one in found if _kind(one) == ("plain", 2)]
    bare = [one for one in found if _kind(one) == ("plain", 0)]
    text = []
    if paper:
        text.append(
            "The plain conversion of the source paper with two aliases a side, on domains "
            f"{paper[0].enlarge} to {paper[-1].enlarge} times the grid, has an error of "
            f"{_range([one.error[0] for one in paper])} at the loaded patch and of "
            f"{_range([max(one.error) for one in paper])} at the worst one."
        )
    if bare:
        text.append(f"Without aliases it is {_range([one.error[0] for one in bare])} at the loaded patch.")
    if split:
        line = (
            f"The error of the split conversion is {scientific(split.largest)} of the largest coefficient "
            f"and at most {scientific(max(split.error))} of any coefficient itself"
        )
        if paper:
            best = min(paper, key=lambda one: max(one.error))
            times = factor(max(best.error), max(split.error))
            line += f"; that of the plain one on its best domain is {times} times as large"
        text.append(line + ".")
    return " ".join(text)


def _table(found: Sequence[ConversionError]) -> Table:
    rows = [
        row(
            _look(_kind(one))[0],
            Cell(f"{one.enlarge or '–'}", float(one.enlarge)),
            *map(number, (one.error[0], one.error[1], max(one.error), one.largest)),
            number(one.seconds, _milli),
        )
        for one in sorted(found, key=lambda one: (_rank(_kind(one)), one.enlarge))
    ]
    return Table(
        "Errors of the influence coefficients of the surface displacement, over the coefficient itself and, "
        "for the largest of all, over the largest coefficient.",
        [
            "conversion",
            "domain / grid",
            "loaded patch",
            "next patch",
            "worst patch",
            "of the largest",
            "time",
        ],
        rows,
    )


def _range(values: Sequence[float]) -> str:
    low, high = 100 * float(np.min(values)), 100 * float(np.max(values))
    return (
        f"{plain(low, 2)} %" if plain(low, 2) == plain(high, 2) else f"{plain(low, 2)} to {plain(high, 2)} %"
    )


def _milli(value: float) -> str:
    return f"{1000 * value:.1f} ms" if value < 0.1 else f"{1000 * value:.0f} ms"
