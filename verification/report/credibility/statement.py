"""The credibility page: what an AGREES of this suite is worth, each figure with where it was measured.

In the order of ASME V&V 10-2006, Guide for Verification and Validation in Computational Solid Mechanics, with
what NASA-STD-7009A (2016), Standard for Models and Simulations, asks besides: limits of use, robustness of
the result, evidence for each.
"""

from collections.abc import Sequence

from verification.credibility.independence import shared
from verification.judging.verdict import Outcome
from verification.report.credibility.tables import (
    alarm_table,
    design_table,
    import_table,
    order_table,
    pair_table,
    parameter_table,
    range_table,
)
from verification.report.material import Evidence, Material
from verification.report.sections.accuracy import accuracies, coverage_table
from verification.report.sections.baseline import baseline_sentence
from verification.report.tables.cells import Cell, Part, Row, Section, Table
from verification.report.tables.numbers import plain
from verification.running.result import CaseResult

__all__ = ["ANCHOR", "figures", "section"]

ANCHOR = "credibility"
ASSUMED = (
    "A rigid, parabolic sphere, much larger than the contact; small strains; linear, isotropic, elastic "
    "layers with nu < 1/2, perfectly bonded, on a half-space; no adhesion, no roughness; Coulomb friction "
    "q = f p that leaves p unchanged."
)
NOT_CLAIMED = (
    "That any of this is true of a real coating: nothing here was held against an experiment, so this is "
    "verification, not validation. That agreement would show an error in what both methods assume. That the "
    "stresses hold closer to the contact edge on the surface than the zone left unjudged. That an "
    "uncertainty is a strict bound: it is an estimate from coarser solutions, and the share in which it "
    "holds the true error stands above. That faults of a kind nobody thought of would be caught at the rate "
    "of those that were planted. That problems outside the ranges above behave alike."
)


def section(material: Material) -> Section | None:
    """Eight steps from the intended use to the limits of the claim, under a table of their figures.

    None where no evidence was collected.
    """
    results, evidence = material.results, material.evidence
    if evidence == Evidence():
        return None
    contacts = material.contacts
    parts = [
        Part(
            "What an AGREES of this report is worth, in the order of ASME V&V 10 (Guide for Verification and "
            "Validation in Computational Solid Mechanics) with what NASA-STD-7009A asks besides. Every "
            "figure was measured in this run, or is read from a record with its date and commit.",
            [_overview(material)],
        ),
        Part(
            "To decide whether numerical solutions of one mathematical model are right within a stated "
            f"uncertainty. The model: {ASSUMED[0].lower()}{ASSUMED[1:]} What was solved in this run, and "
            "what the random problems of the false alarm rate are drawn from:",
            [range_table(contacts)],
            title="1. Intended use and limits",
        ),
        Part(
            "Orders of convergence where the answer is known beforehand: manufactured fields in two bonded "
            "materials for the finite element operator, exact solutions of the contact for both methods.",
            [design_table(evidence.orders), order_table(evidence.accuracy)],
            title="2. Code verification",
        ),
        Part(
            "Every method states an uncertainty U for each number, from coarser companions of the same "
            "problem, one for each knob. Whether U can be believed is seen where the answer is known: "
            f"{_bracketed(contacts)}",
            [coverage_table(contacts), parameter_table(contacts)],
            title="3. Solution verification",
        ),
        Part(
            _compared(results),
            [pair_table(results)],
            title="4. Comparison with references and between methods",
        ),
        Part(
            _independent(evidence), [import_table(evidence.parts)], title="5. Independence of the two methods"
        ),
        Part(_faults(evidence), [], title="6. Fault detection"),
        Part(_alarms(evidence), [alarm_table(evidence.alarms)], title="7. False alarms"),
        Part(NOT_CLAIMED, title="8. What is not claimed"),
    ]
    return Section(ANCHOR, "Credibility", parts, evidence.failures)


def figures(evidence: Evidence) -> tuple[str, str]:
    """Fault detection score and false alarm rate as sentences, each with date and commit."""
    return _faults(evidence), _alarms(evidence)


def _overview(material: Material) -> Table:
    results, info, evidence = material.results, material.info, material.evidence
    study, baseline = evidence.accuracy, evidence.baseline
    here = f"this run, {_day(info.started)}, {info.commit or 'no commit'}"
    good = [one for one in evidence.orders if one.as_designed]
    invariants = [one for result in results for one in result.invariants]
    holding = sum(one.outcome is Outcome.AGREES for one in invariants)
    agreeing, total = _agreeing(results)
    design = f"{len(good)} of {len(evidence.orders)} manufactured solutions at their design order"
    ladders = (
        "not measured in this run" if study is None else f"{len(study.ladders)} ladders on exact solutions"
    )
    laws = f"{holding} of {len(invariants)} laws hold" if invariants else "not measured"
    rows = [
        (
            "Code verification",
            f"{design}; {ladders}" if evidence.orders else f"not measured; {ladders}",
            here,
        ),
        ("Solution verification", _bracketed(material.contacts), here),
        ("Invariants of each solution", laws, here),
        ("Comparison", f"{agreeing} of {total} comparisons agree", here),
        ("Independence", _short_independence(evidence), here),
        ("Regression", "not measured" if baseline is None else baseline_sentence(baseline), here),
        ("Fault detection", *_recorded(_short_faults(evidence), evidence.faults)),
        ("False alarms", *_recorded(_short_alarms(evidence), evidence.alarms)),
    ]
    return Table(
        "The evidence at a glance.",
        ["question", "found", "measured"],
        [Row(Cell(name), [Cell(found, css="words"), Cell(when, css="words")]) for name, found, when in rows],
    )


def _recorded(found: str, record: object) -> tuple[str, str]:
    return found, "never" if record is None else _when(record)


def _when(record: object) -> str:
    commit = getattr(record, "commit", None) or "no commit"
    return f"{_day(getattr(record, 'started', ''))}, {commit}"


def _day(started: str) -> str:
    return started[:10]


def _agreeing(results: Sequence[CaseResult]) -> tuple[int, int]:
    verdicts = [verdict for result in results for _, verdict in result.verdicts]
    return sum(verdict.outcome is Outcome.AGREES for verdict in verdicts), len(verdicts)


def _bracketed(results: Sequence[CaseResult]) -> str:
    found = [item for result in results for item in accuracies(result)]
    if not found:
        return "not measured: no case of this run has an exact reference."
    good = sum(item.covered for item in found)
    return (
        f"U holds the true error at every judged point in {good} of {len(found)} quantities "
        f"({plain(100 * good / len(found), 3)} %)."
    )


def _compared(results: Sequence[CaseResult]) -> str:
    agreeing, total = _agreeing(results)
    if not total:
        return "Nothing was compared in this run."
    sentence = f"{agreeing} of {total} comparisons of this run agree."
    if not any(result.published for result in results):
        sentence += " Numbers that others printed were not part of it: coatcheck run published."
    return sentence


def _independent(evidence: Evidence) -> str:
    if not evidence.parts:
        return "Not measured: the source of the packages could not be read."
    first, second = evidence.parts[:2]
    common = ", ".join(shared(first, second)) or "none"
    both = ", ".join(sorted(set(first.packages) & set(second.packages))) or "none"
    return (
        f"{_short_independence(evidence)} Read from the source as it is installed. Packages that both "
        f"methods stand on: {both}; modules that both import: {common}. A fault in one of these, in Python, "
        "in the processor, would hit both at once. So would a fault in what both assume, in the statement of "
        "the problem that both are given, in the sampling and judging that both go through; the last is what "
        "planted faults and self-tests of the harness are for."
    )


def _short_independence(evidence: Evidence) -> str:
    if not evidence.parts:
        return "not measured"
    bad = [sentence for part in evidence.parts for sentence in (*part.forbidden, *part.hidden)]
    counted = sum(part.statements for part in evidence.parts)
    files = sum(part.files for part in evidence.parts)
    if bad:
        return f"{len(bad)} imports break the contract: {'; '.join(bad[:5])}."
    whole = f"{counted} imports in {files} files of both methods and the references"
    return f"None of {whole} crosses their borders."


def _faults(evidence: Evidence) -> str:
    record = evidence.faults
    if record is None:
        return "Not measured: there is no record of planted faults; make one with: coatcheck faults --record"
    return (
        f"{_short_faults(evidence)} Measured {_when(record)}, by coatcheck faults, which also draws the "
        "matrix of faults against checks. A crash alone does not count as caught. "
        + (
            "The survivors, with the reason and with what would catch them:"
            if record.survivors
            else "None survived."
        )
    )


def _short_faults(evidence: Evidence) -> str:
    record = evidence.faults
    if record is None:
        return "not measured"
    return (
        f"{record.caught} of {len(record.rows)} planted faults are caught, "
        f"{plain(100 * record.share, 3)} %; {record.as_expected} of them by the comparison named beforehand."
    )


def _alarms(evidence: Evidence) -> str:
    record = evidence.alarms
    if record is None:
        return "Not measured: there is no record of false alarms; make one with: coatcheck alarms --record"
    return (
        f"{_short_alarms(evidence)} Measured {_when(record)}, by coatcheck alarms --count {record.problems} "
        f"--seed {record.seed}. An INCONCLUSIVE or a missing result counts as an alarm, too."
    )


def _short_alarms(evidence: Evidence) -> str:
    record = evidence.alarms
    if record is None:
        return "not measured"
    return (
        f"{len(record.alarms)} false alarms in {record.comparisons} comparisons and {record.laws} laws of "
        f"{record.problems} clean random problems; {record.agreeing} of the problems agree throughout."
    )
