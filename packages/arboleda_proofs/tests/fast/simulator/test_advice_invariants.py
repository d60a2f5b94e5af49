"""The invariants of advice hold where it is followed, and bite where it leads nowhere."""

from __future__ import annotations

import pytest

from arboleda.core import advisor
from arboleda.core.operator import Operator
from arboleda.model.cell_states import CellState
from arboleda.model.messages import OperatorRequest, Verb
from arboleda_proofs.simulator.invariants.advice import (
    ADVICE,
    ENOUGH,
    advice_leads_out,
    no_advice_where_all_is_well,
)
from arboleda_proofs.simulator.people import Attendant
from arboleda_proofs.simulator.recorded.acts import Acts

from .watch import Watched

TASK = "sis_a 0B 7"


class Watch(Watched):
    """Finds what the invariants of advice find."""

    def __init__(self) -> None:
        super().__init__(ADVICE)
        self.wait(0.5)

    def act(self, verb: Verb) -> None:
        self.verb(verb, "sis_a")


def works(watch: Watch) -> bool:
    plant, cell = watch.world.plant, watch.world.plant.cells["sis_a"]
    ready = cell.state is CellState.IDLE and cell.not_ready is None
    return ready and plant.at_rest and not cell.queue


@pytest.fixture
def watch() -> Watch:
    return Watch()


def test_an_attendant_who_follows_the_advice_gets_a_cell_to_work(watch: Watch) -> None:
    Attendant(watch.world, seed=1)
    for trouble in (Verb.STOP, Verb.HOLD):
        watch.world.request_task(TASK)
        watch.world.advance(4.0)
        watch.act(trouble)
        assert watch.world.advance(90.0, until=lambda: works(watch))
    watch.world.request_task(TASK)
    watch.world.advance(4.0)
    watch.world.crash("ra_1")
    watch.world.advance(1.0)
    assert watch.world.advance(90.0, until=lambda: works(watch))
    watch.end()
    assert watch.found == {}


def test_an_attendant_does_not_bring_back_what_a_fault_has_taken(watch: Watch) -> None:
    Attendant(watch.world, seed=1)
    watch.world.power_off("ra_1")
    watch.world.advance(30.0)
    assert not watch.world.is_on("ra_1")


def test_advice_that_leads_nowhere_is_found(watch: Watch) -> None:
    watch.act(Verb.STOP)
    for _ in range(ENOUGH - 1):
        watch.act(Verb.STOP)
    assert watch.found == {}
    watch.act(Verb.STOP)
    assert [*watch.found] == ["advice_leads_out"]


def test_the_same_act_on_another_device_counts_once(watch: Watch) -> None:
    acts = ["clear a", "reset a", "retry a", "release left", "release right", "abandon a", "home left"]
    watch.look.record.acts.of["sis_a"] = acts
    assert not [*advice_leads_out.rule(watch.look)]
    watch.look.record.acts.of["sis_a"] = [*acts, "release left"]
    assert [*advice_leads_out.rule(watch.look)]


def test_a_cell_that_works_in_between_begins_anew(watch: Watch) -> None:
    for _ in range(2):
        for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET, Verb.RESUME):
            watch.act(verb)
    assert watch.found == {}


def test_a_fault_in_between_begins_anew(watch: Watch) -> None:
    for number in range(2 * ENOUGH):
        watch.act(Verb.STOP)
        if number == ENOUGH - 1:
            watch.world.crash("ra_1")
    assert watch.found == {}


def test_a_refusal_that_was_not_foretold_is_found(watch: Watch, monkeypatch: pytest.MonkeyPatch) -> None:
    watch.act(Verb.RESUME)
    assert watch.found == {}
    monkeypatch.setattr(Operator, "refusal", lambda self, request: None)
    watch.act(Verb.RESUME)
    assert [*watch.found] == ["refusals_are_foretold"]


def test_advice_where_all_is_well_is_found(watch: Watch, monkeypatch: pytest.MonkeyPatch) -> None:
    watch.end()
    assert watch.found == {}
    monkeypatch.setattr(advisor, "LEADS", dict.fromkeys(advisor.LEADS, advisor.Advisor._stopped))
    watch.end()
    assert [*watch.found] == ["no_advice_where_all_is_well"]


def test_advice_is_said_as_people_write_it(watch: Watch) -> None:
    watch.act(Verb.STOP)
    (said,) = no_advice_where_all_is_well.rule(watch.look)
    assert said == "for sis_a it is advised: clear sis_a"


def test_a_refused_act_counts_only_where_it_was_done_before(watch: Watch) -> None:
    cells, acts = [watch.look.record.cells["sis_a"]], Acts()
    stop, retry = (OperatorRequest(at=0.0, verb=verb, scope="sis_a") for verb in (Verb.STOP, Verb.RETRY))
    acts.take(stop, cells, is_refused=True)
    assert acts.of == {}
    acts.take(stop, cells, is_refused=False)
    acts.take(retry, cells, is_refused=True)
    assert acts.of == {"sis_a": ["stop sis_a"]}
    acts.take(stop, cells, is_refused=True)
    assert acts.of == {"sis_a": ["stop sis_a", "stop sis_a"]}
