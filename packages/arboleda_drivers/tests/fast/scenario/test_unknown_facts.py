"""A fact that a device does not know any more keeps back what needs it, and the plant says what helps."""

from __future__ import annotations

from tests.packages import ROOT

from arboleda.core.plant import Plant
from arboleda.model.advice import sentence
from arboleda.model.messages import MotionState, OperatorRequest, Report, Verb
from arboleda.plant_file.loader import load

BENCH = load(ROOT / "examples/plate_bench/bench.yaml")
TIP, WARM = (("tip", "none"),), (("celsius", 0),)


def heard(plant: Plant, at: float, unknown: tuple[str, ...] = ()) -> None:
    """Have both devices tell that they stand, the handler without the facts that are `unknown`."""
    tip = tuple(each for each in TIP if each[0] not in unknown)
    rows = (("handler", tip, unknown), ("hotplate", WARM, ()))
    for name, facts, lost in rows:
        said = {"epoch": 1, "plant": 1, "boot_id": 1, "state": MotionState.STOPPED}
        plant.step(at, [Report(at=at, robot=name, facts=facts, unknown=lost, **said)])  # type: ignore[arg-type]


def test_a_fact_that_is_unknown_keeps_what_needs_it_back_and_is_led_out() -> None:
    plant = Plant(BENCH, epoch=1, now=0.0)
    heard(plant, 1.0)
    assert plant.advice("bench") == ()
    heard(plant, 2.0, unknown=("tip",))
    told = plant.advice("bench")
    assert str(sentence(told)) == "do handler drop_tip or do handler without_tip"
    assert {(each.moves, str(each.why)) for each in told} == {(("handler",), "handler does not say its tip")}
    work = OperatorRequest(at=2.1, verb=Verb.DO, scope="handler", arguments=(("work", "take_tip A1"),))
    assert str(plant.refusal(work)) == "handler needs tip to be none, and does not say it"
    heard(plant, 3.0)
    assert plant.advice("bench") == ()
