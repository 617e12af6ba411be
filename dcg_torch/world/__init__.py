"""Worlds: their files, the random generator, and the speakers, who give commands in them."""
