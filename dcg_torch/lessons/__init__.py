"""What a model is taught before its first command: 53 hand-made examples, files like theirs, and generated lessons."""

from dcg_torch.lessons.files import TrainingFileError, initial_training, read_training, training_set

__all__ = ["TrainingFileError", "initial_training", "read_training", "training_set"]
