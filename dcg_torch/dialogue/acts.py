"""What a person's text does: a command, an answer, a lesson, a question, a motion, or nothing that the robot does."""

from __future__ import annotations


def is_stop(text: str) -> bool:
    """Does this text stop the robot at once ("stop", "halt!", "please wait")?"""
    raise NotImplementedError
