"""`python -m dcg_torch.evaluate`: ground the commands of episode files."""

from __future__ import annotations

import sys


def main() -> int:
    """Run the command line; the exit status. All else is loaded here, so that Ctrl-C in this time is one line."""
    try:
        from dcg_torch.cli.commands import start
    except KeyboardInterrupt:
        print("dcg_torch: interrupted", file=sys.stderr)
        return 130
    return start("evaluate", sys.argv)


if __name__ == "__main__":
    sys.exit(main())
