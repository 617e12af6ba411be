"""Will each process that runs trials teach its model generated lessons first? It takes minutes, so it is said.

Told from the settings alone: the process that shows how a run goes on does not import the model.
"""

from __future__ import annotations

from dcg_torch.settings import LearnerKind, ModelSettings

SHIPPED = {
    "groups": frozenset({"dcg", "unknown", "hypothetical", "color", "open", "relation"}),
    "hypothetical": True,
    "learns": True,
    "ternary": True,
    "l2": 0.05,
    "beam": 12,
    "lessons": 4500,
}
"""The settings that the shipped model is for; `experiment.factory` reads it where they are these."""


def lessons_note(model: ModelSettings, training: str | None) -> str | None:
    """One line where a model is taught lessons before the first command; None where it is not.

    Args:
        training: a file of initial examples; None: those that come along.
    """
    if model.learner is LearnerKind.commit_first or not model.lessons or "relation" not in model.groups:
        return None
    groups = frozenset(model.groups) - {"names"}
    same = groups == SHIPPED["groups"] and all(
        getattr(model, key) == value for key, value in SHIPPED.items() if key != "groups"
    )
    if same and training is None:
        return None
    return (
        f"the shipped weights are for other settings of model; a model of your own first learns from {model.lessons} "
        "generated lessons, which takes about three minutes"
    )
