"""What people say over maps and on streets. Scenes and commands are ours."""

from __future__ import annotations

import pytest
from seen_whole import meant, thing

from dcg_torch.names.evidence import evidence
from dcg_torch.names.weights import log_odds
from dcg_torch.types import Pose

FARMLAND = [
    thing("dam", "reservoir", 0.0, 0.0, size=(20.0, 20.0, 0.0)),
    *(
        thing(f"mast {name}", "mast", x, y)
        for name, x, y in [("n", 40.0, 3.0), ("se", -22.0, -24.0), ("e", 6.0, -16.0)]
    ),
    thing("silo n", "silo", 60.0, 30.0),
    thing("silo s", "silo", -60.0, -5.0),
    thing("truck w", "tractor", 2.0, 45.0),
    thing("truck sw", "tractor", -33.0, 30.0),
    thing("chapel", "chapel", 70.0, -40.0),
    thing("stone", "boulder", 80.0, 0.0),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("fly to the mast north of the reservoir", "mast n"),
        ("the mast to the southeast of the reservoir", "mast se"),
        ("hover over the mast east of the reservoir", "mast e"),
        ("the tractor south west of the reservoir", "truck sw"),
        ("the tractor just west of the reservoir", "truck w"),
        ("the silo farthest south", "silo s"),
        ("the northernmost building", "chapel"),
        ("the building north of the tractors", "silo n"),
        ("the building farthest south", "silo s"),
    ],
)
def test_on_a_map_the_direction_is_what_is_told(text: str, id_: str) -> None:
    assert meant(text, FARMLAND, Pose(-90.0, 0.0)) == [id_]


def test_the_nearest_in_a_direction_is_one_of_all_that_the_name_of_a_kind_names() -> None:
    things = [
        thing("mill", "windmill", 0.0, 0.0),
        thing("barn", "barn", -8.0, -20.0),
        thing("chapel", "chapel", 3.0, -85.0),
        thing("cottage", "cottage", 40.0, 60.0),
        thing("pond", "pond", 5.0, 40.0),
    ]
    assert meant("the building east of the windmill", things, Pose(-90.0, 0.0)) == ["barn"]


KERB = [
    *(thing(f"bollard{k}", "bollard", 8.0 + 6.0 * k, 6.0 + 0.2 * k) for k in range(4)),
    thing("other", "bollard", 20.0, -9.0),
    thing("tram", "tram", 30.0, 0.0, "green", size=(20.0, 2.5, 3.5)),
    thing("van", "van", 14.0, -4.0, "orange", size=(5.0, 2.0, 2.2)),
    thing("lorry", "lorry", 22.0, -4.0, "orange", size=(8.0, 2.4, 3.2)),
    thing("waiter", "waiter", 12.0, 9.0, shirt="purple"),
    thing("walker", "pedestrian", 25.0, -8.0, shirt="grey"),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("stop by the second bollard on the left", "bollard1"),
        ("the last bollard on your left", "bollard3"),
        ("pull over to the right behind the orange van", "van"),
        ("merge left behind the green tram", "tram"),
        ("look out for the van", "van"),
        ("stop beside the guy in the purple shirt", "waiter"),
        ("wait for the woman in grey", "walker"),
        ("stop next to the lorry after the orange van", "lorry"),
        ("stop right after the orange van", "van"),
        ("let me out at the tram", "tram"),
    ],
)
def test_on_a_street(text: str, id_: str) -> None:
    assert meant(text, KERB) == [id_]


AVENUE = [
    thing("kiosk1", "kiosk", 14.0, -5.0),
    thing("kiosk2", "kiosk", 30.0, -5.5),
    thing("own lane", "scooter", 10.0, -0.2),
    thing("scooter1", "scooter", 18.0, -4.0),
    thing("scooter2", "scooter", 26.0, -4.2),
    thing("kiosk3", "kiosk", 22.0, 6.0),
    thing("arch", "arch", 50.0, 0.0),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("stop at the second kiosk on the right", "kiosk2"),
        ("the first kiosk on your right", "kiosk1"),
        ("park by the first scooter on the right", "scooter1"),
        ("the last scooter on the right", "scooter2"),
    ],
)
def test_what_is_in_the_own_lane_is_on_no_side_of_a_street(text: str, id_: str) -> None:
    assert meant(text, AVENUE) == [id_]


def test_one_line_across_is_no_street() -> None:
    across = [thing(f"bollard{k}", "bollard", 9.0, 9.0 - 3.0 * k) for k in range(3)]
    assert meant("the second bollard on the left", [*across, thing("post", "bollard", 9.0, -4.0)]) != ["post"]


def test_whoever_it_is_may_be_called_a_man_and_no_thing_is() -> None:
    assert min(log_odds("guy", name) for name in ("waiter", "policeman", "pedestrian", "construction worker")) > 0.0
    assert max(log_odds("guy", name) for name in ("bollard", "tram", "girl")) < 0.0
    assert evidence("waiter", "policeman")[1] != "kind: same"
