"""Options that several commands have in common.

The command line imports this for each command, so nothing here needs numpy or rich.
"""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

_BASELINE_HELP = "Directory of the baseline; that of the package unless given."
_RECORDS_HELP = "Directory of the credibility records; that of the package unless given."
_SCHEDULER_HELP = "Address of a Dask scheduler, HOST:PORT; its workers solve, and share the output directory."
_MATERIALS_HELP = (
    'File of the materials that may be given by name alone, "DLC 2 um", "100Cr6"; that of the package unless '
    "given, see coatcheck materials."
)
_JOBS_HELP = "Processes side by side; all cores unless given."

Flag = Annotated[bool, Parameter(negative="")]
Output = Annotated[Path, Parameter(name=["--output", "-o"])]
BaselineFolder = Annotated[
    Path, Parameter(name=["--baseline", "-b"], help=_BASELINE_HELP, show_default=False)
]
RecordsFolder = Annotated[Path, Parameter(help=_RECORDS_HELP, show_default=False)]
MaterialsFile = Annotated[Path, Parameter(help=_MATERIALS_HELP, show_default=False)]
Jobs = Annotated[int | None, Parameter(name=["--jobs", "-j"], help=_JOBS_HELP)]
Scheduler = Annotated[str | None, Parameter(help=_SCHEDULER_HELP)]
Resume = Annotated[bool, Parameter(negative="", help="Keep the valid results in the output directory.")]
Quiet = Annotated[bool, Parameter(name=["--quiet", "-q"], negative="", help="Print nothing but errors.")]
Strict = Annotated[
    bool, Parameter(negative="", help="Refuse implausible numbers, which otherwise are warned of.")
]
AsJson = Annotated[bool, Parameter(name="--json", negative="", help="Print JSON instead of text.")]
