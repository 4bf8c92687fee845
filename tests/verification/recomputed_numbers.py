"""Numbers that a report displays, computed again from its report.json: python FILE FOLDER.

Each number of a row of a table has to be one that its record holds or gives, rounded to the digits displayed
and in their order; each number of a text, one of those of its page. The standard library is enough.
"""

import json
import re
import sys
from html import unescape
from itertools import chain, repeat
from pathlib import Path

from recomputed_pages import case_page, first_page, run_pages
from recomputed_values import Record, compared, group

NUMBER = re.compile(
    r"(?<![\w.])([-+]?)(\d+\.?\d*)(?:e([-+]?\d+))?(?:\((\d+)\))?(?![\w(])"
    r"(?:\s?(%|([fpnµmkMGT]?)(?:Pa|N/m|[NmsB])(?!\w)))?"
)
PREFIX = {name: 1e3**k for k, name in enumerate("fpnµm-kMGT", -5)}
BLOCK = r"<(?:p|li|div|dt|dd|h\d|figcaption|summary|pre|span|figure|section|small|nav|dl)\b[^>]*>"
# What is read as a table of one row, by the name of that table: what its head and its cell look like.
SINGLE = {
    "figure": r'<figcaption>(?P<cell>[^\n]*)</figcaption>\s*<svg[^>]* (?P<head>data-q.*? data-line="[^"]*")',
    "fact": "<div><dt>(?P<head>.*?)</dt><dd>(?P<cell>.*?)</dd></div>",
    "file": "(?P<head>)<pre[^>]*>(?P<cell>.*?)</pre>",
}


def differing(folder):
    """Messages on numbers of report.html that do not follow from report.json."""
    page, data = ((folder / f"report.{kind}").read_text(encoding="utf-8") for kind in ("html", "json"))
    data = json.loads(data, object_hook=Record)
    cases = {f"case-{case.name.replace('_', '-')}": case for case in data.cases}
    yield from by_script(page, cases)
    whole = rules_of([*first_page(data), *run_pages(data)])
    for name, body in pages(page):
        rules = rules_of(case_page(data, cases[name])) if name in cases else whole
        texts = {*flat(rules.get(cases[name].name if name in cases else name, ()))}
        for key, rows in tables(body):
            found = rules.get(key, [repeat(texts)])
            pool = found.pop(0) if found[1:] else found[0]
            rest = iter(pool)
            for row in rows:
                head = plain(row[0])
                numbers_of_row = pool.get(head, ()) if isinstance(pool, dict) else next(rest, ())
                yield from missing(f"{name}, {key}, {head}", " | ".join(row), numbers_of_row)
        for block in re.split(BLOCK, re.sub(r"<table.*?</table>", "", body, flags=re.DOTALL)):
            yield from missing(name, block, texts)


def by_script(page, cases):
    """Messages on the numbers from which the script of the page writes its tables of comparisons."""
    found = re.search(r'<template id="data">(.*?)</template>', page, re.DOTALL)[1]
    for name, rows in ((name, of["rows"]) for name, of in json.loads(unescape(found))["cases"].items()):
        expected = sorted([one.cap, one.uncertainty, one.difference] for one in compared(cases[name]))
        for (*_, difference, U, cap, _), numbers_of_row in zip(rows, expected, strict=True):
            yield from missing(f"{name}, script", f"{cap:.2e} {U:.2e} {difference:.2e}", numbers_of_row)


def rules_of(pairs):
    """Tables of each name, the last of which serves for all that follow."""
    return {name: [rows for _, rows in of] for name, of in group(pairs, lambda pair: pair[0]).items()}


def pages(page):
    """Name and content of each page without its drawings; the caption of a figure becomes a row."""
    page = re.sub(r"<(style|script|template)\b.*?</\1>", "", page, flags=re.DOTALL)
    for key, like in SINGLE.items():
        row = rf"<table><th>{key}</th><tbody><tr><th>\g<head></th><td>\g<cell></td></tr></tbody></table>"
        page = re.sub(like, row + "<svg" * (key == "figure"), page, flags=re.DOTALL)
    page = re.sub(r"<svg\b.*?</svg>", "", page, flags=re.DOTALL)
    found = re.split(r'<(?:section|article) class="page[^"]*" id="([^"]+)">', page)
    return zip(found[1::2], found[2::2], strict=True)


def tables(body):
    """First two heads and the rows of each table; a cell is followed by the unit of its column."""
    for table in re.findall(r"<table.*?</table>", body, re.DOTALL):
        head, _, rest = table.rpartition("<tbody>")
        heads = [plain(one) for one in re.findall(r'<th(?: scope="col")?>(.*?)</th>', head)]
        units = [one.partition("[")[2].strip("]") for one in heads]
        rows = []
        for row in re.findall(r"<tr\b.*?</tr>", rest, re.DOTALL):
            of = repeat("") if re.match('<tr class="(gap|bound)', row) else chain(units, repeat(""))
            cells = re.findall(r"<t[hd]\b[^>]*>(.*?)</t[hd]>", row, re.DOTALL)
            rows.append([f"{cell} {unit}".strip() for cell, unit in zip(cells, of, strict=False)])
        yield "numbers" if 'class="numbers"' in table else "|".join(heads[:2]), rows


def missing(name, text, pool):
    """A message for each number of a text that is none of a pool; those of a list are in its order."""
    found, at = [*numbers(text)], 0
    pool, ordered = [*flat(pool)] if found else [], isinstance(pool, list)
    for value, half in found:
        places = (k for k in range(at, len(pool)) if abs(value - pool[k]) <= half * (1 + 1e-6))
        if (place := next(places, None)) is None:
            yield f"{name}: {value:g} in {plain(text)[:90]!r}"
        elif ordered:
            at = place + 1


def flat(item):
    """Every number of a record, those of its texts too."""
    if isinstance(item, str):
        yield from (value for value, _ in numbers(item))
    elif isinstance(item, int | float):
        yield item
    elif item is not None:
        yield from chain.from_iterable(map(flat, item.values() if isinstance(item, dict) else item))


def numbers(text):
    """Value of each number of a text in SI units, with half of its last digit."""
    for sign, digits, power, last, unit, prefix in NUMBER.findall(plain(text)):
        factor = 0.01 if unit == "%" else PREFIX.get(prefix, 1.0)
        # a commit such as 4e40443 looks like a power, too
        step = factor * 10.0 ** (min(int(power or 0), 300) - len(digits.partition(".")[2]))
        yield float(f"{sign}{digits}e{power or 0}") * factor, step / 2
        if last:
            yield int(last) * step, step / 2


def plain(text):
    """Text of a piece of the page, or of a string of the record, with powers of ten as e-5, times in s."""
    text = text.replace("·10<sup>", "e").replace("10<sup>", "1e").replace("<small", " <small")
    text = unescape(re.sub(r"<[^>]*>", "", text)).replace("−", "-").replace("\N{NO-BREAK SPACE}", " ").strip()
    text = re.sub(r"(\d)T(?=\d\d:)", r"\1 ", text.replace("< 0.01 %", "").replace("< 0.", "< 9e99 "))
    return re.sub(r"(\d+) min (\d\d) s", lambda m: f"{60 * int(m[1]) + int(m[2])} s", text)


if __name__ == "__main__":
    sys.exit("\n".join(differing(Path(sys.argv[1]))) or 0)
