"""`python -m dcg_torch [overrides]`, and `python -m dcg_torch COMMAND ...`; see `cli.commands`."""

import sys

from dcg_torch.cli.commands import main

if __name__ == "__main__":
    sys.exit(main())
