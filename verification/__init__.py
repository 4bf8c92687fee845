"""Verification of coated point contact: read a case, solve it by any source, compare all of them.

>>> import verification
>>> case = verification.read_case("05_ratio_4")
>>> case.title
'Stiff coating, E1/E2 = 4, h = a_h'
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from verification.cases.case_file import Case
    from verification.desk.design_answer import DesignAnswer
    from verification.problem.coated_contact import CoatedContact, ContactSolution
    from verification.problem.point_answers import Points
    from verification.running.case_result import CaseResult

__all__ = ["Points", "answer", "compare", "read_case", "solve", "state"]


def __getattr__(name: str) -> Any:
    """``Points``, imported when it is first asked for: the command line starts without NumPy."""
    if name != "Points":
        raise AttributeError(f"verification has no {name}; its names are {', '.join(__all__)}")
    from verification.problem.point_answers import Points

    return Points


def read_case(name: str | Path) -> Case:
    """A case file, or a shipped case by its name: its problem in SI units, its claims and its numerics.

    Raises ``verification.cases.toml_file.CaseError``, a ValueError, with file and key where it is not valid.
    """
    from verification.cases import case_file

    shipped = case_file.default_cases()
    return case_file.read_case(shipped.get(str(name), Path(name)))


def state(
    *,
    ball: str | float | None = None,
    load: str | float | None = None,
    substrate: str | None = None,
    coatings: str | Sequence[str] = (),
    friction: float = 0.0,
    on_ball: str | Sequence[str] = (),
    approach: str | float | None = None,
    radii: str | None = None,
    against: str | None = None,
    roller: str | None = None,
    temperature_change: float | None = None,
) -> Case:
    """A problem in the words of the options of ``coatcheck solve``, to be solved, answered or compared.

    ``state(ball="10 mm", load="20 N", coatings=["TiN 2 um, 450 GPa, 0.25"], substrate="210 GPa, 0.3")``
    Numbers without a unit are SI. Raises ValueError for words that state no problem.
    """
    from verification.cases.case_file import parse_case
    from verification.desk.case_wording import case_text

    sized, pressed, sunk = (
        repr(one) if isinstance(one, float | int) else one for one in (ball, load, approach)
    )
    layers, on = ([one] if isinstance(one, str) else one for one in (coatings, on_ball))
    text = case_text(
        sized,
        pressed,
        substrate or "",
        layers,
        friction,
        on,
        sunk,
        temperature_change=temperature_change,
        radii=radii,
        against=against,
        roller=roller,
    )
    return parse_case(text.encode(), Path("words"))


def answer(case: Case | None = None, **words: Any) -> DesignAnswer:
    """What ``coatcheck solve`` answers to a case, or to a problem in ``words`` as of ``state``.

    ``answer(ball="10 mm", load="20 N", coatings=["TiN 2 um, 450 GPa, 0.25"], substrate="210 GPa, 0.3")``
    Printed it is a sentence and, where strengths are stated, a verdict; a notebook adds table and figure.
    Raises ValueError for words that state no problem, and what the semi-analytical method raises.
    """
    from verification.desk.design_answer import design_answer

    return design_answer(state(**words) if case is None else case)


def solve(case: Case | CoatedContact, source: str = "semianalytic", **numerics: Any) -> ContactSolution:
    """The solution of a case, or of a ``CoatedContact``, by one source.

    source : "semianalytic", "fem_reference", "integral_equation", or another of ``source_registry.SOURCES``.
    numerics : keywords of that source beside those of the case, such as ``patches=129``.
    Returns pressures and stresses in Pa, lengths in m: ``contact_radius``, ``peak_pressure``, ``approach``,
    ``pressure(x, y)``, ``stress(x, y, z, layer)``, ``displacement(x, y, z)``; with the uncertainty of each
    ``sample(Points(x, y, z, layer), "stress")``.
    Raises ValueError for another source or a problem that the source does not support, and NotConverged.
    """
    from verification.problem.coated_contact import CoatedContact
    from verification.sources.source_registry import solvers

    if isinstance(case, CoatedContact):
        problem = case
    else:
        from verification.running.contact_run import keywords_of

        problem, numerics = case.problem, {**keywords_of(case, source), **numerics}
    if source not in (known := solvers(problem)):
        raise ValueError(f"source = {source!r}; this problem is solved by {', '.join(known)}")
    return known[source](problem, numerics)


def compare(case: Case) -> CaseResult:
    """A case solved by every source that its claims name, with a verdict on each claim and invariant.

    ``outcome`` is the worst of ``verdicts``; a source that failed has its message in ``sources``.
    """
    from verification.running.contact_run import run

    return run(case)
