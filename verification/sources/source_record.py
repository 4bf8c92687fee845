"""Record of one source: name, kind, label, line style, solver, what it supports."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from verification.problem.loading_curve import Problem

RESPONSE = "frequency response of the layers"  # an equation that two sources solve
Solver = Callable[..., Any]  # (problem, numerics) -> Solution, of a LoadingCurve a Loading


class Independence(StrEnum):
    """Common ground of the two sources of a comparison, the most independent first."""

    NOTHING = "without a common equation"
    EQUATION = "with a common equation, coded twice"
    CLOSED = "with closed forms"
    PRINT = "with published tables"


class Kind(StrEnum):
    """Origin of the numbers of a source."""

    METHOD = "method"
    EXACT = "exact"
    CLOSED = "closed form"
    PUBLISHED = "published"


@dataclass(frozen=True)
class Style:
    """Line in a figure: ``colour`` names a role of the style sheet, never a value.

    dash : on, off lengths in line widths; () is a full line, so that colour is never the only difference.
    marker : of single points, in the notation of matplotlib.
    """

    colour: str
    dash: tuple[float, ...] = ()
    width: float = 1.6
    opacity: float = 1.0
    marker: str = "o"


def _everything(problem: Problem, kind: str) -> bool:
    return True


@dataclass(frozen=True)
class Source:
    """One source of numbers.

    solve : solver of every problem it supports; modules are imported when it is called.
    accepts : (problem, kind of quantity) -> whether it gives such quantities of such a problem.
    package : module or package that the fingerprint of its stored solutions is taken of.
    coarse, coarse_stress : keywords of the coarse solves of the invariants, for scalars and for stresses.
    equation : what it solves, where another source solves it too, in code of its own.
    fields : how its fields are written for ParaView, "plane" or "boxes"; "" where they are not.
    """

    name: str
    kind: Kind
    label: str
    style: Style
    solve: Solver | None = None
    accepts: Callable[[Any, str], bool] = _everything
    package: str = ""
    equation: str = ""
    coarse: Mapping[str, Any] = field(default_factory=dict)
    coarse_stress: Mapping[str, Any] = field(default_factory=dict)
    fields: str = ""

    def supports(self, problem: Problem, kind: str = "stress") -> bool:
        """Whether it gives quantities of ``kind``, see ``Quantity``, of ``problem``."""
        return self.solve is not None and self.accepts(problem, kind)
