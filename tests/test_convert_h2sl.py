"""Examples and symbol dictionaries of h2sl: what they mean, and what is left out and why."""

from __future__ import annotations

from pathlib import Path

import pytest
from convert_making import episodes, example, left_out, put, thing

from dcg_torch.evaluation.importers import h2sl, h2sl_symbols
from dcg_torch.evaluation.importers.base import ImportFileError
from dcg_torch.lessons import read_training

pytest.importorskip("defusedxml", reason="needs the extra convert")


@pytest.mark.parametrize(
    ("meant", "target"),
    [
        ('<object id="b"/>', {"b"}),
        ('<container container_type="row" object_ids="a,b"/><object id="a"/><object id="b"/>', {"a", "b"}),
        ('<container container_type="row" object_ids="a, b"/>', {"a", "b"}),
        ('<constraint constraint_type="inside" payload="r" reference="a"/>', {"a"}),
        ('<constraint constraint_type="inside" payload="b" reference="a"/>', {"b"}),
        ('<object id="r"/><object id="a"/>', {"a"}),
        ('<object name="a" object_type="crate"/>', {"a"}),
        ('<container type="row"><object name="a"/><object name="b"/></container>', {"a", "b"}),
    ],
)
def test_what_an_instruction_of_h2sl_means(tmp_path: Path, meant: str, target: set[str]) -> None:
    found = h2sl.convert(put(tmp_path, one=example(meant)) / "one.xml")
    (episode,) = episodes(found, tmp_path).values()
    assert (episode.id, episode.text, set(episode.target)) == ("one", "go to the crate", target)
    assert {o.id: (o.type, o.color, o.position) for o in episode.objects} == {
        "a": ("crate", "red", (3.0, 2.0, 0.0)),
        "b": ("crate", None, (4.0, -1.0, 0.5)),
    }
    assert episode.pose is not None
    assert (episode.pose.x, episode.pose.y, episode.pose.yaw) == (1.0, 2.0, 0.0)
    assert left_out(found) == {"object: a robot, which is no object of an episode": 1}


def test_the_hands_of_a_robot_stand_at_its_base_and_older_names_are_read(tmp_path: Path) -> None:
    hands = (thing("left", "robot", "1,1,1"), thing("right", "robot", "1,-1,1"), thing("floor", "na"))
    older = '<object name="c" type="cone" color="blue" position="2 0 0"/>'
    parse = '<image file="a.png"/><NP><grounding><grounding_set><object name="c"/></grounding_set></grounding></NP>'
    found = h2sl.convert(put(tmp_path, one=example("", *hands, older, parse=parse)))
    (episode,) = episodes(found, tmp_path).values()
    assert episode.pose is not None
    assert (episode.pose.x, episode.pose.y) == (0.0, 0.0)
    assert [(o.id, o.type, o.color) for o in episode.objects] == [("c", "cone", "blue")]
    assert left_out(found)["object: its type is na"] == 1


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (example('<object id="a"/>', text=None), "no text of the instruction"),
        (example('<object id="a"/>', text=" "), "no text of the instruction"),
        (example(""), "its grounding names no object"),
        (example('<region object_id="a"/>'), "its grounding names no object"),
        (example('<object id="r"/>'), "it means the robot"),
        (example("", parse="<NP/>"), "no grounding of the whole phrase"),
        (example("", parse=""), "no parse"),
        (example("", parse="<NP/><VP/>"), "several parses"),
        (example('<object id="a"/>', thing("a", "crate", None)), "an object has no position"),
        (example('<object id="a"/>', thing("a", "crate", "1,x,0")), "a place or size is not given in numbers"),
        (example('<object id="a"/>', thing("a", "crate", "1,2")), "a place or size has too few or too many numbers"),
        (example('<object id="a"/>', thing("r", "robot")), "no objects but robots in its world"),
        (example('<object id="a"/>', thing("b", "crate"), thing("a", "na")), "it means an object whose type is na"),
        (
            example('<object id="a"/>', thing("a", "crate"), thing("a", "cone")),
            "an object has no id, or that of another",
        ),
        ("<root/>", "no world in it"),
        ("<root><symbol_dictionary/></root>", "a symbol dictionary; convert it with h2sl_symbols"),
        ("<root>", "not readable as XML: no element found"),
        ("no XML", "not readable as XML: syntax error"),
    ],
)
def test_an_example_of_h2sl_that_is_none_is_left_out_with_its_reason(tmp_path: Path, content: str, reason: str) -> None:
    found = h2sl.convert(put(tmp_path, good=example('<object id="a"/>'), wrong=content))
    assert list(episodes(found, tmp_path)) == ["good"]
    assert left_out(found)[f"file: {reason}"] == 1


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (example('<object id="z"/>'), "target: 'z' is no object of this episode: a, b"),
        (example('<object id="a"/>', thing("a", "crate", "nan,0,0")), "a number is not finite"),
        (example('<object id="a"/>', thing("a", "crate", "1e9,0,0")), "objects.position: not understood"),
    ],
)
def test_what_is_no_valid_episode_is_left_out(tmp_path: Path, content: str, reason: str) -> None:
    found = h2sl.convert(put(tmp_path, wrong=content))
    assert found.lines == []
    assert left_out(found)[f"episode: {reason}"] == 1


BOMB = (
    '<!DOCTYPE root [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">'
    '<!ENTITY c "&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;">]><root>&c;</root>'
)
ELSEWHERE = '<!DOCTYPE root [<!ENTITY a SYSTEM "file:///etc/hostname">]><root>&a;</root>'


@pytest.mark.parametrize("content", [BOMB, ELSEWHERE, '<!DOCTYPE root SYSTEM "http://localhost/x"><root/>'])
def test_entities_are_not_followed(tmp_path: Path, content: str) -> None:
    with pytest.raises(ImportFileError, match="it declares a document type or entities; remove them"):
        h2sl.convert(put(tmp_path, bomb=content) / "bomb.xml")


def test_a_symbol_dictionary_becomes_a_training_file(tmp_path: Path) -> None:
    path = tmp_path / "symbols.xml"
    path.write_text(
        "<root><symbol_dictionary>"
        '<string_property key="object_type" value="na,crate,robot,table,door,cone"/>'
        '<string_property key="object_color_type" value="na,red,black,light blue"/>'
        '<int_property key="index_value" value="1,2"/>'
        "</symbol_dictionary></root>"
    )
    found = h2sl_symbols.convert(path)
    out = tmp_path / "training.yaml"
    out.write_text(found.lines[0])
    training = read_training(out)
    assert {s.word: s.type for s in training.symbols} == {t: t for t in ("crate", "table", "door", "cone")}
    assert tuple(training.colors) == ("red", "black")
    nouns = {e.phrase.noun for e in training.examples}
    assert {"crate", "table", "door", "cone", "dax"} <= nouns
    assert not {"cube", "sphere", "cylinder"} & nouns
    assert left_out(found) == {
        "symbol: of index_value, for which a training file has no place": 2,
        "symbol: a colour of several words": 1,
    }


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("<root/>", "no symbol dictionary in it"),
        ("<root><symbol_dictionary/></root>", "names no object types or no colours"),
        (
            "<root><symbol_dictionary>"
            f'<string_property key="object_type" value="{"a" * 300}"/>'
            '<string_property key="object_color" value="red"/></symbol_dictionary></root>',
            "makes no training file: symbols",
        ),
    ],
)
def test_a_dictionary_that_teaches_nothing_is_one_line(tmp_path: Path, content: str, says: str) -> None:
    with pytest.raises(ImportFileError, match=says):
        h2sl_symbols.convert(put(tmp_path, symbols=content) / "symbols.xml")


@pytest.mark.parametrize("types", ["crate", "crate,door"])
def test_a_dictionary_of_few_types_teaches_no_contradictions(types: str) -> None:
    known = types.split(",")
    for entry in h2sl_symbols.training(known, ["red"])["examples"]:
        if entry["means"].startswith("hypothetical ") and entry["noun"] in known:
            sought = f"{entry.get('color', '')} {entry['noun']}".strip()
            assert not any(one.endswith(sought) for one in entry["see"]), entry
