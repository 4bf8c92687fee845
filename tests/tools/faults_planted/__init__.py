"""Planted faults: what the checks of the default run are worth, measured on mistakes known to be there."""
