"""Campaigns that maintainers run: python tests/tools COMMAND, with --help for what each does."""

import os
import sys
from pathlib import Path

from cyclopts import App

HERE = str(Path(__file__).resolve().parent)
sys.path.insert(0, HERE)
os.environ["PYTHONPATH"] = os.pathsep.join((HERE, os.environ.get("PYTHONPATH", "")))  # for child processes

app = App(name="tests/tools", help=__doc__, help_format="plaintext")
app.command("bench:bench")
app.command("open_digits_made.making:vectors")
app.command("assumption_maps_made.measuring:assumptions")
app.command("result_picture:picture")
app.command("lobes_picture:lobes")
app.command("faults_planted.faults:faults")
app.command("alarms:alarms")
app.command("calibrate:calibrate")
app.command("stored_answers:answers")
app.command("trade:trade")
app.command("unexecuted:unexecuted")
app.command("enclosures_made.certify:certify")
app.command("code_checked.checking:code")
app.command("method_constants:constants")
app.command("guest_records:guests")

if __name__ == "__main__":
    sys.exit(app(result_action="return_value"))
