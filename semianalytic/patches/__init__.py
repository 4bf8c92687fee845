"""Pressures of surface patches: grids, DC-FFT and conjugate gradients."""
