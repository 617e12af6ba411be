"""`make torture`: kills, pairs of processes, full disks and hostile files, by the hundred. Bounded by `--minutes`.

    python tests/torture [kills] [pairs] [disk] [fuzz] [writers] [soak] [--minutes 30] [--seed 0]
    python tests/torture fuzz --only world,model --inputs 20000 --minutes 60

Prints a line a part and exits with 1 if anything did not hold. The programs run in forks of one process that has
imported all they need, so that their first moments are as likely to be hit as their last.
"""

from __future__ import annotations

import argparse
import functools
import random
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent.parent), str(Path(__file__).parent)]

import disks  # noqa: E402
import fuzz  # noqa: E402
import kills  # noqa: E402
import soak  # noqa: E402
import writers  # noqa: E402

# A part takes a random generator, a folder, and the monotonic time at which it should be done; it says what it found.
PARTS: dict[str, Callable[[random.Random, Path, float], tuple[bool, str]]] = {
    "disk": disks.full_disks,
    "pairs": kills.pairs,
    "kills": kills.kills,
    "fuzz": fuzz.feed_all,
    "writers": writers.fifty_writers,
    "soak": soak.soak,
}


def main() -> int:
    """Run the parts that were asked for, all by default; 0 if all held."""
    parser = argparse.ArgumentParser(prog="python tests/torture")
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"of {', '.join(PARTS)}")
    parser.add_argument("--minutes", type=float, default=28.0, help="for all parts together")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--inputs", type=int, default=fuzz.INPUTS, help="for each reader of fuzz, at the most")
    parser.add_argument("--only", default="", metavar="READER,READER", help="of fuzz; default: all")
    options = parser.parse_args()
    PARTS["fuzz"] = functools.partial(fuzz.feed_all, only=options.only, inputs=options.inputs)
    names = options.parts or list(PARTS)
    until, held = time.monotonic() + 60.0 * options.minutes, True
    for k, name in enumerate(names):
        share = (until - time.monotonic()) / (len(names) - k)
        with tempfile.TemporaryDirectory(prefix="torture_") as folder:
            good, said = PARTS[name](random.Random(options.seed), Path(folder), time.monotonic() + share)
        print(f"{name:<7} {'held' if good else 'BROKE'}: {said}", flush=True)
        held &= good
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
