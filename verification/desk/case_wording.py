"""A problem in words of the command line as the text of a case file.

ball "10 mm" or "10 mm, 210 GPa, 0.3" (radius; of an elastic ball E, nu), coating "3 um, 450 GPa, 0.22"
(thickness, E, nu), substrate "210 GPa, 0.3"; bare numbers are SI. The reader of case files checks them:
both have the same limits, units, messages.
"""

import json
from collections.abc import Sequence

__all__ = ["case_text"]


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
    words = ball.split(",")
    radius, elastic = _toml(words[0]), ""
    if len(words) > 1 or on_ball:
        _, E, nu = _parts("--ball", ball, ("radius", "E", "nu"))
        on = ", ".join(_coating("--ball-coating", text) for text in on_ball)
        elastic = f"ball = {{ E = {E}, nu = {nu}, coatings = [{on}] }}\n"
    E, nu = _parts("--substrate", substrate, ("E", "nu"))
    on = ", ".join(_coating("--coating", text) for text in coatings)
    return (
        'title = "From the command line"\n[problem]\n'
        f"radius = {radius}\nload = {_toml(load)}\nfriction = {friction!r}\n"
        f"substrate = {{ E = {E}, nu = {nu} }}\n{elastic}coatings = [{on}]\n"
    )


def _coating(option: str, text: str) -> str:
    thickness, E, nu = _parts(option, text, ("thickness", "E", "nu"))
    return f"{{ thickness = {thickness}, E = {E}, nu = {nu} }}"


def _parts(option: str, text: str, names: tuple[str, ...]) -> list[str]:
    """The parts of ``text`` between commas as TOML values."""
    words = text.split(",")
    if len(words) != len(names):
        raise ValueError(f'{option} "{text}": give {", ".join(names)}, {len(names)} parts')
    return [_toml(word) for word in words]


def _toml(word: str) -> str:
    """A number as it is, any other word as text."""
    try:
        value = float(word)
    except ValueError:
        return json.dumps(word.strip())
    return repr(value)  # inf and nan are TOML too
