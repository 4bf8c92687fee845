"""Whether the array library of a GPU computes here."""

from importlib import import_module

__all__ = ["LIBRARY", "not_measured"]

LIBRARY = "cupy"


def not_measured(library: str = LIBRARY) -> str | None:
    """Why an array library computes nothing here, in one line; None where it does."""
    try:
        xp = import_module(library)
    except ModuleNotFoundError:
        return f"{library} is not installed"
    except ImportError as error:
        return f"{library} cannot be imported ({error})"
    try:
        float(xp.sum(xp.ones((2, 2))))
    except Exception as error:  # of its driver, whatever that raises
        return f"{library} finds no device that computes ({error})"
    return None
