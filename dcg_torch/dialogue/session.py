"""A conversation with a robot in a world: inputs in, events out, every input on disk before anything comes of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Literal

from dcg_torch.dialogue.events import Event, Watcher
from dcg_torch.model import GroundingModel
from dcg_torch.simulator.view import Pixels
from dcg_torch.types import Percept, Pose
from dcg_torch.world.files import World, WorldObject


class Session:
    """One robot, one world, one model, and whoever talks to it.

    All methods but `stop` are for one thread at a time. Each input returns its events when it is dealt with, and gives
    them to `watch` as they happen: a page shows them there, and may sleep a thirtieth of a second at each `Moved`, for
    that is how long the move took the robot. An input that the world or the robot refuses is answered with `Said`, not
    with an exception.

    Args:
        world: where it begins; a world file, or one of the generator's.
        model: folder of a saved model; None: the shipped one.
        file: where the session is kept, a new file; None: nowhere. `Session.open` goes on with one that is there.
        simulator: with physics, or without.
        seed: kept in the file; draws the recogniser's mistakes, if it is ever told to make any.

    Attributes:
        world: as it is now, the robot's start in it being where it stood when the world was last changed by hand.
        model: what it has learned by now; read it (`lexicon()`, `symbols`), don't teach it past the session.

    Raises:
        SessionError: the file is there already, or is not valid; a UserError, as are those of model and world.
    """

    world: World
    model: GroundingModel
    file: Path | None

    def __init__(
        self,
        world: World,
        model: Path | None = None,
        *,
        file: Path | None = None,
        simulator: Literal["pybullet", "fake"] = "pybullet",
        seed: int = 0,
    ) -> None:
        raise NotImplementedError

    @classmethod
    def open(cls, file: Path, watch: Watcher | None = None) -> Session:
        """Go on with a session: all its inputs are played again, with their events to `watch`.

        This is how a killed server comes back: an input that was under way is carried out to its end.
        """
        raise NotImplementedError

    def say(self, text: str, *, pointing_at: str | None = None, watch: Watcher | None = None) -> tuple[Event, ...]:
        """A text, with the id of the object that was pointed at, if any. First event: `Understood`; last: `Done`."""
        raise NotImplementedError

    def click(self, object_id: str, *, watch: Watcher | None = None) -> tuple[Event, ...]:
        """A click: the answer to a question, or else the robot says what it takes the object for."""
        raise NotImplementedError

    def add_object(self, thing: WorldObject, *, watch: Watcher | None = None) -> tuple[Event, ...]:
        """Put an object into the world."""
        raise NotImplementedError

    def move_object(
        self, object_id: str, position: tuple[float, float], yaw: float | None = None, *, watch: Watcher | None = None
    ) -> tuple[Event, ...]:
        """Put an object elsewhere: metres, and radians if it is turned too."""
        raise NotImplementedError

    def remove_object(self, object_id: str, *, watch: Watcher | None = None) -> tuple[Event, ...]:
        """Take an object away."""
        raise NotImplementedError

    def stop(self) -> None:
        """Stop what is under way, at once; any thread may call this, also while the robot drives.

        Nothing happens if nothing is under way. A page calls it for a text of which `acts.is_stop` holds, and does not
        wait for its turn.
        """
        raise NotImplementedError

    @property
    def pose(self) -> Pose:
        """Where the robot is; from the session's own thread."""
        raise NotImplementedError

    @property
    def memory(self) -> Sequence[Percept]:
        """The objects that it has seen, as it remembers them, in the order of first sight."""
        raise NotImplementedError

    @property
    def question(self) -> tuple[str, ...]:
        """Ids of the objects that its open question is about; empty: none is open."""
        raise NotImplementedError

    def words(self) -> Mapping[str, Mapping[str, float]]:
        """word -> type -> probability: what each word heard or taught may mean, those of the start left out."""
        raise NotImplementedError

    def reasons(self, most: int = 12) -> list[str]:
        """Why the last command was grounded as it was: factors and features with their log-odds, a line each."""
        raise NotImplementedError

    def picture(self, *, width: int = 320, height: int = 180) -> Pixels | None:
        """What the camera sees, (height, width, 3) bytes; None without physics. From the session's own thread."""
        raise NotImplementedError

    def save_model(self, folder: Path) -> None:
        """Write what it has learned into a folder; `Session(model=folder)` and `dcg_torch.load` read it."""
        raise NotImplementedError

    def save_world(self, path: Path) -> None:
        """Write the world as it is now, the robot's pose as its start, as a world file."""
        raise NotImplementedError

    def close(self) -> None:
        """Let go of the simulator and the file."""
        raise NotImplementedError
