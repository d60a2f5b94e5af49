"""What the methods of a client return, and what they raise, against the API of a plant in this process."""

from __future__ import annotations

import asyncio
import sys

import pytest
from tests.guarded_plant import guarded
from tests.in_process import ORIGIN, Machine
from tests.in_process import machine as machine
from tests.web_plant import KEPT, LATE, TASK, TOKENS, Plant
from tests.web_plant import plant as plant

from arboleda.client import (
    AsyncPlant,
    Conflict,
    Forbidden,
    Later,
    LibraryMissing,
    NotFound,
    OtherPlant,
    PlantError,
    Rows,
    Unauthorized,
    WrongRequest,
)
from arboleda.client import Plant as Client
from arboleda.model.errors import QueueFull, TextError
from arboleda.model.messages import Outcome, Verb
from arboleda.web.access.auth import Role


@pytest.fixture
def client(machine: Machine, plant: Plant) -> Client:
    machine.listen(8080, guarded(plant).app)
    return Client(ORIGIN, patience_s=0.0)


def test_forms_and_looks_come_as_they_are_declared(client: Client, plant: Plant) -> None:
    client.submit_form(cell="sis_a", values={"path": "0B", "station": 7}, id="lot43")
    assert plant.forms == [("sis_a", "", {"path": "0B", "station": 7}, "lot43")]
    assert client.recipes()[0].recipes[0].parameters[0].choices == ["5"]
    assert client.promises("sis_a,sis_b 0B 7")[1].cell == "sis_b"


def test_the_history_comes_as_rows_and_as_a_table(client: Client, plant: Plant) -> None:
    rows = client.history(state="failed", limit=20)
    assert [row.number for row in rows] == [row.number for row in KEPT]
    assert rows[0].unchecked == ["release"] and rows[0].key == LATE.key and rows[0].values == {"robot": "ra1"}
    assert (plant.queries[-1].state, plant.queries[-1].limit) == ("failed", 20)
    assert client.history_csv(cell="sis_a").startswith("number,id,text,cell,")


def test_rows_are_a_frame_of_pandas_or_say_how_to_get_it(
    client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Pandas:
        DataFrame = staticmethod(lambda rows: rows)

    rows = client.history()
    monkeypatch.setitem(sys.modules, "pandas", Pandas)
    assert rows.to_pandas()[0]["cell"] == "sis_b"
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(LibraryMissing, match="pip install pandas"):
        Rows(rows).to_pandas()


@pytest.mark.parametrize(("raised", "error"), [(TextError, WrongRequest), (QueueFull, Later)])
def test_a_refusal_of_the_plant_is_an_error_with_its_sentence_as_data(
    client: Client, plant: Plant, raised: type, error: type
) -> None:
    plant.answer = raised(LATE)
    with pytest.raises(raised, match=r"^ra1 was late$") as refused:
        client.submit("sis_x")
    assert isinstance(refused.value, error)
    assert (refused.value.key, refused.value.values) == ("late", {"robot": "ra1"})
    assert refused.value.retry_after_s == (10.0 if error is Later else None)


def test_a_task_that_is_refused_is_an_error_too(client: Client, plant: Plant) -> None:
    plant.answer = TASK | {"state": "refused", "sentence": "There is no sis_x."}
    with pytest.raises(WrongRequest, match=r"^There is no sis_x\.$") as refused:
        client.submit("sis_x 0B 7")
    assert refused.value.data["state"] == "refused"


def test_verbs_carry_their_arguments(client: Client, plant: Plant) -> None:
    plant.told = {"act": 4, "outcome": Outcome.UNDER_WAY}
    assert client.operate(Verb.HOME, "ra1", by_hand=True).act == 4
    client.operate("answer", "ana", answer="yes")
    assert client.stop().verb == "stop"
    assert plant.acts == [
        (Verb.HOME, "ra1", True),
        (Verb.ANSWER, "ana", False, ("answer", "yes")),
        (Verb.STOP, "", False),
    ]
    plant.refusal = "ra1 still moves."
    with pytest.raises(Conflict, match=r"^ra1 still moves\.$"):
        client.operate("clear", "sis_a")
    with pytest.raises(WrongRequest, match="is not an operator's verb"):
        client.operate("explode")


def test_an_act_is_followed_to_its_end(client: Client, plant: Plant) -> None:
    row = {"number": 4, "at": 1.0, "verb": "home", "scope": "ra1", "cell": None, "sentence": ""}
    row |= {"why": None, "ended_at": None, "ended": None}
    outcomes = iter(["under_way", "done"])
    plant.act = lambda number: row | {"outcome": next(outcomes)}
    assert client.outcome(4).outcome == "done"


def test_any_route_is_asked_by_its_address(client: Client, plant: Plant) -> None:
    assert [row["cell"] for row in client.get("/api/history", {"cell": "sis_a", "state": None})] == ["sis_a"]
    assert plant.queries[-1].cell == "sis_a" and plant.queries[-1].state == ""
    assert client.post("/api/tasks", {"text": "sis_a 0B 7"})["state"] == "queued"
    assert client.post("/api/plant/stop")["verb"] == "stop"
    with pytest.raises(WrongRequest, match="since"):
        client.get("/api/history", {"since": "yesterday"})
    with pytest.raises(NotFound, match="/api/docs"):
        client.post("/api/nothing")


def test_an_address_that_would_lead_to_another_host_is_refused(client: Client, machine: Machine) -> None:
    with pytest.raises(PlantError, match=r"^The path of a route begins with /, as in /api/plant; '@x/api' "):
        client.get("@x/api")
    assert machine.asked == []


def test_any_route_is_awaited_in_a_loop(machine: Machine, plant: Plant) -> None:
    machine.listen(8080, guarded(plant).app)

    async def work() -> None:
        async with AsyncPlant(ORIGIN, patience_s=0.0) as client:
            assert (await client.get("/api/plant"))["plant"] == "demo"
            assert (await client.post("/api/plant/stop"))["verb"] == "stop"

    asyncio.run(work())


def test_what_is_not_there_is_said_to_be_that(client: Client) -> None:
    with pytest.raises(NotFound, match="knows no task 'lot'"):
        client.task("lot")
    with pytest.raises(NotFound, match="knows no act 7"):
        client.act(7)


def test_what_is_not_allowed_without_a_token_or_to_a_viewer_is_told_apart(
    machine: Machine, plant: Plant
) -> None:
    machine.listen(8080, guarded(plant, dict(TOKENS)).app)
    with pytest.raises(Unauthorized, match="token"):
        Client(ORIGIN).snapshot()
    viewer = Client(ORIGIN, token=TOKENS[Role.VIEWER])
    assert viewer.snapshot().plant == "demo" and viewer.stop().verb == "stop"
    with pytest.raises(Forbidden, match="operator's token"):
        viewer.submit("sis_a 0B 7")


def test_another_plant_at_the_address_gets_nothing_done(machine: Machine, plant: Plant) -> None:
    machine.listen(8080, guarded(plant, name="demo").app)
    with pytest.raises(OtherPlant, match="demo"):
        Client(ORIGIN, plant="other", patience_s=0.0).submit("sis_a 0B 7")
    assert plant.texts == []
