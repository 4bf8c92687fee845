"""The files that names on the command line stand for: shipped ones by name, others by path."""

import os
import unicodedata
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from verification.cases.case_file import Case, default_cases
from verification.cases.published_file import PublishedCase, published_cases, read_any_case
from verification.cases.toml_file import CaseError
from verification.commands.common.terminal import did_you_mean

SHIPPED = "case (see coatcheck list)"


def chosen_cases(names: Sequence[str]) -> list[Case | PublishedCase]:
    """The cases that ``names`` stand for, all shipped contacts without any; "published" names a group.

    Raises CaseError for an unknown name, a file that cannot be used, or two cases of one name.
    """
    shipped, published = default_cases(), published_cases()
    cases: list[Case | PublishedCase] = []
    for name in names or shipped:
        if name == "published":
            cases += [read_any_case(path) for path in published.values()]
        else:
            path = path_of(name, shipped | published, SHIPPED, ["published"])
            cases.append(read_any_case(path))
    require_distinct([case.name for case in cases])
    return cases


def path_of(name: str, shipped: Mapping[str, Path], kind: str, others: Iterable[str] = ()) -> Path:
    """The shipped file called ``name``, otherwise the path that it is.

    kind : what is shipped, for the message.   others : more names that may have been meant.
    Raises CaseError where it is neither.
    """
    if name in shipped:
        return shipped[name]
    if name.endswith(".toml") or "/" in name or os.path.lexists(name):
        return Path(name)
    near = did_you_mean(name, [*shipped, *others])
    raise CaseError(f"{name}: neither a shipped {kind} nor a .toml file{near}")


def require_distinct(names: Sequence[str]) -> None:
    """Raises CaseError where two ``names`` of cases are one to a file system."""
    plain = [unicodedata.normalize("NFC", name).casefold() for name in names]
    count = Counter(plain)
    twice = sorted(name for name, one in zip(names, plain, strict=True) if count[one] > 1)
    if twice:
        raise CaseError(f"{twice[0]}: named twice; give each case file a name of its own")
