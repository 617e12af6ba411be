"""What a teacher's sentence names, and what it does not. These sentences were written for this project."""

from __future__ import annotations

import pytest

from dcg_torch.speech_acts.teaching import read_teaching


@pytest.mark.parametrize(
    "text",
    ["this is not a lamp", "that is no lamp", "no, it was never a lamp", "this isn't a lamp", "that's not the lamp"],
)
def test_what_a_thing_is_not_names_nothing(text: str) -> None:
    assert read_teaching(text) is None


@pytest.mark.parametrize("text", ["this is a lamp", "no, that is a lamp", "it was the lamp", "call this a lamp"])
def test_what_a_thing_is_names_it(text: str) -> None:
    said = read_teaching(text)
    assert said is not None
    assert (said.name, said.subject) == ("lamp", None)


@pytest.mark.parametrize(
    "said", ["wrong", "good", "great", "fine", "enough", "very good", "too far", "broken", "mine", "why", "on fire"]
)
@pytest.mark.parametrize("subject", ["that is", "that's", "no, it was"])
def test_how_a_thing_is_names_nothing(subject: str, said: str) -> None:
    assert read_teaching(f"{subject} {said}") is None


@pytest.mark.parametrize("name", ["pallet", "wug", "sand", "drill", "metal", "desk lamp", "cold drink", "white board"])
def test_a_name_may_come_without_an_article(name: str) -> None:
    said = read_teaching(f"this is {name}")
    assert said is not None
    assert name.endswith(said.name)
