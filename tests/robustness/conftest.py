"""Lets the tests of this folder share their helper modules by name, also those of tests/verification."""

import sys
from pathlib import Path

# pytest's importlib mode leaves sys.path alone, so a helper beside the tests would not be found.
HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "verification")]
