"""Each case of a report says how to solve it again, a user's own file by its path."""

import shlex

import pytest

from verification.report.rerun import again


@pytest.mark.parametrize(
    ("name", "command", "words"),
    [
        ("05_ratio_4", "coatcheck run", ["05_ratio_4"]),
        ("05_ratio_4", "coatcheck run 05_ratio_4 mine.toml", ["05_ratio_4"]),
        ("05_ratio_4", "coatcheck run drafts/05_ratio_4.toml", ["drafts/05_ratio_4.toml"]),
        ("mine", "coatcheck run 05_ratio_4 mine.toml", ["mine.toml"]),
        ("my case", "coatcheck run 'a folder/my case.toml'", ["a folder/my case.toml"]),
        ("$(reboot)", "coatcheck run '$(reboot).toml'", ["$(reboot).toml"]),
        ("-rf", "coatcheck run -- -rf.toml", ["./-rf.toml"]),
        ("mine", "coatcheck run, stopped before its report or of several runs", ["mine.toml"]),
        ("mine", "coatcheck run 'no end", ["mine.toml"]),
    ],
)
def test_the_command_names_the_file_as_a_shell_takes_it(name, command, words):
    assert shlex.split(again(name, command)) == ["coatcheck", "run", *words]
