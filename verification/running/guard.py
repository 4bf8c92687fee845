"""A module run as a process that ends with its parent, the first to go where memory ends.

python -m verification.running.guard LIFELINE MODULE WORDS... runs ``python -m MODULE WORDS...``.
LIFELINE is the number of an open pipe whose other end the parent holds for as long as it lives.
"""

import os
import runpy
import signal
import sys
import threading
from contextlib import suppress
from pathlib import Path

from verification.running.store import StoreError

__all__ = ["UNWRITABLE", "main"]

UNWRITABLE = 74  # exit code of a process that could not write its result, EX_IOERR of sysexits.h


def main(lifeline: int, module: str, *words: str) -> None:
    """Run ``module``; what goes wrong is one line on standard error."""
    threading.Thread(target=_end_with_parent, args=(lifeline,), daemon=True).start()
    _first_to_go()
    sys.argv = [module, *words]
    try:
        runpy.run_module(module, run_name="__main__", alter_sys=True)
    except StoreError as error:
        _leave(UNWRITABLE, str(error))
    except MemoryError as error:
        _leave(1, f"out of memory ({_line(error)}); run fewer --jobs or coarsen the case")
    except Exception as error:
        _leave(1, f"{type(error).__name__}: {_line(error)}")


def _end_with_parent(lifeline: int) -> None:
    # Nothing is ever written into the pipe, so reading returns when the parent is gone, however it went.
    with suppress(OSError):
        os.read(lifeline, 1)
    os.killpg(0, signal.SIGKILL)


def _first_to_go() -> None:
    # No limit of its own on memory: the sparse factorisation asks for four times what it then touches, so one
    # that stopped a runaway would refuse good cases. Where memory ends the kernel takes this process before
    # the one that writes the report.
    with suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text("1000")


def _line(error: BaseException) -> str:
    return " ".join(str(error).split())[:500] or "no message"


def _leave(code: int, sentence: str) -> None:
    sys.stderr.write(sentence + "\n")
    sys.exit(code)


if __name__ == "__main__":
    main(int(sys.argv[1]), *sys.argv[2:])
