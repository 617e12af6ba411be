"""Algorithm 1's loop over a robot: one command, and a trial of many."""
