"""Extension of Sphinx: formulas as MathML, docstrings as they are written here."""

import re
from typing import Any

# A list of parameters: ``name, name : what it is [unit].   other : what``
NAME = r"\*{0,2}\w+(?: \[[^\]]*\])?"
PARAMETER = re.compile(rf"^({NAME}(?:, {NAME})*) : ")
PARAMETERS = re.compile(rf" {{2,}}(?={NAME}(?:, {NAME})*(?: : | \[))")
ARRAY = re.compile(
    r"(?:numpy\.)?ndarray\[(?:tuple\[(?:typing\.)?Any, \.\.\.\]|[^\[\],]*), dtype\[(?:numpy\.)?\w+\]\]"
)
LITERAL = re.compile(r"(``.+?``|`[^`]+?`)")
SPECIAL = re.compile(r"([\\*`|_])")


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
) -> tuple[str | None, str | None]:
    """Arguments and result with NumPy's arrays as Array, which alone tells a reader something."""
    return given and ARRAY.sub("Array", given), returned and ARRAY.sub("Array", returned)


def restructured(text: str) -> str:
    """A docstring in plain text as reStructuredText.

    Indented blocks are formulas, kept as they are; lists of parameters become lists.
    """
    parts: list[str] = []
    for block in re.split(r"\n\s*\n", text.strip("\n")):
        lines = [line for line in block.splitlines() if line.strip()]
        if not lines:
            continue
        if all(line.startswith("  ") for line in lines):
            parts.append("::\n\n" + "\n".join(f"    {line}" for line in lines))
            continue
        paragraph: list[str] = []
        for line in lines:
            indented = line.startswith("    ") and not _lists(paragraph)
            if indented:
                parts += _flowing(paragraph)
                paragraph = []
                parts.append("::\n\n    " + line)
            else:
                paragraph.append(line)
        parts += _flowing(paragraph)
    return "\n\n".join(parts)


def _lists(lines: list[str]) -> bool:
    """Whether the lines hold a parameter, whose description may go on indented."""
    return any(PARAMETER.match(line) for line in lines)


def _flowing(lines: list[str]) -> list[str]:
    """Paragraphs of running text, lists of parameters."""
    if not lines:
        return []
    items: list[list[str]] = [[]]
    for line in lines:
        for i, piece in enumerate(PARAMETERS.split(line.strip())):
            if PARAMETER.match(piece) or i:
                items.append([])
            items[-1].append(piece)
    text = [" ".join(item) for item in items]
    found = [_escaped(text[0])] if text[0] else []
    listed = []
    for item in text[1:]:
        name, _, what = item.partition(" : ")
        # A sentence on what is raised ends a list without being part of it.
        what, raises, rest = what.partition(" Raises ")
        listed.append(f"- **{_escaped(name)}** : {_escaped(what)}")
        if raises:
            listed.append("\nRaises " + _escaped(rest) + "\n")
    return [*found, "\n".join(listed)] if listed else found


def _escaped(text: str) -> str:
    """Text with what reStructuredText would read as markup escaped, names in backticks as code."""
    parts = LITERAL.split(text)
    for i, part in enumerate(parts):
        parts[i] = f"``{part.strip('`')}``" if i % 2 else SPECIAL.sub(r"\\\1", part)
    return "".join(parts)
