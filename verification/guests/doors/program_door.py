"""The door of programs: questions on standard input, answers on standard output, a line each."""

import os
import selectors
import subprocess
import sys
import threading
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from verification.guests.guest_description import Guest
from verification.guests.guest_protocol import TOKEN, GuestAnswer, ProtocolError, Question, parse_answer

MOST_BYTES = 64_000_000  # of one answer with the chatter before it
MOST_WORDS = 2000  # of standard error that are kept
CHUNK = 1 << 16
GRACE = 2.0  # s for a program to end after its last answer


@dataclass(frozen=True)
class TimedAnswer:
    """An ``answer`` with the seconds until it came and the peak memory [bytes] of the program by then."""

    answer: GuestAnswer
    seconds: float
    memory: int | None = None


class Program:
    """A guest's program at work, until ``end``.

    It shares the process group of the caller, which the pool ends as a whole.
    """

    def __init__(self, command: tuple[str, ...], folder: Path) -> None:
        try:
            self.process = subprocess.Popen(
                _resolved(command, folder),
                cwd=folder,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                bufsize=0,
            )
        except OSError as error:
            reason = f"{command[0]}: cannot be started ({error.strerror or error})"
            raise ProtocolError(f"{reason}; see command in guest.toml") from None
        self.unread, self._seen = bytearray(), 0  # bytes of a line begun, how many hold no end of it
        self.last: deque[bytes] = deque(maxlen=2)
        self._drain = threading.Thread(target=self._keep_last_words, daemon=True)
        self._drain.start()

    def end(self, patience: float = GRACE) -> None:
        """Close its input, then end it where it does not end by itself within ``patience`` [s]."""
        assert self.process.stdin is not None
        with suppress(OSError):
            self.process.stdin.close()
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(patience)
        self.process.kill()
        self.process.wait()
        assert self.process.stdout is not None
        self.process.stdout.close()
        # A process that the program left behind may hold its standard error open, and the thread up.
        self._drain.join(0.2)

    def ask(self, question: Question, time_limit: float) -> TimedAnswer:
        """The answer to ``question``. Raises ProtocolError with what the program did instead."""
        begin = time.monotonic()
        line = question.model_dump_json().encode() + b"\n"
        assert self.process.stdin is not None
        # In a thread, since a program may write before it reads all of the question; to a descriptor of its
        # own, since ``end`` may close the other one meanwhile.
        pipe = os.dup(self.process.stdin.fileno())
        self._writing = threading.Thread(target=_write, args=(pipe, line), daemon=True)
        self._writing.start()
        content = self._answer_line(begin + time_limit, time_limit)
        return TimedAnswer(parse_answer(content, question), time.monotonic() - begin, self._memory())

    def _answer_line(self, until: float, time_limit: float) -> bytes:
        """The next line that begins with the token, without it; what lies before is dropped as it comes."""
        assert self.process.stdout is not None
        token, count = TOKEN.encode() + b" ", 0
        with selectors.DefaultSelector() as ready:
            ready.register(self.process.stdout, selectors.EVENT_READ)
            while True:
                while (end := self.unread.find(b"\n", self._seen)) >= 0:
                    line, self.unread, self._seen = bytes(self.unread[:end]), self.unread[end + 1 :], 0
                    if line.startswith(token):
                        return line[len(token) :]
                # Chatter of any length needs no memory: only a line that may be an answer is kept.
                if not (self.unread.startswith(token) or token.startswith(self.unread)):
                    self.unread = bytearray(b".")
                self._seen = len(self.unread)
                left = until - time.monotonic()
                if left <= 0 or not ready.select(left):
                    raise ProtocolError(self._silence(time_limit, count))
                more = os.read(self.process.stdout.fileno(), CHUNK)
                count += len(more)
                if count > MOST_BYTES:
                    raise ProtocolError(f"it wrote more than {MOST_BYTES // 10**6} MB without an answer")
                if not more:
                    raise ProtocolError(self._end())
                self.unread += more

    def _silence(self, time_limit: float, count: int) -> str:
        """Sentence on how much a program still at work has read and written since the question."""
        read = "it has read the question" if not self._writing.is_alive() else "it has not read the question"
        wrote = f"written {count} bytes without an answer" if count else "written nothing"
        flush = "flush the output after each answer, or raise time_limit in guest.toml"
        return f"no answer after {time_limit:.3g} s; {read} and {wrote}; {flush}"

    def _end(self) -> str:
        """How a program that closed its output ended."""
        try:
            code = self.process.wait(GRACE)
        except subprocess.TimeoutExpired:
            return "it closed its output without an answer"
        how = f"crashed with signal {-code}" if code < 0 else f"ended with code {code}"
        self._drain.join(GRACE)
        words = b"".join(self.last)[-MOST_WORDS:].decode(errors="replace").strip().splitlines()
        cut = "in the middle of an answer" if self.unread.startswith(TOKEN.encode()) else "without an answer"
        return f"it {how} {cut}" + (f": {words[-1][:300]}" if words else "")

    def _keep_last_words(self) -> None:
        assert self.process.stderr is not None
        with self.process.stderr as pipe, suppress(OSError):
            while more := os.read(pipe.fileno(), CHUNK):
                self.last.append(more)

    def _memory(self) -> int | None:
        """Peak resident memory of the program [bytes]; None where the system does not tell."""
        with suppress(OSError, ValueError, IndexError):
            for line in Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
                if line.startswith("VmHWM:"):
                    return 1024 * int(line.split()[1])
        return None


def command_of(guest: Guest) -> tuple[str, ...]:
    """The program of ``guest``: its own, or that which calls its Python function."""
    if guest.callable is not None and guest.python is not None:
        return (guest.python, str(Path(__file__).with_name("own_python.py")), guest.callable)
    if guest.callable is not None:
        return (sys.executable, "-m", "verification.guests.doors.serve_function", guest.callable)
    return tuple(guest.command or ())


def _write(pipe: int, line: bytes) -> None:
    """Write to a descriptor and close it."""
    rest = memoryview(line)
    with suppress(OSError):  # the program has ended, as its end of file will tell
        while rest:
            rest = rest[os.write(pipe, rest) :]
    os.close(pipe)


def _resolved(command: tuple[str, ...], folder: Path) -> list[str]:
    """``command`` with a relative program that lies in ``folder``."""
    beside = folder / command[0]
    first = str(beside) if "/" in command[0] and beside.exists() else command[0]
    return [first, *command[1:]]
