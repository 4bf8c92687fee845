"""Every number that the finite element method chose, with what it trades and where it comes from.

A number without a source was chosen by measurement: `python tests/tools trade NAME VALUES` solves random
contacts with each of the values and shows the largest errors against the exact reference and the time.
Sizes of triangles are lengths in the stretched plane of `meridian_mesh` unless said otherwise.
"""

# --- uncertainty: coverage against width
COARSER = 1.4  # size of the triangles of each mesh of a family over that of the next finer one
EDGE_COARSER = 4.0  # the same of the last triangles at the edge: what these miss goes with the root
# Roache's factor of safety for an order that is not relied on, J. Fluids Eng. 116 (1994) 405-413; 1.1 was
# needed in 17 random problems.
SAFETY = 3.0
RINGS = 3  # of triangles around a point, or cells of a line on either side, within which changes count
# Of a stress over the peak pressure: rounding deep in a stack, 4e-8 against the exact reference.
ROUNDING = 1e-7
# The displacement of the field is part of the uncertainty within this distance of the edge over the radius.
STRIP = 0.3

# --- sizes of triangles: errors against time
# Size of a triangle over its distance from the contact edge; all other sizes follow from it.
QUALITY = {"fast": 0.27, "default": 0.15, "fine": 0.1}
# The same where a layer is stiffer than the next below by more than this factor: it bends like a plate, whose
# stresses exceed the pressure. Under a compliant layer errors are below those of bare steel at the same size.
CONTRASTS = {
    10.0: {"fast": 0.17, "default": 0.12, "fine": 0.1},
    100.0: {"fast": 0.15, "default": 0.1, "fine": 0.085},
}
# Sizes over that one: in the fan around the edge, at the point of first contact, far away and in coatings.
FAN_SIZE, AXIS_SIZE, FAR_SIZE = 1.4, 0.65, 2.7
# Largest sizes in the fan, far away and in coatings. A film of one row of triangles as high as the last makes
# the contact too stiff by up to 1e-5.
LARGEST_IN_FAN, LARGEST_FAR, LARGEST_IN_FILM = 0.6, 0.7, 0.47
ROWS = 2.6  # of triangles across a coating next to the contact
# Films buried at many times their thickness are left to flat triangles: least height of a row over the size.
LEAST_ROW = 0.25
EDGE_SIZE = 1e-7  # smallest triangle, at the contact edge, over the contact radius
# Size of a triangle in the fan: this power of its distance from the edge. What the innermost triangles miss
# counts as the root of the distance.
FAN_POWER = 0.94
# Sizes are uniform to this depth over the contact radius, then grow by this share a unit; to the depth of all
# coatings, then more slowly, since a stack bends beyond its own depth.
UNIFORM_DEPTH, GROWTH = 2.0, 0.6
# Growth of sizes with the distance from the point of first contact and from a coating.
AXIS_GROWTH, FILM_GROWTH = 0.3, 0.4
# Above this Poisson ratio flat triangles in a film lock far from the contact: at 0.4999 the approach erred by
# 2.4 times its uncertainty until the largest were this share of those of other films.
INCOMPRESSIBLE, NARROWER = 0.495, 0.64

# --- sizes on a surface that is divided evenly, under a pressure that is not round
SURFACE_BELOW, SURFACE_BEYOND = 0.2, 0.5  # growth in depth and beyond the contact
# The size at an edge of the pressure, and its growth with the distance, over the size elsewhere; the same
# growth on interfaces, where 11 errs by 8e-4 p_h.
SURFACE_LEAST, SURFACE_RATE, BURIED_RATE = 1 / 24, 11.0, 7.5

# --- the contact radius: time
# Size and rows of the first mesh. One row in a coating gives the radius to 1e-5, from where one solve on the
# next is enough.
FIRST_SIZE, FIRST_ROWS = 0.5, 1.0
# Tolerances of the load. Those of coarser meshes count in the estimate. The final mesh meets its own by one
# solve, then moves with its edge to the load itself.
FIRST_LOAD, COARSE_LOAD, FINAL_LOAD = 1e-3, 1e-5, 3e-8
MOST_SOLVES = 30  # of the contact on one mesh, then ElementsNotConverged
STRETCH = 1.3  # largest factor by which radii are stretched before a new mesh is generated
NO_DISC = 1e-3  # penetration over the approach, or tension over the peak, from which a contact is no disc

# --- beside the contact edge: errors of stresses there
# Distances from the edge over EDGE_SIZE times the radius: the series replaces the strains below the first and
# is fitted from there to the second.
EDGE_SERIES = 20.0, 5000.0
# The growth of the contact is fitted this much farther from the edge than stresses: where the displacement of
# the edge by its last triangles does not count. It is good to 1e-4 on a coarse mesh, in place of 5e-3.
FARTHER = 100.0
# A point this close to a jump of a prescribed pressure, over the radius of the load, has no value.
AT_SINGULAR = 1e-8

# --- linear algebra and search: time alone
TRIANGLES_AT_ONCE = 512  # whose matrices are made together: more take longer, for fresh memory
COLUMNS_AT_ONCE = 32  # of right-hand sides: all at once take twice as long, for fresh memory
# Of conjugate gradients on a factor in single precision: 8 in most solids, more where moduli differ by 1000.
MOST_STEPS = 30
# Triangles whose centroids are nearest: most points lie within one of a few, those on edges need more.
NEAREST, NEIGHBOURS = 4, 12
# Smallest radius over the contact radius: u/r on the axis is the limit from outside, exact to its square.
AXIS_RADIUS = 1e-7

# --- what is refused
MAX_COATINGS = 50
MAX_CONTRAST = 1e9  # of a coating and the substrate; digits are lost in proportion
# Of a coating over a_h: the mesher and the search for triangles fail beyond.
MIN_THICKNESS, MAX_THICKNESS = 1e-4, 1e4
LARGEST_RADIUS = 0.9  # of the contact over that of the sphere
LARGEST_STEP = 1e-4  # of a given pressure at one radius, over its mean magnitude: what is less is no jump
SMALLEST_SIZE, LARGEST_SIZE = 0.08, 0.5  # a minute and gigabytes; coarse
