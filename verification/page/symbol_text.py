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
    "phi": "φ",
}


def _letter(symbol: str) -> list[Piece]:
    return [Piece(_GREEK.get(symbol, symbol), True)]


def _indexed(symbol: str, index: str, italic: bool = False) -> list[Piece]:
    return [*_letter(symbol), Piece(index, italic, -1)]


def _component(symbol: str, index: str) -> list[Piece]:
    return _indexed(symbol, index, italic=True)


def _power_of_ten(mantissa: str, exponent: str) -> list[Piece]:
    exponent = str(int(exponent.replace("−", "-"))).replace("-", "−")
    mantissa = mantissa.replace("-", "−")
    if exponent == "0":
        return [Piece(mantissa)]
    times = mantissa[:-1] if mantissa in ("1", "+1", "−1") else f"{mantissa}·"
    return [Piece(f"{times}10"), Piece(exponent, level=1)]


def _modulus(index: str | None) -> list[Piece]:
    return [Piece("E", True), *([Piece(index, level=-1)] if index else []), Piece("*", level=1)]


def _related(letter: str, relation: str) -> list[Piece]:
    # a formula is not broken behind its first letter
    return [Piece(letter, True), Piece(relation.replace(" ", "\N{NO-BREAK SPACE}"))]


# What is typeset, each with what makes pieces of its groups; the first that fits counts.
_RULES: tuple[tuple[str, Callable[..., list[Piece]]], ...] = (
    (r"(?<![\w.])([+−-]?\d+(?:\.\d+)?)e([+−-]?\d+)(?!\w)", _power_of_ten),
    (r"(?<!\w)(sigma|eps)_([xyzk]{2})(?!\w)", _component),
    (r"(?<!\w)([uR])_([xyz])(?!\w)", _component),
    (r"(?<!\w)(a|p|S|delta)_h(?!\w)", lambda symbol: _indexed(symbol, "H")),
    (r"(?<!\w)tau_max(?!\w)", lambda: _indexed("tau", "max")),
    (r"(?<!\w)von_mises_max(?!\w)", lambda: _indexed("sigma", "vM")),
    (r"(?<!\w)dW/d ?delta(?!\w)", lambda: [Piece("d"), *_letter("W"), Piece("/d"), *_letter("delta")]),
    (r"(?<!\w)E_?([12s]|ball)?\*(?!\w)", _modulus),
    (r"(?<!\w)(E|nu|h)_?([12s])(?!\w)", _indexed),
    (r"(?<!\w)(p)_?(0)(?!\w)", _indexed),
    (r"(?<!\w)(U)_([A-Z])(?!\w)", _component),
    (r"(?<!\w)(u)_(val|num|input|D|random|common)(?!\w)", _indexed),
    (r"(?<!\w)(delta|nu|kappa|sigma|eps|phi)(?!\w)", _letter),
    (r"(?<!\w)([hfpERUWxyzsaqN])( (?:=|/|<|>|−|≤) )", _related),
    (r"(?<!\w)(x)(?= of max )", _letter),
    (r"^([aEhfpRWxz])(?= \[|$)", _letter),
    (r"(?:(?<=radius )|(?<=load )|(?<=leaves )|(?<=friction )|(?<=pressure ))([RaWfqp])(?!\w)", _letter),
    (r"(?<=over )([RWfqp]|a(?! [a-z]))(?!\w)", _letter),  # not "over a part"
    (r"(?<=q = )(f p)(?!\w)", _letter),
    (r"(?<!\w)(U)(?![\w.])", _letter),
    (r"(?<=\d )(a)(?=[ .,;)]|$)(?! \w)", _letter),
    (r"(?<=/ )([aW])(?!\w)", _letter),
    (r"\|([AB]) − ([AB])\|", lambda a, b: [Piece("|"), *_letter(a), Piece(" − "), *_letter(b), Piece("|")]),
)
_PATTERN = re.compile("|".join(pattern for pattern, _ in _RULES))
SMALL = 0.78  # size of an index over that of the line
_SUPERSCRIPT = str.maketrans("0123456789-−+", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁻⁺")


def pieces(text: str) -> list[Piece]:
    """``text`` with its symbols taken apart; everything else as it is."""
    found, at = [], 0
    for match in _PATTERN.finditer(text):
        if match.start() > at:
            found.append(Piece(text[at : match.start()]))
        for pattern, make in _RULES:
            if groups := re.compile(pattern).match(text, match.start()):
                found += make(*groups.groups())
                break
        at = match.end()
    return [*found, Piece(text[at:])] if at < len(text) else found


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


@lru_cache(maxsize=8192)
def unicode(text: str) -> str:
    """``text`` in plain Unicode, for names that a screen reader or a tooltip gives."""
    return "".join(
        piece.text.translate(_SUPERSCRIPT) if piece.level > 0 else "_" * -piece.level + piece.text
        for piece in pieces(text)
    )
