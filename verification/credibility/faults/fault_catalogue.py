"""Every planted fault by name, read from ``lists/``, group after group, with the negative controls."""

import ast
from pathlib import Path
from typing import Any

from verification.cases.toml_file import load_toml
from verification.credibility.faults.fault_planting import Constant, Edit, Fault
from verification.running.json_records import decode

LISTS = Path(__file__).parent / "lists"
_ORDER = (
    "material",
    "ball",
    "frf",
    "conversion_fft",
    "conjugate_gradients",
    "stress",
    "finite_elements",
    "fields",
    "references",
    "harness",
    "coverage",
)


def _listed(group: str) -> tuple[str, dict[str, Fault]]:
    """Title of a group, and its faults by name; what a fault leaves out is that of its group."""
    _, content = load_toml((LISTS / f"{group}.toml").read_bytes())
    common = {"group": group, "where": content["where"], "cases": content["cases"]}
    faults = [_fault(common | entry) for entry in content["fault"]]
    return content["title"], {fault.name: fault for fault in faults}


def _fault(entry: dict[str, Any]) -> Fault:
    changes = [
        Constant(change["target"], ast.literal_eval(change["value"]))
        if "value" in change
        else decode(Edit, change)
        for change in entry.get("changes", ())
    ]
    return decode(Fault, entry | {"changes": changes})


_GROUPS = {group: _listed(group) for group in _ORDER}
# The title of each group, in the order of the matrix.
GROUPS = {group: title for group, (title, _) in _GROUPS.items()}
FAULTS = {name: fault for _, faults in _GROUPS.values() for name, fault in faults.items()}
# No check that catches a fault may fail in these trials.
CONTROLS = _listed("control")[1]


def chosen(names: tuple[str, ...], group: str | None) -> list[Fault]:
    """The faults named, those of a group, or all with the controls. Raises KeyError for an unknown name."""
    known = FAULTS | CONTROLS
    if names:
        return [known[name] for name in dict.fromkeys(names)]
    if group is not None:
        return [fault for fault in FAULTS.values() if fault.group == group]
    return list(known.values())
