"""One problem answered for a designer in Python: sentence, verdict, table and the figure of a notebook."""

import tempfile
from base64 import b64encode
from dataclasses import dataclass
from html import escape
from pathlib import Path

from verification.cases.case_file import Case
from verification.desk.contact_answer import ContactAnswer, answer, summary
from verification.desk.layer_limits import LayerMode, modes_of, place_name, verdict
from verification.desk.stack_text import conditions, stack, units_of
from verification.sources.source_registry import METHODS


@dataclass(frozen=True)
class DesignAnswer:
    """The ``found`` stresses of a ``case``, in SI, with the ``modes`` by which it may fail.

    Printed it is the sentence and the verdict; a notebook shows table and figure too.
    """

    case: Case
    found: ContactAnswer
    modes: tuple[LayerMode, ...]

    @property
    def verdict(self) -> str:
        """Verdict in words: what fails, or what is nearest to it; "" where the case states no strength."""
        return verdict(self.case, self.modes)

    def __str__(self) -> str:
        said = summary(self.case.problem, self.found, self.case.names)
        head = f"{stack(self.case)}\n{conditions(self.case.problem)}"
        return "\n".join(filter(None, (head, said, self.verdict)))

    def rows(self) -> list[tuple[str, str, str, str]]:
        """Every largest stress as quantity, place, value and uncertainty with its unit."""
        units = units_of(self.case.problem)
        return [
            (
                at.quantity,
                place_name(self.case, at),
                units.shown_stress(at.value),
                units.shown_stress(at.uncertainty),
            )
            for at in self.found.extremes
        ]

    def _repr_html_(self) -> str:
        """Sentence, table and figure for a notebook."""
        from verification.desk.answer_figure import write

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "answer.png"
            write(self.case, self.found, path)
            image = b64encode(path.read_bytes()).decode()
        said = "".join(f"<p>{escape(line)}</p>" for line in str(self).splitlines())
        heads = "".join(f"<th>{head}</th>" for head in ("largest", "place", "value", "±"))
        cells = "".join(
            "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in self.rows()
        )
        table = f"<table><tr>{heads}</tr>{cells}</table>"
        return f'{said}{table}<img alt="stresses" width="640" src="data:image/png;base64,{image}">'


def design_answer(case: Case) -> DesignAnswer:
    """The answer of ``coatcheck solve`` to a ``case``. Raises what the semi-analytical method raises."""
    numerics = case.numerics.get(METHODS[0])
    found = answer(case.problem, METHODS[0], numerics, case.residual, case.layers)
    return DesignAnswer(case, found, modes_of(case, found))
