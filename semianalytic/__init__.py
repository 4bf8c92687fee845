"""Semi-analytical contact of a rigid indenter on a coated elastic half-space."""
