"""Every planted fault by name, read from ``lists/``, group after group, with the negative controls."""

from pathlib import Path

from faults_planted.fault_planting import Fault
from verification.cases.toml_file import load_toml
from verification.evidence.fault_record import GROUPS
from verification.running.json_records import decode

LISTS = Path(__file__).parent / "lists"


def _listed(group: str) -> dict[str, Fault]:
    """The faults of a group by name; each key that a fault leaves out is that of its group."""
    _, content = load_toml((LISTS / f"{group}.toml").read_bytes())
    common = {"group": group, "where": content["where"], "cases": content["cases"]}
    faults = [decode(Fault, common | entry) for entry in content["fault"]]
    return {fault.name: fault for fault in faults}


FAULTS = {name: fault for group in GROUPS for name, fault in _listed(group).items()}
# No check that catches a fault may fail in these trials.
CONTROLS = _listed("control")


def chosen(names: tuple[str, ...], group: str | None) -> list[Fault]:
    """The faults named, those of a group, or all with the controls. Raises KeyError for an unknown name."""
    known = FAULTS | CONTROLS
    if names:
        return [known[name] for name in dict.fromkeys(names)]
    if group is not None:
        return [fault for fault in FAULTS.values() if fault.group == group]
    return list(known.values())
