"""How well commands are grounded in scenes that are seen as a whole: episodes, the protocol, baselines."""
