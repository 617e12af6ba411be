"""Programs around the model for people and other systems: each an extra, and nothing else knows of them."""
