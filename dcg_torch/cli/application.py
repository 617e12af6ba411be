"""From errors to one line on standard error and an exit status: 0 done, 2 wrong input, 130 interrupted."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from pathlib import Path
from types import FrameType

from hydra._internal.utils import get_args_parser

from dcg_torch import __version__
from dcg_torch.cli.config import CONFIG_ERRORS, explain, refuse_nothing, register
from dcg_torch.report.terminal import CLOSED, close_output, open_closed
from dcg_torch.storage.errors import UserError, explain_os_error
from dcg_torch.storage.untrusted_files import plain

_LONGEST = 1_000  # characters of a message
GOES_ON: ContextVar[str] = ContextVar("GOES_ON", default="")
"""How to go on after an interruption, where `one_line_errors` was not told; a sweep says it for all its jobs."""


class Stopped(KeyboardInterrupt):
    """The process was asked to end by a signal other than Ctrl-C."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number


def refuse(message: str, directory: Path | None = None) -> int:
    """Say what is wrong, in one line; the exit status. A folder that was made for nothing goes away."""
    with contextlib.suppress(OSError):
        print(f"dcg_torch: {plain(' '.join(message.split()), _LONGEST)}", file=sys.stderr, flush=True)
    if directory is not None:
        with contextlib.suppress(OSError):
            directory.rmdir()  # only if it is empty
    return 2


@contextlib.contextmanager
def one_line_errors(directory: Path | None = None, goes_on: str = "", program: str = "run") -> Iterator[None]:
    """End the program with one line, where the user or the machine has to mend something.

    Args:
        directory: the run folder; it goes away if nothing was written into it.
        goes_on: what to say after "interrupted", of how to go on.
        program: of `settings_help.SCHEMAS`.
    """
    open_closed()
    try:
        yield
    except CONFIG_ERRORS as error:
        sys.exit(refuse(explain(error, program), directory))
    except UserError as error:
        sys.exit(refuse(str(error), directory))
    except BrokenPipeError:
        close_output()
        sys.exit(refuse(CLOSED, directory))
    except OSError as error:
        sys.exit(refuse(explain_os_error(error), directory))
    except MemoryError:
        sys.exit(refuse("there is not enough memory; ask for less at a time", directory))
    except KeyboardInterrupt as error:
        with contextlib.suppress(OSError):
            how = goes_on or GOES_ON.get()
            print(f"dcg_torch: interrupted{how and '; ' + how}", file=sys.stderr, flush=True)
        sys.exit(128 + (error.number if isinstance(error, Stopped) else signal.SIGINT))


@contextlib.contextmanager
def raised_errors(directory: Path, program: str = "run") -> Iterator[None]:
    """In a job of a launcher, which carries an error to the process that says it: as a `UserError` of one line.

    Args:
        directory: the run folder; it goes away if nothing was written into it.
        program: of `settings_help.SCHEMAS`.

    Raises:
        UserError: there is something for the user or the machine to mend.
    """
    try:
        yield
    except (*CONFIG_ERRORS, UserError, OSError) as error:
        with contextlib.suppress(OSError):
            directory.rmdir()  # only if it is empty
        if isinstance(error, UserError):
            raise UserError(str(error)) from None
        said = explain_os_error(error) if isinstance(error, OSError) else explain(error, program)
        raise UserError(said) from None


def run_application(application: Callable[[], None], program: str = "run") -> int:
    """Run a Hydra application; the exit status: 0 done, 2 wrong input, 130 interrupted.

    Args:
        program: of `settings_help.SCHEMAS`.
    """
    os.environ["HYDRA_FULL_ERROR"] = "1"  # errors come here as exceptions, not as Hydra's own printed report
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) is signal.SIG_DFL:  # not under nohup
            signal.signal(number, _stop)
    with one_line_errors(program=program):
        try:
            return _run(application, program)
        finally:
            sys.stdout.flush()  # here, where a closed pipe is said in one line
    raise AssertionError("an error ends the program")


def _run(application: Callable[[], None], program: str) -> int:
    if "--version" in sys.argv[1:]:
        print(f"dcg_torch {__version__}")
        return 0
    # Hydra would answer an option that it doesn't have with ten lines of usage.
    given, strange = get_args_parser().parse_known_args()
    if strange:
        return refuse(f"{strange[0]}: there is no such option; settings are written KEY=VALUE, without dashes")
    refuse_nothing(given.overrides)
    register(program)
    application()
    return 0


def _stop(number: int, _: FrameType | None) -> None:
    raise Stopped(number)
