"""Record of what was checked of the code itself: orders of the finite element operator, imports of each part.

``python tests/tools code`` of a checkout measures both.
"""

from dataclasses import dataclass

from verification.running.json_records import RecordFile

COARSE = 0.25  # admissible shortfall of the order on coarse meshes


@dataclass(frozen=True)
class DesignOrder:
    """Orders of the displacement and of its gradient observed with elements of ``order``.

    The design orders are order + 1 and order, in L2.   errors : of the displacement, coarse then fine.
    """

    order: int
    harmonic: int
    displacement: float
    gradient: float
    errors: tuple[float, float]

    @property
    def as_designed(self) -> bool:
        """True where neither order is more than ``COARSE`` below its design."""
        return self.displacement > self.order + 1 - COARSE and self.gradient > self.order - COARSE


@dataclass(frozen=True)
class Imports:
    """Imports of the package ``name``: how many ``files`` with how many ``statements`` were read.

    modules : every module outside the standard library that it imports, its own left out.
    forbidden : messages, one for each forbidden import.
    hidden : messages, one for each import that is resolved only at run time.
    functions : full names of what it uses of NumPy and SciPy, numpy.linalg.solve.
    """

    name: str
    files: int
    statements: int
    modules: tuple[str, ...]
    forbidden: tuple[str, ...]
    hidden: tuple[str, ...]
    functions: tuple[str, ...] = ()

    @property
    def packages(self) -> tuple[str, ...]:
        """The top-level packages among ``modules``."""
        return tuple(sorted({module.partition(".")[0] for module in self.modules}))

    @property
    def wrong(self) -> tuple[str, ...]:
        """Messages on all that is forbidden or out of sight."""
        return self.forbidden + self.hidden

    @property
    def passed(self) -> bool:
        """True where nothing forbidden is imported, nothing out of sight."""
        return not self.wrong


@dataclass(frozen=True)
class CodeRecord:
    """Orders on manufactured solutions; imports of both methods, then of the references; provenance.

    source : hash of the code.
    """

    orders: tuple[DesignOrder, ...]
    parts: tuple[Imports, ...]
    started: str
    seconds: float
    commit: str | None
    machine: str
    versions: dict[str, str]
    source: str = ""


def shared(first: Imports, second: Imports) -> tuple[str, ...]:
    """Modules that both import, by the name in the source: scipy.special, numpy, ..."""
    return tuple(sorted(set(first.modules) & set(second.modules)))


def shared_functions(first: Imports, second: Imports) -> tuple[str, ...]:
    """Names that both use of NumPy and SciPy, in full."""
    return tuple(sorted(set(first.functions) & set(second.functions)))


_FILE = RecordFile(CodeRecord, "code.json", ("coatcheck-code/1",), "checks of the code", "measure it again")
write_record, read_record = _FILE.write, _FILE.read
