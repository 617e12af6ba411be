"""What goes wrong in the simulator."""


class SimulatorError(RuntimeError):
    """The simulator can't do what was asked; the message is one line."""
