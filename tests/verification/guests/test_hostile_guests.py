"""Hostile guests: whatever a program, a function or a file does, it is one message, and the others go on."""

import json
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest
from guest_exams import prepared, question, verdicts_on

from verification.guests.case_exam import claims_of, exam_path, prepare, question_of
from verification.guests.doors.ask_guest import answered, ask_task
from verification.guests.doors.file_door import pack
from verification.guests.doors.program_door import Program
from verification.guests.guest_description import Guest, Supports
from verification.guests.guest_protocol import ProtocolError
from verification.judging.verdict import Outcome
from verification.running.pool.process_pool import run_tasks

LIMIT = 0.4  # s for an answer of a guest that hangs
COMMAND = (sys.executable, "-S", "-E", "hostile.py")
# Every program begins so: the question is read, `good` is what Hertz would answer.
HEAD = """
import json, math, os, signal, sys, time
def say(text): sys.stdout.write(text); sys.stdout.flush()
line = sys.stdin.readline()
q = json.loads(line)
p = q["problem"]; s = p["substrate"]
a = (3 * p["load"] * p["radius"] * (1 - s["nu"]**2) / (4 * s["E"]))**(1/3)
p0 = 3 * p["load"] / (2 * math.pi * a * a)
x = q["lines"][0]["x"]
values = {"contact": {"contact_radius": a, "approach": a * a / p["radius"], "peak_pressure": p0},
          "surface": {"pressure": [p0 * math.sqrt(max(0, 1 - (r / a)**2)) for r in x]}}
good = {"protocol": "coatcheck-guest/1", "id": q["id"], "values": values}
c, f = values["contact"], values["surface"]
def answer(): say("COATCHECK " + json.dumps(good) + "\\n")
"""
NO, AGREE, OFF, NONE = Outcome.NO_RESULT, Outcome.AGREES, Outcome.DISAGREES, Outcome.UNSUPPORTED
# name: what it does, outcome of the contact radius, words of the message
PROGRAMS = {
    "good": ("answer()", AGREE, "within the claimed"),
    "hangs": ("time.sleep(1000)", NO, "no answer after 0.4 s"),
    "crashes": ("os.kill(os.getpid(), signal.SIGSEGV)", NO, "crashed with signal 11"),
    "raises": ("raise RuntimeError('no licence')", NO, "no licence"),
    "exits_0_without_answer": ("sys.exit(0)", NO, "ended with code 0 without an answer"),
    "closes_its_output": ("os.close(1); time.sleep(3)", NO, "closed its output"),
    "half_a_line": ('say(\'COATCHECK {"protocol": "coatch\'); sys.exit(0)', NO, "in the middle of an answer"),
    "chatter_before": ("say('Iteration 1\\n\\x00\\xff\\n'); answer()", AGREE, ""),
    "chatter_without_newline": ("say('x' * 10**6); answer()", NO, "without an answer"),
    "not_json": ("say('COATCHECK 42 apples\\n')", NO, "not JSON"),
    "deeply_nested": ("say('COATCHECK ' + '[' * 100000 + '\\n')", NO, "not JSON"),
    "wrong_id": ("good['id'] = 'another'; answer()", NO, "answers the question 'another'"),
    "no_values": ("del good['values']; answer()", NO, "exactly one of"),
    "unknown_key": ("good['extra'] = 1; answer()", AGREE, "within the claimed"),
    "unsupported": ("good.pop('values'); good['unsupported'] = 'not today'; answer()", NONE, "not today"),
    "error": ("good.pop('values'); good['error'] = 'did not converge'; answer()", NO, "did not converge"),
    "nan": ("c['contact_radius'] = float('nan'); answer()", NO, "no finite contact_radius"),
    "text_for_a_number": ("c['contact_radius'] = 'wide'; answer()", NO, "contact_radius"),
    "too_short": ("f['pressure'].pop(); answer()", AGREE, "within the claimed"),
    "empty_values": ("values.clear(); answer()", NONE, "not answered"),
    "null": ("c['contact_radius'] = None; answer()", NONE, "null"),
    "a_line_that_is_not_asked": ("values['nowhere'] = {'pressure': [1.0]}; answer()", AGREE, ""),
    "a_value_that_is_not_asked": ("c['colour'] = 1.0; answer()", AGREE, ""),
    "a_list_for_a_number": ("c['contact_radius'] = [a, a]; answer()", NO, "one number is needed"),
    "missing": (
        "del c['contact_radius']; good['missing'] = {'contact': {'contact_radius': 'soon'}}; answer()",
        NONE,
        "soon",
    ),
    "failed": (
        "del c['contact_radius']; good['failed'] = {'contact': {'contact_radius': 'oh'}}; answer()",
        NO,
        "oh",
    ),
    "in_other_units": ("good['units'] = {'length': 'mm'}; answer()", NO, "units"),
    "uncertainty_of_nothing": (
        "good['uncertainty'] = {'surface': {'sigma_xx': [0.0] * len(x)}}; answer()",
        AGREE,
        "within the claimed",
    ),
    "boastful_uncertainty": (
        "c['contact_radius'] *= 1.001\n"
        "good['uncertainty'] = {'contact': {'contact_radius': 1e-20}}; answer()",
        AGREE,
        "does not show this accuracy",
    ),
    "boastful_and_wrong": (
        "c['contact_radius'] *= 1.1\ngood['uncertainty'] = {'contact': {'contact_radius': 1e-20}}; answer()",
        OFF,
        "exceeds the uncertainty",
    ),
    "vague_uncertainty": (
        "good['uncertainty'] = {'contact': {'contact_radius': 1.0}}; answer()",
        AGREE,
        "exceeds the cap",
    ),
    "leaves_a_child_behind": (
        "import subprocess; subprocess.Popen(['sleep', '3']); answer(); sys.exit(0)",
        AGREE,
        "",
    ),
}


@pytest.fixture(scope="module")
def hertz(tmp_path_factory):
    """The uncoated case with its exact reference and where that is stored."""
    folder = tmp_path_factory.mktemp("hostile")
    return *prepared("01_uncoated_steel", folder), folder


def guest(folder, **way_in):
    return Guest.model_construct(
        folder=folder, text=repr(way_in), name="g", claim=0.01, supports=Supports(friction=True), **way_in
    )


def hostile(folder, program, limit=LIMIT):
    """A guest whose program is this text in Python."""
    (folder / "hostile.py").write_text(program + "\n")
    return guest(folder, command=COMMAND, time_limit=limit)


def verdict_on(hertz, host):
    """The verdict on the contact radius of a guest."""
    case, exam, _ = hertz
    (reply,) = answered(host, case, [question(case, exam, host)])
    return verdicts_on(case, exam, reply, host)["contact_radius", "contact"]


def check_message(verdict, outcomes, words):
    assert verdict.outcome in outcomes, verdict.reason
    assert words in verdict.reason
    assert "\n" not in verdict.reason
    assert len(verdict.reason) < 2500


@pytest.fixture(scope="module")
def verdicts(hertz, tmp_path_factory):
    """The verdict on each program; several at a time, since most of them do nothing but wait."""

    def verdict_of(name):
        program, *_ = PROGRAMS[name]
        # Who must end by itself has time: start and reading take theirs on a machine at work.
        limit = LIMIT if name == "hangs" else 20.0
        return verdict_on(hertz, hostile(tmp_path_factory.mktemp(name), HEAD + program, limit))

    with ThreadPoolExecutor(8) as pool:
        return dict(zip(PROGRAMS, pool.map(verdict_of, PROGRAMS), strict=True))


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_hostile_program_is_one_message(verdicts, name):
    _, outcome, words = PROGRAMS[name]
    check_message(verdicts[name], (outcome,), words)


@pytest.mark.slow
def test_a_program_with_a_gigabyte_to_say_is_one_message(hertz, tmp_path):
    host = hostile(tmp_path, HEAD + "while True: say('x' * 10**6 + '\\n')", 60.0)
    check_message(verdict_on(hertz, host), (NO,), "more than 64 MB without an answer")


# What a function does: body, words of the message. All end without a result.
FUNCTIONS = {
    "hangs": ("import time; time.sleep(1000)", "no answer after"),
    "exits": ("import os; os._exit(0)", "ended with code 0"),
    "calls_sys_exit": ("import sys; sys.exit(3)", "ended with code 3"),
    "crashes": ("import ctypes; ctypes.string_at(0)", "crashed with signal 11"),
    "returns_none": ("return None", "none of contact_radius"),
    "raises_with_a_novel": ("raise ValueError('x' * 10**6)", "ValueError: xxx"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_hostile_function_is_one_message(hertz, tmp_path, name):
    body, words = FUNCTIONS[name]
    (tmp_path / "adapter.py").write_text(f"def solve(radius, load, substrate):\n    {body}\n")
    host = guest(tmp_path, callable="adapter:solve", time_limit=10.0)
    check_message(verdict_on(hertz, host), (NO, NONE), words)


def test_answers_out_of_order_are_refused(hertz, tmp_path):
    case, exam, _ = hertz
    host = hostile(
        tmp_path, HEAD + "second = sys.stdin.readline()"
    )  # waits for a second one before it answers
    host = host.model_copy(update={"refine": {"n": [1, 2, 4]}})
    claims = claims_of(case, host)
    questions = [question_of(case, exam, host, claims, parameter) for parameter in host.questions]
    replies = answered(host, case, questions)
    assert len(replies) == 3
    assert all(reply.answer.error for reply in replies)
    hostile(tmp_path, HEAD + "good['id'] = q['id'].replace('=1', '=2'); answer()")
    replies = answered(host, case, questions)
    assert "question" in replies[0].answer.error


def test_a_program_that_keeps_its_answer_in_a_buffer_is_told_to_flush(hertz, tmp_path):
    program = "import sys, time; print('COATCHECK {}', flush=False); sys.stdin.readline(); time.sleep(100)"
    assert "flush" in verdict_on(hertz, hostile(tmp_path, program, 1.0)).reason


def test_a_program_that_is_not_there_is_one_message(tmp_path):
    with pytest.raises(ProtocolError, match="no_such_program"):
        Program(("no_such_program",), tmp_path)


def test_hostile_files_are_one_message(hertz, tmp_path):
    case, exam, _ = hertz
    host = guest(tmp_path, results="answers")
    asked = question(case, exam, host)
    folder = pack(host, case, asked)
    for content in (
        b"\xff\xfe\x00",
        b"",
        b"quantity,value\n" + b"contact_radius,1e9999\n" * 10,
        b'"' * 10**5,
    ):
        (folder / "contact.csv").write_bytes(content)
        answer = answered(host, case, [asked])[0].answer
        assert answer.values is None or "contact" in answer.values
    (folder / "contact.csv").unlink()
    os.mkfifo(folder / "contact.csv")
    answer = answered(host, case, [asked])[0].answer
    assert "regular" in answer.error


def test_a_hostile_guest_does_not_hold_up_the_others(hertz, tmp_path):
    case, exam, folder = hertz
    text = f'name = "g"\ncommand = {json.dumps(COMMAND)}\nclaim = 0.01\ntime_limit = {LIMIT}\n'
    host = hostile(tmp_path, HEAD + "time.sleep(1000)").model_copy(update={"text": text})
    begin = time.monotonic()
    second = replace(case, name="second")
    prepare(second, exam_path(folder, second))
    tasks = [ask_task(host, one, folder) for one in (case, second)]
    found = run_tasks(tasks, jobs=1, time_limit=60.0)
    assert all(replies[0].answer.error for replies in found)
    assert time.monotonic() - begin < 60
    assert exam.profiles
