"""Worlds: their files, the random generator, and Upsilon (what the robot believes is there)."""
