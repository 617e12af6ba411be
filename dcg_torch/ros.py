"""`python -m dcg_torch.ros`: a ROS 2 node around the model."""

from __future__ import annotations

import sys

from dcg_torch.cli.commands import start

if __name__ == "__main__":
    sys.exit(start("ros", ["python -m dcg_torch.ros", *sys.argv[1:]]))
