"""Report of a verification run: one offline page, its figures, JSON, JUnit XML.

Drawn from case results alone; the only place that divides by the Hertz scales of the bare substrate.
"""

from verification.report.write import write_report

__all__ = ["write_report"]
