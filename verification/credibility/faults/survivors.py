"""Why a planted fault is not caught by the checks of the default run, with what would catch it."""

__all__ = ["SURVIVORS"]

# name: (why it survives, what would catch it)
SURVIVORS: dict[str, tuple[str, str]] = {
    "load_of_the_rim": (
        "what the rim lacks shrinks with the patches, so that the ladder over the patch size sees it: the "
        "result is off by 5e-5 of p_h at most, and the uncertainty stated grows to cover it, still far below "
        "the caps",
        "caps drawn as tight as the method usually is, or the baseline, which reports that the uncertainty "
        "grew; a result whose error lies within what it states is not wrong, only poorer",
    ),
    "far_load_missing": (
        "a clamped boundary at 1000 contact radii costs 6e-4 of the approach, nothing else; the ladder over "
        "the outer boundary sees it, so that the uncertainty stated grows a thousandfold to just that, and "
        "0.1 % is what the cap on the approach allows",
        "a cap of 1e-4 on the approach, of which both methods state 1e-5 at most; or the baseline, which "
        "reports that value and uncertainty changed",
    ),
    "reduced_quadrature_contact": (
        "the peak pressure is off by 3e-5, and the ladder over the element size sees it: the uncertainty "
        "stated grows sixtyfold, to 7e-4, and 0.1 % is what the cap on the peak pressure allows",
        "a cap of 2e-4 on the peak pressure, of which both methods state 4e-5 at most; or the baseline, that "
        "reports that value and uncertainty changed",
    ),
}
