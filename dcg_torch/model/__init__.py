"""The model that users import: train on examples, ground a sentence in a world, learn from the outcome."""

from dcg_torch.learning.learner import Experience, Learned, TrainingSet
from dcg_torch.model.core import GroundingModel
from dcg_torch.model.teacher import Told
from dcg_torch.model.variant import Variant

__all__ = ["Experience", "GroundingModel", "Learned", "Told", "TrainingSet", "Variant"]
