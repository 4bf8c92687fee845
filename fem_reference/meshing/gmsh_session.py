"""A private gmsh session that leaves the state of the process unchanged.

gmsh is one global object per process: one list of models, one set of options, one log. Its Python
module can be imported only where certain system libraries exist. All use of it goes through ``session``,
which admits one thread at a time and restores the models and options of the caller.
"""

import ctypes
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any

_LOCK = threading.Lock()

_OPTIONS = {
    "General.Terminal": 0,
    "General.Verbosity": 0,
    "General.NumThreads": 1,
    "General.AbortOnError": 2,
    "Mesh.Algorithm": 6,  # frontal Delaunay
    "Mesh.ElementOrder": 1,
    "Mesh.RandomSeed": 1,
    "Mesh.MeshSizeExtendFromBoundary": 0,
    "Mesh.MeshSizeFromPoints": 0,
    "Mesh.MeshSizeFromCurvature": 0,
    "Mesh.MeshSizeMin": 0,
    "Mesh.MeshSizeMax": 1e22,
    "Mesh.MeshSizeFactor": 1,
    "Mesh.Optimize": 1,
    "Mesh.RecombineAll": 0,
    "Mesh.SubdivisionAlgorithm": 0,
}


def _start(gmsh: ModuleType) -> None:
    """gmsh without signal handlers or configuration files, the answer to a closed pipe as it was before.

    gmsh resets that to its default, by which a write to a closed pipe ends the process. It is put back by
    the C library, since Python does so in the main thread alone.
    """
    pipe = getattr(signal, "SIGPIPE", None)
    if pipe is None:
        gmsh.initialize([], readConfigFiles=False, interruptible=False)
        return
    answer = ctypes.CDLL(None).signal
    answer.argtypes, answer.restype = (ctypes.c_int, ctypes.c_void_p), ctypes.c_void_p
    before = answer(pipe, int(signal.SIG_IGN))
    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    answer(pipe, before)


@contextmanager
def session(name: str) -> Iterator[Any]:
    """A gmsh with one fresh model called ``name``, silent, with defaults of its own.

    Where the caller's process already runs gmsh, its models stay, its current model stays current and its
    options return to what they were; otherwise gmsh is started in any thread and shut down again.
    Raises ImportError (naming the apt packages) when gmsh's system libraries are missing.
    """
    with _LOCK:
        try:
            import gmsh
        except (ImportError, OSError) as error:
            raise ImportError(
                f"gmsh cannot be loaded ({error}); on a bare Debian or Ubuntu run: "
                "apt-get install libglu1-mesa libxrender1 libxcursor1 libxft2 libxinerama1 libgl1"
            ) from error
        running = bool(gmsh.isInitialized())
        if not running:
            _start(gmsh)
        before = {option: gmsh.option.getNumber(option) for option in _OPTIONS}
        current = gmsh.model.getCurrent()
        try:
            for option, value in _OPTIONS.items():
                gmsh.option.setNumber(option, value)
            gmsh.model.add(name)
            yield gmsh
        finally:
            if running:
                gmsh.model.setCurrent(name)
                gmsh.model.remove()
                gmsh.model.setCurrent(current)
                for option, value in before.items():
                    gmsh.option.setNumber(option, value)
            else:
                gmsh.finalize()
