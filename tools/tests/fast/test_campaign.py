"""Output of tools/campaign on a summary."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from tests.scripts import load

from arboleda_proofs.simulator.faults import KINDS

SCRIPT = Path(__file__).parents[2] / "campaign"


@pytest.fixture
def campaign() -> Any:
    return load("campaign")


def summary(**faults: int) -> dict[str, Any]:
    """A thousand seeds that held, the first with 100 faults of each kind besides `faults`."""
    seeds = [
        {"seed": number, "broken": None, "cycles": 50, "faults": {"reboot": 50}} for number in range(1000)
    ]
    return {"seeds": [{**seeds[0], "faults": {**dict.fromkeys(KINDS, 100), **faults}}, *seeds[1:]]}


def test_a_campaign_that_held_with_every_kind_of_fault_is_enough(campaign: Any) -> None:
    assert campaign.shortcomings(summary()) == []


def test_a_kind_that_came_too_seldom_is_named(campaign: Any) -> None:
    assert campaign.shortcomings(summary(loss=99)) == ["loss came 99 times, 100 are needed"]


def test_too_few_cycles_or_faults_are_named(campaign: Any) -> None:
    lazy = summary()
    for seed in lazy["seeds"]:
        seed.update(cycles=49, faults=dict.fromkeys(KINDS, 1) if seed["seed"] < 100 else {})
    assert campaign.shortcomings(lazy) == [
        "49000 cycles, 50000 are needed",
        f"{100 * len(KINDS)} faults, 50000 are needed",
    ]


def test_a_broken_seed_and_missing_seeds_are_named(campaign: Any) -> None:
    short = summary()
    short["seeds"][3]["broken"] = {"invariant": "stop_holds"}
    short["seeds"].pop()
    short["seeds"][1]["cycles"] = 1000
    short["seeds"][1]["faults"] = {"reboot": 1000}
    assert campaign.shortcomings(short) == ["seed 3 breaks stop_holds", "999 seeds, 1000 are needed"]


def test_of_drawn_plants_less_is_needed(campaign: Any) -> None:
    drawn = summary(loss=99)
    drawn["seeds"][0]["plant_file"] = {}
    assert campaign.shortcomings(drawn) == []
    drawn["seeds"] = drawn["seeds"][:499]
    assert campaign.shortcomings(drawn) == ["499 seeds, 500 are needed"]
