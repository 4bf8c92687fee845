"""Turn matplotlib's SVG into a compact inline one whose colours follow the page."""

import re
from collections.abc import Mapping
from xml.etree import ElementTree

from markupsafe import Markup, escape

__all__ = ["compact"]

_PAIR = re.compile(r"([ML])\s+(\S+)\s+(\S+)")
_KEPT = {
    "stroke",
    "fill",
    "stroke-width",
    "stroke-dasharray",
    "stroke-opacity",
    "fill-opacity",
    "opacity",
    "text-anchor",
}
_EMPTY = {"g", "defs"}


def compact(svg: str, *, key: str, colours: Mapping[str, str], label: str) -> Markup:
    """Rewrite ``svg`` as one short element for use inside a page.

    Identifiers start with ``key`` so that figures on one page never clash, every colour of ``colours``
    (hex -> name) becomes the style sheet's variable of that name, polylines are written in tenths of a
    unit relative to the point before, and metadata with its foreign addresses is dropped.

    label : what a screen reader says.   Returns markup that may stand in HTML as it is.
    """
    root = ElementTree.fromstring(svg)
    used = {name for node in root.iter() for name in _references(node)}
    names = {name: f"{key}-{number}" for number, name in enumerate(sorted(used))}
    inner = "".join(_write(child, names, colours) for child in root)
    box = root.get("viewBox", "0 0 100 100")
    return Markup(
        f'<svg class="figure" viewBox="{escape(box)}" role="img" aria-label="{escape(label)}">{inner}</svg>'
    )


def _references(node: ElementTree.Element) -> list[str]:
    found = [value[1:] for name, value in node.attrib.items() if name.endswith("href")]
    clip = node.get("clip-path", "")
    return found + ([clip[5:-1]] if clip.startswith("url(#") else [])


def _write(node: ElementTree.Element, names: Mapping[str, str], colours: Mapping[str, str]) -> str:
    tag = node.tag.rpartition("}")[2]
    if tag in ("metadata", "style", "title"):
        return ""
    inner = "".join(_write(child, names, colours) for child in node)
    attributes = _attributes(node, names, colours)
    if tag in _EMPTY and not inner:
        return ""
    if tag == "path" and attributes.get("fill") == "none" and not {"class", "stroke"} & set(attributes):
        return ""
    if tag == "g" and not attributes:
        return inner
    text = str(escape(node.text)) if tag == "text" and node.text else ""
    body = "".join(f' {name}="{escape(value)}"' for name, value in attributes.items())
    return f"<{tag}{body}>{text}{inner}</{tag}>" if inner or text else f"<{tag}{body}/>"


def _attributes(
    node: ElementTree.Element, names: Mapping[str, str], colours: Mapping[str, str]
) -> dict[str, str]:
    written: dict[str, str] = {}
    for name, value in node.attrib.items():
        if name == "id":
            if value in names:
                written["id"] = names[value]
        elif name.endswith("href"):
            written["href"] = f"#{names[value[1:]]}"
        elif name == "clip-path" and "-grid" in _style(node.get("style", ""), colours).get("class", ""):
            continue  # grid lines end at the frame as they are
        elif name == "clip-path":
            written["clip-path"] = f"url(#{names[value[5:-1]]})"
        elif name == "d":
            written["d"] = _relative(value)
        elif name == "style":
            written.update(_style(value, colours))
        elif name in ("x", "y", "width", "height"):
            written[name] = f"{float(value):.1f}"
        elif name == "transform" and not value.startswith("rotate(-0"):
            written[name] = value
    return written


def _style(style: str, colours: Mapping[str, str]) -> dict[str, str]:
    pairs = dict(part.split(":", 1) for part in style.split(";") if ":" in part)
    kept = {name.strip(): value.strip() for name, value in pairs.items() if name.strip() in _KEPT}
    for name in ("stroke", "fill"):
        if kept.get(name, "").lower() in colours:
            # A presentation attribute cannot hold var(): the class does.
            kept["class"] = " ".join(
                filter(None, [kept.get("class"), f"{name[0]}-{colours[kept.pop(name).lower()]}"])
            )
    return kept


def _relative(path: str) -> str:
    if path.count("z") > 1 or set(path) & set("CQ"):
        # Markers and broken polygons are few; they stay as they are.
        return " ".join(path.split())
    written = []
    x = y = 0
    for command, px, py in _straightened(_PAIR.findall(path)):
        nx, ny = round(10 * float(px)), round(10 * float(py))
        if command == "M":
            written.append(f"M{_tenths(nx)} {_tenths(ny)}")
        else:
            dx, dy = _tenths(nx - x), _tenths(ny - y)
            start = "l" if written[-1][0] == "M" else "" if dx[0] == "-" else " "
            written.append(f"{start}{dx}{'' if dy[0] == '-' else ' '}{dy}")
        x, y = nx, ny
    return "".join(written) + ("z" if path.rstrip().endswith("z") else "")


def _straightened(points: list[tuple[str, str, str]]) -> list[tuple[str, str, str]]:
    """``points`` without those in the middle of a level or upright stretch that keeps its direction."""
    kept: list[tuple[str, str, str]] = []
    for point in points:
        while (
            len(kept) > 1 and point[0] == "L" and kept[-1][0] == "L" and _needless(kept[-2], kept[-1], point)
        ):
            kept.pop()
        kept.append(point)
    return kept


def _needless(
    before: tuple[str, str, str], middle: tuple[str, str, str], after: tuple[str, str, str]
) -> bool:
    for along, across in ((1, 2), (2, 1)):
        a, b, c = (round(10 * float(p[along])) for p in (before, middle, after))
        if len({round(10 * float(p[across])) for p in (before, middle, after)}) == 1:
            return a <= b <= c or a >= b >= c
    return False


def _tenths(value: int) -> str:
    """0.1 times ``value`` in as few characters as a path needs."""
    whole, tenth = divmod(abs(value), 10)
    sign = "-" if value < 0 else ""
    if not tenth:
        return f"{sign}{whole}"
    return f"{sign}{whole or ''}.{tenth}"
