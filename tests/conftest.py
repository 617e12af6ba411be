"""What the tests share: one trained model, one thread of torch, one hypothesis profile."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import pytest
import torch
from asked import shipped
from hypothesis import Phase, settings

from dcg_torch.language import Parser, default_parser
from dcg_torch.lessons import initial_training
from dcg_torch.model import GroundingModel, TrainingSet, Variant

if TYPE_CHECKING:
    from robotics import Far

    from dcg_torch.simulator import SimulatedRobot

# Without hypothesis's explanations, which take minutes where an example is a whole trained model.
PHASES = (Phase.explicit, Phase.reuse, Phase.generate, Phase.shrink)
settings.register_profile("house", deadline=None, max_examples=25, print_blob=True, phases=PHASES)
settings.load_profile("house")
torch.set_num_threads(1)  # as in a trial; the matrices are small


@pytest.fixture(scope="session")
def training() -> TrainingSet:
    return initial_training()


@pytest.fixture(scope="session")
def trained(training: TrainingSet) -> GroundingModel:
    """A model after lines 1 to 6. Shared by all tests: look, don't teach."""
    return GroundingModel.trained(training)


@pytest.fixture(scope="session")
def pupil(trained: GroundingModel) -> Callable[[], GroundingModel]:
    """Makes models after lines 1 to 6 that may be taught."""
    return lambda: copy.deepcopy(trained)


@pytest.fixture(scope="session")
def binary(training: TrainingSet) -> GroundingModel:
    """As `trained`, with the correspondences of eqs. 6, 8 and 9."""
    return GroundingModel.trained(training, Variant(ternary=False))


@pytest.fixture(scope="session")
def model() -> GroundingModel:
    """The shipped model. Shared by all tests: look, don't teach."""
    return shipped()


@pytest.fixture(scope="session")
def parser() -> Parser:
    return default_parser()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The fast ones first, so that most failures show at once; in parallel, those of a file in one process."""
    items.sort(key=lambda item: item.get_closest_marker("slow") is not None)
    for item in items:
        if item.config.pluginmanager.hasplugin("xdist"):
            slow = "" if item.get_closest_marker("slow") is None else ", slow"
            item.add_marker(pytest.mark.xdist_group(item.nodeid.partition("::")[0] + slow))


@pytest.fixture(scope="module")
def shared() -> Iterator[SimulatedRobot]:
    """One robot in physics for all tests of a file that load their own world: it must not depend on those before."""
    from dcg_torch.simulator import SimulatedRobot

    with SimulatedRobot() as robot:
        yield robot


@pytest.fixture
def far() -> Far:
    """A robot that is known by its messages alone, at the origin."""
    from robotics import Far

    return Far.at_the_origin()
