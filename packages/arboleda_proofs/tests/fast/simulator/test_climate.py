"""The climate: how much goes wrong in a run, drawn from a seed or told in a file."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict

import pytest

from arboleda.model.plant_model import Evidence
from arboleda.testing import shipped
from arboleda_proofs.simulator.checks import BadFaults
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.faults import KINDS, OF_DEVICES, OF_PLACES, Fault
from arboleda_proofs.simulator.levels import LEVELS

MODEL = shipped()
DRAWN = [name for name, kind in KINDS.items() if kind.weight and name not in (*OF_DEVICES, *OF_PLACES)]


def drawn(seed: int, level: str = "normal", minutes: int = 3) -> list[Fault]:
    climate = Climate.draw(MODEL, seed, level)
    return [fault for minute in range(minutes) for fault in climate.faults(minute)]


@pytest.mark.long
def test_a_thousand_seeds_have_enough_of_every_kind():
    kinds = Counter(fault.kind for seed in range(1000) for fault in drawn(seed))
    assert kinds.total() >= 50_000
    assert set(kinds) == set(DRAWN)
    assert min(kinds.values()) >= 100


@pytest.mark.parametrize(("level", "least", "most"), [(level, *rates) for level, rates in LEVELS.items()])
def test_a_level_is_so_many_faults_a_minute(level, least, most):
    for seed in range(20):
        climate = Climate.draw(MODEL, seed, level)
        assert least - 0.001 <= sum(climate.rates.values()) <= most + 0.001
        assert int(least) <= len(climate.faults(seed)) <= most + 1


def test_seeds_differ_in_character():
    rates = [Climate.draw(MODEL, seed, "normal").rates for seed in range(50)]
    missing = [len(DRAWN) - len(each) for each in rates]
    assert min(missing) >= 2 and max(missing) <= 30
    assert len({tuple(each) for each in rates}) == 50
    totals = [sum(each.values()) for each in rates]
    assert max(totals) > 3 * min(totals)


def test_a_minute_has_its_faults_in_order_and_within_it():
    for minute in range(5):
        faults = Climate.draw(MODEL, 1, "many").faults(minute)
        times = [fault.at for fault in faults]
        assert times == sorted(times)
        assert all(60 * minute <= at < 60 * minute + 60 for at in times)


def test_the_same_seed_has_the_same_faults_whichever_minute_is_asked_first():
    one, other = Climate.draw(MODEL, 7, "normal"), Climate.draw(MODEL, 7, "normal")
    forwards = [one.faults(minute) for minute in range(4)]
    backwards = [other.faults(minute) for minute in reversed(range(4))]
    assert forwards == backwards[::-1]
    assert forwards != [Climate.draw(MODEL, 8, "normal").faults(minute) for minute in range(4)]


def test_a_seed_has_the_faults_it_always_had():
    assert drawn(4711, "few", 1)[:1] == [GOLDEN]


@pytest.mark.parametrize("evidence", Evidence)
def test_whatever_is_drawn_can_happen_in_the_plant(evidence):
    model = shipped("sis_a", evidence=evidence)
    for seed in range(5):
        for fault in Climate.draw(model, seed, "many").faults(0):
            assert KINDS[fault.kind].objection(fault, model) is None
    if evidence is not Evidence.IDS:
        assert "piece_false" not in Climate.draw(model, 0, "many").rates


def told(data, seed: int = 1) -> Climate:
    return Climate.from_file(shipped("sis_a"), seed, data)


def test_a_file_can_tell_rates():
    climate = told({"rates": {"reboot": 30, "mute": 0.5}})
    kinds = Counter(fault.kind for minute in range(20) for fault in climate.faults(minute))
    assert set(kinds) == {"reboot", "mute"}
    assert 570 <= kinds["reboot"] <= 620


def test_a_file_can_tell_faults_and_what_it_leaves_out_is_drawn():
    climate = told({"faults": [{"kind": "mute", "at": 61, "target": "ra_1"}, {"kind": "loss", "at": 5.5}]})
    assert climate.faults(0)[0].kind == "loss"
    assert 0.01 <= climate.faults(0)[0].amount <= 0.3
    (mute,) = climate.faults(1)
    assert (mute.at, mute.target) == (61, "ra_1")
    assert climate.faults(2) == []


def test_faults_that_are_told_as_they_were_drawn_are_the_same():
    faults = Climate.draw(shipped("sis_a"), 3, "many").faults(0)
    assert told({"faults": [asdict(fault) for fault in faults]}).faults(0) == faults


def test_a_file_can_tell_both():
    climate = told({"rates": {"reboot": 2}, "faults": [{"kind": "mute", "at": 1}]})
    assert sorted(fault.kind for fault in climate.faults(0)) == ["mute", "reboot", "reboot"]


@pytest.mark.parametrize("data", [{}, {"rates": {}}, {"faults": []}])
def test_a_file_can_tell_that_nothing_goes_wrong(data):
    assert told(data).faults(0) == []


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ([], ["the file is not a mapping", "rates, faults"]),
        ({"rate": {}}, ["'rate'", "rates, faults"]),
        ({"rates": {"rebot": 1}}, ["'rebot'", "reboot, brown_out"]),
        ({"rates": {"reboot": "often"}}, ["reboot is 'often'", "number"]),
        ({"rates": {"reboot": True}}, ["reboot is True", "number"]),
        ({"rates": {"reboot": -1}}, ["reboot is -1", "number"]),
        ({"rates": ["reboot"]}, ["rates is not a mapping"]),
        ({"faults": {"kind": "reboot"}}, ["faults is not a list"]),
        ({"faults": ["reboot"]}, ["a fault is not a mapping", "kind, at, seconds"]),
        ({"faults": [{"at": 1}]}, ["None is not a kind", "reboot, brown_out"]),
        ({"faults": [{"kind": "rebot", "at": 1}]}, ["'rebot' is not a kind", "reboot, brown_out"]),
        ({"faults": [{"kind": ["reboot"], "at": 1}]}, ["kind of a fault is ['reboot']", "text"]),
        ({"faults": [{"kind": "reboot"}]}, ["reboot: at is missing"]),
        ({"faults": [{"kind": "reboot", "at": "1"}]}, ["at of a fault is '1'", "number"]),
        ({"faults": [{"kind": "reboot", "at": float("nan")}]}, ["at of a fault is nan", "number"]),
        ({"faults": [{"kind": "reboot", "at": -1}]}, ["at and seconds are 0 or more"]),
        ({"faults": [{"kind": "reboot", "at": 1, "board": "x"}]}, ["'board'", "target"]),
        ({"faults": [{"kind": "reboot", "at": 1, "target": "ra_9"}]}, ["'ra_9'", "'ra_1', 'rm_sis_a'"]),
        ({"faults": [{"kind": "reboot", "at": 1, "word": "x"}]}, ["'x'", "'will', 'no will'"]),
    ],
)
def test_a_bad_file_is_refused_with_what_is_allowed(data, words):
    with pytest.raises(BadFaults) as refused:
        told(data)
    assert all(word in str(refused.value) for word in words)
    assert "\n" not in str(refused.value)


def test_a_kind_that_befalls_nobody_in_this_plant_is_refused():
    model = shipped("sis_a", evidence=Evidence.STATE)
    with pytest.raises(BadFaults, match="piece_false cannot"):
        Climate.from_file(model, 1, {"faults": [{"kind": "piece_false", "at": 1}]})


def test_a_level_that_there_is_not_is_refused():
    with pytest.raises(BadFaults, match="'lots' is not a level of faults; there are none, few, normal, many"):
        Climate.draw(MODEL, 1, "lots")


GOLDEN = Fault(kind="operator_reset", at=20.448, target="rm_sis_b", seed=301925940)
