"""An assistant at a plant that really runs: it looks, stops a task, asks why that failed, tries the file."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from mcp import Client, StdioServerParameters, stdio_client
from tests.system.conftest import paths

from arboleda.client import Plant
from arboleda.plant_file.loader import load

pytestmark = pytest.mark.system
ASKED_EVERY_S = 0.2  # who asks all the time has too many requests
PROGRAM = "from arboleda.cli.main import main; main()"


async def data(client: Client, tool: str, **given: Any) -> Any:
    result = await client.call_tool(tool, given)
    assert result.structured_content is not None and not result.structured_content["refused"], result
    return result.structured_content["data"]


@pytest.mark.smoke
def test_it_looks_stops_asks_why_and_tries_the_plant_file(
    arboleda: Callable[..., Any], start: Callable[..., Any], free_port: int, tmp_path: Path
) -> None:
    new = start(sys.executable, "-c", PROGRAM, "new", str(tmp_path / "own"), env={"PYTHONPATH": paths()})
    assert new.wait() == 0, new.output
    file = tmp_path / "own" / "plant.yaml"
    file.write_text(file.read_text("utf-8") + "\nassistants: read\n", "utf-8")
    up = arboleda("up", "--no-ros", "--plant", str(file), "--port", str(free_port))
    up.wait_for("HTTP API")
    options = ["mcp", "--plant", str(file), "--state", str(tmp_path / "state")]
    server = StdioServerParameters(
        command=sys.executable, args=["-c", PROGRAM, *options], env={**os.environ, "PYTHONPATH": paths()}
    )

    async def work() -> None:
        async with Client(stdio_client(server)) as client:
            assert (await data(client, "check"))["status"] == 0
            (offer,) = (await data(client, "recipes"))["offers"]
            with Plant(f"http://127.0.0.1:{free_port}") as person:
                task = await asyncio.to_thread(person.submit, offer["recipes"][0]["example"])
                running = await asyncio.to_thread(lambda: next(_running(person, task.id)))
            assert running.state == "running"
            assert (await data(client, "tree", cell=offer["cell"]))["svg"].startswith("<svg ")
            assert (await data(client, "targets", cell=offer["cell"]))["targets"]
            await data(client, "stop")
            report = await data(client, "why_failed", task_id=task.id)
            assert report["cause"]["kind"] == "operator" and report["evidence"]["acts"][-1]["words"] == "stop"
            assert (await data(client, "history", state="failed"))[0]["id"] == task.id
            simulated = await data(client, "simulate", seeds=1, cycles=1)
            assert simulated["status"] == 0, simulated

    asyncio.run(work())
    assert up.interrupt() == 0, up.output


TREE = """<root BTCPP_format="4"><BehaviorTree ID="Rest"><Sequence>{step}</Sequence></BehaviorTree></root>"""
LIMITS = "\nassistants: submit\nassistant_limits: {cells: [%s]}\n"


def test_what_it_proposes_moves_nothing_before_a_person_has_approved_it(
    arboleda: Callable[..., Any], start: Callable[..., Any], free_port: int, tmp_path: Path
) -> None:
    new = start(sys.executable, "-c", PROGRAM, "new", str(tmp_path / "own"), env={"PYTHONPATH": paths()})
    assert new.wait() == 0, new.output
    file = tmp_path / "own" / "plant.yaml"
    cell = str(load(file).cells[0].name)
    file.write_text(file.read_text("utf-8") + LIMITS % cell, "utf-8")
    up = arboleda("up", "--no-ros", "--plant", str(file), "--port", str(free_port))
    up.wait_for("HTTP API")
    options = ["mcp", "--plant", str(file), "--state", str(tmp_path / "state")]
    server = StdioServerParameters(
        command=sys.executable, args=["-c", PROGRAM, *options], env={**os.environ, "PYTHONPATH": paths()}
    )

    async def refused(client: Client, tool: str, **given: Any) -> str:
        result = await client.call_tool(tool, given)
        assert result.structured_content is not None and result.structured_content["refused"]
        return str(result.structured_content["data"]["sentence"])

    async def work() -> None:
        async with Client(stdio_client(server)) as client:
            with Plant(f"http://127.0.0.1:{free_port}") as person:
                loader = next(iter((await data(client, "targets", cell=cell))["devices"]))
                tree = TREE.format(step=f"<{loader}_home/>")
                wanted = {"name": "resting", "words": "<b>it rests</b>", "recipes": ["rest"]}
                wrong = await data(client, "propose", **wanted, trees={"rest.xml": TREE.format(step="<no/>")})
                assert wrong["hash"] is None and "no" in wrong["problems"][0]
                first = (await data(client, "propose", **wanted, trees={"rest.xml": tree}))["hash"]
                await refused(client, "give_task", text=f"{cell} rest")
                await asyncio.to_thread(person.reject, first, "Ana", "say why")
                assert (await data(client, "proposal", hash=first))["reason"] == "say why"
                wanted["words"] = "it goes home twice"
                tree = TREE.format(step=f"<{loader}_home/><{loader}_home/>")
                second = (await data(client, "propose", **wanted, trees={"rest.xml": tree}))["hash"]
                await data(client, "prove_proposal", hash=second, recipes=["rest"], budget_s=2)
                proof = None
                while proof is None:
                    await asyncio.sleep(ASKED_EVERY_S)
                    proof = (await data(client, "proposal", hash=second))["proof"]
                assert proof["runs"]["done"] > 0
                assert await asyncio.to_thread(person.history) == []
                done = await asyncio.to_thread(person.approve, second, "Ana")
                assert (done.stage, done.version, done.problems) == ("approved", 2, [])
                task = await data(client, "give_task", text=f"{cell} rest #lot42")
                assert (await asyncio.to_thread(person.wait, task["id"])).state == "done"
                (row,) = await asyncio.to_thread(person.history)
                assert row.asked_by == "assistant" and "approved by Ana" in str(row.choice)
                other = next(each.name for each in load(file).cells[0].recipes if each.name != "rest")
                example = next(
                    each["example"]
                    for each in (await data(client, "recipes"))["offers"][0]["recipes"]
                    if each["name"] == other
                )
                assert "nobody has approved" in await refused(client, "give_task", text=example)

    asyncio.run(work())
    assert up.interrupt() == 0, up.output


def _running(person: Plant, task: str) -> Any:
    return (each for each in person.follow(task) if each.state == "running")
