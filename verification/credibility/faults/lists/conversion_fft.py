"""Faults in influence coefficients, with those of the discrete convolutions."""

from verification.credibility.faults.planting import Edit, faults_of

__all__ = ["FAULTS"]

SOLID = ("01_uncoated_steel", "14_ratio_4_sliding")
SCALARS = ("approach", "peak_pressure", "contact_radius", "pressure", "influence coefficients")
STRESS = ("sigma_xx", "sigma_yy", "sigma_zz", "sigma_xz")
fault = faults_of("conversion_fft", "semianalytic", SOLID)
fault = faults_of("conversion_fft", "semianalytic", SOLID)

FAULTS = (
    fault(
        "no_padding",
        "the convolution for the surface is circular: no zero padding",
        SCALARS,
        Edit(
            "semianalytic.convolution:even_convolution",
            "spectrum = _even_spectrum(kernel, good_size(2 * nx - 1), good_size(2 * ny - 1), threads)",
            "mx, my = good_size(nx), good_size(ny); "
            "spectrum = _even_spectrum(kernel[: mx // 2 + 1, : my // 2 + 1], mx, my, threads)",
        ),
    ),
    fault(
        "no_padding_stress",
        "the convolution for the stresses is circular: no zero padding",
        STRESS,
        Edit(
            "semianalytic.nodal_convolution:_at_sites",
            "size = (next_fast_len(m.size, real=True), next_fast_len(n.size, real=True))",
            "size = (max(force.shape[0], m.size // 2), max(force.shape[1], n.size // 2))",
        ),
        Edit(
            "semianalytic.nodal_convolution:_at_sites",
            "irfft2(rfft2(part, size) * spectrum, size)[i, j]",
            "irfft2(rfft2(part, size) * spectrum, size)[i % size[0], j % size[1]]",
        ),
    ),
    fault(
        "grid_too_small",
        "the grid reaches to 0.98 of the contact radius only",
        SCALARS,
        Edit(
            "semianalytic.solver:solve",
            "half_width = fill * first.radius",
            "half_width = 0.98 * first.radius",
        ),
    ),
    fault(
        "conversion_domain_too_small",
        "the wavenumbers of the layers' response start at 1/(20 h): the domain of its transform is too small",
        SCALARS,
        Edit(
            "semianalytic.influence:_radial",
            "low, high = 1e-7 / max(b, sum(thickness))",
            "low, high = 0.05 / h",
        ),
    ),
    fault(
        "wavenumbers_cut",
        "the exact deflection under the layers leaves out wavelengths shorter than 4 coatings",
        SCALARS,
        Edit("semianalytic.abel:layer_table", "k_max = min(14 / thickness,", "k_max = min(1.5 / thickness,"),
    ),
    fault(
        "no_patch_averaging",
        "the surface is deflected by point forces at the patch centres: no average over the patch",
        SCALARS,
        Edit(
            "semianalytic.halfspace:surface_deflection",
            "corner = _potential_corner(X[:, None], Y[None, :], np.asarray(depth))",
            "x, y = np.arange(nx)[:, None] * dx, np.arange(ny)[None, :] * dy; "
            "V = dx * dy / np.sqrt(x**2 + y**2 + depth**2 + 1e-2 * dx * dy); "
            "return V; "
            "corner = None",
        ),
    ),
    fault(
        "no_patch_averaging_stress",
        "stresses near the surface are those of constant patches, not averaged over the pressure between",
        STRESS,
        Edit(
            "semianalytic.interpolation_kernel:near_influence",
            "_block_of_rectangle(rectangle, dx, dy, z)",
            "rectangle(*np.meshgrid(np.arange(-BLOCK, BLOCK + 1) * dx, np.arange(BLOCK + 1) * dy, "
            'indexing="ij"))',
        ),
    ),
    fault(
        "half_patch_shift",
        "the patches of the surface kernel are counted from their corners",
        SCALARS,
        Edit(
            "semianalytic.halfspace:surface_deflection",
            "X = (np.arange(nx + 1) - 0.5) * dx",
            "X = np.arange(nx + 1) * dx",
        ),
    ),
    fault(
        "half_patch_shift_stress",
        "the forces below which stresses are found lie half a patch off in x",
        STRESS,
        Edit(
            "semianalytic.nodal_convolution:nodal_forces",
            "Lattice(grid_x[rows[0]] - dx,",
            "Lattice(grid_x[rows[0]] - dx / 2,",
        ),
    ),
    fault(
        "transposed_kernel",
        "the table of the stress kernel is filled with x and y exchanged",
        ("sigma_xx", "sigma_yy"),
        Edit(
            "semianalytic.nodal_convolution:influence_table",
            "influence(a.ravel(), b.ravel())",
            "influence(b.ravel(), a.ravel())",
        ),
    ),
    fault(
        "correlation",
        "the stresses of sliding are correlated with the kernel where they are convolved with it",
        ("sigma_xx", "sigma_xz", "sigma_zz"),
        Edit(
            "semianalytic.nodal_convolution:influence_table",
            "influence(a.ravel(), b.ravel())",
            "influence(-a.ravel(), b.ravel())",
        ),
    ),
    fault(
        "k_zero_zeroed",
        "the response of the layers at k = 0 is set to zero: its image is left out and so is the mean",
        SCALARS,
        Edit(
            "semianalytic.abel:layer_table", "* excess(k))", "* np.where(k < 0.05 / thickness, 0, excess(k)))"
        ),
    ),
    fault(
        "k_zero_zeroed_stress",
        "the transforms of the stress response leave out its value at k = 0",
        STRESS,
        Edit("semianalytic.hankel:_at_zero", "return F_0, slope / unit", "return 0 * F_0, slope / unit"),
    ),
)
