"""Experiments: trials of Algorithm 1, the processes that run them, and the folder in which they leave their lines.

plan     the worlds, commands and random numbers of a trial
factory  settings -> model, how it explores and asks
robots   settings -> robot
trial    Algorithm 1 over a list of commands, a record for each
folder   the names in a run folder, and what of it is whole
journal  the lines of all trials in one file
pool     processes that work off a list of tasks
backends the same over joblib's backends: loky, Ray, Dask
worker   what such a process does with a trial
runner   an experiment: the trials that are not finished yet
outcome  figures, curves and summary of a finished one
recording what happens in a trial as plain values, and as an animation
"""
