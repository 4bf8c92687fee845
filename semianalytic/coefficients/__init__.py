"""Response of layered half-spaces and the influence coefficients that follow from it."""
