"""The door of Python functions: python -m verification.guests.doors.serve_function MODULE:FUNCTION.

Answers the questions on standard input by calls of the function. What the function prints goes to standard
error, so that it is not taken for an answer.
"""

import inspect
import os
import sys
import traceback
from collections.abc import Callable
from dataclasses import fields
from importlib import import_module
from typing import Any

from verification.guests.doors.returned_answers import NotGiven, values_of
from verification.guests.exam_subjects import Load, SquareLoad
from verification.guests.guest_protocol import TOKEN, VERSION, Answer, Disc, Layer, Question, Square
from verification.problem.array_types import Coatings
from verification.problem.coated_contact import CoatedContact, NotClaimed, PrescribedLoad
from verification.running.json_records import plain


def main(place: str) -> None:
    """Answer every line of standard input."""
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    sys.path.insert(0, os.getcwd())
    for line in sys.stdin:
        question = Question.model_validate_json(line)
        replies.write(f"{TOKEN} {answer(place, question).model_dump_json()}\n")
        replies.flush()


def answer(place: str, question: Question) -> Answer:
    """The answer of the function at ``place``; an exception becomes an answer too."""
    given: dict[str, Any] = {"protocol": VERSION, "id": question.id}
    try:
        module, _, name = place.partition(":")
        function: Any = import_module(module)
        for part in name.split("."):
            function = getattr(function, part)
        problem = problem_of(question)
        values, uncertainty = values_of(called(function, problem, question.parameter), problem, question)
        return Answer(**given, values=plain(values), uncertainty=plain(uncertainty))
    except (NotImplementedError, NotClaimed, NotGiven) as error:
        return Answer(**given, unsupported=_message(error) or "not implemented")
    except Exception as error:
        frames = traceback.extract_tb(error.__traceback__)
        # The last line of the guest's own, where there is one.
        own = [frame for frame in frames if frame.filename.startswith(os.getcwd())] or frames[-1:]
        where = f" ({os.path.basename(own[-1].filename)}, line {own[-1].lineno})" if own else ""
        return Answer(**given, error=f"{type(error).__name__}: {_message(error)}{where}")


def problem_of(question: Question) -> Load:
    """The problem of ``question`` in the units of the guest."""
    p = question.problem
    substrate = (p.substrate.E, p.substrate.nu)
    if isinstance(p, Disc):
        return PrescribedLoad(p.pressure, p.load_radius, _layers(p.coatings), substrate)
    if isinstance(p, Square):
        return SquareLoad(p.pressure, p.side, _layers(p.coatings), substrate)
    ball = None if p.ball is None else (p.ball.E, p.ball.nu, _layers(p.ball.coatings))
    return CoatedContact(p.radius, p.load, _layers(p.coatings), substrate, p.friction, ball)


def _layers(coatings: list[Layer]) -> Coatings:
    return tuple((c.E, c.nu, c.thickness or 0.0) for c in coatings)


def called(function: Callable[..., Any], problem: Load, parameter: dict[str, float]) -> Any:
    """``function`` called with the problem by keywords; one that it lacks must be nothing."""
    given = {f.name: getattr(problem, f.name) for f in fields(problem)}
    accepted = inspect.signature(function).parameters
    if not any(p.kind is inspect.Parameter.VAR_KEYWORD for p in accepted.values()):
        for name, nothing in (("friction", 0.0), ("coatings", ()), ("ball", None)):
            if name in given and name not in accepted and given[name] == nothing:
                del given[name]
    return function(**given, **parameter)


def _message(error: BaseException) -> str:
    return " ".join(str(error).split())[:500]


if __name__ == "__main__":
    main(sys.argv[1])
