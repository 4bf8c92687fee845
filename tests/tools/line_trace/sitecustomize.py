"""Notes each line of both methods at its first execution, in this process and those that it starts.

Python imports this module at its start where its folder stands in PYTHONPATH; `unexecuted` sets that, and
LINE_TRACE, the file to which "path:line" is appended.
"""

import os
import sys
import threading
from pathlib import Path
from types import FrameType
from typing import Any

ROOT = str(Path(__file__).parents[3])
METHODS = tuple(os.path.join(ROOT, name, "") for name in ("semianalytic", "fem_reference"))
unseen: dict[tuple[str, int, str], set[int]] = {}  # lines of each function, not executed yet


def on_call(frame: FrameType, event: str, arg: object) -> Any:
    """Trace of a function of the methods, as long as it has lines that were not executed yet."""
    code = frame.f_code
    if not code.co_filename.startswith(METHODS):
        return None
    key = code.co_filename, code.co_firstlineno, code.co_name
    if key not in unseen:
        unseen[key] = {line for *_, line in code.co_lines() if line}
    left = unseen[key]

    def on_line(frame: FrameType, event: str, arg: object) -> Any:
        if event == "line" and frame.f_lineno in left:
            left.discard(frame.f_lineno)
            os.write(log, f"{os.path.relpath(code.co_filename, ROOT)}:{frame.f_lineno}\n".encode())
        return on_line

    return on_line if left else None


if "LINE_TRACE" in os.environ:
    log = os.open(os.environ["LINE_TRACE"], os.O_WRONLY | os.O_APPEND | os.O_CREAT)
    threading.settrace(on_call)
    sys.settrace(on_call)
