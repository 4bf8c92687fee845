"""A process that imports what tasks need once, then forks a child for each task.

python -m verification.running.pool.fork_guard reads a request a line on standard input,

    {"work": PICKLED_PARTIAL, "ahead": [MODULE, ...], "more": BOOL}

imports the modules and calls the partial function in a child. On standard output the child answers "taken
PID" and, where more is to come, "done PID" before it reads the next request. When the child is gone, "ended
PID CODE" is answered, with a negative CODE for a signal.

A child that crashes, hangs or runs out of memory takes nothing else with it. All end with the parent, and
before it where memory ends.
"""

import base64
import json
import os
import pickle
import select
import signal
import sys
import threading
import warnings
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import BinaryIO, NoReturn

from verification.running.checked_files import StoreError

UNWRITABLE = 74  # exit code of a process that could not write its result, EX_IOERR of sysexits.h


def main() -> None:
    """Serve requests until standard input ends."""
    requests, replies = os.fdopen(os.dup(0), "rb"), os.dup(1)
    null = os.open(os.devnull, os.O_RDWR)
    os.dup2(null, 0)
    os.dup2(null, 1)
    _first_candidate_when_memory_ends()
    for line in requests:
        for module in json.loads(line)["ahead"]:
            with suppress(Exception):  # one that fails is left to the child
                import_module(module)
        with warnings.catch_warnings():
            # The only other threads are idle ones of BLAS, which ends them before a fork.
            warnings.simplefilter("ignore", DeprecationWarning)
            child = os.fork()
        if child == 0:
            _serve(line, requests, replies)
        with suppress(OSError):
            os.setpgid(child, child)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        with suppress(OSError):
            os.killpg(child, signal.SIGKILL)  # whatever it started
        _reply(replies, f"ended {child} {code}")


def _serve(line: bytes, requests: BinaryIO, replies: int) -> NoReturn:
    """Run the request ``line``, then those that share the process with it; never returns."""
    code = 1
    try:
        os.setpgid(0, 0)
        threading.Thread(target=_end_with_parent, args=(requests.fileno(),), daemon=True).start()
        while True:
            _reply(replies, f"taken {os.getpid()}")
            request = json.loads(line)
            code = _run(request["work"])
            if code or not request["more"]:
                break
            _reply(replies, f"done {os.getpid()}")
            line = requests.readline()
    finally:
        sys.stderr.flush()
        os._exit(code)


def _run(work: str) -> int:
    """Exit code of the pickled ``work``; an error becomes one line on standard error."""
    try:
        pickle.loads(base64.b64decode(work))()
        return 0
    except Exception as error:
        code, message = 1, " ".join(str(error).split())[:500] or "no message"
        if isinstance(error, StoreError):
            code = UNWRITABLE
        elif isinstance(error, MemoryError):
            message = f"out of memory ({message}); run fewer --jobs or coarsen the case"
        else:
            message = f"{type(error).__name__}: {message}"
        sys.stderr.write(message + "\n")
        return code


def _end_with_parent(requests: int) -> None:
    # With no event registered, poll returns when the other end is closed: the parent has ended.
    end = select.poll()
    end.register(requests, 0)
    end.poll()
    os.killpg(0, signal.SIGKILL)


def _first_candidate_when_memory_ends() -> None:
    # No limit on memory: the sparse factorisation reserves four times what it uses, so a limit that stops a
    # runaway would refuse good cases. The kernel ends this process before the one that writes the report.
    with suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text("1000")


def _reply(replies: int, text: str) -> None:
    # A parent that is gone reads nothing; standard input ends next.
    with suppress(BrokenPipeError):
        os.write(replies, f"{text}\n".encode())


if __name__ == "__main__":
    main()
