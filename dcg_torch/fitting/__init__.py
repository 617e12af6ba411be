"""The log-linear factor Psi and its fit: design matrices, the smallest problem of the same optimum, solvers.

What the columns mean is not known here: rows are labelled factors over column numbers.
"""
