"""What is known of the suite's own credibility, measured now or read from records."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from verification.credibility import alarms
from verification.credibility.alarms import AlarmRecord
from verification.credibility.faults.campaign import RECORD
from verification.credibility.faults.record import Record, read_record
from verification.credibility.independence import Part, parts
from verification.credibility.manufactured import DesignOrder, design_orders
from verification.running.store import StoreError

__all__ = ["Evidence", "gather"]

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Evidence:
    """What no case shows by itself; what could not be had is None or (), its sentence among ``failures``."""

    orders: tuple[DesignOrder, ...] = ()
    parts: tuple[Part, ...] = ()
    faults: Record | None = None
    alarms: AlarmRecord | None = None
    failures: tuple[str, ...] = ()


def gather(records: Path) -> Evidence:
    """Manufactured solutions and imports as they are; faults and false alarms as recorded in ``records``."""
    failures: list[str] = []

    def had(what: str, ask: Callable[[], T], otherwise: T) -> T:
        try:
            return ask()
        except Exception as error:  # one row of the page, never the report
            said = str(error) if isinstance(error, StoreError) else f"{what}: {error}"
            failures.append(" ".join(said.split())[:300])
            return otherwise

    return Evidence(
        had("manufactured solutions", design_orders, ()),
        had("imports", parts, ()),
        had("planted faults", lambda: read_record(records / RECORD), None),
        had("false alarms", lambda: alarms.read_record(records), None),
        tuple(failures),
    )
