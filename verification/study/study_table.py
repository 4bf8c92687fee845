"""The table of a study: one row for each point from each source, with its full input.

Columns, in SI units unless they say "over":

    point, source, status ("solved" or "failed"), failure (the message, null where there is none)
    radius, load, coating_E, coating_nu, thickness, residual_stress, substrate_E, substrate_nu,
    friction                                                                                       the input
    ball (JSON): E, nu, coatings of an elastic ball, null of a rigid one
    indenter (JSON): "ellipsoid" with the radii of the gap along x and y [m], null of a sphere
    modulus_ratio (E1/E2), thickness_over_a_h; a_h, p_h, delta_h of the bare substrate and ball
    peak_pressure, contact_radius, approach: X, X_over_p_h | a_h | delta_h, X_uncertainty
    each stress of QUANTITIES: X, X_over_p_h, X_uncertainty, X_x, X_x_over_a_h, X_z, X_z_over_a_h
    numerics, versions (JSON), key (of the stored solve), seconds (of that solve, which its frictions share)

An unknown number is null: all of a failed point, the position of a tension that does not exist.
"""

import io
import json
from collections.abc import Iterable, Mapping
from itertools import islice
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from verification.problem.quantity import QUANTITIES as ALL
from verification.problem.quantity import SCALARS as CONTACT_SCALARS
from verification.running.checked_files import StoreError, write_atomically
from verification.sources.source_registry import EXACT, METHODS
from verification.study.largest_stresses import QUANTITIES

# The first solves every point, the others those that are cross-checked.
SOURCES = (*METHODS, *EXACT)
# Each scalar of the contact with the scale of the bare substrate that it is given over.
SCALARS = {name: ALL[name].scale for name in CONTACT_SCALARS}
SCALES = dict.fromkeys(QUANTITIES, "p_h") | SCALARS
# Each column that is given over a scale too.
OVER = SCALES | {f"{name}_{axis}": "a_h" for name in QUANTITIES for axis in "xz"}

_INPUT = (
    *("radius", "load", "coating_E", "coating_nu", "thickness", "residual_stress"),
    *("substrate_E", "substrate_nu", "friction"),
    *("modulus_ratio", "thickness_over_a_h", "a_h", "p_h", "delta_h"),
)
_RESULT = (
    *(f"{name}{end}" for name, scale in SCALARS.items() for end in ("", f"_over_{scale}", "_uncertainty")),
    *(
        f"{name}{end}"
        for name in QUANTITIES
        for end in ("", "_over_p_h", "_uncertainty", "_x", "_x_over_a_h", "_z", "_z_over_a_h")
    ),
)
_TEXTS = ("ball", "indenter", "numerics", "versions", "key")
COLUMNS = pa.schema(
    [
        pa.field("point", pa.int64(), nullable=False),
        *(
            pa.field(name, pa.string(), nullable=name == "failure")
            for name in ("source", "status", "failure")
        ),
        *(pa.field(name, pa.float64(), nullable=False) for name in _INPUT),
        *(pa.field(name, pa.float64()) for name in _RESULT),
        *(pa.field(name, pa.string(), nullable=False) for name in _TEXTS),
        pa.field("seconds", pa.float64(), nullable=False),
    ]
)
GROUP = 1024  # rows held at once


def write_table(path: Path, rows: Iterable[Mapping[str, Any]], study: Mapping[str, Any]) -> int:
    """Write ``rows``, in their order, whole or not at all; their number. Raises StoreError.

    study : stored with the rows, plain JSON.  A column that a row lacks is null.
    """
    schema = COLUMNS.with_metadata({"coatcheck_study": json.dumps(study, sort_keys=True)})
    content, following, count = io.BytesIO(), iter(rows), 0
    with pq.ParquetWriter(content, schema, compression="zstd") as writer:
        while group := list(islice(following, GROUP)):
            # from_pandas: NaN becomes null
            arrays = [pa.array([r.get(f.name) for r in group], f.type, from_pandas=True) for f in schema]
            writer.write_table(pa.Table.from_arrays(arrays, schema=schema))
            count += len(group)
    write_atomically(path, content.getvalue())
    return count


def read_columns(path: Path) -> dict[str, NDArray[Any]]:
    """Every column of a table by name; null numbers are NaN, null texts None. Raises StoreError."""
    try:
        table = pq.read_table(path)
    except (OSError, pa.ArrowException) as error:
        raise StoreError(f"{path}: cannot be read as a table ({str(error).splitlines()[0]})") from None
    return {name: table[name].to_numpy(zero_copy_only=False) for name in table.column_names}
