"""Algorithm 1 over a robot: look, ask, act."""
