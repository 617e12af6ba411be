"""`python -m dcg_torch.evaluate`: ground the commands of episode files."""

from __future__ import annotations

import sys

from dcg_torch.cli.commands import start


def main() -> int:
    """Run the command line; the exit status. The program is loaded here, so that Ctrl-C in this time is one line."""
    return start("evaluate", sys.argv)


if __name__ == "__main__":
    sys.exit(main())
