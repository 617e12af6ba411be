"""`dcg-torch pretrain`: makes the shipped model anew from what is in the repository (`make pretrain`)."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from dcg_torch.cli.application import one_line_errors
from dcg_torch.lessons import initial_training
from dcg_torch.model.checkpoint import DESCRIPTION, WEIGHTS, save
from dcg_torch.model.pretrain import LESSONS, SHIPPED, train_open_world
from dcg_torch.storage.arguments import Arguments
from dcg_torch.storage.claim import claim
from dcg_torch.storage.errors import UserError

_MOST = 100_000


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit status."""
    parser = Arguments(prog="dcg-torch pretrain", description="Make the shipped model anew.")
    parser.add_argument("--out", metavar="DIR", type=Path, default=SHIPPED, help="the folder; default: the package's")
    parser.add_argument("--lessons", metavar="N", type=int, default=LESSONS, help=f"generated; default: {LESSONS}")
    with one_line_errors(goes_on="the same command begins anew"):
        options = parser.parse_args(arguments)
        if not 0 <= options.lessons <= _MOST:
            raise UserError(f"--lessons {options.lessons}: give a number from 0 to {_MOST}")
        with claim(options.out, (WEIGHTS, DESCRIPTION), setting="--out"):
            save(train_open_world(initial_training(), lessons=options.lessons), options.out)
        size = sum((options.out / name).stat().st_size for name in (WEIGHTS, DESCRIPTION))
        print(f"{options.out}: {size / 1e6:.2f} MB", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
