"""Report of a verification run: one offline page with its figures, JSON, JUnit XML."""
