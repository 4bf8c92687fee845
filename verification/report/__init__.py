"""Report of a verification run."""
