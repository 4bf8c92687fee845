"""Numbers as text: engineering prefixes, as many digits as the uncertainty supports."""

from collections.abc import Sequence
from math import floor, isfinite, log10
from typing import Any

from markupsafe import Markup

from verification.problem.display_units import prefix_of

MOST_DIGITS = 9


def engineering(value: Any, unit: str, digits: int = 4) -> str:
    """``value`` in SI with an engineering prefix, e.g. 4.2e11, "Pa" -> "420 GPa"."""
    number = _number(value)
    if number is None:
        return f"{value} {unit}"
    factor, prefix = _prefix(number)
    return f"{plain(number / factor, digits)} {prefix}{unit}"


def aligned(values: Sequence[tuple[Any, Any] | None], unit: str) -> tuple[str, list[Markup | str]]:
    """(value, uncertainty) pairs [SI] of one column: its unit with one prefix, the texts point under point.

    The uncertainty follows in parentheses, in units of the last digit; two digits of it, at most nine of the
    value. A pair that is None has no text; an uncertainty None is "not stated" (six digits are shown), 0 is
    "exact".
    """
    found = [_number(pair[0]) for pair in values if pair is not None]
    first = next((number for number in found if number), 0.0)
    factor, prefix = _prefix(first)
    parts = [("", "") if pair is None else _parted(*pair, factor) for pair in values]
    width = max((len(after) for _, after in parts), default=0)
    mark = Markup('{}<span class="after" style="min-width:{}ch">{}</span>')
    texts = [mark.format(whole, width, after) if whole else "–" for whole, after in parts]
    return f"{prefix}{unit}" if unit != "1" else "", texts


def _parted(value: Any, uncertainty: Any, factor: float) -> tuple[str, str]:
    """The text before the decimal point; the rest."""
    number, stated = _number(value), _number(uncertainty)
    if number is None or (uncertainty is not None and not 0 <= (-1.0 if stated is None else stated) < 1e30):
        return "not finite", ""
    mantissa = number / factor
    if not 1e-6 < abs(mantissa) < 1e6 and mantissa:
        return _minus(f"{mantissa:.3e}"), ""
    whole = floor(log10(abs(mantissa))) if mantissa else 0
    most = MOST_DIGITS - 1 - whole
    width = 0.0 if stated is None else stated / factor
    decimals = max((5 if uncertainty is None else MOST_DIGITS - 1) - whole, 0)
    if width > 0:
        decimals = min(max(1 - floor(log10(width)), 0), max(most, 0))
    text, point, after = _minus(f"{mantissa:.{decimals}f}").partition(".")
    last = round(width * 10**decimals) if 0 < width < 1e9 else 0
    return text, f"{point}{after}{f'({last})' if last else ''}"


def scientific(value: Any, digits: int = 2, sign: bool = False) -> str:
    """A fraction such as 3.1e-5, short enough for a cell; "–" where there is none."""
    if value is None:
        return "–"
    number = _number(value)
    if number is None:
        return "not finite"
    if number == 0:
        return "0"
    mantissa, exponent = format(number, f"{'+' if sign else ''}.{digits - 1}e").split("e")
    return _minus(f"{mantissa}e{int(exponent)}")


def plain(value: Any, digits: int = 4) -> str:
    """A ratio or a count with ``digits`` significant digits, all those before its point: 154, not 1.5e2."""
    number = _number(value)
    if number is None:
        return str(value)
    text = format(number + 0.0, f".{digits}g")
    return _minus(f"{number:.0f}" if "e+0" in text else text)


def seconds(value: Any) -> str:
    """A time: "0.43 s", "12.3 s", "2 min 05 s"."""
    number = _number(value)
    if number is None:
        return "–"
    if number >= 90:
        minutes, rest = divmod(round(number), 60)
        return f"{minutes} min {rest:02d} s"
    return f"{number:.2f} s" if number < 10 else f"{number:.1f} s"


def _number(value: Any) -> float | None:
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return number if isfinite(number) else None


def _prefix(number: float) -> tuple[float, str]:
    factor, letter = prefix_of(number) if number else (1.0, "")
    return factor, letter.replace("u", "µ")


def _minus(text: str) -> str:
    return f"−{text[1:]}" if text.startswith("-") else text
