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

from verification.running.checked_files import write_checked


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
        # The first of a run may come before anything else has made the folder.
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        Path(f"{path}.pids").write_text(f"{os.getpid()} {child.pid}\n")
        time.sleep(600)
    elif how == "memory":
        import numpy as np

        np.empty(1 << 46, dtype=np.uint8)
    elif how == "kernel":
        os.kill(os.getpid(), signal.SIGKILL)
    elif how == "process":
        write_checked(Path(path), {"said": str(os.getpid())})
    elif how == "threads":
        write_checked(Path(path), {"said": os.environ["OMP_NUM_THREADS"]})
    elif how == "method":
        import semianalytic

        write_checked(Path(path), {"said": semianalytic.solve.__name__})
    elif how == "nothing":
        pass
    else:
        write_checked(Path(path), {"said": how})


if __name__ == "__main__":
    main(*sys.argv[1:])
