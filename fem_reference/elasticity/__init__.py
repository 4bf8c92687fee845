"""Linear elasticity on the meridian plane: assembly, solution, loads, recovered fields."""
