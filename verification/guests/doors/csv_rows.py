"""Rows of a CSV file with their places for messages, and the numbers in its cells."""

import csv
from pathlib import Path
from typing import Any

from verification.guests.guest_protocol import ProtocolError
from verification.running.checked_files import StoreError, read_bounded, rows_of_csv


def csv_rows(path: Path, most: int) -> list[tuple[str, dict[str, Any]]]:
    """Each row of a CSV file of at most ``most`` bytes below its head, with its place for messages.

    Raises ProtocolError naming the file.
    """
    try:
        head, *rows = rows_of_csv(read_bounded(path, most).decode("utf-8-sig")) or [[]]
    except StoreError as error:
        raise ProtocolError(str(error)) from None
    except UnicodeDecodeError:
        raise ProtocolError(f"{path}: not UTF-8 text") from None
    except csv.Error as error:
        raise ProtocolError(f"{path}: not CSV ({error})") from None
    filled = ([*row, *[""] * len(head)] for row in rows if row)
    return [
        (f"{path}: row {number}", dict(zip(head, row, strict=False)))
        for number, row in enumerate(filled, start=2)
    ]


def cell_number(text: str, where: str) -> float:
    """The number in a cell. Raises ProtocolError naming ``where``."""
    try:
        return float(text)
    except ValueError:
        shown = text.strip()[:20]
        raise ProtocolError(f"{where}: {shown!r} is not a number" if shown else f"{where} is empty") from None
