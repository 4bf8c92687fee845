"""Why a planted fault is not caught by the checks of the default run, with what would catch it."""

__all__ = ["SURVIVORS"]

# name: (why it survives, what would catch it)
SURVIVORS: dict[str, tuple[str, str]] = {
    "load_of_the_rim": (
        "what the rim lacks shrinks with the patches, so that the ladder over the patch size sees it: the "
        "result is off by 5e-5 of p_h at most, and the method says so, for its uncertainty grows tenfold and "
        "stays far below the caps",
        "caps drawn as tight as the method usually is, or the baseline, which reports that the uncertainty "
        "grew; a result whose error lies within what it states is not wrong, only poorer",
    ),
}
