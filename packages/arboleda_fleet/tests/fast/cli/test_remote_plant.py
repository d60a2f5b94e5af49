"""Commands ask the leader of a plant that stands by here."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from tests.guarded_plant import guarded
from tests.in_process import Machine
from tests.in_process import machine as machine
from tests.unit.cli.test_remote_plant import ASKED, HERE, LEADER, LED, OTHER, STORE, client
from tests.unit.cli.test_remote_plant import plant as plant
from tests.unit.cli.test_remote_plant import state as state
from tests.web_plant import QUEUED, TOKENS, VIEW, Plant

from arboleda.cli.client import PlantClient
from arboleda.client import NoAnswer
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Verb
from arboleda.runtime.leader import LeaderInfo
from arboleda.runtime.state import StateDir
from arboleda.runtime.tokens import TOKENS as FILE
from arboleda.runtime.web_options import WebOptions
from arboleda.web import stream
from arboleda.web.access.auth import Role
from arboleda_fleet.standby.waiting_room import WaitingRoom


@pytest.fixture
def guarded_plant(machine: Machine) -> Plant:
    """The plant of a leader that wants a token."""
    plant = Plant()
    machine.listen(LEADER, guarded(plant, dict(TOKENS)).app)
    return plant


@contextmanager
def standing_by(machine: Machine, state: Path, led: LeaderInfo | None, port: int = HERE) -> Iterator[None]:
    """A process on this state directory that stands by."""
    room = WaitingRoom("demo", state, WebOptions(port=port))
    room.show("waits for its end", led)
    machine.listen(port, room.app)
    with StateDir(state, plant="demo", store=STORE) as made:
        made.announce(port)
        yield


def test_what_is_asked_of_a_standby_is_asked_of_the_leader_and_said_once(
    state: Path, machine: Machine, plant: Plant, capsys: pytest.CaptureFixture[str]
) -> None:
    with standing_by(machine, state, LED):
        reached = PlantClient(state)
        assert reached.submit("sis_a 0B 7") == QUEUED
        assert reached.operate(Verb.STOP) == {"verb": "stop", "scope": ""}
        assert reached.status() == VIEW and reached.task("t-1") == QUEUED
    assert (plant.texts, plant.asked_by) == (["sis_a 0B 7"], ["command"])
    assert plant.acts == [(Verb.STOP, "", False)]
    assert capsys.readouterr().err == ASKED


@pytest.mark.usefixtures("guarded_plant")
@pytest.mark.parametrize("known", ["", "demo", LED.url], ids=["state directory", "name", "address"])
def test_a_leader_that_wants_a_token_is_shown_one_that_is_known_for_it(
    state: Path, machine: Machine, known: str
) -> None:
    if not known:
        state.mkdir()
        (state / FILE).write_text(json.dumps({role.value: token for role, token in TOKENS.items()}))
        (state / FILE).chmod(0o600)
    with standing_by(machine, state, LED):
        reached = client(state, {known: TOKENS[Role.OPERATOR]} if known else {})
        assert reached.submit("sis_a 0B 7") == QUEUED


@pytest.mark.usefixtures("guarded_plant")
@pytest.mark.parametrize("known", [{}, {"demo": "x" * 32}], ids=["none", "a wrong one"])
def test_a_leader_that_refuses_the_token_has_it_said_where_one_belongs(
    state: Path, machine: Machine, known: dict[str, str]
) -> None:
    with standing_by(machine, state, LED), pytest.raises(ArboledaError) as refused:
        client(state, known).status()
    said = str(refused.value)
    assert said.startswith(f"Plant demo is led on {LED.host}, which refuses this at {LED.url}: ")
    assert ("no token is known for it" in said) is (not known)
    assert f"copy tokens.json of the state directory there into {state}" in said
    assert "`demo TOKEN`" in said and "--tokens or $ARBOLEDA_TOKENS" in said


@pytest.mark.usefixtures("guarded_plant")
def test_what_a_leader_refuses_to_a_viewer_is_said_in_its_words(state: Path, machine: Machine) -> None:
    with standing_by(machine, state, LED), pytest.raises(ArboledaError, match="A viewer may look and stop"):
        client(state, {"demo": TOKENS[Role.VIEWER]}).submit("sis_a 0B 7")


def test_a_leader_that_is_not_there_is_said_to_be_that(state: Path, machine: Machine) -> None:
    with standing_by(machine, state, LED), pytest.raises(NoAnswer) as silent:
        PlantClient(state).operate(Verb.STOP)
    assert f"which cannot be reached at {LED.url} (" in str(silent.value)


def test_an_address_that_only_the_leaders_host_reaches_is_said_to_be_that(
    state: Path, machine: Machine
) -> None:
    far = replace(LED, host="host-a")
    with standing_by(machine, state, far), pytest.raises(ArboledaError) as unreached:
        PlantClient(state).status()
    assert str(unreached.value).endswith(
        f"it waits for its end. Plant demo is led on host-a, at {LED.url}, which is reached from"
        " host-a alone: start both hosts with `--host ADDRESS`, 0.0.0.0 or an address that other hosts reach."
    )


def test_an_address_where_another_plant_answers_gets_nothing_done(state: Path, machine: Machine) -> None:
    painting = Plant()
    machine.listen(LEADER, guarded(painting, name="painting").app)
    with standing_by(machine, state, LED), pytest.raises(ArboledaError, match="'demo' is meant"):
        PlantClient(state).operate(Verb.STOP)
    assert painting.acts == []


def test_where_what_answers_stands_by_as_well_nothing_goes_round_and_round(
    state: Path, machine: Machine, tmp_path: Path
) -> None:
    there = replace(LED, url=f"http://127.0.0.1:{OTHER}")
    with (
        standing_by(machine, tmp_path / "other", LED, OTHER),
        standing_by(machine, state, there),
        pytest.raises(ArboledaError, match="changes just now"),
    ):
        PlantClient(state).submit("sis_a 0B 7")
    assert machine.asked == [HERE, OTHER]


def test_while_nobody_leads_a_standby_says_what_it_waits_for(state: Path, machine: Machine) -> None:
    with (
        standing_by(machine, state, None),
        pytest.raises(ArboledaError, match=r"stands by and .* waits for its end$"),
    ):
        PlantClient(state).status()


def test_of_a_task_that_ended_between_two_leaders_the_history_tells(
    state: Path, machine: Machine, plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def tell(*_: object):
        yield f"event: snapshot\ndata: {json.dumps(VIEW | {'tasks': []})}\n\n"

    monkeypatch.setattr(stream, "tell", tell)
    with standing_by(machine, state, LED):
        assert [row["state"] for row in PlantClient(state).follow(QUEUED | {"id": "t-2"})] == ["failed"]
