"""A ROS 2 node around the model: commands, percepts and a pose come in as messages, goal poses and words go out.

Conventions: metres and radians in one world frame with z up. A stamp is an int of nanoseconds of the robot's clock, 0
where it is not said. Only `messages`, `node` and `simulated` import ROS.
"""
