"""NaN and infinity in what the methods compute, one function at a time, never end in agreement."""

import importlib
import sys
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp
from case_texts import case_text

from verification.cases.case_file import Case, parse_case
from verification.judging.standard_claims import standard_claims
from verification.judging.verdict import Outcome
from verification.running.case_result import CaseResult
from verification.running.contact_run import run
from verification.sources.source_registry import solvers

TEXT = case_text(
    "E = 420e9; nu = 0.25; thickness_over_a_h = 0.8",
    more="friction = 0.25",
    tables='[semianalytic]\npatches = 65\n[fem_reference]\nquality = "fast"\n',
)


@dataclass(frozen=True)
class Place:
    """What ``name`` (a function, or Class.method) of ``module`` gives, or ``part`` of it.

    part : field of a dataclass, or place in a tuple. Of a function that is given, what that one gives.
    """

    module: str
    name: str
    part: str | int | None = None

    @property
    def method(self) -> str:
        return self.module.partition(".")[0]


PLACES = (
    Place("semianalytic.coefficients.frf", "compliance_excess"),
    Place("semianalytic.coefficients.frf", "stress_frf"),
    Place("semianalytic.coefficients.halfspace", "surface_deflection"),
    Place("semianalytic.coefficients.influence", "remainder_coefficients"),
    Place("semianalytic.patches.convolution", "even_convolution"),
    Place("semianalytic.patches.convolution", "circulant_inverse"),
    Place("semianalytic.patches.contact", "solve", "pressure"),
    Place("semianalytic.patches.contact", "solve", "approach"),
    Place("semianalytic.edge.edge_shape", "Shape.pressure"),
    Place("semianalytic.edge.smooth_edge", "beyond_centres", 0),
    Place("semianalytic.edge.smooth_edge", "near_influence"),
    Place("semianalytic.stresses.subsurface", "stress"),
    Place("semianalytic.stresses.fields", "stress"),
    Place("semianalytic.coefficients.point_force", "half_space_stress"),
    Place("semianalytic.solution", "Solution._pressure", 0),
    Place("semianalytic.solution", "Solution._pressure", 1),
    Place("semianalytic.solution", "Solution._stress", 0),
    Place("semianalytic.solution", "Solution._stress", 1),
    Place("semianalytic.uncertainty", "of_contact", "approach"),
    Place("semianalytic.uncertainty", "of_contact", "peak_pressure"),
    Place("fem_reference.meshing.mesh", "meridian_mesh", "points"),
    Place("fem_reference.elasticity.axisymmetric", "strain_operator", 0),
    Place("fem_reference.elasticity.axisymmetric", "elasticity"),
    Place("fem_reference.elasticity.axisymmetric", "Discretisation.stiffness"),
    Place("fem_reference.elasticity.axisymmetric", "Discretisation.contact_mass"),
    Place("fem_reference.elasticity.axisymmetric", "Discretisation.contact_load"),
    Place("fem_reference.elasticity.linear_system", "constrained_solve", "u"),
    Place("fem_reference.scaling", "boussinesq"),
    Place("fem_reference.scaling", "cerruti"),
    Place("fem_reference.contact.fixed_radius", "solve_at_radius", "fields"),
    Place("fem_reference.contact.fixed_radius", "solve_at_radius", "approach"),
    Place("fem_reference.contact.fixed_radius", "solve_at_radius", "load"),
    Place("fem_reference.contact.fixed_radius", "solve_at_radius", "stiffness"),
    Place("fem_reference.contact.fixed_radius", "complementarity", 0),
    Place("fem_reference.contact.fixed_radius", "Multiplier.__call__"),
    Place("fem_reference.elasticity.loading", "solve_traction"),
    Place("fem_reference.elasticity.recovery", "HarmonicField.__call__", 1),
    Place("fem_reference.estimate", "PressureEstimate.__call__"),
    Place("fem_reference.estimate", "StressEstimate.__call__"),
    Place("fem_reference.solved_contact", "Solution._stress", 0),
)


def spoilt(value: Any, bad: float, part: str | int | None) -> Any:
    """``value`` with ``bad`` in the middle of it."""
    if part is not None and isinstance(value, tuple):
        assert isinstance(part, int)
        inner = spoilt(value[part], bad, None)
        return tuple(inner if n == part else item for n, item in enumerate(value))
    if part is not None:
        assert isinstance(part, str)
        return replace(value, **{part: spoilt(getattr(value, part), bad, None)})
    if sp.issparse(value):
        value = value.copy()
        value.data = spoilt(value.data, bad, None)
        return value
    if is_dataclass(value) and not isinstance(value, type):
        first = next(f.name for f in fields(value) if isinstance(getattr(value, f.name), np.ndarray))
        return replace(value, **{first: spoilt(getattr(value, first), bad, None)})
    if callable(value):
        return lambda *words, **named: spoilt(value(*words, **named), bad, None)
    if np.ndim(value) == 0:
        return bad
    array = np.array(value, dtype=np.result_type(value, float))
    array.flat[array.size // 2] = bad
    return array


@contextmanager
def planted(place: Place, bad: float) -> Iterator[Counter[str]]:
    """``bad`` in what ``place`` gives for as long as this lasts; yields how often it was asked."""
    asked: Counter[str] = Counter()
    owner: Any = importlib.import_module(place.module)
    *path, name = place.name.split(".")
    for step in path:
        owner = getattr(owner, step)
    original: Callable[..., Any] = vars(owner)[name]

    def wrapped(*words: Any, **named: Any) -> Any:
        asked["times"] += 1
        return spoilt(original(*words, **named), bad, place.part)

    # A function imported by name lives in several modules.
    holders = [owner] if path else [m for n, m in sys.modules.items() if n.split(".")[0] == place.method]
    found = [(h, key) for h in holders for key, value in list(vars(h).items()) if value is original]
    for holder, key in found:
        setattr(holder, key, wrapped)
    try:
        yield asked
    finally:
        for holder, key in found:
            setattr(holder, key, original)


@cache
def clean() -> tuple[Case, CaseResult, dict[str, Any]]:
    """A case in which every part of both methods takes part, its result, and the solution of each source.

    It is solved on coarse grids, and makes those claims that agree on them.
    """
    kept: dict[str, Any] = {}

    def keeping(name: str, solve: Any) -> Any:
        def solved(problem: Any, numerics: Any) -> Any:
            kept[name] = solve(problem, numerics)
            return kept[name]

        return solved

    found = parse_case(TEXT.encode(), Path("spoilt.toml"))
    whole = replace(found, claims=tuple(replace(c, cap=1.0) for c in standard_claims(found.problem)))
    result = run(whole, {name: keeping(name, solve) for name, solve in solvers().items()})
    agreed = tuple(claim for claim, verdict in result.verdicts if verdict.outcome is Outcome.AGREES)
    case = replace(whole, claims=agreed)
    result = run(case, {name: lambda *_, name=name: kept[name] for name in kept})
    return case, replace(result, invariants=()), kept


def outcome_of(place: Place, bad: float) -> tuple[CaseResult, int]:
    """The case with one method spoilt, the other sources as they were; how often the place was asked."""
    case, _, kept = clean()
    available = solvers()
    for name in kept:
        if name != place.method:
            available[name] = lambda problem, numerics, name=name: kept[name]
    with planted(place, bad) as asked, warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        # By its claims alone: what the invariants notice comes on top.
        return replace(run(case, available), invariants=()), asked["times"]


def test_twenty_places_of_each_method_are_spoilt():
    assert min(Counter(place.method for place in PLACES).values()) >= 20


@pytest.mark.slow
@pytest.mark.parametrize("place", PLACES, ids=lambda place: f"{place.module}.{place.name}-{place.part}")
def test_nan_and_infinity_in_a_place_never_agree(place):
    _, whole, _ = clean()
    assert whole.outcome is Outcome.AGREES
    assert len(whole.verdicts) > 40
    for value in (np.nan, np.inf, -np.inf):
        result, asked = outcome_of(place, value)
        assert asked > 0, f"{place} was never asked, so nothing was spoilt"
        assert result.outcome is not Outcome.AGREES, f"{value} in {place} agrees"
