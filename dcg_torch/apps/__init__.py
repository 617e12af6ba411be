"""Programs around the model, each with an extra of its own; nothing below knows of them."""
