"""coatcheck manual: the manual as HTML pages, to read without a network."""

from pathlib import Path

from verification.commands.common.command_error import CommandError
from verification.commands.common.shared_options import AsJson, Output, Quiet
from verification.commands.common.terminal import print_files, with_exit_code


@with_exit_code
def manual(*, output: Output = Path("manual"), quiet: Quiet = False, as_json: AsJson = False) -> int:
    """Write the manual: theory, cases, formats, API, from the sources of this version.

    Requires the extra manual: pip install 'coatcheck[manual]'.

    Args:
        output: Directory of the pages, index.html first.
    """
    from verification.manual.manual_build import build

    try:
        files = [build(output)]
    except ValueError as error:
        raise CommandError(str(error)) from None
    print_files(files, as_json=as_json, quiet=quiet)
    return 0
