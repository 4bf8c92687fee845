"""coatcheck manual: the manual as HTML pages, to read without a network, or as a PDF."""

from pathlib import Path

from verification.commands.common.command_error import CommandError, no_result
from verification.commands.common.exit_codes import with_exit_code
from verification.commands.common.shared_options import AsJson, Flag, Output, Quiet
from verification.commands.common.terminal import print_files


@with_exit_code
def manual(
    *,
    output: Output = Path("manual"),
    pdf: Flag = False,
    time_limit: float = 300.0,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> int:
    """Write the manual: theory, cases, formats, API, from the sources of this version.

    Requires the extra manual: pip install 'coatcheck[manual]'.

    Args:
        output: Directory of the pages, index.html first.
        pdf: Also write coatcheck.pdf there, through an installed Chromium or Chrome.
        time_limit: Seconds that printing may take.
    """
    from verification.manual.manual_build import build, print_manual
    from verification.page.pdf_file import NoBrowser

    try:
        files = print_manual(output, "coatcheck.pdf", time_limit) if pdf else [build(output)]
    except NoBrowser as error:
        raise no_result(str(error)) from None
    except ValueError as error:
        raise CommandError(str(error)) from None
    print_files(files, as_json=as_json, quiet=quiet)
    return 0
