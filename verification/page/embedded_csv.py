"""The numbers of the figures as CSV embedded in the page."""

import base64
import csv
import gzip
from collections.abc import Sequence
from io import StringIO


def embedded(text: str) -> str:
    """``text`` compressed as a data address; the same text always gives the same address."""
    packed = gzip.compress(text.encode(), compresslevel=9, mtime=0)
    return f"data:application/gzip;base64,{base64.b64encode(packed).decode()}"


def written(rows: Sequence[Sequence[str]]) -> str:
    """``rows`` as CSV."""
    out = StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()
