"""How the report calls and draws each source, quantity and outcome."""

from dataclasses import dataclass

from verification.judging.verdict import Outcome

__all__ = [
    "EXACT",
    "METHODS",
    "OUTCOMES",
    "OutcomeStyle",
    "Style",
    "pair_label",
    "pair_style",
    "source_label",
    "source_style",
]

METHODS = ("semianalytic", "fem_reference")
EXACT = ("integral_equation", "hertz", "hamilton")

_LABELS = {
    "semianalytic": "semi-analytical",
    "fem_reference": "finite elements",
    "integral_equation": "integral equation",
    "hertz": "Hertz",
    "hamilton": "Hamilton",
    "case": "the case",
}


@dataclass(frozen=True)
class Style:
    """A line in a figure: ``colour`` names a role of the style sheet, never a value.

    dash : on, off lengths in line widths; () is a full line, so that colour is never the only difference.
    """

    colour: str
    dash: tuple[float, ...] = ()
    width: float = 1.6
    opacity: float = 1.0


# The exact curve lies below as a broad grey road on which the methods have to drive.
_STYLES = {
    "semianalytic": Style("semi"),
    "fem_reference": Style("fem", (3.6, 3.0), 1.9),
    "integral_equation": Style("exact", (), 5.0, 0.35),
    "hertz": Style("hertz", (1.0, 1.4), 1.8),
    "hamilton": Style("hertz", (1.0, 1.4), 1.8),
}
_OTHER = Style("other", (5.0, 1.5, 1.0, 1.5))
_BETWEEN_METHODS = Style("pair", (4.5, 1.4, 1.0, 1.4), 1.4)
_BETWEEN_REFERENCES = Style("ink", (1.0, 1.4), 1.4)


@dataclass(frozen=True)
class OutcomeStyle:
    """How a verdict is shown without relying on colour: a letter, a mark, a word."""

    letter: str
    mark: str
    word: str
    css: str
    rank: int


OUTCOMES = {
    Outcome.DISAGREES: OutcomeStyle("D", "✗", "disagrees", "disagrees", 0),
    Outcome.NO_RESULT: OutcomeStyle("N", "∅", "no result", "no-result", 1),
    Outcome.INCONCLUSIVE: OutcomeStyle("I", "?", "inconclusive", "inconclusive", 2),
    Outcome.AGREES: OutcomeStyle("A", "✓", "agrees", "agrees", 3),
}


def source_label(source: str) -> str:
    """The name of a source in running text; an unknown one keeps its own."""
    return _LABELS.get(source, source)


def source_style(source: str) -> Style:
    """The line a source is drawn with in every figure."""
    return _STYLES.get(source, _OTHER)


def pair_label(pair: tuple[str, str]) -> str:
    """Two sources held against each other, as column heads and legends say it."""
    return " – ".join(source_label(source) for source in pair)


def pair_style(pair: tuple[str, str]) -> Style:
    """The line of a difference: a method's error has the method's own colour and dash."""
    methods = [source for source in pair if source in METHODS]
    if len(methods) == 1:
        style = source_style(methods[0])
        return Style(style.colour, style.dash, 1.4)
    return _BETWEEN_METHODS if methods else _BETWEEN_REFERENCES
