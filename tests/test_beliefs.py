"""The posterior over meanings against a brute-force Bayes in plain Python, and its properties."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.learning.beliefs import SPREAD, UNMET, Beliefs, Evidence, Prior
from dcg_torch.learning.lexicon import lexicon

KNOWN = {"cube": "cube", "sphere": "sphere"}
NEW = ("cone", "drill", "hydrant")
TYPES = (*KNOWN.values(), *NEW)
PRIOR = Prior(synonym=0.1, unmet=0.5, slip=0.05)

worlds = st.dictionaries(st.sampled_from(TYPES), st.integers(1, 3), min_size=1)
histories = st.lists(
    st.builds(
        Evidence, st.sampled_from(["zorp", "wug", "dax"]), worlds, st.sampled_from([0.0, 0.3]), st.just("somewhere")
    ),
    min_size=1,
    max_size=6,
)


def after(history: list[Evidence], prior: Prior = PRIOR) -> Beliefs:
    beliefs = Beliefs.start(KNOWN, prior).meet(NEW)
    for evidence in history:
        beliefs = beliefs.weigh(evidence)
    return beliefs


def brute_force(history: list[Evidence]) -> dict[str, dict[str, float]]:
    """Bayes over whole assignments, from the prior and equation (1), evidence by evidence."""
    words = list(dict.fromkeys(e.word for e in history))
    columns = (*TYPES, UNMET)
    scores = {}
    for choice in itertools.product(columns, repeat=len(words)):
        p = 1.0
        for t in columns:
            count = choice.count(t)
            if t == UNMET:
                p *= PRIOR.unmet**count
            elif t in KNOWN.values():
                p *= PRIOR.synonym**count
            else:
                p *= PRIOR.synonym ** max(0, count - 1)
        for e in history:
            t = choice[words.index(e.word)]
            n, total = e.fitting.get(t, 0), sum(e.fitting.values())
            p *= (1 - PRIOR.slip) * (n + e.unseen) + PRIOR.slip / SPREAD * (total - n)
        scores[choice] = p
    whole = math.fsum(scores.values())
    return {
        w: {t: math.fsum(p for c, p in scores.items() if c[k] == t) / whole for t in columns}
        for k, w in enumerate(words)
    }


@given(histories)
def test_the_posterior_is_bayes(history: list[Evidence]) -> None:
    found = after(history).posterior
    for word, truth in brute_force(history).items():
        assert found.of(word) == pytest.approx(truth, abs=1e-9)


@given(histories)
def test_rows_are_distributions(history: list[Evidence]) -> None:
    posterior = after(history).posterior
    assert np.allclose(posterior.table.sum(axis=1), 1.0)
    assert math.isclose(posterior.new.sum(), 1.0)
    for word, type_ in KNOWN.items():
        assert posterior.of(word)[type_] == 1.0


@given(histories, st.randoms(use_true_random=False))
def test_the_order_of_commands_does_not_matter(history: list[Evidence], random: object) -> None:
    shuffled = list(history)
    random.shuffle(shuffled)  # type: ignore[attr-defined]
    one, other = after(history).posterior, after(shuffled).posterior
    for word in one.words:
        assert one.of(word) == pytest.approx(other.of(word), abs=1e-9)


@given(histories, st.sampled_from(NEW))
def test_the_only_thing_there_gains_belief(history: list[Evidence], type_: str) -> None:
    before, more = after(history), Evidence("zorp", {type_: 1.0})
    assert before.weigh(more).posterior.of("zorp")[type_] >= before.posterior.of("zorp")[type_] - 1e-12


def test_a_wrong_belief_is_revised() -> None:
    misleading = [Evidence("zorp", {"drill": 1.0})] * 2
    beliefs = after(misleading)
    assert beliefs.posterior.of("zorp")["drill"] > 0.95
    for _ in range(4):
        beliefs = beliefs.weigh(Evidence("zorp", {"cone": 1.0, "cube": 1.0}))
    assert beliefs.posterior.best("zorp")[0] == "cone"
    assert beliefs.posterior.of("zorp")["drill"] < 0.05


def test_a_synonym_is_learned() -> None:
    beliefs = after([Evidence("ball", {"sphere": 1.0, "drill": 1.0}), Evidence("ball", {"sphere": 1.0, "cone": 1.0})])
    assert beliefs.posterior.best("ball")[0] == "sphere"
    assert beliefs.posterior.best("sphere") == ("sphere", 1.0)


def test_elimination_without_ever_being_shown_alone() -> None:
    history = [
        Evidence("zorp", {"cone": 1.0}),
        Evidence("wug", {"cone": 1.0, "drill": 1.0}),
        Evidence("dax", {"cone": 1.0, "drill": 1.0, "hydrant": 1.0}),
    ]
    posterior = after(history, Prior(synonym=0.01)).posterior
    assert [posterior.best(w)[0] for w in ("zorp", "wug", "dax")] == ["cone", "drill", "hydrant"]
    assert posterior.best("dax")[1] > 0.9


def test_a_new_word_is_expected_to_name_what_has_no_name() -> None:
    prior = after([Evidence("zorp", {"cone": 1.0})]).posterior.of("never heard")
    assert prior["drill"] > 5 * prior["cone"]
    assert prior["drill"] > 5 * prior["cube"]


def test_an_incomplete_look_says_less() -> None:
    seen_all = after([Evidence("zorp", {"cone": 1.0})]).posterior.of("zorp")
    seen_part = after([Evidence("zorp", {"cone": 1.0}, unseen=0.3)]).posterior.of("zorp")
    assert seen_all["drill"] < seen_part["drill"] < seen_part["cone"]


def test_nothing_seen_says_nothing() -> None:
    assert after([Evidence("zorp", {})]).heard == {}


def test_forget_and_correct() -> None:
    beliefs = after([Evidence("zorp", {"cone": 1.0})] * 3)
    assert "zorp" not in beliefs.forget("zorp").posterior.words
    corrected = beliefs.correct("zorp", "drill")
    assert corrected.posterior.best("zorp") == ("drill", 1.0)
    assert corrected.weigh(Evidence("zorp", {"cone": 1.0})).posterior.best("zorp") == ("drill", 1.0)


def test_memory_does_not_grow_with_commands() -> None:
    beliefs = after([Evidence("zorp", {"cone": 1.0, "drill": 2.0}, source=str(k)) for k in range(500)])
    heard = beliefs.heard["zorp"]
    assert heard.commands == 500
    assert len(heard.more) == 2
    assert len(heard.sources) <= 8


def test_the_lexicon_names_sources() -> None:
    beliefs = after([Evidence("zorp", {"cone": 1.0, "cube": 1.0}, source="3")])
    entry = lexicon(beliefs)[-1]
    assert (entry.word, entry.commands, entry.sources, entry.settled) == ("zorp", 1, ("3",), False)
    assert entry.types[0][0] == "cone"


@pytest.mark.parametrize("wrong", [{"synonym": 0.0}, {"unmet": 0.0}, {"slip": 0.0}, {"slip": 1.0}])
def test_a_prior_that_forbids_learning_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=next(iter(wrong))):
        Prior(**wrong)


def test_a_word_is_said_of_a_type_that_is_called_alike_where_its_own_is_not_there() -> None:
    beliefs = Beliefs.start(KNOWN, Prior(names=True)).meet(["laptop", "computer", "apple"])
    beliefs = beliefs.weigh(Evidence("notebook", {"laptop": 1}))
    assert beliefs.posterior.best("notebook")[0] == "laptop"
    alike, other = beliefs.akin("notebook", "computer"), beliefs.akin("notebook", "apple")
    assert 0.5 > alike > 20.0 * other
    assert beliefs.akin("notebook", "laptop") == beliefs.akin("notebook", UNMET) == 0.0
