"""Every number that the finite element method chose, with what it trades and where it comes from.

A number without a source was chosen by measurement: `python tests/tools trade NAME VALUES` solves random
contacts with each of the values and shows the largest errors against the exact reference and the time. Those
of contacts that are not round are measured by the file under tests/fem_reference in brackets.
Sizes of triangles are lengths in the stretched plane of `meridian_mesh` unless said otherwise.
"""

# --- uncertainty: coverage against width
COARSER = 1.4  # size of the triangles of each mesh of a family over that of the next finer one
EDGE_COARSER = 4.0  # the same of the last triangles at the edge: what these miss goes with the root
# Roache's factor of safety for an order that is not relied on, J. Fluids Eng. 116 (1994) 405-413; 1.1 was
# needed in 17 random problems. Also for two meshes of a contact that is not round.
SAFETY = 3.0
RINGS = 3  # of triangles around a point, or cells of a line on either side, within which changes count
# Times as much on the axis, where integrals in r dr hold the fields least; under contacts that are not round
# less and less to this part of the unit of length [test_shaped_contact], on planes of round ones on the
# axis alone: 1.7 was needed in some 900 random problems.
AXIS_SAFETY = 2.25, 0.15
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
# Smallest triangle, at the contact edge, over the contact radius. Places nearer to each other coincide: with
# the axis, where u/r is the limit from outside, exact to its square; over a triangle, with an interface. An
# edge that moves less is at rest.
EDGE_SIZE = 1e-7
# Distance from a jump of a prescribed pressure, over the radius of the load, within which it has no value.
AT_SINGULAR = 1e-8
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

# --- contacts that are not round: meshes
# Size of the triangles, of those on the surface, harmonics, degree of the polynomial in the pressure over the
# number of waves around, which counts as 2 at least. [test_shaped_contact]
SHAPED_QUALITY = {"fast": (0.5, 0.12, 120, 4), "default": (0.44, 0.045, 240, 6), "fine": (0.4, 0.035, 288, 6)}
# A higher degree, to twice that, is taken where it leaves the edge less uncertain; so many worse ones in turn
# end the search.
WORSE = 2
# Size, that on the surface, harmonics and margin of the mesh that tells how far a contact reaches, and the
# degree there. [test_shaped_contact]
ROUGH_GRID, ROUGH_DEGREE = (0.6, 0.16, 36, 1.3), 4
SHAPED_AXIS = 0.3  # triangles at the axis over those elsewhere [test_off_axis]
# Of the contact up to the last node below the pressure, and as much before the first. [test_shaped_contact]
MARGIN = 1.04
# Times the number of waves as wide as the contact at its end on y = 0, as deep inside as the triangles there,
# are the harmonics of a contact with pointed ends. [test_shaped_contact]
AT_END = 5.0

# --- contacts that are not round: harmonics [test_off_axis]
DIRECT = 8  # harmonics below are solved one by one
# What is left of a harmonic m >= 2, which falls as the power m + 1 of the distance from the axis in contact
# radii, where it is taken as zero
VANISHED = 2e-6
# Nodes of the mesh times solutions, for memory and time. Films of a hundredth of a long contact need more.
MOST_KEPT = 8e5
# Points of the interpolation beyond for a factor e of m: 5 change no stress by 1e-5 p_h, 2.8 by 2e-3.
DENSITY = 3.1
FULL = 0.4  # of the harmonics count in full in a stress, those beyond ever less
# Distances from an edge, over the triangles there, between which the series beside it is fitted, and within
# which it is used; its half powers, and as many to see what they add.
BESIDE_EDGE, WITHIN, HALVES = (1.2, 16.0), 2.5, (3, 2)
RADIAL = 6  # points of quadrature between two vertices of the surface
ANGULAR = 24, 1.6  # points on an arc inside the contact: some, and more for each harmonic
ARC_SAMPLES = 256  # on half a circle, between which an arc begins or ends

# --- contacts that are not round: contour and pressure [test_shaped_contact]
# Power of the root in the conditions: elements miss int p u dA by h^((WEIGHT + 5)/2) along an edge
WEIGHT = 5
MORE, FIRM = 4, 1e3  # degree of the conditions beyond that of the pressure; weight of the load
CORRECTING = 160  # of the harmonics, that correct the pressure: 96 leave 1e-3 of it beside pointed ends
# Length over width, beyond which the triangles on the surface are smaller and more harmonics correct the
# pressure: 16 : 1 has no contour at rest without.
SLENDER = 5.0
LARGEST_MOVE = 0.2  # of the edge in one step
# Change of the edge on the rough mesh in the last step, and the most elsewhere in a step that was the last.
EDGE_CLOSE = 1e-4
# Of the peak, a negative pressure, and of the approach, a penetration: what elements may err by
ALLOWED = 3e-3

# --- contacts that are not round: uncertainty [test_shaped_contact]
SHAPED_COARSER = 1.3  # triangles of the companion over those of the mesh
# Times the change of fields from the companion, with the order that is observed beside edges; and that of the
# pressure and the scalars by the last degree.
OF_FIELDS = 2.0
# What lies beyond the last harmonic, over what the last third of them adds: of the deflection, whose terms
# fall as m^-5/2, of the stress, m^-3/2, and alternate in sign but at the edge.
BEYOND = 0.5, 1.0
STIFF = 1e-5  # of the approach, by elements of the default size; the change from the companion may vanish
RESOLVED = 1 / 8  # of an element's width, within which a pressure is smeared
# Per cent of points below the contact whose stress changes less from the companion; points by radius, angle
# and depth.
TYPICAL, TYPICAL_POINTS = 97, (8, 3, 7)

# --- the contact radius: time
# Tolerances of the load. Those of coarser meshes count in the estimate. The final mesh meets its own by one
# solve, then moves with its edge to the load itself.
FIRST_LOAD, COARSE_LOAD, FINAL_LOAD = 1e-3, 1e-5, 3e-8
STRETCH = 1.3  # largest factor by which radii are stretched before a new mesh is generated
NO_DISC = 1e-3  # penetration over the approach, or tension over the peak, from which a contact is no disc

# --- beside the contact edge: errors of stresses there
# Distances from the edge over EDGE_SIZE times the radius: the series replaces the strains below the first and
# is fitted from there to the second.
EDGE_SERIES = 20.0, 5000.0
# Its powers of the distance; a displaced edge adds the power -1/2, which is fitted and left out.
EDGE_POWERS = -0.5, 0.5, 1.0, 1.5, 2.0
# The growth of the contact is fitted this much farther from the edge than stresses: where the displacement of
# the edge by its last triangles does not count. It is good to 1e-4 on a coarse mesh, in place of 5e-3.
FARTHER = 100.0

# --- linear algebra and search: time alone
TRIANGLES_AT_ONCE = 512  # whose matrices are made together: more take longer, for fresh memory
COLUMNS_AT_ONCE = 32  # of right-hand sides: all at once take twice as long, for fresh memory
# Of any search, which then has failed: contacts on one mesh, edges that close a gap, wider rough meshes; of
# conjugate gradients on a factor in single precision, 8 in most solids, more where moduli differ by 1000.
MOST_STEPS = 30
# Triangles whose centroids are nearest: most points lie within one of a few, those on edges need more.
NEAREST = 4

# --- what is refused
MAX_COATINGS = 50
MAX_CONTRAST = 1e9  # of a coating and the substrate; digits are lost in proportion
MAX_THICKNESS = 1e4  # of a coating over a_h, or a_h over it: mesher and search for triangles fail beyond
LARGEST_RADIUS = 0.9  # of the contact over that of the sphere
LARGEST_STEP = 1e-4  # of a given pressure at one radius, over its mean magnitude: what is less is no jump
# A minute and gigabytes; coarse, also of the first mesh: with one row in a coating it gives the contact
# radius to 1e-5, from where one solve on the next is enough.
SMALLEST_SIZE, LARGEST_SIZE = 0.08, 0.5
