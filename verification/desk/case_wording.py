"""A problem in words of the command line as the text of a case file.

ball "10 mm" or "10 mm, 210 GPa, 0.3" (radius; of an elastic ball E, nu), coating "3 um, 450 GPa, 0.22"
(thickness, E, nu), substrate "210 GPa, 0.3"; bare numbers are SI. Strengths and residual stress may follow:
"TiN 2 um, 450 GPa, 0.25, strength 2 GPa, residual -1.5 GPa". "d = 20 mm" is a diameter, and a name may
come first: "DLC 3 um, 450 GPa, 0.22", "M2 HSS 60 HRC 220 GPa, 0.3", "100Cr6 d = 6 mm, 210 GPa, 0.3". The
reader of case files checks the numbers: both have the same limits, units, messages. "300 GPa to 150 GPa" is
the modulus of a graded coating, from its surface down.
"""

import json
import re
from collections.abc import Callable, Sequence
from functools import partial
from itertools import permutations
from pathlib import Path

from verification.cases.materials import SHIPPED, meant, plain_name, read_materials
from verification.cases.toml_file import CaseError, is_number
from verification.cases.unit_numbers import NUMBER, in_si, is_of

_D, _R = r"d|D|dia\.?|diam\.?|diameter|Ø|ø|⌀", r"r|R|radius"
_VALUE = rf"{NUMBER}\s*(?:[^\W\d_]\S*)?"
_SIZE = rf"(?:(?:{_D}|{_R})\s*=?\s*)?{_VALUE}(?:\s+(?:{_D}|{_R}))?"
_SIZED = re.compile(rf"({_D}|{_R})?\s*=?\s*({_VALUE}?)(?:\s+({_D}|{_R}))?")
_NAMED = re.compile(rf"(.*?\S)[\s:]+({_SIZE})")
# A name does not begin with a number, but for that of a steel, 1.3505; nor does it hold a size.
_NO_NAME = re.compile(rf"(?!1\.\d{{4}}\b)[+-]?[\d.,]+(?:\s|$)|.*\b{NUMBER} ?(?:[numk]?m|µm|[kMGT]?Pa)\b")
_AFTER = re.compile(rf"({NUMBER} ?(?:[num]?m|µm))\s+(\S.*)")
_BETWEEN = re.compile(r"\s/\s|(?<=\dm)/|(?<=[ \d][nuµm]m)/|(?<=\.\d)/|(?<=\.\d\d)/")
_NUMERIC = re.compile(rf"(?:(?:{_D}|{_R})\s*=\s*)?{NUMBER}\s*(?:[numkµMGT]?(?:m|Pa))?(?!\w)")
_KEY = re.compile(r"(?:E|nu|h|t|thickness)\s*=\s*(?=[\d.])")
_REPEATED = re.compile(r"(\d{1,3})\s*[x*×]\s*\((.*)\)", re.DOTALL)
_GRADED = re.compile(rf"({NUMBER})\s*([^\W\d_]*)\s+to\s+({NUMBER})\s*([^\W\d_]*)")
SUBLAYERS = 16  # of a graded coating
_COMMA = re.compile(r"\d,\d")
# What may be stated of a layer behind its numbers, with the keys of a case file.
_KEYS = {
    "strength": "strength",
    "tensile strength": "strength",
    "residual": "residual_stress",
    "residual stress": "residual_stress",
    "yield": "yield_strength",
    "yield strength": "yield_strength",
    "adhesion": "adhesion",
    "hardness": "hardness",
    "expansion": "expansion",
    "alpha": "expansion",
}
_STATED = re.compile(
    rf"({'|'.join(sorted(_KEYS, key=len, reverse=True))})\s*[=:]?\s*([-+\d.].*)", re.IGNORECASE
)
STATED = '"strength 2 GPa", "residual -1.5 GPa", "yield 3 GPa", "adhesion 400 MPa"'
Solid = Callable[[str, str], tuple[str, list[str]]]
SOLID = "--ball with --radii or --roller"  # the solid alone
FORMS = {
    SOLID: ("E", "nu", "100Cr6 210 GPa, 0.3"),
    "--ball": ("radius", "E", "nu", "100Cr6 d = 6 mm, 210 GPa, 0.3"),
    "--coating": ("thickness", "E", "nu", "TiN 3 um, 450 GPa, 0.25"),
    "--ball-coating": ("thickness", "E", "nu", "TiN 3 um, 450 GPa, 0.25"),
    "--substrate": ("E", "nu", "100Cr6 210 GPa, 0.3"),
}


def case_text(
    ball: str | None,
    load: str | None,
    substrate: str,
    coatings: Sequence[str] = (),
    friction: float = 0.0,
    on_ball: Sequence[str] = (),
    approach: str | None = None,
    materials: Path = SHIPPED,
    temperature_change: float | None = None,
    radii: str | None = None,
    against: str | None = None,
    roller: str | None = None,
) -> str:
    """The case file of a problem in words; coatings from the surface of each body inwards.

    approach : in place of the load, which then is None.   materials : the file of those given by name alone.
    temperature_change : since deposition [K], which needs "expansion 9e-6" of coatings and bodies.
    radii, against : of curvature, along x and y, of either body; the ball then is a solid alone, or rigid.
    roller : "R = 5 mm, crown 2 m", which rolls along x, in place of the radii.
    Raises ValueError where the number of words is wrong, naming the option.
    """
    used: dict[str, str] = {}
    solid = partial(_solid, materials=materials, used=used)
    coated, elastic = ", ".join(_layers("--ball-coating", text, solid) for text in on_ball), ""
    sized = None
    named, size = _named(ball.strip()) if ball is not None else ("", "")
    if against is not None and radii is roller is None and re.fullmatch(_SIZE, size):
        ball, bend = named, _radius(f'--ball "{ball}"', *_size(size))
        radii = f"{bend}, {bend}"
    if radii is not None and roller is not None:
        raise ValueError(f'--roller "{roller}", --radii "{radii}": both are given; give one')
    if radii is not None or roller is not None:
        bends = [("radii", _bends("--radii", radii) if radii is not None else _crowned(str(roller)))]
        bends += [("against", _bends("--against", against))] if against is not None else []
        entries = ", ".join(f"{key} = [{', '.join(map(_toml, words))}]" for key, words in bends)
        sized = f'indenter = {{ shape = "ellipsoid", {entries} }}'
        if ball:
            called, (E, nu) = solid(SOLID, ball)
            elastic = f"ball = {{ {called}E = {_toml(E)}, nu = {_toml(nu)}, coatings = [{coated}] }}\n"
        elif on_ball:
            raise ValueError(f'--ball-coating "{on_ball[0]}": give the solid below it too, --ball "E, NU"')
    elif against is not None:
        raise ValueError(f'--against "{against}": give the radii of the other body too, --radii or --roller')
    elif ball is None:
        raise ValueError("give --ball, --radii or --roller")
    elif plain_name(ball) in read_materials(materials) or not re.search(r"\d", ball):
        raise ValueError(f'--ball "{ball}": give its size too, such as "100Cr6 d = 6 mm"')
    elif "," in ball or on_ball or named:
        called, (size, *words) = solid("--ball", ball)
        E, nu = map(_toml, words)
        elastic = f"ball = {{ {called}E = {E}, nu = {nu}, coatings = [{coated}] }}\n"
        sized = _sized(size)
    else:
        sized = _sized(ball)
    called, words = solid("--substrate", substrate)
    E, nu = map(_toml, words)
    on = ", ".join(_layers("--coating", text, solid) for text in coatings)
    pressed = "".join(
        f"{key} = {_toml(word)}\n" for key, word in (("load", load), ("approach", approach)) if word
    )
    pressed += "" if temperature_change is None else f"temperature_change = {temperature_change!r}\n"
    told = f"typical values: {'; '.join(used.values())}"[:500]
    source = f"source = {json.dumps(told, ensure_ascii=False)}\n" if used else ""
    return (
        f'title = "From the command line"\n{source}[problem]\n'
        f"{sized}\n{pressed}friction = {friction!r}\n"
        f"substrate = {{ {called}E = {E}, nu = {nu} }}\n{elastic}coatings = [{on}]\n"
    )


def _size(word: str) -> tuple[str, str]:
    """The key of a ball's size with its value: "d = 20 mm" is a diameter, "R = 10 mm" or "10 mm" a radius."""
    found = _SIZED.fullmatch(word.strip())
    if found is None:
        return "radius", word
    said = found[1] or found[3] or "r"
    return ("diameter" if re.fullmatch(_D, said) else "radius"), found[2]


def _sized(word: str) -> str:
    """The line of a case file that states a ball's size."""
    key, size = _size(word)
    return f"{key} = {_toml(size)}"


def _bends(option: str, text: str, needs: str = 'R_x, R_y, 2 parts, such as "3.8 mm, 183 mm"') -> list[str]:
    """Both radii of curvature of a body."""
    words = [word.strip() for word in text.split(",")]
    if len(words) != 2 or not all(words):
        comma = "; write decimals with a point, such as 0.3" if _COMMA.search(text) else ""
        raise ValueError(f'{option} "{text}": give {needs}{comma}')
    return words


def _crowned(text: str) -> list[str]:
    """Both radii of curvature of a roller, whose size may be a diameter: "d = 10 mm, crown 2 m"."""
    form = 'R, crown, 2 parts, such as "R = 5 mm, crown 2 m"; a cylinder without a crown is not solved'
    size, crown = _bends("--roller", text, form)
    if _named(size)[0] or re.match(r"[lL]\s*=|length", crown):
        raise ValueError(f'--roller "{text}": give {form}; its solid is --ball, such as --ball 100Cr6')
    return [_radius(f'--roller "{text}"', *_size(size)), re.sub(rf"^crown\s*(?:{_R})?\b\s*=?\s*", "", crown)]


def _radius(given: str, key: str, word: str) -> str:
    """The radius of a size, see ``_size``; ``given`` names it where it is no number with a unit."""
    return word if key == "radius" else repr(metres(given, word) / 2)


def metres(given: str, word: str) -> float:
    """A length in words, bare in metres. Raises CaseError, which begins with what was ``given``."""
    try:
        return float(word) if is_number(word) else in_si(word, "m")
    except ValueError as error:
        raise CaseError(f"{given}: {error}, not {word!r}") from None


def _named(word: str) -> tuple[str, str]:
    """A name beside a number, "DLC 2 um" or "2 um DLC", with that number; "" where there is none."""
    if re.fullmatch(_SIZE, word):
        return "", word
    if (found := _AFTER.fullmatch(word)) and not _NO_NAME.match(found[2]):
        return found[2], found[1]
    found = _NAMED.fullmatch(word)
    name = found[1].rstrip(" :") if found else ""
    return (name, found[2]) if found and not _NO_NAME.match(name) else ("", word)


def _layers(option: str, text: str, solid: Solid) -> str:
    """A coating, or several that repeat: "10 x (TiN 100 nm, 450 GPa, 0.25 / CrN 100 nm, 250 GPa, 0.22)"."""
    found = _REPEATED.fullmatch(text.strip())
    if found is None:
        return _coating(option, text, solid)
    parts = _BETWEEN.split(found[2])
    try:
        stack = ", ".join(_coating(option, part, solid) for part in parts)
    except ValueError as error:
        between = "" if len(parts) > 1 else '; layers of a stack are separated by " / "'
        raise ValueError(f"{error}{between}") from None
    return f"{{ repeat = {found[1]}, stack = [{stack}] }}"


def _coating(option: str, text: str, solid: Solid) -> str:
    called, words = solid(option, text)
    orders = [order for order in permutations(words) if _fits(*order)]
    if orders and not _fits(*words):
        right = max(orders, key=lambda order: float(order[2]))
        raise ValueError(f'{option} "{text}": the order is thickness, E, nu, "{", ".join(right)}"')
    graded = _GRADED.fullmatch(words[1])
    thickness, E, nu = map(_toml, words)
    if graded:
        ends = (
            _toml(f"{number} {unit or graded[4]}")
            for number, unit in (graded.groups()[:2], graded.groups()[2:])
        )
        E = '{{ course = "linear", top = {}, base = {} }}, layers = {}'.format(*ends, SUBLAYERS)
    return f"{{ {called}thickness = {thickness}, E = {E}, nu = {nu} }}"


def _fits(thickness: str, E: str, nu: str) -> bool:
    """Whether words can be a thickness, a modulus and a Poisson's ratio, in this order."""
    h, modulus = (float(word) if is_number(word) else word for word in (thickness, E))
    elastic = bool(_GRADED.fullmatch(E)) or is_of("Pa", modulus)
    return is_of("m", h) and elastic and is_number(nu) and -1 < float(nu) <= 0.5


def _solid(option: str, text: str, materials: Path, used: dict[str, str]) -> tuple[str, list[str]]:
    """The entry of a name, "" without, and the words between the commas, E and nu of a known name among them.

    used : what was taken from the file of ``materials``, in words.
    """
    *names, example = FORMS[option]
    every = [_KEY.sub("", word.strip()) for word in text.split(",")]
    more = [found for word in every[1:] if (found := _STATED.fullmatch(word))]
    words = [word for word in every if not _STATED.fullmatch(word)] or every
    stated = "".join(f"{_KEYS[found[1].casefold()]} = {_toml(found[2])}, " for found in more)
    name, words[0] = _named(words[0])
    if not name and len(words) in (len(names) + 1, 2):
        i = next((i for i, word in enumerate(words) if not _NUMERIC.match(word)), -1)
        name = words.pop(i).rstrip(":") if i in range(len(names) - 1) else ""
    unknown = ""
    if len(words) == 1 and (name or len(names) == 2):
        name = f"{name} {words.pop()}".strip() if len(names) == 2 else name
        known = read_materials(materials)
        if (material := known.get(plain_name(name))) is None:
            unknown = f"; {name!r} is not among those of coatcheck materials{meant(name, known)}"
        else:
            used[name] = material.told
            words += [repr(float(material.E)), repr(material.nu)]
    if len(words) != len(names):
        form = f'give {", ".join(names)}, {len(names)} parts, such as "{example}"'
        comma = "; write decimals with a point, such as 0.3" if _COMMA.search(text) else ""
        named = "" if comma or len(words) < 4 else f"; name what else is stated, such as {STATED}"
        raise ValueError(f'{option} "{text}": {form}{comma}{named}{unknown}')
    called = f"name = {json.dumps(name, ensure_ascii=False)}, " if name else ""
    return called + stated, words


def _toml(word: str) -> str:
    """A number as it is, any other word as text."""
    try:
        value = float(word)
    except ValueError:
        return json.dumps(word.strip())
    return repr(value)  # inf and nan are TOML too
