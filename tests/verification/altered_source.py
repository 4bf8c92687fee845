"""A source with some of its answers replaced, so that only what a test changes can matter."""

from dataclasses import replace

from verification.problem.point_answers import Answer, Sampled


class Altered(Sampled):
    """``sound`` with the value of a field, or with "NAME_uncertainty" its uncertainty, replaced.

    changes : change(field, x, y) of the pressure, (field, x, y, z) of the displacement, or with the layer too
    of the stress, field being the sound one as a function of these.   stated : whether it has uncertainties.
    """

    def __init__(self, sound, stated=True, **changes):
        self.sound, self.stated, self.changes, self.frames = sound, stated, changes, sound.frames
        self.coarser = None if sound.coarser is None else Altered(sound.coarser, stated, **changes)
        self.surface_nodes, self.diagnostics = sound.surface_nodes, sound.diagnostics
        self.uncertainty = sound.uncertainty if stated else None

    def sample(self, points, quantity, uncertainty=True):
        """Answer of the sound source, changed."""
        answer = self.sound.sample(points, quantity, uncertainty and self.stated)
        parts = [self._changed(k, answer[k], points, quantity) for k in (0, 1)]
        return Answer(*parts)

    def _changed(self, k, sound, points, quantity):
        change = self.changes.get(quantity + ("", "_uncertainty")[k])
        if change is None or sound is None:
            return sound
        names = {"pressure": ("x", "y"), "displacement": ("x", "y", "z"), "stress": ("x", "y", "z", "layer")}

        def field(*place):
            given = dict(zip(names[quantity], place, strict=False))
            return self.sound.sample(replace(points, **given), quantity)[k].copy()

        return change(field, *(getattr(points, name) for name in names[quantity]))
