"""JUnit XML: one test case for each comparison, invariant, self-test, so that any CI can read a run."""

import re
from collections.abc import Collection, Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from verification.judging.verdict import Outcome
from verification.regression.baseline_change import Regression, State
from verification.regression.manifest import manifest_message
from verification.running.case_result import CaseResult, RunInfo

# XML 1.0 has no way to write these, not even escaped.
_FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
COUNTS = {"tests": "", "failures": "/failure", "errors": "/error", "skipped": "/skipped"}


def junit_xml(
    results: Sequence[CaseResult],
    info: RunInfo,
    beside: Regression | None = None,
    tests: Mapping[str, str] | None = None,
    skipped: Collection[Outcome] = (Outcome.UNSUPPORTED,),
) -> str:
    """The verdicts as JUnit XML, with the manifest and the baseline ``beside`` them.

    DISAGREES is a failure, NO_RESULT an error. INCONCLUSIVE is a failure too, of its own type: only
    AGREES passes, and a skipped test counts as passed in most readers of this format. UNSUPPORTED, what a
    guest does not give, is skipped.
    skipped : outcomes that neither pass nor fail; of guests INCONCLUSIVE too, which is no error of theirs.
    tests : what each self-test found wrong, "" where it passed.
    """
    root = Element("testsuites", name="coatcheck", time=f"{info.seconds:.3f}")
    for result in results:
        _suite(root, result, info, skipped)
    messages = {f"self-test of the {name}": message for name, message in (tests or {}).items()}
    if beside is not None and beside.update is not None:
        moved = [
            case.name for case in beside.cases if case.beyond or case.state in (State.DRIFTED, State.GONE)
        ]
        messages["manifest"] = manifest_message(beside.less)
        messages["baseline"] = f"drifted: {', '.join(moved)}" if beside.unexplained else ""
    if messages:
        suite = SubElement(root, "testsuite", name="run", time="0")
        for name, message in messages.items():
            item = SubElement(suite, "testcase", classname="run", name=name, time="0")
            _mark(item, Outcome.DISAGREES if message else Outcome.AGREES, message, message)
    for name, tag in COUNTS.items():
        for suite in root:
            suite.set(name, str(len(suite.findall(f"testcase{tag}"))))
        if name != "skipped":
            root.set(name, str(sum(int(suite.get(name, "0")) for suite in root)))
    indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _suite(root: Element, result: CaseResult, info: RunInfo, skipped: Collection[Outcome]) -> None:
    time, started = f"{result.seconds:.3f}", _text(info.started)
    suite = SubElement(root, "testsuite", name=_text(result.name), time=time, timestamp=started)
    properties = SubElement(suite, "properties")
    SubElement(properties, "property", name="title", value=_text(result.title))

    def made(name: str) -> Element:
        return SubElement(suite, "testcase", classname=_text(result.name), name=_text(name), time="0")

    for claim, verdict in result.verdicts:
        item = made(f"{claim.quantity} on {claim.line}: {' against '.join(claim.between)}")
        text = (
            f"{verdict.reason}\ndifference {_number(verdict.difference)}, uncertainty "
            f"{_number(verdict.uncertainty)}, cap {_number(claim.cap)}, margin {_number(verdict.margin)}"
        )
        _mark(item, verdict.outcome, verdict.reason, text, skipped)
    for one in result.invariants:
        item = made(f"{one.name} of {one.source}")
        text = f"{one.message}\nresidual {_number(one.value)}, bound {_number(one.bound)}"
        _mark(item, one.outcome, one.message, text)
    if not result.verdicts:
        # A case without a result must not vanish from the count.
        item = made("case")
        failures = [f"{s.source}: {s.failure}" for s in result.sources if s.failure is not None]
        _mark(item, Outcome.NO_RESULT, "the case has no comparison", "\n".join(failures))


def _mark(item: Element, outcome: Outcome, reason: str, text: str, skipped: Collection[Outcome] = ()) -> None:
    if outcome is Outcome.AGREES:
        return
    if outcome in skipped:
        SubElement(item, "skipped", message=_text(reason))
        return
    tag = "error" if outcome is Outcome.NO_RESULT else "failure"
    SubElement(item, tag, type=outcome.value, message=_text(reason)).text = _text(text)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.1e}"


def _text(text: str) -> str:
    return _FORBIDDEN.sub("\ufffd", text)
