"""Which thickness, which load: strengths, failure modes, their probabilities."""
