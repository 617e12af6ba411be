"""`python -m dcg_torch.talk`: a page in the browser to talk to the robot, watch it and teach it."""

from __future__ import annotations

import sys

from dcg_torch.cli.commands import start

if __name__ == "__main__":
    sys.exit(start("talk", ["python -m dcg_torch.talk", *sys.argv[1:]]))
