"""Labels, line styles, marks of sources, pairs of sources, outcomes."""

from dataclasses import dataclass

from verification.judging.verdict import Outcome
from verification.problem.quantity import QUANTITIES
from verification.sources.source_record import Style
from verification.sources.source_registry import METHODS, SOURCES

_OTHER = SOURCES["published"].style
_BETWEEN_METHODS = Style("pair", (4.5, 1.4, 1.0, 1.4), 1.4)
_BETWEEN_REFERENCES = Style("ink", (1.0, 1.4), 1.4)


@dataclass(frozen=True)
class OutcomeStyle:
    """How a verdict is shown without relying on colour: a mark, a word."""

    mark: str
    word: str
    css: str
    rank: int


OUTCOMES = {
    Outcome.DISAGREES: OutcomeStyle("✗", "disagrees", "disagrees", 0),
    Outcome.NO_RESULT: OutcomeStyle("∅", "no result", "no-result", 1),
    Outcome.INCONCLUSIVE: OutcomeStyle("?", "inconclusive", "inconclusive", 2),
    Outcome.AGREES: OutcomeStyle("✓", "agrees", "agrees", 3),
    Outcome.UNSUPPORTED: OutcomeStyle("–", "unsupported", "unsupported", 4),
}


def row_css(outcome: Outcome) -> str:
    """Class of the row of a verdict: none where it agrees."""
    return "" if outcome in (Outcome.AGREES, Outcome.UNSUPPORTED) else OUTCOMES[outcome].css


def symbol_of(quantity: str) -> str:
    """The symbol of a quantity; an unknown one keeps its name."""
    return QUANTITIES[quantity].symbol if quantity in QUANTITIES else quantity


def source_label(source: str) -> str:
    """The name of a source in running text; an unknown one keeps its own."""
    return SOURCES[source].label if source in SOURCES else {"case": "the case"}.get(source, source)


def source_style(source: str) -> Style:
    """The line a source is drawn with in every figure."""
    return SOURCES[source].style if source in SOURCES else _OTHER


def pair_label(pair: tuple[str, str]) -> str:
    """Two compared sources, for column heads and legends."""
    return " – ".join(source_label(source) for source in pair)


def pair_style(pair: tuple[str, str]) -> Style:
    """The line of a difference: a method's error has the method's own colour and dash."""
    methods = [source for source in pair if source in METHODS]
    if len(methods) == 1:
        style = source_style(methods[0])
        return Style(style.colour, style.dash, 1.4)
    return _BETWEEN_METHODS if methods else _BETWEEN_REFERENCES
