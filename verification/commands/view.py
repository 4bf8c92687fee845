"""coatcheck view: the fields of a case in a window or as a picture."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from verification.cases.case_file import default_cases
from verification.commands.common.command_error import CommandError, no_result
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.shared_options import Output
from verification.commands.common.terminal import did_you_mean
from verification.problem.quantity import STRESSES
from verification.running.checked_files import StoreError, write_atomically
from verification.running.stored_fields import read_fields

QUANTITIES = ("von_mises", *STRESSES)


@with_exit_code
def view(
    case: str,
    /,
    *,
    quantity: Annotated[str, Parameter(name=["--quantity", "-q"])] = "von_mises",
    output: Output = Path("reports"),
    screenshot: Path | None = None,
    time_limit: float = 60.0,
) -> int:
    """Show the fields of a case from coatcheck run --fields: finite elements beside semi-analytical.

    Args:
        case: Name of the case; ParaView opens its fields too, CASE-fem.vtu and CASE-semi.vtm in
            OUTPUT/fields.
        quantity: von_mises, or a stress: sigma_xx, sigma_yy, sigma_zz, sigma_xy, sigma_yz, sigma_xz.
        output: Directory of the run.
        screenshot: Write this PNG file instead of opening a window; no display is needed.
        time_limit: Longest time of rendering [s].
    """
    if quantity not in QUANTITIES:
        raise CommandError(f"--quantity = {quantity}; there are {', '.join(QUANTITIES)}")
    if Path(case).name != case:
        raise CommandError(f"{case}: not the name of a case; see coatcheck list")
    if screenshot is not None and screenshot.suffix.lower() != ".png":
        raise CommandError(f"--screenshot = {screenshot}; the name has to end in .png")
    try:
        read_fields(output, case)
    except StoreError as error:
        stored = [path.stem for path in (output / "fields").glob("*.json")]
        near = "" if case in (cases := default_cases()) else did_you_mean(case, [*stored, *cases])
        raise CommandError(f"{error}; fields are written by: coatcheck run {case} --fields{near}") from None
    viewer = [sys.executable, "-m", "verification.desk.field_viewer"]
    words = [*viewer, str(output), case, f"{quantity} [Pa]"]
    if screenshot is not None:
        _picture(words, screenshot, time_limit)
        return 0
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise no_result("there is no display here; write a picture with --screenshot FILE.png")
    code = subprocess.run(words, stderr=subprocess.DEVNULL, check=False).returncode
    if code:
        raise no_result(f"VTK could not open a window ({_ended(code)}); try --screenshot FILE.png")
    return 0


def _picture(words: list[str], path: Path, time_limit: float) -> None:
    """Render in a process of its own, which may crash or hang; the picture appears whole or not at all."""
    with tempfile.TemporaryDirectory() as folder:
        drawn = Path(folder) / "picture.png"
        try:
            done = subprocess.run([*words, str(drawn)], capture_output=True, timeout=time_limit, check=False)
        except subprocess.TimeoutExpired:
            raise no_result(f"no picture after {time_limit:g} s; raise --time-limit") from None
        if done.returncode != 0 or not drawn.exists():
            raise no_result(
                f"VTK could not render off screen here ({_ended(done.returncode)}); ParaView opens the "
                "fields, and the report has pictures of the plane y = 0"
            )
        write_atomically(path, drawn.read_bytes())


def _ended(code: int) -> str:
    return f"signal {-code}" if code < 0 else f"code {code}"
