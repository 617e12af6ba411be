"""`python -m dcg_torch.evaluate`: ground the commands of episode files."""

from __future__ import annotations

import sys

from dcg_torch.cli.evaluate import main

__all__ = ["main"]

if __name__ == "__main__":
    sys.exit(main())
