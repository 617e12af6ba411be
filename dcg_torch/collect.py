"""`python -m dcg_torch.collect`: the same as `dcg-torch collect`."""

from __future__ import annotations

import sys

from dcg_torch.cli.commands import start

if __name__ == "__main__":
    sys.exit(start("collect", ["python -m dcg_torch.collect", *sys.argv[1:]]))
