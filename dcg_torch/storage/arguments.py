"""The options of a program; a wrong one is a line and exit status 2, like all that a user has to mend."""

from __future__ import annotations

import argparse
from typing import NoReturn

from dcg_torch.storage.untrusted_files import plain

_LONGEST = 400  # characters of a message


class Arguments(argparse.ArgumentParser):
    """argparse's parser, which says one line where argparse would print the usage as well."""

    def error(self, message: str) -> NoReturn:
        """End the program."""
        self.exit(2, f"dcg_torch: {plain(message, _LONGEST)}; see {self.prog} --help\n")
