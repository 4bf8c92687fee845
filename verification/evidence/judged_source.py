"""The source that each stored record judges, as a hash that tells whether it has changed since."""

from typing import Any

from verification.running.provenance import fingerprint

_METHODS = ("semianalytic", "fem_reference", "verification.sources")
_VERDICTS = (*_METHODS, "verification.judging", "verification.sampling")
_COMPARING = ("measured_modulus", "validation_metric")
# The packages that each record judges. Enclosures are proven without any, and held against each run.
JUDGED = {
    "code": _METHODS,
    "faults": _VERDICTS,
    "alarms": _VERDICTS,
    "alarms of spheres": _VERDICTS,
    "maps": ("verification.sources.assumptions",),
    "validation": (*_METHODS, *(f"verification.validation.{name}" for name in _COMPARING)),
}
_WITHOUT = {"alarms of spheres": "fem_reference.not_round"}  # which no contact of a sphere runs
_PARTS = {"maps": "maps", "alarms": "campaigns"}  # of records that are made a part at a time


def source_hash(record: str) -> str:
    """SHA-256 of the source that ``record`` judges, of a checkout or as it is installed."""
    return fingerprint(JUDGED[record], (), _WITHOUT.get(record, ""))


def is_older(name: str, record: Any) -> bool:
    """Whether the source that a record, or any part of it, judges is not the present one."""
    parts = getattr(record, _PARTS[name]) if name in _PARTS else (record,)
    return name in JUDGED and any(one.source != source_hash(getattr(one, "judged", name)) for one in parts)
