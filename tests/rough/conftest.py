"""Lets the tests of this folder share their helper modules by name."""

import sys
from pathlib import Path

# pytest's importlib mode leaves sys.path alone, so a helper beside the tests would not be found.
sys.path.insert(0, str(Path(__file__).parent))
