"""Ranges of the random problems on which the uncertainties were judged."""

RATIO = (0.02, 50.0)  # E_i / E of the substrate, of every coating
THICKNESS = (0.02, 10.0)  # h / a_h, of each coating or of all together
THINNEST = 0.02  # h / a_h of a coating where THICKNESS is that of all together
POISSON = (0.0, 0.49)  # of every layer
FRICTION = (0.0, 0.8)
MOST_COATINGS = 5
# Of problems of thin films alone, under a ball without coatings.
FILM_RATIO = (0.1, 10.0)
FILM_THICKNESS = (0.001, 0.02)  # h / a_h
OVER_INTERLAYER = (0.001, 0.2)  # h / a_h of the outer of two
MOST_FILMS = 2
# Of ellipses on one coating, under bodies with none or one.
ELONGATION = (1.5, 4.0)  # about the ratio of the axes; that of the radii to the power 1.5
CLOSE_RATIO = (0.25, 4.0)  # E1/E2
OF_SHORT_AXIS = (0.1, 2.0)  # h over the short half axis
ELLIPSE_POISSON = (0.1, 0.45)
SLIDING = (0.0, 0.1, 0.3, 0.5)
