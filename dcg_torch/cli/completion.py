"""`dcg-torch completion bash|zsh`: what a shell completes, as a script for it to read.

source <(dcg-torch completion bash)
"""

from __future__ import annotations

import enum
import sys
from collections.abc import Iterator

from dcg_torch.cli.commands import COMMANDS
from dcg_torch.cli.settings_help import SCHEMAS
from dcg_torch.settings import described
from dcg_torch.storage.arguments import Arguments
from dcg_torch.storage.resources import resource

_SCRIPT = """\
_dcg_torch() {{
    local word="${{COMP_WORDS[COMP_CWORD]}}" words
    if [ "$COMP_CWORD" -eq 1 ]; then words="{commands}"
    else case "${{COMP_WORDS[1]}}" in
{cases}
        *) words="" ;;
    esac; fi
    COMPREPLY=($(compgen -W "$words" -- "$word"))
    case "${{COMPREPLY[0]}}" in *=) compopt -o nospace ;; esac
}}
COMP_WORDBREAKS="${{COMP_WORDBREAKS//=/}}"
complete -o default -F _dcg_torch dcg-torch
"""
_GROUPS = {"run": ("experiment", "model", "simulator"), "evaluate": ("model",)}
_ZSH = "autoload -U +X bashcompinit && bashcompinit\n"


def words(program: str) -> Iterator[str]:
    """KEY= for every setting of a program, and KEY=VALUE where the values are few."""
    conf = resource("conf")
    for group in _GROUPS.get(program, ()):
        yield from (f"{group}={path.stem}" for path in sorted((conf / group).glob("*.yaml")))
    for name, default, _, _ in described(SCHEMAS[program]):
        if isinstance(default, enum.Enum):
            yield from (f"{name}={choice}" for choice in type(default))
        elif isinstance(default, bool):
            yield from (f"{name}=true", f"{name}=false")
        else:
            yield f"{name}="
    yield "hydra.run.dir="


def script(shell: str) -> str:
    """The script for a shell, bash or zsh."""
    cases = "\n".join(f'        {program}) words="{" ".join(words(program))}" ;;' for program in SCHEMAS)
    text = _SCRIPT.format(commands=" ".join(COMMANDS), cases=cases)
    return _ZSH + text.replace("compopt -o nospace", ":") if shell == "zsh" else text


def main() -> int:
    """Print the script; the exit status."""
    parser = Arguments(prog="dcg-torch completion", description="Print what your shell completes.")
    parser.add_argument(
        "shell", metavar="SHELL", choices=("bash", "zsh"), help="then: source <(dcg-torch completion SHELL)"
    )
    print(script(parser.parse_args().shell), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
