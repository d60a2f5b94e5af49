"""Factsheet of a vehicle: orders of its length, and a sentence for each thing that it lacks."""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest

from arboleda_drivers.vda5050.factsheet import Factsheet, read
from arboleda_drivers.vda5050.machine import FACTSHEET_TRIES
from arboleda_drivers.vda5050.virtual.factsheet import factsheet_of

from .vda5050_rig import Rig

STOPS = ("cancelOrder", "startPause", "stopPause")
FORKS = ("pick", "drop", "detectObject")


def sheet(
    *actions: dict[str, Any], arrays: dict[str, int] | None = None, **strings: object
) -> dict[str, Any]:
    """A factsheet of 2.1 with these actions beside those that stop a vehicle."""
    stops = [action(name, "INSTANT") for name in STOPS]
    return {
        "protocolLimits": {"maxStringLens": strings, "maxArrayLens": arrays or {}},
        "protocolFeatures": {"agvActions": [*stops, *actions]},
    }


def action(name: str, *scopes: str, **values: bool) -> dict[str, Any]:
    """An action with its scopes, and its values with whether it can do without."""
    rows = [{"key": key, "isOptional": optional} for key, optional in values.items()]
    return {"actionType": name, "actionScopes": list(scopes), "actionParameters": rows}


def able(**values: bool) -> list[dict[str, Any]]:
    """Actions of the example's forks, with these values of `pick`."""
    return [
        action("pick", "NODE", **(values or {"height": False})),
        *(action(name, "NODE") for name in FORKS[1:]),
    ]


def lacks(said: dict[str, Any], **settings: Any) -> list[str]:
    rig = Rig(**settings)
    return [str(each).partition("factsheet: ")[2] for each in told_by(rig, said)]


def told_by(rig: Rig, said: dict[str, Any]) -> list[str]:
    return [message.text for message in rig.vehicle.factsheet(0.0, said)]  # type: ignore[union-attr]


@pytest.mark.parametrize("version", ["2.0", "2.1", "3.0"])
def test_a_vehicle_is_asked_for_its_factsheet_when_it_comes(version: str) -> None:
    rig = Rig(version)
    rig.run(0.5)
    asked = [each["actionType"] for _, said in rig.received for each in said["actions"]]
    assert asked == ["stateRequest", "factsheetRequest"]
    assert rig.log == []  # the virtual one has all that the example asks for


def test_a_vehicle_that_does_not_listen_at_once_is_asked_again() -> None:
    rig = Rig()
    rig.faults.switch("deaf", on=True)
    rig.faults.switch("hush", on=True)
    rig.run(10.0)
    asked = Counter(each["actionType"] for _, said in rig.received for each in said["actions"])
    assert asked["factsheetRequest"] == FACTSHEET_TRIES
    assert asked["stateRequest"] == 5  # without a state it is of no use
    assert all(len(said["actions"]) == 1 for _, said in rig.received)


@pytest.mark.parametrize("version", ["2.1", "3.0"])
def test_a_factsheet_is_read_in_both_spellings(version: str) -> None:
    found = read(factsheet_of(version))
    assert found.actions["drop"].scopes == {"NODE", "INSTANT"}
    assert found.actions["pick"].parameters == {"height": True}
    assert (found.most_nodes, found.longest_id, found.only_digits) == (None, None, False)


def test_a_limit_of_zero_is_none() -> None:
    assert read(sheet(arrays={"order.nodes": 0}, idLen=0)) == read(sheet())
    assert isinstance(read(sheet()), Factsheet)


def test_nothing_is_said_of_a_vehicle_that_can_do_all() -> None:
    assert lacks(sheet(*able())) == []


def test_an_action_that_it_has_not_or_not_there_is_named_with_those_that_it_has() -> None:
    assert lacks(sheet(*able()[:2], action("detectObject", "EDGE"))) == [
        "it has no action detectObject at a node, which is for forks detect_object; it has pick, drop"
    ]
    assert lacks(sheet(*able()), instant=("drop",)) == [
        "it has no action drop at once, which is for forks drop; it has cancelOrder, startPause, stopPause"
    ]


def test_values_that_it_needs_and_that_it_does_not_know_are_named() -> None:
    assert lacks(sheet(*able(stationType=False, speed=True))) == [
        "its action pick needs a value stationType, which forks pick does not give",
        "its action pick has no value height, which forks pick gives; it has stationType, speed",
    ]


def test_a_vehicle_without_a_pause_is_named() -> None:
    said = sheet(*able())
    said["protocolFeatures"]["agvActions"].pop(1)
    assert lacks(said) == [
        "it has no action startPause at once, which is for stops; it has cancelOrder, stopPause"
    ]


def test_ids_that_are_too_long_or_no_numbers_are_named() -> None:
    (short,) = lacks(sheet(*able(), idLen=20))
    assert short.startswith("its ids may have 20 characters; arboleda-m-")
    (digits,) = lacks(sheet(*able(), idNumericalOnly=True))
    assert digits.startswith("its ids may only have digits; ")


def test_a_message_has_no_more_nodes_than_it_takes_and_the_rest_comes_by_updates() -> None:
    rig = Rig(base=0)
    rig.run(0.5)
    told_by(rig, sheet(*able(), arrays={"order.edges": 2}))
    rig.drive(0, 3, 6, 7, 8)
    rig.run(5.0)
    sizes = [len(said["nodes"]) for topic, said in rig.received if topic == "order"]
    assert (max(sizes), len(sizes)) == (3, 3)
    assert rig.reports["cart"].done == "1-1"
    assert rig.reports["cart"].node == 8


def test_a_base_that_is_shorter_than_the_limit_stays_as_it_is() -> None:
    rig = Rig(base=1)
    rig.run(0.5)
    told_by(rig, sheet(*able(), arrays={"order.nodes": 4}))
    rig.drive(0, 3, 6, 7, 8)
    assert [node["released"] for node in rig.received[-1][1]["nodes"]] == [True, True, False, False]


def test_orders_of_one_node_are_named() -> None:
    (one,) = lacks(sheet(*able(), arrays={"order.nodes": 1}))
    assert one == "its orders may have one node, so it cannot be sent to another"
