"""What goes wrong in the simulator."""

from dcg_torch.storage.errors import UserError


class SimulatorError(UserError):
    """The simulator can't do what was asked; the message is one line."""
