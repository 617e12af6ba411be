"""Trials of Algorithm 1: their plan, the processes that run them, and the folder in which they leave their lines."""
