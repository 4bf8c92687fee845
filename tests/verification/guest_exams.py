"""Exams for tests of guests: a shipped case with its exact reference, the question that a guest is asked."""

from dataclasses import replace

from verification.cases.case_file import default_cases, read_case
from verification.guests.case_exam import claims_of, exam_path, prepare, question_of
from verification.guests.doors.program_door import TimedAnswer
from verification.guests.exam_subjects import SPHERE, subject_of
from verification.guests.guest_description import Guest, Supports, read_guest
from verification.guests.guest_protocol import VERSION, GuestAnswer
from verification.guests.guest_verdicts import judged
from verification.running.case_result import from_json
from verification.running.checked_files import read_checked

GUEST = Guest.model_construct(
    folder=None, text="", name="g", claim=0.01, supports=Supports(coatings=9, friction=True, stress=True)
)


def guest_in(folder, text):
    """The guest of a file with that ``text``, written into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "guest.toml").write_text(text)
    return read_guest(folder)


def prepared(name, folder, load=SPHERE, **changed):
    """The case under ``load`` with its exact reference, stored below ``folder``; ``changed`` are fields."""
    case = subject_of(replace(read_case(default_cases()[name]), **changed), load)
    path = exam_path(folder, case)
    prepare(case, path)
    return case, from_json(read_checked(path))


def question(case, exam, guest=GUEST):
    return question_of(case, exam, guest, claims_of(case, guest), {})


def verdicts_on(case, exam, answer, guest=GUEST):
    """The verdict on each claim by quantity and line."""
    result = judged(
        guest, case, exam, [answer if isinstance(answer, TimedAnswer) else TimedAnswer(answer, 0.0)]
    )
    return {(claim.quantity, claim.line): verdict for claim, verdict in result.verdicts}


def result_of(case, exam, values, guest=GUEST):
    """The verdicts on those of ``values``, arrays by (quantity, line), that are asked for."""
    asked = question(case, exam, guest)
    wanted = {line.line: line.quantities for line in asked.lines} | {"contact": asked.contact}
    plain = {}
    for (q, line), value in values.items():
        if q in wanted.get(line, ()):
            plain.setdefault(line, {})[q] = float(value[0]) if line == "contact" else value.tolist()
    return judged(guest, case, exam, [TimedAnswer(GuestAnswer(protocol=VERSION, id="x", values=plain), 0.0)])
