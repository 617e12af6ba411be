"""Programs around the model, each an extra and each thin."""
