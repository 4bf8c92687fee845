"""A guest asked about one case at every level, as a task of the pool."""

from functools import partial
from pathlib import Path
from typing import Any

from verification.guests.case_exam import claims_of, exam_path, question_of
from verification.guests.doors.file_door import read_answer
from verification.guests.doors.program_door import GRACE, Program, TimedAnswer, command_of
from verification.guests.exam_subjects import Subject
from verification.guests.guest_description import Guest, parse_guest
from verification.guests.guest_protocol import VERSION, GuestAnswer, ProtocolError, Question
from verification.running.case_result import from_json
from verification.running.checked_files import StoreError, read_checked, write_checked
from verification.running.json_records import plain
from verification.running.pool.pool_task import Task

Replies = list[TimedAnswer]


def ask(guest_file: Path, guest_text: str, case: Subject, exam: Path, path: Path) -> None:
    """Put ``case`` to the guest at every level; write its answers to ``path``."""
    guest = parse_guest(guest_text.encode(), guest_file)
    result = from_json(read_checked(exam))
    claims = claims_of(case, guest)
    questions = [question_of(case, result, guest, claims, parameter) for parameter in guest.questions]
    replies = answered(guest, case, questions, _at_work)
    content = [
        {"answer": solved.answer.model_dump(), "seconds": solved.seconds, "memory": solved.memory}
        for solved in replies
    ]
    write_checked(path, {"schema": VERSION, "replies": plain(content)})


# The program of the last case, which answers the next one too where both share a process.
_at_work: dict[str, Program] = {}


def answered(
    guest: Guest, case: Subject, questions: list[Question], at_work: dict[str, Program] | None = None
) -> Replies:
    """The guest's answer to each question; what it does instead becomes an error.

    at_work : programs by guest file that are left to go on; one started here ends here without.
    """
    replies: Replies = []
    programs = {} if at_work is None else at_work
    key = guest.text
    for question in questions:
        try:
            if guest.results is not None:
                replies.append(TimedAnswer(read_answer(guest, case, question), 0.0))
            else:
                if key not in programs:
                    programs[key] = Program(command_of(guest), guest.folder)
                replies.append(programs[key].ask(question, guest.time_limit))
        except ProtocolError as error:
            failed = GuestAnswer(protocol=VERSION, id=question.id, error=str(error)[:2000])
            replies.append(TimedAnswer(failed, 0.0))
            if key in programs:
                programs.pop(key).end(0.0)
    if key in programs and at_work is None:
        programs.pop(key).end(GRACE)
    return replies


def end_programs() -> None:
    """End the programs at work in this process; those of the pool end with theirs."""
    while _at_work:
        _at_work.popitem()[1].end()


def ask_task(guest: Guest, case: Subject, folder: Path, process: int = 0) -> Task[Replies]:
    """Asking ``guest`` about ``case``, whose exact reference lies in ``folder``.

    process : tasks of one number share a process, and so the program of the guest.
    """
    path, exam = folder / "answers" / f"{case.name}.json", exam_path(folder, case)
    return Task(
        case.name,
        partial(ask, guest.folder / "guest.toml", guest.text, case, exam, path),
        path,
        _read,
        partial(_none, case),
        cost=1.0 + len(case.problem.coatings),
        together=process,
    )


def _read(data: dict[str, Any]) -> Replies:
    if data.get("schema") != VERSION:
        raise StoreError("not answers of this version")
    return [
        TimedAnswer(GuestAnswer.model_validate(reply["answer"]), reply["seconds"], reply["memory"])
        for reply in data["replies"]
    ]


def _none(case: Subject, reason: str, seconds: float) -> Replies:
    answer = GuestAnswer(protocol=VERSION, id=case.name, error=reason)
    return [TimedAnswer(answer, seconds)]
