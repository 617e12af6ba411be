"""Watching a trial: what happens is recorded as plain values, and drawn afterwards, so that no trial notices."""
