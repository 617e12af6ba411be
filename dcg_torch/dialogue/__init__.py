"""A conversation with a robot: what a person's text does, what the robot answers, and the session as a file.

A page or a terminal sends inputs to a `session.Session` and shows its `events`. Nothing here knows of either.
"""
