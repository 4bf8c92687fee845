"""A worker that does what it is told: crash, hang, exhaust memory, or leave a result.

python -m planted_worker HOW RESULT.json
"""

import ctypes
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from verification.store import write_checked


def main(how: str, path: str) -> None:
    """Do ``how``; "good" alone leaves a result at ``path``."""
    if how == "segmentation fault":
        # No core file of it.
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        ctypes.string_at(0)
    elif how == "exit":
        os._exit(7)
    elif how == "exception":
        raise RuntimeError("the matrix is singular\nat row 7")
    elif how == "abort":
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        os.abort()
    elif how == "hang":
        child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
        Path(f"{path}.pids").write_text(f"{os.getpid()} {child.pid}\n")
        time.sleep(600)
    elif how == "memory":
        # Never touched, so no memory is taken from the machine; it counts against the limit all the same.
        blocks: list[np.ndarray] = []
        while len(blocks) < 4096:
            blocks.append(np.empty(1 << 30, dtype=np.uint8))
        raise RuntimeError(f"no limit at {len(blocks)} GiB")
    elif how == "kernel":
        os.kill(os.getpid(), signal.SIGKILL)
    elif how == "nothing":
        pass
    else:
        write_checked(Path(path), {"said": how})


if __name__ == "__main__":
    main(*sys.argv[1:])
