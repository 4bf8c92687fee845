"""Every number on a line of a case as CSV."""

from collections.abc import Iterable
from itertools import zip_longest

import numpy as np

from verification.page.page_parts import written
from verification.problem.line_profile import Profile, coordinate_of
from verification.problem.quantity import unit_of

MOST_DIGITS = 10


def line_csv(profiles: Iterable[Profile], line: str) -> str:
    """Every quantity of every source on ``line`` as CSV, SI units in the column heads.

    Sources at the same positions share one position column; another one follows where they differ.
    """
    groups: dict[bytes, list[Profile]] = {}
    for profile in profiles:
        if profile.line == line:
            groups.setdefault(profile.position.tobytes(), []).append(profile)
    columns: list[list[str]] = []
    for group in groups.values():
        if line != "contact":
            columns.append([f"{coordinate_of(line)} [m]", *(f"{x:.9g}" for x in group[0].position.tolist())])
        for profile in group:
            head = f"{profile.quantity} [{unit_of(profile.quantity)}] {profile.source}"
            columns.append([_safe(head), *_cut(profile)])
            if profile.uncertainty is not None:
                uncertainty = [f"{v:.2g}" for v in profile.uncertainty.tolist()]
                columns.append([_safe(f"uncertainty of {head}"), *uncertainty])
    return written(list(zip_longest(*columns, fillvalue="")))


def _cut(profile: Profile) -> list[str]:
    """The values, each to a tenth of its uncertainty, ten digits at most; eight where none is stated."""
    values = profile.value
    if profile.uncertainty is None:
        return [f"{v:.8g}" for v in values.tolist()]
    with np.errstate(all="ignore"):
        digits = np.ceil(np.log10(np.abs(values) / profile.uncertainty) + 1.7)
    digits = np.clip(np.nan_to_num(digits, nan=2, posinf=MOST_DIGITS), 2, MOST_DIGITS).astype(int)
    return [f"{v:.{d}g}" for v, d in zip(values.tolist(), digits.tolist(), strict=True)]


def _safe(text: str) -> str:
    # An untrusted name must not run as a formula when the file is opened in a spreadsheet.
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text
