"""The same cases over and over: verdicts have to be identical, numbers within 1e-12.

python tests/robustness/repetitions.py [CASE ...] --times 10 --output FOLDER

The differences are printed for each; it ends with 1 where one exceeds 1e-12. With --jobs 1 2 3 the number of
cases side by side is turned too, with it the threads of each, and the order in which sums are taken.
"""

import argparse
import sys
from pathlib import Path

from kill_default_run import largest_difference

from verification.cases.case_file import read_case, shipped_cases
from verification.running.case_tasks import case_task
from verification.running.pool.process_pool import run_tasks

__all__ = ["LIMIT", "main", "repeated"]

LIMIT = 1e-12
# A bare solid, a stiff coating that slides, two coatings.
USUAL = ("01_uncoated_steel", "14_ratio_4_sliding", "08_dlc_chromium_steel")


def repeated(names: tuple[str, ...], output: Path, times: int, jobs: tuple[int, ...] = (2,)) -> list[float]:
    """Differences of each repetition from the first, as ``largest_difference`` finds them."""
    shipped = shipped_cases()
    cases = [read_case(shipped.get(name, Path(name))) for name in names]
    differences = []
    for n in range(times):
        tasks = [case_task(case, output / f"{n}") for case in cases]
        run_tasks(tasks, jobs=jobs[n % len(jobs)], time_limit=3600)
        difference, compared = largest_difference(output / "0", output / f"{n}")
        differences.append(difference)
        sys.stdout.write(
            f"{n}: --jobs {jobs[n % len(jobs)]}, {compared} values, largest difference {difference:.2g}\n"
        )
        sys.stdout.flush()
    return differences


def main() -> int:
    """Repeat and print; 1 where the numbers are not the same."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="*", default=USUAL)
    parser.add_argument("--times", type=int, default=10)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--jobs", type=int, nargs="*", default=(2,))
    chosen = parser.parse_args()
    differences = repeated(tuple(chosen.cases), chosen.output, chosen.times, tuple(chosen.jobs))
    sys.stdout.write(f"{len(differences)} repetitions: largest difference {max(differences):.2g}\n")
    return int(max(differences) > LIMIT)


if __name__ == "__main__":
    sys.exit(main())
