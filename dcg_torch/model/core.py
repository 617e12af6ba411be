"""The model that users import: train on examples, ground a sentence in a world, learn from the outcome.

It joins the rooms: a variant, the features, the weights of the factor, and a learner that says what these follow.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from dcg_torch.fitting.design import DesignMatrix
from dcg_torch.fitting.devices import device_of
from dcg_torch.fitting.fit import FitResult, fit
from dcg_torch.fitting.psi import BINARY, TERNARY, LogLinearFactor
from dcg_torch.grounding.command import ground_command
from dcg_torch.grounding.encoding import encode
from dcg_torch.grounding.features import FeatureSet, Group, give_odds
from dcg_torch.grounding.graph import FactorGraph
from dcg_torch.grounding.readings import SharedSearch
from dcg_torch.grounding.solution import Solution
from dcg_torch.grounding.statistics import Statistics
from dcg_torch.interpretation.marks import heard
from dcg_torch.interpretation.parser_protocol import ReadCommand
from dcg_torch.learning.commit_first import CommitFirst
from dcg_torch.learning.landmarks import Lesson
from dcg_torch.learning.learner import Experience, Learned, Learner, TrainingSet
from dcg_torch.learning.lexicon import Entry
from dcg_torch.learning.places import place_examples
from dcg_torch.learning.trainable import rows_mask, taught_mask
from dcg_torch.model.caches import Followed, Kept
from dcg_torch.model.growth import start_as_the_last, widened
from dcg_torch.model.serialization import Stored, write
from dcg_torch.model.teacher import Told, forgotten, interpret, settled
from dcg_torch.model.training import RELATION_L2, teach_corpus, teach_relations
from dcg_torch.model.variant import Variant, initial_features, restrict
from dcg_torch.scene.upsilon import nearest_first, with_known, world_model
from dcg_torch.scene.workspace import Workspace, with_places
from dcg_torch.types import LOOKED_ROUND, ParseTree, Percept, Pose, Symbol, WorldModel
from dcg_torch.types.arrays import Bools, Floats


class GroundingModel:
    """A variant, features, weights and a learner: every model of this project is a configuration of it.

    Attributes:
        variant: what it represents.
        features: the columns, which say what is known.
        factor: Psi with its weights.
        learner: what it has learned of words: `CommitFirst` is the paper's, `WordPosterior` goes beyond it.
        held: (L, G) the weights that a corpus has taught: learning leaves them alone.
        prior: (P, L, G) what the penalty pulls the weights towards; None: zero, as until a corpus has taught some.
        fitted: how the last training went; None for a model that was restored.
    """

    def __init__(self, variant: Variant, features: FeatureSet, factor: LogLinearFactor, learner: Learner) -> None:
        self.variant = variant
        self.features = features
        self.factor = factor
        self.learner = learner
        self.held: Bools = np.zeros(features.shape, dtype=np.bool_)
        self.prior: Floats | None = None
        self.fitted: FitResult | None = None
        self._kept = Kept(Statistics(features.groups))

    @classmethod
    def trained(
        cls, training: TrainingSet, variant: Variant | None = None, learner: Learner | None = None
    ) -> GroundingModel:
        """Lines 1 to 6 of Algorithm 1: a model with its initial groundings and features, trained.

        Args:
            training: the labelled examples.
            variant: DCG-UPUP-Away with colour by default.
            learner: the paper's by default, with the training set as T.
        """
        variant = variant or Variant()
        training = replace(training, examples=tuple(restrict(training.examples, variant)))
        learner = learner or CommitFirst.start(training, learns_symbols=Group.UNKNOWN in variant.groups)
        features = initial_features(variant, training, learner)
        model = cls(variant, features, LogLinearFactor(features.pairs, TERNARY if variant.ternary else BINARY), learner)
        if Group.NAMES in variant.groups:
            give_odds(model.factor, features)
        model.train()
        if variant.related:
            designs = encode(place_examples(), features, model.factor.correspondences)
            model.fit_weights(designs, free=taught_mask(features), l2=RELATION_L2)
        return model

    def copy(self) -> GroundingModel:
        """A model that is like this one, and learns by itself from here."""
        factor = LogLinearFactor(self.features.pairs, self.factor.correspondences, self.factor.weight.device)
        factor.set_weight(self.factor.weight.detach().clone())
        other = GroundingModel(self.variant, self.features, factor, self.learner)
        other.held, other.fitted = self.held.copy(), self.fitted
        other.prior = None if self.prior is None else self.prior.copy()
        other._kept = Kept(self._kept.statistics.copy())
        return other

    def to(self, device: str) -> GroundingModel:
        """This model, with its weights on a device, where Psi is computed and the sums of its fits; in place.

        Args:
            device: as torch names it: "cpu", "cuda", "cuda:1".

        Raises:
            DeviceError: torch cannot use it here.
        """
        if device != str(self.factor.weight.device):
            self.factor.to(device_of(device))
        return self

    @property
    def symbols(self) -> dict[str, Symbol]:
        """Every word that is held to name a type, in the order of learning."""
        return dict(self.learner.symbols)

    @property
    def known_types(self) -> tuple[str, ...]:
        """The types that are known, in the order in which they became so: the one definition of `Object.known`."""
        return self.learner.known_types

    def world_model(
        self,
        percepts: Iterable[Percept],
        robot: Pose | None = None,
        speaker: Pose | None = None,
        *,
        looked: bool = False,
        workspace: Workspace | None = None,
    ) -> WorldModel:
        """Upsilon as this variant represents it (lines 8 and 9).

        Args:
            percepts: all that has been recognised.
            robot: where it stands; None: unknown.
            speaker: where the speaker stands; None: with the robot.
            looked: has the robot looked all round? The paper's hypothetical objects don't depend on it.
            workspace: of a robot that works in one, which has edges and a middle.
        """
        world = world_model(
            percepts,
            self.known_types,
            unknown=self.variant.unknown,
            hypothetical=self.variant.hypothetical,
            robot=robot,
            speaker=speaker,
            unseen=frozenset({LOOKED_ROUND} if looked and Group.OPEN in self.variant.groups else ()),
        )
        return with_places(nearest_first(world), workspace) if self.variant.related else world

    def ground(self, command: str | ParseTree | ReadCommand, world: WorldModel) -> Solution:
        """[phi*, gamma*] of a command in a world (line 11).

        Args:
            command: what was said, its parse tree, or what a parser made of it: of several readings the world decides.
            world: of `world_model`.

        Raises:
            TypeError: the command is none of these.
        """
        world = with_known(world, self.known_types)
        if isinstance(command, ParseTree):
            return self._search(world).ground(command)
        if isinstance(command, str):
            from dcg_torch.language import parse_command  # its words are data that only who gives text pays for

            command = heard(parse_command, command, self.symbols.keys(), world.objects)
        if not hasattr(command, "readings"):
            raise TypeError(f"a command is text, a parse tree or what a parser made of it, not {command!r:.60}")
        related = self.variant.related
        frames = self.learner.frames if related else None
        speakers = None if frames is None else frames.speakers
        return ground_command(command, world, self._search, self.learner.readings, speakers, related=related)

    def _search(self, world: WorldModel) -> SharedSearch:
        encoder = self._kept.encoder(self.features, world)
        return SharedSearch(encoder, self._kept.phrases(self.features, self.factor), self.variant.beam)

    def solve(self, tree: ParseTree, world: WorldModel) -> Solution:
        """The solution of a tree of factors."""
        encoder = self._kept.encoder(self.features, world)
        tables = self._kept.phrases(self.features, self.factor)
        return FactorGraph(tree, world, encoder).solve(
            self.features, self.factor, beam=self.variant.beam, tables=tables
        )

    def learn(self, solution: Solution, experience: Experience | None = None) -> Learned:
        """Learn from the outcome of a command that was carried out, and retrain (lines 16 to 25).

        Args:
            solution: its last grounding.
            experience: how it was carried out; None: as far as the solution's world tells.

        Returns:
            The symbol that was made or changed, or the reason why there is none.
        """
        if not self.variant.learns:
            return Learned(reason="this variant does not learn")
        if not isinstance(solution, Solution):
            raise TypeError(f"an outcome is what ground() returns, not {solution!r:.60}")
        if solution.best is None:
            return Learned(reason=solution.problem or "the command was not grounded to an object")
        looked = all(LOOKED_ROUND in o.attributes for o in solution.world.objects if o.hypothetical)
        self.learner, learned = self.learner.hear(solution, experience or Experience(looked), self.solve)
        self.train()
        return learned

    def tell(self, sentence: str, world: WorldModel, *, pointing_at: str | None = None) -> Told:
        """Learn a name from a teacher: "this is a pallet", "that red thing is a euro pallet", "no, that is a drill".

        Args:
            sentence: what the teacher says.
            world: what there is to speak of, of `world_model`.
            pointing_at: id of the object that the teacher points at.
        """
        found = interpret(sentence, world, pointing_at, self)
        if found.word is not None and found.type is not None:
            self.learner = self.learner.told(found.word, found.type)
            self.train()
        return found

    def correct(self, word: str, type_: str) -> None:
        """Settle a noun on a type, by someone who knows, and retrain.

        Raises:
            ValueError: nothing of this type was ever met, or there is no word.
        """
        self.learner = settled(self.learner, word, type_)
        self.train()

    def forget(self, word: str) -> None:
        """Forget all that was heard of a noun, and retrain.

        Raises:
            ValueError: it was never heard.
        """
        self.learner = forgotten(self.learner, word)
        self.train()

    def train(self) -> FitResult:
        """M.train (lines 6 and 25): columns for all that was learned, and a fit from the present weights."""
        before = self.features.shape
        self.grow(self.learner.columns(self.features))
        free = self.learner.trainable(self.features)
        if free is None:
            start_as_the_last(self.factor, self.features, before, self.symbols.values())
        elif self.held.any():
            free = free & (~self.held | rows_mask(self.features, self.learner.open_words))
        examples, soft = self.learner.training_examples(self.features), self.learner.soft_labels(self.features)
        follows = Followed(self.features, self.factor.weight, self.prior, examples, soft, free)
        if self._kept.follows is not None and self.fitted is not None and self._kept.follows.same(follows):
            return self.fitted
        designs = self._kept.statistics.designs(examples, soft, self.features, self.factor.correspondences)
        fitted = self.fit_weights(designs, free=free, l2=self.variant.l2)
        self._kept.follows = replace(follows, weight=self.factor.weight)
        return fitted

    def teach(
        self,
        lessons: Sequence[Lesson],
        *,
        relations_only: bool = False,
        known_types: Collection[str] | None = None,
        known_colors: Collection[str] | None = None,
        rounds: int = 4,
        progress: Callable[[int], None] | None = None,
    ) -> None:
        """Train on commands whose objects are known; their landmarks are inferred.

        Args:
            relations_only: teach what words for relations mean, and nothing of what things are called.
            known_types: types that may become known; None: all that are meant in the lessons.
            known_colors: the same of colours.
            rounds: of expectation and maximisation.
            progress: called with the number of each round that is done.
        """
        if relations_only:
            teach_relations(self, lessons, rounds=rounds, progress=progress)
            return
        teach_corpus(
            self, lessons, known_types=known_types, known_colors=known_colors, rounds=rounds, progress=progress
        )

    def save(self, directory: Path | str) -> None:
        """Write the model into a folder, which is made if need be; `dcg_torch.load` reads it."""
        write(Stored(self.variant, self.features, self.factor, self.learner, self.prior, self.held), directory)

    def lexicon(self) -> list[Entry]:
        """Every noun with what it may mean, and from which commands."""
        return self.learner.lexicon()

    def beliefs_about(self, but: Collection[str]) -> dict[str, dict[str, float]] | None:
        """noun -> type -> probability, of all nouns `but` some; None for a learner without degrees of belief."""
        return self.learner.beliefs(but)

    def sure_names(self) -> dict[str, str]:
        """type -> a word for it that the robot holds for certain."""
        return self.learner.names()

    def beliefs_of(self, word: str) -> dict[str, float]:
        """type -> probability that a noun names it."""
        return self.learner.meanings(word)

    def grow(self, features: FeatureSet) -> None:
        """Columns of zero weight for what is new."""
        if features.shape == self.features.shape:
            return
        self.features = features
        self.factor.grow(features.pairs)
        self.held = widened(self.held, features.shape)
        self.prior = None if self.prior is None else widened(self.prior, features.shape)

    def fit_weights(self, designs: Sequence[DesignMatrix], *, free: Bools | None, l2: float) -> FitResult:
        """Fit the free weights to labelled factors, in place: see `fit`."""
        self.fitted = fit(self.factor, designs, l2=l2, free=free, prior=self.prior)
        return self.fitted
