"""Twenty thousand hostile inputs for each reader.

Each input comes of the seed, the reader's name and a number alone, so that one that went wrong can be made again.
"""

from __future__ import annotations

import random
import resource
import shutil
import signal
import sys
import time
import traceback
import warnings
from pathlib import Path
from types import FrameType
from typing import NamedTuple

from hydra.core.global_hydra import GlobalHydra
from readers import LONGEST, Reader, readers

INPUTS = 20_000
_SLOWEST, _MOST = 2.0, 200.0  # seconds of CPU, and MB by which the peak of memory grew, for one input
_HANGS = 20.0  # seconds of CPU after which an input is given up


class Fed(NamedTuple):
    """What came of a reader's inputs: how many there were and were taken, the most seconds and MB for one."""

    tried: int = 0
    taken: int = 0
    slowest: float = 0.0
    most: float = 0.0
    wrong: tuple[str, ...] = ()

    def __str__(self) -> str:
        said = f"{self.tried} inputs, {self.taken} taken, slowest {self.slowest:.2f} s, most {self.most:.0f} MB"
        return said + "".join(f"\n        {line}" for line in self.wrong[:5])


def feed_all(
    rng: random.Random, directory: Path, until: float, *, only: str = "", inputs: int = INPUTS
) -> tuple[bool, str]:
    """Feed every reader; it takes an input or refuses it with one printable line, quickly."""
    start, said, good = rng.randrange(2**32), [], True
    all_of_them = readers(directory)
    choice = [name for name in all_of_them if not only or name in only.split(",")]
    for k, name in enumerate(choice):
        share = time.monotonic() + (until - time.monotonic()) / (len(choice) - k)
        with warnings.catch_warnings():
            fed = _feed(name, all_of_them[name], start, directory / "input", share, inputs)
        GlobalHydra.instance().clear()  # the parts that follow start programs in forks of this process
        good &= not fed.wrong and fed.slowest < _SLOWEST and fed.most < _MOST and fed.tried > 0
        said.append(f"\n    {name}: {fed}")
        print(f"fuzz    {name}: {fed}", file=sys.stderr, flush=True)
    return good, "".join(said)


def _feed(name: str, reader: Reader, start: int, folder: Path, until: float, inputs: int) -> Fed:
    signal.signal(signal.SIGVTALRM, _give_up)
    warnings.simplefilter("error")  # a number that overflows got past a check
    fed, wrong = Fed(), dict[str, str]()
    for number in range(inputs):
        if time.monotonic() > until:
            break
        rng = random.Random(f"{start} {name} {number}")
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        given = reader.make(rng, folder)
        began, held, taken = time.process_time(), _megabytes(), 0
        signal.setitimer(signal.ITIMER_VIRTUAL, _HANGS)
        try:
            reader.read(given)
            taken = 1
        except reader.refuses as error:
            if not str(error).isprintable() or len(str(error)) > LONGEST + 3:
                wrong.setdefault("message", f"{number}: {str(error)!r:.300}")
        except Exception as error:
            last = traceback.extract_tb(error.__traceback__)[-1]
            kind = f"{type(error).__name__} at {Path(last.filename).name}:{last.lineno}"
            wrong.setdefault(kind, f"{number}: {kind}: {str(error)!r:.200}")
        finally:
            signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        seconds, more = time.process_time() - began, _megabytes() - held
        if seconds > _SLOWEST or more > _MOST:
            wrong.setdefault("dear", f"{number}: {seconds:.1f} s, {more:.0f} MB")
        fed = Fed(fed.tried + 1, fed.taken + taken, max(fed.slowest, seconds), max(fed.most, more))
    return fed._replace(wrong=tuple(wrong.values()))


def _give_up(_: int, __: FrameType | None) -> None:
    raise TimeoutError("it hangs")


def _megabytes() -> float:
    """The peak of this process's memory so far."""
    unit = 1024 if sys.platform != "darwin" else 1024**2
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit
