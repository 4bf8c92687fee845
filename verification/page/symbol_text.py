"""Symbols of the field in running text: sigma_xx, a_h, E1/E2, 3.1e-5 as typeset formulas.

A text is cut into pieces, each upright or italic, on the line, below or above it; one writer makes HTML of
them, another SVG, a third plain Unicode.
"""

import re
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

from markupsafe import Markup, escape


class Piece(NamedTuple):
    """A part of a formula.   level : -1 subscript, 0 on the line, 1 superscript."""

    text: str
    italic: bool = False
    level: int = 0


_GREEK = {
    "sigma": "σ",
    "eps": "ε",
    "tau": "τ",
    "delta": "δ",
    "nu": "ν",
    "beta": "β",
    "kappa": "κ",
    "epsilon": "ε",
}
_NUMBER = r"(?<![\w.])(?P<mantissa>[+−-]?\d+(?:\.\d+)?)e(?P<exponent>[+−-]?\d+)(?!\w)"
_PATTERN = re.compile(
    "|".join(
        (
            _NUMBER,
            r"(?<!\w)(?P<tensor>sigma|eps)_(?P<component>[xyzk]{2})(?!\w)",
            r"(?<!\w)u_(?P<displacement>[xyz])(?!\w)",
            r"(?<!\w)(?P<hertz>a|p|S|delta)_h(?!\w)",
            r"(?<!\w)(?P<maximum>tau_max|von_mises_max)(?!\w)",
            r"(?<!\w)(?P<slope>dW/d ?delta)(?!\w)",
            r"(?<!\w)(?P<modulus>E)(?P<index>[12s])?(?P<star>\*)(?!\w)",
            r"(?<!\w)(?P<indexed>E|nu|h)_?(?P<layer>[12s])(?!\w)",
            r"(?<!\w)p_?(?P<peak>0)(?!\w)",
            r"(?<!\w)U_(?P<side>[A-Z])(?!\w)",
            r"(?<!\w)(?P<greek>delta|nu|kappa)(?!\w)",
            r"(?<!\w)(?P<letter>[hfpERUWxyzsaq])(?P<relation> (?:=|/|<|>|−|≤) )",
            r"(?<!\w)(?P<place>x)(?= of max )",
            r"^(?P<alone>[aEhfpRWxz])(?= \[|$)",
            r"(?:(?<=radius )|(?<=load )|(?<=leaves )|(?<=friction )|(?<=pressure )|(?<=over ))"
            r"(?P<named>[RaWfqp])(?!\w)",
            r"(?<=q = )(?P<traction>f p)(?!\w)",
            r"(?<!\w)(?P<bound>U)(?![\w.])",
            r"(?<=\d )(?P<unit>a)(?=[ .,;)]|$)(?! \w)",
            r"(?<=/ )(?P<under>[aW])(?!\w)",
            r"\|(?P<first>[AB]) − (?P<second>[AB])\|",
        )
    )
)
SMALL = 0.78  # size of an index over that of the line
_SUPERSCRIPT = str.maketrans("0123456789-−+", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁻⁺")


def pieces(text: str) -> list[Piece]:
    """``text`` with its symbols taken apart; everything else as it is."""
    found, at = [], 0
    for match in _PATTERN.finditer(text):
        if match.start() > at:
            found.append(Piece(text[at : match.start()]))
        found += _formula({name: value for name, value in match.groupdict().items() if value is not None})
        at = match.end()
    return [*found, Piece(text[at:])] if at < len(text) else found


def _formula(of: dict[str, str]) -> list[Piece]:
    if "mantissa" in of:
        exponent = str(int(of["exponent"].replace("−", "-"))).replace("-", "−")
        mantissa = of["mantissa"].replace("-", "−")
        times = "" if mantissa in ("1", "+1", "−1") else f"{mantissa}·"
        return [Piece(f"{times or mantissa[:-1]}10"), Piece(exponent, level=1)]
    if "tensor" in of:
        return [Piece(_GREEK[of["tensor"]], True), Piece(of["component"], True, -1)]
    if "displacement" in of:
        return [Piece("u", True), Piece(of["displacement"], True, -1)]
    if "hertz" in of:
        return [Piece(_GREEK.get(of["hertz"], of["hertz"]), True), Piece("H", level=-1)]
    if "maximum" in of:
        symbol, index = ("τ", "max") if of["maximum"] == "tau_max" else ("σ", "vM")
        return [Piece(symbol, True), Piece(index, level=-1)]
    if "slope" in of:
        return [Piece("d"), Piece("W", True), Piece("/d"), Piece("δ", True)]
    if "modulus" in of:
        below = [Piece(of["index"], level=-1)] if "index" in of else []
        return [Piece("E", True), *below, Piece("*", level=1)]
    if "indexed" in of:
        return [Piece(_GREEK.get(of["indexed"], of["indexed"]), True), Piece(of["layer"], level=-1)]
    if "peak" in of:
        return [Piece("p", True), Piece("0", level=-1)]
    if "side" in of:
        return [Piece("U", True), Piece(of["side"], True, -1)]
    if "first" in of:
        return [Piece("|"), Piece(of["first"], True), Piece(" − "), Piece(of["second"], True), Piece("|")]
    if "relation" in of:  # a formula is not broken behind its first letter
        return [Piece(of["letter"], True), Piece(of["relation"].replace(" ", "\N{NO-BREAK SPACE}"))]
    (text,) = of.values()
    return [Piece(_GREEK.get(text, text), True)]


def html(text: str, escaped: Callable[[str], object]) -> str:
    """HTML of ``text``, every piece of it ``escaped``."""
    written = []
    for piece in pieces(text):
        inner = str(escaped(piece.text))
        inner = f"<i>{inner}</i>" if piece.italic else inner
        tag = {-1: "sub", 1: "sup"}.get(piece.level)
        written.append(f"<{tag}>{inner}</{tag}>" if tag else inner)
    return "".join(written)


@lru_cache(maxsize=4096)
def _html(text: str) -> Markup:
    return Markup(html(text, escape))


def typeset(text: object) -> Markup:
    """HTML of ``text``, escaped; what is ``Markup`` already stays as it is."""
    return text if isinstance(text, Markup) else _html(str(text))


def drawn(text: str) -> Markup:
    """SVG of ``text`` for the inside of a text element, escaped."""
    written, level = [], 0
    for piece in pieces(text):
        inner = str(escape(piece.text))
        # An em is that of the piece itself.
        shift = (level - piece.level) * 0.3 / (SMALL if piece.level else 1.0)
        if piece.italic or piece.level or shift:
            style = ' class="it"' if piece.italic else ""
            style += f' font-size="{SMALL:.0%}"' if piece.level else ""
            style += f' dy="{shift:.2f}em"' if shift else ""
            inner = f"<tspan{style}>{inner}</tspan>"
        written.append(inner)
        level = piece.level
    return Markup("".join(written))


def unicode(text: str) -> str:
    """``text`` in plain Unicode, for names that a screen reader or a tooltip gives."""
    return "".join(
        piece.text.translate(_SUPERSCRIPT) if piece.level > 0 else "_" * -piece.level + piece.text
        for piece in pieces(text)
    )
