"""A power cut of the plant's host alone: what boards echo of the step that was lost lets its task go on."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable

import pytest
from packages.arboleda_proofs.tests.fast.scenario.test_walk_back import (
    CELL,
    ID,
    TASK,
    full,
    held,
    outcome,
    run,
    ways,
)

from arboleda.model.messages import Fact, TaskState, Verb
from arboleda.rig.plant_process import Fuse, Side
from arboleda.testing import Rig, shipped
from arboleda.wire.transport import Publication
from arboleda_proofs.testing import Witness

Change = Callable[[dict[str, object]], object]
GRIPPED, LET_GO = 9, 18  # messages of a task after which a command to the effector has left, and is not kept


def cut(message: int, *, boards: Change = lambda said: None) -> tuple[Rig, Witness]:
    """A task whose host loses power right after a message, with all that was not synced; `boards` change
    what they say from then on.
    """
    rig = Rig(shipped(CELL))
    witness = Witness(rig)
    burnt: list[float] = []
    rig.carry = lambda each: changed(each, boards) if burnt else [each]
    rig.wait(0.5)
    rig.submit(TASK)

    def burn() -> None:
        burnt.append(rig.now)
        rig.plant_process.cut_power(0)
        rig.stop_bridge()

    rig.plant_process.fuses.append(Fuse(message, Side.AFTER, burn))
    rig.wait(60.0, until=lambda: bool(burnt))
    return rig, witness


def changed(said: Publication, boards: Change) -> Iterable[Publication]:
    if not said.topic.endswith("/sensores"):
        return [said]
    body = json.loads(said.payload)
    boards(body)
    payload = json.dumps(body, separators=(",", ":")).encode()
    return [Publication(topic=said.topic, payload=payload, qos=said.qos, retain=said.retain)]


def start(rig: Rig) -> None:
    rig.wait(1.0)
    rig.plant_process.start()
    rig.start_bridge()
    rig.wait(6.0)


def without_tokens(said: dict[str, object]) -> None:
    said.pop("ficha_ack", None)
    said.pop("ficha_hecho", None)


def of_another(said: dict[str, object]) -> None:
    if "ficha_ack" in said:
        said["ficha_ack"] = said["ficha_hecho"] = "0123456789ab"


def as_another_board_would(said: dict[str, object]) -> None:
    if "ficha_ack" in said:
        said["ficha_ack"] = said["ficha_hecho"] = "of_my_own"


def one_ahead(said: dict[str, object]) -> None:
    """Another command came since, of which nothing is known."""
    if "ficha_ack" in said and isinstance(said["ack"], int):
        said["ack"] += 1


@pytest.mark.long
def test_wherever_it_is_cut_its_task_goes_on_picks_once_and_places_once() -> None:
    message, echoed = 1, 0
    while True:
        rig, witness = cut(message)
        start(rig)
        if run(rig).task is None:
            break
        walk = run(rig).keeping.walk
        echoed += walk.judge(run(rig).context).echo is not None
        assert held(rig).endswith("resume sis_a or abandon sis_a"), message
        assert rig.operate(Verb.RESUME, CELL) is None, message
        assert outcome(rig) is TaskState.DONE, message
        assert [switch.on for switch in witness.switches] == [True, False], message
        assert full(rig) == ["station_7"], message
        assert not witness.illegal and not witness.false_successes, message
        message += 1
    assert message > 20
    assert echoed >= 5, "only what boards echo tells of some"


@pytest.mark.parametrize("message", [GRIPPED, LET_GO])
@pytest.mark.parametrize("boards", [without_tokens, of_another, as_another_board_would, one_ahead])
def test_a_board_that_echoes_nothing_or_something_else_leaves_only_the_recovery(
    message: int, boards: Change
) -> None:
    rig, _ = cut(message, boards=boards)
    start(rig)
    assert "abandon" in ways(rig)
    assert held(rig).endswith("abandon sis_a") and "resume" not in held(rig)


def test_a_board_that_has_booted_proves_nothing_by_what_it_echoes() -> None:
    rig, _ = cut(GRIPPED)
    rig.power_off("ra_1")
    rig.power_on("ra_1")
    start(rig)
    assert "resume" not in held(rig)


def test_a_second_cut_before_anybody_resumes_changes_nothing() -> None:
    rig, witness = cut(LET_GO)
    start(rig)
    rig.plant_process.cut_power(0)
    rig.stop_bridge()
    start(rig)
    assert rig.operate(Verb.RESUME, CELL) is None
    assert outcome(rig) is TaskState.DONE
    assert [switch.on for switch in witness.switches] == [True, False]


def test_where_the_task_stands_is_kept_as_before_once_it_has_gone_on() -> None:
    rig, _ = cut(LET_GO)
    start(rig)
    before = rig.disk.facts[Fact.STEP][ID]
    rig.operate(Verb.RESUME, CELL)
    rig.wait(0.5)
    assert rig.disk.facts[Fact.STEP].get(ID) != before
