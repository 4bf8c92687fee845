"""coatcheck bench: the semi-analytical contact timed beside other codes."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Annotated, Any

from cyclopts import Parameter
from rich.console import Console
from rich.table import Table

from verification.commands.common.exits import EXIT, CommandError, with_exit_code
from verification.commands.common.options import AsJson, Flag
from verification.commands.common.terminal import print_json
from verification.judging.verdict import Outcome

Numbers = Annotated[tuple[int, ...], Parameter(consume_multiple=True, negative="")]


@with_exit_code
def bench(
    *,
    sizes: Annotated[Numbers, Parameter(name=["--sizes", "-N"])] = (128, 256, 512),
    threads: Numbers = (1, 2),
    repeats: int = 5,
    coated: Flag = False,
    plane: Flag = False,
    as_json: AsJson = False,
) -> int:
    """Time the semi-analytical contact beside tamaas and aspher, one test of residuals for all; ratios first.

    tamaas comes with the extra "bench"; aspher is used if it is installed (pip install aspher, which builds
    it with CMake, a C++17 compiler and Eigen). The full set takes half an hour:
    coatcheck bench --sizes 128 256 512 1024 2048 --coated --plane

    Args:
        sizes: Patches along a side of the square [-2a, 2a]^2.
        threads: Numbers of threads to measure with.
        repeats: Measurements of each; the median counts.
        coated: Also count the iterations of coated solids on each of the grids.
        plane: Also time the six stresses of a plane beside six inverse real FFTs.
    """
    if min(sizes) < 16 or max(sizes) > 4096 or min(threads) < 1 or repeats < 1:
        raise CommandError("--sizes from 16 to 4096, --threads and --repeats from 1")
    from verification.bench.contact import coated_ratios, ratios, run_bench, run_coated, run_plane

    console = Console(stderr=True)
    rows = run_bench(sizes=sizes, threads=threads, repeats=repeats, progress=lambda line: console.print(line))
    found = ratios(rows)
    layered = run_coated(sizes=sizes) if coated else []
    planes = run_plane() if plane else []
    for p in planes:
        found.append((f"six stresses of a plane / six inverse FFTs, {p.patches} patches", p.ratio))
        found.append((f"memory of it / the six stresses, {p.patches} patches", p.memory))
        found.append((f"setting it up / one evaluation, {p.patches} patches", p.setup_seconds / p.seconds))
    found += coated_ratios(layered)
    if as_json:
        records: dict[str, Sequence[Any]] = {"rows": rows, "coated": layered, "planes": planes}
        content = {name: [asdict(record) for record in some] for name, some in records.items()}
        print_json(content | {"ratios": dict(found)})
        return 0
    figures = Table("figure", "value", box=None, header_style="bold")
    for name, value in found:
        figures.add_row(name, f"{value:.4g}")
    measured = Table("solver", "N", "threads", "s, median", "gap", "penetration", "load", "judge", box=None)
    for r in rows:
        judge = (f"{r.gap:.1e}", f"{r.penetration:.1e}", f"{r.load:.1e}", "meets" if r.passes else "FAILS")
        measured.add_row(r.solver, str(r.patches), str(r.threads), f"{r.seconds:.3f}", *judge)
    Console().print(figures, "", measured)
    if layered:
        table = Table("N", "E1/E2", "h/a", "iterations", "convolutions", "s", "of it coefficients", box=None)
        for c in layered:
            counts = (str(c.iterations), str(c.convolutions), f"{c.seconds:.3f}", f"{c.setup_seconds:.3f}")
            table.add_row(str(c.patches), f"{c.modulus_ratio:g}", f"{c.thickness:g}", *counts)
        Console().print("", table)
    return 0 if all(row.passes for row in rows) else EXIT[Outcome.DISAGREES]
