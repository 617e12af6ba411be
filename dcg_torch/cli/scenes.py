"""`dcg-torch scenes FILE`: scenes and commands made by a program, as an episode file to certify with."""

from __future__ import annotations

from pathlib import Path

from dcg_torch.cli.application import one_line_errors
from dcg_torch.evaluation.made_scenes import made_episodes
from dcg_torch.storage.arguments import Arguments
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.errors import UserError

_MOST = 100_000


def main() -> int:
    """Run the command line; the exit status."""
    parser = Arguments(prog="dcg-torch scenes", description="Make scenes with commands that we wrote, to certify with.")
    parser.add_argument("file", metavar="FILE", type=Path, help="the episode file to write")
    parser.add_argument("--episodes", metavar="N", type=int, default=300, help="default: 300")
    parser.add_argument("--seed", metavar="N", type=int, default=0, help="default: 0")
    with one_line_errors(goes_on="the same command begins anew"):
        options = parser.parse_args()
        for name, given, low in (("episodes", options.episodes, 1), ("seed", options.seed, 0)):
            if not low <= given <= _MOST:
                raise UserError(f"--{name} {given}: give a number from {low} to {_MOST}")
        made = made_episodes(options.episodes, options.seed)
        lines = (e.model_dump_json(exclude_none=True, exclude_defaults=True) for e in made)
        print(write_whole(options.file, "".join(f"{line}\n" for line in lines)))
    return 0
