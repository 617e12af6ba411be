"""What a conversation rests on: the robot, what it remembers, what was said last, and the question that is open."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from dcg_torch.agent.asking import AskingPolicy, Question, Reply, candidates, question
from dcg_torch.agent.command import CommandUnderWay, Look
from dcg_torch.agent.explore import LookBefore, Point, Worth, missing
from dcg_torch.agent.robot import InteractiveRobot
from dcg_torch.dialogue import sentences
from dcg_torch.dialogue.events import Asked, Candidates, Done, Looking, Said, Watcher
from dcg_torch.grounding.features import Group
from dcg_torch.grounding.solution import Solution
from dcg_torch.language import Parse
from dcg_torch.model import GroundingModel
from dcg_torch.names import log_odds
from dcg_torch.types import DriveResult, Percept, Pose

ASKING = AskingPolicy(below=0.75)
_WORTH = Worth(sure=ASKING.below)
_SURE_WORD = 0.95  # probability from which on the robot uses a word itself

FirstAnswer = Callable[[Solution, bool], None]
"""Says what a command is taken to mean, before the robot moves; and whether it moves now to see more."""


class Stopped(Exception):
    """Somebody stopped the robot."""


@dataclass
class Errand:
    """A command, or the search for the thing of a question, as far as it has come.

    Attributes:
        text: what the person said.
        solution: the last grounding.
        looked: had the robot looked all round by then?
        asked: the questions with their answers.
        start, in_view: where the robot stood when it was spoken to, and what it saw from there.
        looks: every grounding, for those who draw them.
        result: how the drive ended; None: there was none.
        taken_back: did the person say that another thing was meant?
    """

    text: str
    command: CommandUnderWay
    solution: Solution
    looked: bool
    start: Pose
    in_view: tuple[str, ...]
    looks: list[Look] = field(default_factory=list)
    asked: list[tuple[Question, Reply]] = field(default_factory=list)
    result: DriveResult | None = None
    taken_back: bool = False

    @property
    def chosen(self) -> str | None:
        """Id of the seen object that is taken to be meant."""
        thing = self.solution.object
        return None if thing is None or thing.hypothetical else thing.id


@dataclass(frozen=True, slots=True)
class UnclearLesson:
    """A teacher's sentence, of which it is not clear which object it is about."""

    text: str


@dataclass
class Situation:
    """The state of a conversation.

    Attributes:
        emit: takes the events.
        stopped: has somebody stopped the robot since this input began?
        memory: what was seen, by id; a thing that is changed by hand leaves it.
        places: where the robot has looked all round since the world was last changed.
        before: where it stood when it was last sent elsewhere.
        last: the last command; None before the first.
        open: the question that waits for an answer, and what it is about.
        taught: the words that a person taught, as "told".
    """

    robot: InteractiveRobot
    model: GroundingModel
    emit: Watcher
    stopped: Callable[[], bool]
    memory: dict[str, Percept] = field(default_factory=dict)
    places: list[Point] = field(default_factory=list)
    before: Pose | None = None
    last: Errand | None = None
    open: tuple[Errand | UnclearLesson, Question] | None = None
    taught: dict[str, str] = field(default_factory=dict)

    @property
    def seen(self) -> tuple[Percept, ...]:
        """All that it remembers."""
        return tuple(self.memory.values())

    def look(self) -> tuple[str, ...]:
        """Look ahead, and remember; the ids in view."""
        found = self.robot.perceive()
        self.memory.update((p.id, p) for p in found)
        return tuple(p.id for p in found)

    def warm_up(self) -> None:
        """Look, and ground some command, so that the first one of a person does not wait for what is loaded then."""
        self.look()
        self.model.ground("go to the red thing next to the cube", self.model.world_model(self.seen, self.robot.pose))

    def check(self) -> None:
        """End this input if somebody has stopped the robot.

        Raises:
            Stopped: so it is.
        """
        if self.stopped():
            raise Stopped

    def say(self, text: str) -> None:
        """A sentence."""
        self.emit(Said(text))

    def names(self) -> dict[str, str]:
        """type -> the word that the robot uses for it: of those that it is sure of, the one learned first."""
        found: dict[str, str] = {}
        sure = set(self.model.sure_names())
        for symbol in self.model.symbols.values():
            if symbol.type in sure and self.model.beliefs_of(symbol.word).get(symbol.type, 0.0) >= _SURE_WORD:
                found.setdefault(symbol.type, symbol.word)
        return found

    def is_new(self, solution: Solution) -> bool:
        """Is the noun of a command one that was never heard before?"""
        noun = solution.noun.noun if solution.noun is not None else None
        return noun is not None and noun not in {entry.word for entry in self.model.lexicon()}

    def is_named_so(self, solution: Solution, thing: Percept) -> bool:
        """Does the name of its class say that a thing is what the noun names?"""
        noun = None if solution.noun is None else solution.noun.noun
        return noun is not None and Group.NAMES in self.model.variant.groups and log_odds(noun, thing.type) > 0.0

    def the(self, id_: str) -> str:
        """An object that was seen, in words that fit no other."""
        return sentences.the(self.memory[id_], self.seen, self.robot.pose, self.names())

    def where(self, id_: str) -> str:
        """Where an object is, from here."""
        return sentences.where(self.memory[id_], self.robot.pose)

    def unclear(self, solution: Solution) -> tuple[str, ...]:
        """The objects to ask about: more than one may be meant, and what is meant is here more likely than not."""
        return candidates(solution, ASKING) if missing(solution) <= _WORTH.absent else ()

    def ask(self, about: Errand | UnclearLesson, ids: Sequence[str]) -> Done:
        """Ask which of these objects is meant; the next input may answer."""
        asking = question(ids, self.seen, self.robot.pose, self.names())
        self.open = about, asking
        self.emit(Asked(asking.text, asking.candidates))
        return Done(self.robot.pose, "asked")

    def look_round(self) -> None:
        """Turn until all round has been seen, unless that has been done since the world last changed."""
        if self.places:
            return
        self.emit(Looking())
        for _ in range(LookBefore.TURNS):
            self.robot.spin(LookBefore.STEP)
            self.check()
            self.look()
        self.places.append((self.robot.pose.x, self.robot.pose.y))

    def find(self, text: str, said: Parse, first: FirstAnswer) -> Errand:
        """Ground what was said, and look on until it is clear what is meant or that it is not there.

        Args:
            first: called once.
        """
        in_view, start = self.look(), self.robot.pose
        looks: list[Look] = []
        pending = [first]

        def watch(look: Look) -> None:
            self.check()
            self.show(looks, look)

        def before() -> None:
            while pending:
                pending.pop()(looks[-1].solution, True)
                self.emit(Looking())

        command = CommandUnderWay(said, self.model, _Announced(self.robot, before), start, self.memory)
        explorer = LookBefore.resumed(self.model.beliefs_of, _WORTH, self.places)
        solution = command.look(explorer, watch)
        self.check()
        if pending:
            first(solution, False)
        return Errand(text, command, solution, explorer.looked, start, in_view, looks)

    def show(self, looks: list[Look], look: Look) -> None:
        """Another grounding: for those who draw them all, and for those who watch."""
        looks.append(look)
        names, solution = self.names(), look.solution
        rows = [sentences.candidate(o, solution.probabilities.get(o.id, 0.0), names) for o in solution.world.objects]
        rows.sort(key=lambda row: (-row.probability, row.id))
        self.emit(Candidates(tuple(rows), tuple(p.id for p in look.percepts)))


class _Announced:
    """The robot, which says what it does before it moves to see more."""

    def __init__(self, robot: InteractiveRobot, before: Callable[[], None]) -> None:
        self._robot, self._before = robot, before
        self.perceive = robot.perceive
        self.drive_to, self.drive_away = robot.drive_to, robot.drive_away

    @property
    def pose(self) -> Pose:
        return self._robot.pose

    def spin(self, angle: float) -> None:
        self._before()
        self._robot.spin(angle)

    def go_to(self, x: float, y: float, percepts: Sequence[Percept]) -> DriveResult:
        self._before()
        return self._robot.go_to(x, y, percepts)


def beside(pose: Pose, angle: float, metres: float) -> tuple[float, float]:
    """The place so far from here in a direction, radians from the heading."""
    return pose.x + metres * math.cos(pose.yaw + angle), pose.y + metres * math.sin(pose.yaw + angle)
