"""Slips planted in two codes with errors of their own, patches and elements: how many are named exactly."""

import math
from dataclasses import replace
from functools import cache, reduce

import numpy as np
import pytest
from guest_exams import GUEST, prepared, result_of

from verification.guests.diagnosis.other_solutions import other_values, sampled
from verification.guests.diagnosis.slip_diagnosis import causes_of
from verification.guests.exam_subjects import DISC
from verification.judging.verdict import Outcome
from verification.problem.quantity import DISPLACEMENTS, STRESSES
from verification.sources.source_registry import SOURCES

CASE = "08_dlc_chromium_steel"  # two coatings of unlike thickness and material
LENGTHS = ("contact_radius", "approach", "tension_place", *DISPLACEMENTS)
PRESSURES = ("pressure", "peak_pressure", "largest_tension", *STRESSES)


def materials(p, of):
    coatings = tuple((*of(E, nu), h) for E, nu, h in p.coatings)
    return replace(p, coatings=coatings, substrate=of(*p.substrate))


def upside_down(p):
    """The materials in reverse order, the substrate's first, in layers of the same thickness."""
    (E1, nu1, h1), (E2, nu2, h2) = p.coatings
    E, nu = p.substrate
    return replace(p, coatings=((E, nu, h1), (E2, nu2, h2)), substrate=(E1, nu1))


def plane_stress(E, nu):
    """E and nu of which the plane strain is the plane stress of these."""
    return E * (1 + 2 * nu) / (1 + nu) ** 2, nu / (1 + nu)


# Of the input: the problem that is solved, words of the message.
INPUT = {
    "E for E*": (lambda p: materials(p, lambda E, nu: (E * (1 - nu**2), nu)), "E in place of E*"),
    "E*/2": (lambda p: materials(p, lambda E, nu: (E / 2, nu)), "half of E*"),
    "G for E*": (lambda p: materials(p, lambda E, nu: (E * (1 - nu) / 2, nu)), "shear modulus"),
    "plane stress": (lambda p: materials(p, plane_stress), "plane stress"),
    "half load": (lambda p: replace(p, load=p.load / 2), "half of the load"),
    "load/2 pi": (lambda p: replace(p, load=p.load / (2 * math.pi)), "2 pi"),
    "diameter": (lambda p: replace(p, radius=2 * p.radius), "diameter in place of the radius"),
    "reversed": (lambda p: replace(p, coatings=p.coatings[::-1]), "reverse order"),
    "exchanged": (upside_down, "exchanged"),
    "depths": (
        lambda p: replace(p, coatings=(p.coatings[0], (*p.coatings[1][:2], sum(c[2] for c in p.coatings)))),
        "depths of the interfaces",
    ),
    "uncoated": (lambda p: replace(p, coatings=()), "no coatings"),
    "half as thick": (
        lambda p: replace(p, coatings=tuple((E, n, h / 2) for E, n, h in p.coatings)),
        "halved",
    ),
}


def scaled(quantities, factor):
    return lambda values, places: {k: factor * v if k[0] in quantities else v for k, v in values.items()}


def renamed(names):
    """The values of other quantities by ``names``, zero where a line does not have them."""
    return lambda values, places: {
        (q, at): values.get((names.get(q, q), at), 0 * v) for (q, at), v in values.items()
    }


def sides(of):
    """``of`` the upper and the lower value on either side of an interface, upper first."""

    def change(values, places):
        found = dict(values)
        for q, line in values:
            if line.endswith("upper side"):
                both = (q, line), (q, line.replace("upper", "lower"))
                found |= dict(zip(both, of(*(values[key] for key in both)), strict=True))
        return found

    return change


def cylindrical(values, places):
    """Stress by Q sigma Q^T in the directions r, theta, z."""
    found = dict(values)
    for line, (x, y) in places.items():
        if ("sigma_xx", line) not in values:
            continue
        theta = np.arctan2(y, x)
        c, s, o, one = np.cos(theta), np.sin(theta), 0 * theta, 1 + 0 * theta
        Q = np.array([[c, s, o], [-s, c, o], [o, o, one]])
        sigma = np.zeros((3, 3, theta.size))
        for q, (i, j) in STRESSES.items():
            sigma[i, j] = sigma[j, i] = values.get((q, line), o)
        turned = np.einsum("ian,abn,jbn->ijn", Q, sigma, Q)
        found |= {(q, line): turned[c] for q, c in STRESSES.items() if (q, line) in values}
    return found


def shifted(values, places):
    """A constant stress in the plane of the surface."""
    offset = 0.05 * np.abs(values["sigma_zz", "axis"]).max()
    return {k: v + offset if k[0] in ("sigma_xx", "sigma_yy") else v for k, v in values.items()}


XY = {"sigma_xx": "sigma_yy", "sigma_yy": "sigma_xx", "sigma_xz": "sigma_yz", "sigma_yz": "sigma_xz"}
VOIGT = {"sigma_yz": "sigma_xy", "sigma_xz": "sigma_yz", "sigma_xy": "sigma_xz"}
OUTPUT = {
    "transposed": (renamed(XY | {"u_x": "u_y", "u_y": "u_x"}), "x and y transposed"),
    "transposed stress": (renamed(XY), "in the stresses alone"),
    "averaged": (sides(lambda up, low: ((up + low) / 2, (up + low) / 2)), "mean of both sides"),
    "layer ignored": (sides(lambda up, low: (up, up)), "layer ignored"),
    "other layer": (sides(lambda up, low: (low, up)), "other layer"),
    "not rotated": (cylindrical, "not rotated"),
    "Voigt": (renamed(VOIGT), "Voigt"),
    "tt and zz": (renamed({"sigma_yy": "sigma_zz", "sigma_zz": "sigma_yy"}), "rr, zz, tt"),
    "z upwards": (scaled(("sigma_xz", "sigma_yz", "u_z"), -1.0), "z upwards"),
    "compression": (scaled(tuple(STRESSES), -1.0), "compression positive"),
    "MPa": (scaled(PRESSURES, 1e-6), "MPa in place of Pa"),
    "mm": (scaled(LENGTHS, 1e3), "mm in place of m"),
    "periodic": (shifted, "periodic"),
}
ALL = INPUT | OUTPUT
UNDER_DISC = [("depths",), ("MPa", "compression"), ("load/2 pi", "layer ignored")]
PAIRS = [
    ("half load", "MPa"),
    ("E for E*", "compression"),
    ("reversed", "mm"),
    ("exchanged", "averaged"),
    ("plane stress", "z upwards"),
    ("load/2 pi", "not rotated"),
    ("diameter", "transposed"),
    ("depths", "MPa"),
    ("MPa", "compression"),
    ("mm", "averaged"),
    ("layer ignored", "z upwards"),
    ("Voigt", "MPa"),
]


class Code:
    """A method on a coarse grid or mesh as a code of somebody else, which makes slips."""

    def __init__(self, method, folder):
        self.method, (self.case, self.exam) = method, prepared(CASE, folder)
        self.positions = {p.line: p.position for p in self.exam.profiles}
        self.places = {
            n: self.case.line(n).points(x)[:2] for n, x in self.positions.items() if n != "contact"
        }

    @cache  # noqa: B019
    def solved(self, name):
        problem = INPUT[name][0](self.case.problem) if name else self.case.problem
        record = SOURCES[self.method]
        solution = record.solve(problem, record.coarse_stress)
        wanted = {(p.quantity, p.line) for p in self.exam.profiles} - {("tension_place", "contact")}
        return sampled(self.case, problem, solution, self.positions, wanted)

    def named(self, names):
        """The messages about the answers of the code with the slips ``names``."""
        values = self.solved(next((name for name in names if name in INPUT), ""))
        values = reduce(lambda v, n: OUTPUT[n][0](v, self.places), [n for n in names if n in OUTPUT], values)
        return self.messages(values)

    def messages(self, values):
        result = result_of(self.case, self.exam, values)
        return [cause.message for cause in causes_of(self.case, result, GUEST.name)]


def exactly(messages, names):
    """Whether every slip has its message, and there is no other."""
    return len(messages) == len(names) and all(any(ALL[n][1] in m for m in messages) for n in names)


@pytest.fixture(scope="module", params=["semianalytic", "fem_reference"])
def code(request, tmp_path_factory):
    return Code(request.param, tmp_path_factory.mktemp("exam"))


@pytest.mark.parametrize("count", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_right_answers_and_random_numbers_have_no_causes(code, count):
    assert code.named([]) == []
    rng = np.random.default_rng(66)
    for _ in range(count):
        random = {k: rng.normal(size=v.size) * np.abs(v).max() for k, v in code.solved("").items()}
        assert code.messages(random) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("sets", "share"),
    [([[name] for name in INPUT], 0.9), ([[name] for name in OUTPUT], 0.9), (PAIRS, 0.7)],
    ids=["an input", "an output", "two"],
)
def test_planted_slips_are_named_exactly_and_no_other(code, sets, share):
    found = {tuple(names): code.named(names) for names in sets}
    inexact = {names: messages for names, messages in found.items() if not exactly(messages, names)}
    assert len(inexact) <= (1 - share) * len(sets), inexact
    wrong = {n: m for n, m in inexact.items() if any(not any(ALL[one][1] in text for one in n) for text in m)}
    assert not wrong


def test_a_slip_under_a_prescribed_load_is_named_and_one_rough_point_is_not(tmp_path):
    case, exam = prepared("01_uncoated_steel", tmp_path, DISC)
    values = {(p.quantity, p.line): p.value for p in exam.profiles if p.line != "contact"}
    assert causes_of(case, result_of(case, exam, values), GUEST.name) == ()
    rough = values["sigma_zz", "axis"].copy()
    rough[0] += 1.2 * GUEST.claim * case.problem.p_h
    result = result_of(case, exam, values | {("sigma_zz", "axis"): rough})
    assert [c.line for c, verdict in result.verdicts if verdict.outcome is Outcome.DISAGREES] == ["axis"]
    assert causes_of(case, result, GUEST.name) == ()
    wrong = {k: v * 1e-6 if k[0] in PRESSURES else v for k, v in values.items()}
    (cause,) = causes_of(case, result_of(case, exam, wrong), GUEST.name)
    assert "MPa in place of Pa" in cause.message


@pytest.mark.slow
def test_slips_of_stresses_alone_under_a_prescribed_load_are_named_exactly(tmp_path):
    case, exam = prepared(CASE, tmp_path, DISC)
    positions = {p.line: p.position for p in exam.profiles}
    wanted = {(p.quantity, p.line) for p in exam.profiles if p.quantity in STRESSES}
    places = {n: case.line(n).points(x)[:2] for n, x in positions.items() if n != "contact"}
    rng = np.random.default_rng(66)
    inexact = {}
    for names in UNDER_DISC:
        problem = reduce(lambda p, n: INPUT[n][0](p), [n for n in names if n in INPUT], case.problem)
        right = other_values(case, problem, positions, wanted)
        # Errors of a mesh, by half of what is claimed.
        most = 0.5 * GUEST.claim * case.problem.p_h * problem.load / case.problem.load
        rough = {k: right[k] + rng.uniform(-most, most, right[k].size) for k in sorted(wanted)}
        outputs = [n for n in names if n in OUTPUT]
        values = reduce(lambda v, n: OUTPUT[n][0](v, places), outputs, rough)
        causes = causes_of(case, result_of(case, exam, values), GUEST.name)
        messages = [cause.message for cause in causes]
        if not exactly(messages, names):
            inexact[names] = messages
    assert not inexact
