"""coatcheck materials: the library of materials, with the source of each."""

from pathlib import Path

from rich.markup import escape

from verification.cases.materials import SHIPPED, meant, plain_name, read_materials
from verification.commands.common.command_error import CommandError
from verification.commands.common.shared_options import AsJson
from verification.commands.common.terminal import named_table, print_json, print_out, with_exit_code
from verification.problem.display_units import prefixed


@with_exit_code
def materials(*names: str, file: Path = SHIPPED, as_json: AsJson = False) -> int:
    """List the materials that solve knows by name: typical E and nu, ranges, sources.

    Args:
        names: Materials to show alone.
        file: A file of your own in place of the one that is shipped; copy that one and extend it.
    """
    known = read_materials(file)
    chosen = []
    for name in names:
        if (found := known.get(plain_name(name))) is None:
            raise CommandError(f"{name}: not in {file}{meant(name, known)}")
        chosen.append(found)
    chosen = chosen or list({one.name: one for one in known.values()}.values())
    if as_json:
        print_json([one.model_dump(exclude_none=True) for one in chosen])
        return 0
    table = named_table("name", "E GPa", "range GPa", "nu", "also")
    lines = []
    for one in chosen:
        ends = f"{one.low / 1e9:g} to {one.high / 1e9:g}" if one.low and one.high else ""
        cells = (one.name, f"{one.E / 1e9:g}", ends, f"{one.nu:g}", ", ".join(one.also))
        table.add_row(*map(escape, cells))
        more = [
            f"yields at {prefixed(one.yield_strength, 'Pa')}" if one.yield_strength else "",
            one.note.strip("-"),
            f"compared with it: {one.checked}" if one.checked != "no" else "",
        ]
        lines.append(escape(f"{one.name}: {'; '.join([one.source, *filter(None, more)])}"))
    said = (
        f"typical values, for lack of your own: {file}; each was compared with its source where that is said"
    )
    print_out(table, "", *lines, "", escape(said))
    return 0
