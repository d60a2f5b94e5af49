"""The tools of an assistant, by the client of the SDK, before the API of a plant in this process."""

from __future__ import annotations

import asyncio
from pathlib import Path
from types import SimpleNamespace

import pytest
from tests.guarded_plant import guarded
from tests.in_process import ORIGIN, Machine
from tests.in_process import machine as machine
from tests.web_plant import Plant

from arboleda.model.assistants import NO_LIMITS, Assistants
from arboleda.testing import Rig, shipped
from arboleda_make.assistant.bench import Bench

from .asking import in_process, replied
from .asking import read as read

LOOKS = {"plant", "devices", "recipes", "nodes", "targets", "tree", "tasks", "task", "history", "why_failed"}
LOOKS |= {"worked"}
LOOKS |= {"check_tree", "copy_tree", "proposals", "proposal"}
PROPOSES = {"propose", "prove_proposal", "simulate_proposal", "withdraw", "give_task"}
TRIES = {"check", "simulate", "prove", "twin"}
NEVER = (
    "jog",
    "override",
    "release",
    "clear",
    "reset",
    "home",
    "resume",
    "retry",
    "submit",
    "answer",
    "publish",
)


@pytest.fixture
def plant(machine: Machine) -> Plant:
    plant = Plant()
    machine.listen(8080, guarded(plant).app)
    return plant


def test_a_plant_that_does_not_allow_it_is_not_looked_at_and_can_be_stopped(plant: Plant) -> None:
    plant.model = SimpleNamespace(assistants=Assistants.OFF, assistant_limits=NO_LIMITS)  # type: ignore[attr-defined]

    async def work() -> None:
        async with in_process(ORIGIN, Bench(Path("plant.yaml"), lambda _: ["false"])) as client:
            for tool in (await client.list_tools()).tools:
                named = tool.input_schema.get("required", [])
                reply = await replied(client, tool.name, **dict.fromkeys(named, "sis_a"))
                refused = tool.name != "stop"
                assert reply["refused"] is refused
                assert not refused or "`assistants: read`" in reply["data"]["sentence"]

    asyncio.run(work())


def test_what_people_do_has_no_tool_and_what_only_looks_says_so(read: Plant) -> None:
    async def work() -> None:
        async with in_process(ORIGIN, Bench(Path("plant.yaml"))) as client:
            tools = {tool.name: tool for tool in (await client.list_tools()).tools}
            assert tools.keys() == LOOKS | PROPOSES | TRIES | {"stop"}
            acts = {name for name, tool in tools.items() if not tool.annotations.read_only_hint}
            assert acts == PROPOSES | {"stop"}
            for name in NEVER:
                result = await client.call_tool(name, {"scope": "sis_a"})
                assert result.is_error

    asyncio.run(work())
    assert read.acts == [] and read.texts == []


def test_a_tree_that_runs_is_drawn_and_a_cell_that_is_none_is_said_to_be_that(read: Plant) -> None:
    rig = Rig(shipped())
    rig.submit("sis_a 0B 7")
    rig.wait(1.0)
    (rows,) = (each["tree"] for each in rig.snapshot()["cells"] if each["name"] == "sis_a")
    cell = {"name": "sis_a", "state": "execute", "devices": [], "task": None, "step": None, "queue": []}
    cell |= {"paused": False, "advice": [], "refused": {}, "places": [], "teaching": None, "tree": rows}
    cell |= dict.fromkeys(("waiting_for", "not_ready", "blocked_by", "held_by"))
    read.becomes(cells=[cell])

    async def work() -> None:
        async with in_process(ORIGIN) as client:
            assert "tree" not in (await replied(client, "plant"))["data"]["cells"][0]
            drawn = (await replied(client, "tree", cell="sis_a"))["data"]
            assert drawn["svg"].startswith("<svg ") and "drive path 0B" in drawn["svg"]
            assert len(drawn["rows"]) == len(rows)
            none = await replied(client, "tree", cell="sis_z")
            assert none["refused"] and "'sis_z' is not a cell; there are sis_a" in none["data"]["sentence"]

    asyncio.run(work())
