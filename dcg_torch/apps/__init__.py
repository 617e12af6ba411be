"""Applications around the model; each needs an extra of its own, and nothing below knows of them."""
