"""The factor graph of a command in a world: features, the log-linear factor Psi and its fit, the search for phi*."""
