"""JUnit XML: one test case for each comparison or invariant, so that any CI can read a run."""

import re
from collections.abc import Sequence
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from verification.judging.verdict import Outcome
from verification.report.tables.numbers import scientific
from verification.running.result import CaseResult, RunInfo

# XML 1.0 has no way to write these, not even escaped.
_FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def junit_xml(results: Sequence[CaseResult], info: RunInfo) -> str:
    """The verdicts as JUnit XML.

    DISAGREES is a failure, NO_RESULT an error. INCONCLUSIVE is a failure too, of its own type: only
    AGREES passes, and a skipped test counts as passed in most readers of this format. UNSUPPORTED, what a
    guest does not give, is skipped.
    """
    root = Element("testsuites", name="coatcheck", time=f"{info.seconds:.3f}")
    for result in results:
        _suite(root, result, info)
    for name in ("tests", "failures", "errors"):
        root.set(name, str(sum(int(suite.get(name, "0")) for suite in root)))
    indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _suite(root: Element, result: CaseResult, info: RunInfo) -> None:
    suite = SubElement(
        root,
        "testsuite",
        name=_text(result.name),
        time=f"{result.seconds:.3f}",
        timestamp=_text(info.started),
    )
    properties = SubElement(suite, "properties")
    SubElement(properties, "property", name="title", value=_text(result.title))
    for claim, verdict in result.verdicts:
        name = f"{claim.quantity} on {claim.line}: {' against '.join(claim.between)}"
        item = SubElement(suite, "testcase", classname=_text(result.name), name=_text(name), time="0")
        text = (
            f"{verdict.reason}\ndifference {scientific(verdict.difference)}, uncertainty "
            f"{scientific(verdict.uncertainty)}, cap {scientific(claim.cap)}, "
            f"margin {scientific(verdict.margin, sign=True)}"
        )
        _mark(item, verdict.outcome, verdict.reason, text)
    for one in result.invariants:
        name = f"{one.name} of {one.source}"
        item = SubElement(suite, "testcase", classname=_text(result.name), name=_text(name), time="0")
        text = f"{one.message}\nresidual {scientific(one.value)}, bound {scientific(one.bound)}"
        _mark(item, one.outcome, one.message, text)
    if not result.verdicts:
        # A case without a result must not vanish from the count.
        item = SubElement(suite, "testcase", classname=_text(result.name), name="case", time="0")
        failures = [f"{s.source}: {s.failure}" for s in result.sources if s.failure is not None]
        _mark(item, Outcome.NO_RESULT, "the case has no comparison", "\n".join(failures))
    suite.set("tests", str(len(suite.findall("testcase"))))
    suite.set("failures", str(len(suite.findall("testcase/failure"))))
    suite.set("errors", str(len(suite.findall("testcase/error"))))
    suite.set("skipped", str(len(suite.findall("testcase/skipped"))))


def _mark(item: Element, outcome: Outcome, reason: str, text: str) -> None:
    if outcome is Outcome.AGREES:
        return
    if outcome is Outcome.UNSUPPORTED:
        SubElement(item, "skipped", message=_text(reason))
        return
    tag = "error" if outcome is Outcome.NO_RESULT else "failure"
    SubElement(item, tag, type=outcome.value, message=_text(reason)).text = _text(text)


def _text(text: str) -> str:
    return _FORBIDDEN.sub("\ufffd", text)
