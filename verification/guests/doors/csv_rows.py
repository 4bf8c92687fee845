"""Rows of a CSV file with their places for messages, and the numbers in its cells."""

import csv
import io
from pathlib import Path
from typing import Any

from verification.guests.guest_protocol import ProtocolError
from verification.running.checked_files import StoreError, read_bounded


def csv_rows(path: Path, most: int) -> list[tuple[str, dict[str, Any]]]:
    """Each row of a CSV file of at most ``most`` bytes below its head, with its place for messages.

    Raises ProtocolError naming the file.
    """
    try:
        text = read_bounded(path, most).decode("utf-8-sig")
        # Spreadsheets of some languages separate by semicolons, with a decimal comma.
        head = text.partition("\n")[0]
        separator = ";" if head.count(";") > head.count(",") else ","
        rows = list(csv.DictReader(io.StringIO(text), delimiter=separator))
    except StoreError as error:
        raise ProtocolError(str(error)) from None
    except UnicodeDecodeError:
        raise ProtocolError(f"{path}: not UTF-8 text") from None
    except csv.Error as error:
        raise ProtocolError(f"{path}: not CSV ({error})") from None
    return [(f"{path}: row {number}", row) for number, row in enumerate(rows, start=2)]


def cell_number(text: str, where: str) -> float:
    """The number in a cell, with a decimal point or comma. Raises ProtocolError naming ``where``."""
    try:
        return float(text.strip().replace(",", "."))
    except ValueError:
        shown = text.strip()[:20]
        raise ProtocolError(f"{where}: {shown!r} is not a number" if shown else f"{where} is empty") from None
