"""`python -m dcg_torch.convert`: scenes and commands of others, as files of ours."""

from __future__ import annotations

import sys

from dcg_torch.cli.convert import main

__all__ = ["main"]

if __name__ == "__main__":
    sys.exit(main())
