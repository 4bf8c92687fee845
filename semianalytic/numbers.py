"""Every number that the semi-analytical method chose: what it trades, and what measures it again.

Each stands below its unit and what it trades. In brackets: a source, or the command that shows the effect of
another value, with "problems" for ``python tests/tools calibrate`` (errors over U on random
problems), "bench" for ``python tests/tools bench`` (time), else a file under ``tests/semianalytic``.
"""

# ----------------------------------------------------------------------------------------- coefficients
# Sides of a patch beyond which a series replaces the closed form; where their errors cross.
# [test_halfspace]
FAR_SIDES = 25.0
# Points of the logarithmic grid of Hankel transforms, usual and long, and the ratio of its ends, usual:
# more points cost time, a longer grid holds films that stretch over more than 1e4 of their scale.
# [test_hankel]
HANKEL_POINTS, HANKEL_LONG, HANKEL_SPAN = 1500, 1929, 3e10
# Its bias for each order, of F and of F/k: balances the truncation errors at both ends. [test_hankel]
HANKEL_BIAS = (0.7, 0.25, 0.0, 0.0)
HANKEL_BIAS_OVER_K = (0.25, 0.0, -0.25, -0.25)
# r over the scale, nearer than which a power series of J_m replaces the grid, its terms, and the radii
# tabulated there: the rest is below 0.1^16. [test_hankel]
NEAR_AXIS, NEAR_AXIS_TERMS, NEAR_AXIS_RADII = 0.1, 8, 60
# Patches from the nearest singularity, beyond which differences average a patch. [test_influence]
AVERAGED = 12.0
# Points of the spline of the compliance: to rounding at any ratio of moduli. [test_frf]
COMPLIANCE_SAMPLES = 2000
# Of the compliance, below which the layers no longer reflect; error of the quadrature over a patch, relative
# to the value at its centre, which sets its order. [test_influence]
NEGLIGIBLE = 1e-12

# ----------------------------------------------------------------------------------------- patches
# Patches a side of the coarsest grid that is solved. [problems]
COARSEST = 33
# Residual on a fixed contact set, over the first one, at which the set is updated, iterations after which it
# is in any case, and updates after which it follows the signs of p and g: fewer let the set oscillate.
# [bench]
RESIDUAL_FALL, ITERATIONS_PER_SET, PREDICTED_UPDATES = 0.5, 3, 12
# Iterations after which the residual is cut off at the edge, and after which the preconditioner is that of
# a half-space: for contacts that the other misleads. [bench]
EXTENDED_ITERATIONS, PRECONDITIONED_ITERATIONS = 10, 100
# Change of the pressure by a further step, over its peak and the tolerance, beyond which the iteration goes
# on: 1e-6 of the peak. On a stiff film that it hardly bends 2e-5 was left. [problems]
LEFT = 1e3
# Patches over which the residual is extended beyond the contact, and share of contact in the mean below
# which it fades; cut off at the edge it would take twice the iterations. [bench]
EXTENSION, FADED_RESIDUAL = 2.0, 0.1
# Points of a transform, below which a second thread gains nothing. [bench]
SHARED = 3 * 2**17
# Of the patches a side, over those of the grids of a refinement study; of patches alone. [problems]
REFINED, HALVED = (2.0, 1.4, 1.0), (4.0, 2.0, 1.0)
# Steps to the lowest point between the patches, off by 1e-4 of the height over a patch. [test_nested]
HALVINGS = 6
# Of the approach, by which patches of twice the side may miss the deflection beside a contact.
# [test_nested]
BESIDE_WINDOW = 1e-3
# Change of a given pressure at one radius, over its largest magnitude, that is a jump. [test_prescribed]
JUMP = 1e-4
# Half-width of the grid over the contact radius: room for the set to change. [bench]
FILL = 1.12
# Half-width of the first grid under an indenter that is no sphere, over Hertz's radius.
# [test_long_contacts]
WIDER_SHAPE = 2.0
# Patches a side of the grid that finds the contact, and its half-width over the radius. [bench]
ROUGH, ROOMY = 49, 1.5
# Contact radius over that of the sphere, beyond which the problem is not one of small strains. [the model]
LARGEST = 0.9
# Length over width, beyond which a contact has more patches. [test_long_contacts]
LONG = 8.0
# Patches that tell a width: across a contact on the rough grid, in a for a harmonic or a polynomial of its
# shape; and fewer than which across a contact are no answer. [test_long_contacts]
PATCHES_A_WIDTH, RESOLVED_WIDTH = 4, 12
# Patches a side of the next grid over the last, where the accuracy asked is not met, half of those of grids
# that only give the start, and the box that tests the domain over the box in use. [problems]
FINER = 1.4
# Patches a side of the last for ``accuracy``, half of them where refining no longer helps, and of contacts
# that are no disc or at neighbouring loads: time and memory. [bench]
LARGEST_GRID, BESIDE_GRID = 2801, 513
# Steps of the load to the contacts that give the stiffness, the share of their extrapolation's change that
# is its uncertainty (0.31 was needed), times as many iterations, and the relative error of an approach that
# two grids may share. [problems]
STEPS, OF_STEP, FURTHER, SHARED_NOISE = (0.05, 0.1), 0.5, 8, 2e-7

# ----------------------------------------------------------------------------------------- smooth edge
# Rounds of fit and contact at most, those from patches alone in which the edge is held, and the movement of
# the edge, in patches, that is the last. At 5e-4 the pressure was left 1e-7 off all over the contact, which
# no difference between grids shows; a round costs a tenth of the time. [problems]
ROUNDS, HELD_ROUNDS, STILL = 10, 2, 2e-5
# Share of the first step of a fit that is taken: rounds would oscillate. [test_smooth_edge]
DAMPING = 0.8
# Patches by which the pressures near a smooth edge may miss its shape, and the edge pass the centre of a
# patch; in the first rounds. [test_smooth_edge]
MISFIT, COARSE_MISFIT = 0.3, 2.0
# Of the load, the most that patches may miss; of the peak, the most that the shape may miss inside:
# ellipses 3e-5, a kink of the indenter's slope 0.1. [test_smooth_edge]
LOST, INNER_MISFIT = 0.2, 3e-3
# 1 - (r/a)^2, beyond which a difference of patches and shape is the shape's own, not of the edge; as far
# outside the contour is an ellipse. [problems]
FAR_INSIDE = 0.6
# Of the peak, that the patches differ from the shape inside before the difference counts.
# [test_smooth_edge]
RIPPLE = 3e-4
# Polynomials of an uncoated body; of a layer, the second for each of asinh(1/e); near the edge alone.
# [problems]
FEWEST_TERMS, LAYERED, OUTER_TERMS = 3, (6.0, 4.6), 6
# Patches in a of the coarsest of three default grids, beyond which one 1.4 times as fine has a polynomial
# more, so that the change on refining holds what they leave out; polynomials for each sqrt(patches in a times
# e asinh(1/e)), where 2 did not converge under stacks. [problems]
USUAL_RADIUS, RESOLVED_TERMS = 57, 1.75
# e over h/a: 4 is best for one coating, 8 for a stack; and e beyond which a layer does not matter.
# [problems]
LAYER, THICK = 7.0, 100.0
# Harmonics of contacts that are round; even in x and in y, the last for the ends of a long ellipse on a stiff
# film; even in y, beside its mirror image; even in y. [test_long_contacts]
ROUND, EVEN, HALF = (0,), (0, 2, 4, 6, 8, 10, 12), (0, 1, 2, 3, 4, 5, 6, 7, 8)
ACROSS = (0, 1, 2, 3, 4, 6, 8, 9, 10, 12)
# The highest harmonic of a shape fitted to few patches alone. [test_long_contacts]
LOW_HARMONICS = 6
# Patches in a, below which the edge is not resolved, and below which the next grid tries anew. [problems]
NARROW_EDGE, FEW_PATCHES = 5, 32
# t over which a pressure fitted near the edge alone fades to the inside; largest change of an axis in a fit.
# [test_smooth_edge]
FADED_INSIDE, WIDEST = (0.15, 0.4), 0.3
# Patches from the edge, nearer than which the column of the edge, infinite there, is constant. [problems]
BLUNT = 0.7
# Of a patch a side, odd: the approach errs by 4e-8, 1e-8, 1e-9 with 15, 25, 41, the pressure next to the
# edge by a fifth of what it did with 15. [problems]
PARTS = 25
# Points a side of a patch between which f^2 is interpolated: its error is below that of the parts.
# [test_smooth_edge]
SQUARE_NODES = 5
# Depth in contact to which patches are integrated by parts, and patches within which the deflection is that
# of the parts, beyond which it is that of their moments. [test_smooth_edge]
PARTED, NEAR_PARTS = 3, 4

# ----------------------------------------------------------------------------------------- fields
# Patches, above which depth a node is no point force: aliases exp(-6 pi); and from it, beyond which its
# sixth moment contributes 1e-5 of the pressure. [test_patch_field]
SHALLOW, NEAR_NODE = 3.0, 6
# Depth over lattice spacing: interpolation through ten sites errs by 1e-8 of p_h. [test_nodal_convolution]
SITES_A_DEPTH = 12.0
# Sites for which direct summation is faster than Fourier transforms. [bench]
FEW_SITES = 32
# Columns of sites for which one transform along x each is faster than one in the plane. [bench]
COLUMNS = 10
# Forces a side from which distant ones are gathered on the lattice of 2^GATHERED times the spacing; distance
# in it from which forces are distant, width of the change: 5e-7 of the sum. [test_nodal_convolution]
WIDE, GATHERED = 400, 3
SPLIT, BLEND = 18.0, 3.0
# Tables of point forces that a body keeps, of up to 14 depths and 9 MB each. [bench]
KEPT_TABLES = 4
# Chebyshev depths within an octave of the reach: 10 leave 1e-6 of p0. [test_subsurface]
DEPTHS = 14
# Angles at which a contour that is no circle is sampled, and a ring around a point. [test_smooth_edge]
AROUND, RING = 128, 96
# Steps of bisection, then of the Illinois method, to where a ring crosses the edge: within 1e-9.
# [test_subsurface]
CROSSING = 6, 9
# Points of a ring within a node and on a panel of rings: 2e-6 of the field of unit pressure.
# [test_patch_field]
NODE_POINTS = 64, 32
# Numbers held at once that fit the processor's cache. [bench]
CACHE = 12_000
# Relative differences of places that are none. [rounding]
ROUNDING = 1e-9

# ----------------------------------------------------------------------------------------- uncertainty
# Roache's factor with an order observed on three grids. [J. Fluids Eng. 116 (1994) 405-413]
SAFETY = 1.25
# Orders: of patches under a smooth edge; of patches alone, and of a shape that is
# fitted near the edge alone. [problems]
ORDERS = (2.0, 1.0)
# Share of the distance to the edge within which the largest change of a field counts; patches of it at
# least. [problems]
NEIGHBOURHOOD, LEAST_NEIGHBOURHOOD = 0.5, 2.0
# Of approach and peak pressure under a smooth edge, times (d/a)^2: what patches leave of the deflection.
# [test_long_contacts]
SECOND = 1e-3
# Patches from a smooth edge, nearer than which they are cut by it. [problems]
CUT = 1.5
# Patches between centre and edge, below which an edge on a film within ``NARROW_EDGE`` patches is no better
# known than a staircase: on 15 patches it was off by 0.2 of one. [test_semianalytic_solver]
FEW_FOR_EDGE = 24
# Distances from the edge at which changes of a field are sampled, and depth in contact radii. [problems]
TABLE, DEEPEST = 16, 8.0
# Error of a field over the peak pressure: on rings; by patches, above 4 of them and below.
# [test_subsurface]
RINGS, BY_PATCHES = 3e-9, (5e-6, 5e-7)
# Patches from the edge, beyond which stresses change in proportion to its radius. [problems]
NEAR_EDGE = 8.0
# Fall of the uncertainty on refining twice that makes a larger grid worth its time; and of the ripple, or
# of the change of the pressure, that shows that a grid is the first to resolve the edge. [problems]
FALL, SUDDEN = 3.0, 0.1
