"""A problem in words of the command line as the text of a case file.

ball "10 mm" or "10 mm, 210 GPa, 0.3" (radius; of an elastic ball E, nu), coating "3 um, 450 GPa, 0.22"
(thickness, E, nu), substrate "210 GPa, 0.3"; bare numbers are SI. "d = 20 mm" is a diameter, and a name may
come before the first number of a solid: "DLC 3 um, 450 GPa, 0.22", "100Cr6 210 GPa, 0.3". The reader of case
files checks them: both have the same limits, units, messages.
"""

import json
import re
from collections.abc import Sequence

_SIZE = re.compile(r"(d|D|diameter|r|R|radius)\s*=?\s*([\d.+-].*)")
# words with a letter in each, before a number: DLC, 100Cr6, a-C:H, tool steel
_NAMED = re.compile(r"\s*((?:(?=[\w.:/-]*[^\W\d_])[\w.:/-]+\s+)+)(?=[\d.+-])")
_COMMA = re.compile(r"\d,\d")


def case_text(
    ball: str,
    load: str,
    substrate: str,
    coatings: Sequence[str] = (),
    friction: float = 0.0,
    on_ball: Sequence[str] = (),
) -> str:
    """The case file of a problem in words; coatings from the surface of each body inwards.

    Raises ValueError where the number of words is wrong, naming the option.
    """
    words, coated = ball.split(","), ", ".join(_coating("--ball-coating", text) for text in on_ball)
    elastic = ""
    if len(words) > 1 or on_ball:
        _, E, nu = _parts("--ball", ball, ("radius", "E", "nu"))
        elastic = f"ball = {{ E = {E}, nu = {nu}, coatings = [{coated}] }}\n"
    key, size = _size(words[0])
    called, solid = _named(substrate)
    E, nu = _parts("--substrate", solid, ("E", "nu"))
    on = ", ".join(_coating("--coating", text) for text in coatings)
    return (
        'title = "From the command line"\n[problem]\n'
        f"{key} = {_toml(size)}\nload = {_toml(load)}\nfriction = {friction!r}\n"
        f"substrate = {{ {called}E = {E}, nu = {nu} }}\n{elastic}coatings = [{on}]\n"
    )


def _size(word: str) -> tuple[str, str]:
    """The key of a ball's size with its value: "d = 20 mm" is a diameter, "R = 10 mm" or "10 mm" a radius."""
    found = _SIZE.fullmatch(word.strip())
    if found is None:
        return "radius", word
    return ("diameter" if found[1].lower().startswith("d") else "radius"), found[2]


def _named(text: str) -> tuple[str, str]:
    """The entry of a name that comes before the first number, with the text behind it."""
    found = _NAMED.match(text)
    return (f"name = {json.dumps(found[1].strip())}, ", text[found.end() :]) if found else ("", text)


def _coating(option: str, text: str) -> str:
    called, solid = _named(text)
    thickness, E, nu = _parts(option, solid, ("thickness", "E", "nu"))
    return f"{{ {called}thickness = {thickness}, E = {E}, nu = {nu} }}"


def _parts(option: str, text: str, names: tuple[str, ...]) -> list[str]:
    """The parts of ``text`` between commas as TOML values."""
    words = text.split(",")
    if len(words) != len(names):
        comma = "; write decimals with a point, such as 0.3" if _COMMA.search(text) else ""
        raise ValueError(f'{option} "{text}": give {", ".join(names)}, {len(names)} parts{comma}')
    return [_toml(word) for word in words]


def _toml(word: str) -> str:
    """A number as it is, any other word as text."""
    try:
        value = float(word)
    except ValueError:
        return json.dumps(word.strip())
    return repr(value)  # inf and nan are TOML too
