"""Why a planted fault is not caught by the checks of the default run, with what would catch it."""

__all__ = ["SURVIVORS"]

# name: (why it survives, what would catch it)
SURVIVORS: dict[str, tuple[str, str]] = {}
