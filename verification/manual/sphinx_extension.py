"""Extension of Sphinx: formulas as MathML, docstrings as they are written here."""

import re
from textwrap import indent
from typing import Any

# Code between backticks, or a character that reStructuredText would read as markup.
MARKUP = re.compile(r"(``.+?``)|[\\*`|_]")
FIELD = re.compile(r"\w[\w,.*` ]{0,50} : ")
# How NumPy spells out ArrayLike.
LIKE = (
    "_Buffer | _SupportsArray[dtype[Any]] | _NestedSequence[_SupportsArray[dtype[Any]]] | complex | bytes "
    "| str | _NestedSequence[complex | bytes | str]"
)
ARRAY = re.compile(
    r"(?:numpy\.)?ndarray\[(?:tuple\[(?:typing\.)?Any, \.\.\.\]|[^\[\],]*), dtype\[(?:numpy\.)?\w+\]\]"
)


def setup(app: Any) -> dict[str, bool]:
    """Entry of the extension."""
    app.add_html_math_renderer("mathml", (_inline_formula, None), (_formula, None))
    app.connect("autodoc-process-docstring", _docstring)
    app.connect("autodoc-process-signature", _signature)
    app.connect("missing-reference", _missing)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def mathml(tex: str, block: bool = False) -> str:
    """MathML of a formula in TeX, which every present browser draws by itself. Raises ValueError."""
    from docutils.utils.math import latex2mathml

    return latex2mathml.tex2mathml(tex, as_block=block)


def _inline_formula(writer: Any, node: Any) -> None:
    from docutils.nodes import SkipNode

    writer.body.append(f'<span class="math">{mathml(node.astext())}</span>')
    raise SkipNode


def _formula(writer: Any, node: Any) -> None:
    from docutils.nodes import SkipNode

    number = f'<span class="eqno">({node["number"]})</span>' if node.get("number") else ""
    place = f' id="{node["ids"][0]}"' if node.get("ids") else ""
    writer.body.append(f'<div class="math"{place}>{mathml(node.astext(), block=True)}{number}</div>')
    raise SkipNode


def _docstring(app: Any, what: str, name: str, it: object, options: object, lines: list[str]) -> None:
    lines[:] = restructured("\n".join(lines)).splitlines()


def _missing(app: Any, env: Any, node: Any, content: Any) -> None:
    """Warn of a function, method or module that a page names and the code lacks."""
    from sphinx.util.logging import getLogger

    if node.get("refdomain") == "py" and node.get("reftype") in ("func", "meth", "mod"):
        getLogger(__name__).warning("no %s %r", node["reftype"], node["reftarget"], location=node)


def _signature(
    app: Any, what: str, name: str, it: object, options: object, given: str | None, returned: str | None
) -> tuple[str | None, ...]:
    """Arguments and result with NumPy's arrays as Array, which alone tells a reader something."""
    return tuple(text and ARRAY.sub("Array", text.replace(LIKE, "ArrayLike")) for text in (given, returned))


def restructured(text: str) -> str:
    """A docstring as reStructuredText: formulas as they are written, "name : meaning" as a list of fields."""
    parts = []
    for paragraph in re.split(r"\n *\n|\n(?=Returns|Raises)", text.strip("\n")):
        flat = MARKUP.sub(
            lambda found: found[0] if found[1] else "\\" + found[0], " ".join(paragraph.split())
        )
        if paragraph.startswith((" ", "...", ">>>")):
            parts.append(f"::\n\n{indent(paragraph, '    ')}")
        elif FIELD.match(paragraph):
            # each begins a line, or stands behind three spaces
            fields = re.sub(r"(?:^|\n|   +)(?=\w[\w,.*` ]{0,50} : )", "\0", paragraph).split("\0")[1:]
            parts += [_field(*one.partition(" : ")[::2]) for one in fields]
        else:
            parts.append(flat)
    return "\n\n".join(parts) + "\n"


def _field(name: str, meaning: str) -> str:
    said = MARKUP.sub(lambda found: found[0] if found[1] else "\\" + found[0], " ".join(meaning.split()))
    return f":{name.strip()}: {said}"
