"""What one command leaves behind: the line of `iterations.jsonl`, and the wall-clock times beside it.

The names of `Iteration`'s fields are relied on by tools outside this project; fields are added, never renamed.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AllowInfNan, SerializerFunctionWrapHandler, model_serializer

from dcg_torch.storage.untrusted_files import Strict

Kind = Literal["known", "unknown", "learned"]
NO_EFFECT = ("name", "trials", "workers", "backend", "metric", "animate", "figures", "tensorboard", "screenshots")
"""Settings that change no byte of a trial: two runs that differ in these alone are of one configuration,
and a run may be gone on with although these differ."""


class PoseRecord(Strict):
    """A pose in the world: metres and radians."""

    x: float
    y: float
    yaw: float


class ObjectRecord(Strict):
    """One object of the world; `position` is (x, y) in metres."""

    id: str
    type: str
    color: str
    position: tuple[float, float]


class ParsedRecord(Strict):
    """The noun and colour of the object meant, as the parser read them."""

    noun: str | None
    color: str | None


class Iteration(Strict):
    """One command of a trial, free of wall-clock times, so that the same seed gives the same bytes."""

    trial: int
    iteration: int
    world: str
    command: str
    noun: str  # as said, in the singular
    color: str | None  # as said
    robot: PoseRecord  # at the start
    objects: tuple[ObjectRecord, ...]
    in_view: tuple[str, ...]  # ids seen from the start pose
    known_types: tuple[str, ...]  # before the trial began
    target: str
    grounded: str | None  # the object the robot went to; None also after an order to keep away
    correct: bool  # it went to the object meant, or left the surroundings of the one that it was to keep away from
    kind: Kind  # what the target's word was to the robot when it heard it
    probability: float | None  # of the grounding; None without one
    asked: int
    symbols: dict[str, str]  # the words learned so far: word -> type
    path_length: float  # metres
    turned: float  # radians
    parsed: ParsedRecord | None  # None: no object phrase found
    seen: tuple[str, ...]  # ids perceived by the end
    chosen: str | None  # the object grounded to, whether or not the robot reached it
    arrived: bool | None  # None: there was nowhere to drive
    collisions: int  # contacts with anything but the floor
    expected_symbols: float  # known types if every new type met so far had been learned (the paper's red curve)
    # Only of a model that has them; elsewhere the line doesn't mention them.
    beliefs: dict[str, dict[str, float]] | None = None  # word -> type -> probability, of the words heard so far
    dialogue: tuple[tuple[str, str], ...] | None = None  # the questions asked, with their answers

    @model_serializer(mode="wrap")
    def _without_absent(self, serialise: SerializerFunctionWrapHandler) -> dict[str, Any]:
        fields: dict[str, Any] = serialise(self)
        return {k: v for k, v in fields.items() if v is not None or k not in ("beliefs", "dialogue")}


class Timing(Strict):
    """Wall-clock seconds of one command, and the size of what was trained."""

    trial: int
    iteration: int
    load_world: float
    parse: float
    perceive: float
    ground: float
    groundings: int  # how often the command was grounded (once a look)
    explore: float
    drive: float
    train: float
    train_steps: int
    train_loss: Annotated[float, AllowInfNan(True)]
    train_rows: int
    language_columns: int
    grounding_columns: int
    moving: float = 0.0  # simulated seconds
