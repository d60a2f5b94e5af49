"""`arboleda mcp` with the client of the SDK, over stdio and HTTP, before the real server of a plant."""

from __future__ import annotations

import asyncio
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx2
from mcp import Client, StdioServerParameters, stdio_client
from mcp.client.streamable_http import streamable_http_client
from packages.arboleda_make.tests.fast.assistant.asking import in_process, replied
from packages.arboleda_make.tests.fast.assistant.asking import read as read
from tests.contract.web.conftest import Web
from tests.web_plant import TOKENS, Plant

from arboleda.model.messages import Verb
from arboleda.web.access.auth import Role
from arboleda_make.assistant.bench import Bench

PROGRAM = "from arboleda.cli.main import main; main()"
ENVIRON = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
PROOF: dict[str, Any] = {"complete": True, "runs": {"done": 1, "of": 9}, "alone": 1.0}
PROOF |= {key: [] for key in ("table", "scenarios", "unnoticed", "breaches")}


def over_stdio(url: str, *options: str) -> Any:
    command = ["-c", PROGRAM, "mcp", "--url", url, *options]
    return stdio_client(StdioServerParameters(command=sys.executable, args=command, env=ENVIRON))


@contextmanager
def over_http(url: str) -> Iterator[str]:
    """The address of a server for assistants on a port of its own."""
    command = [sys.executable, "-c", PROGRAM, "mcp", "--url", url, "--port", "0"]
    process = subprocess.Popen(command, env=ENVIRON, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    try:
        yield process.stderr.readline().removeprefix("MCP: ").strip()
    finally:
        process.terminate()
        process.wait()
        process.stderr.close()


def test_over_stdio_an_assistant_looks_and_stops_and_has_nothing_else(local: Web, read: Plant) -> None:
    async def work() -> None:
        async with Client(over_stdio(local.origin)) as client:
            tools = {tool.name for tool in (await client.list_tools()).tools}
            assert {"plant", "tasks", "propose", "stop"} <= tools and not tools & {"check", "release"}
            assert (await replied(client, "plant"))["data"]["plant"] == "demo"
            assert (await replied(client, "tasks"))["data"][0]["id"] == "t-1"
            assert (await replied(client, "stop", scope="sis_a"))["data"]["verb"] == "stop"

    asyncio.run(work())
    assert read.acts == [(Verb.STOP, "sis_a", False)]


def test_over_http_each_call_has_the_role_of_its_token(open_to_all: Web, read: Plant) -> None:
    async def work(address: str, token: str) -> dict[str, Any]:
        headers = {"authorization": f"Bearer {token}"} if token else {}
        async with (
            httpx2.AsyncClient(headers=headers) as http,
            Client(streamable_http_client(address, http_client=http)) as client,
        ):
            looked, stopped = await replied(client, "history", limit=1), await replied(client, "stop")
            targets = await replied(client, "targets", cell="sis_a")
            return {"history": looked, "stop": stopped, "targets": targets}

    with over_http(open_to_all.origin) as address:
        viewer = asyncio.run(work(address, TOKENS[Role.VIEWER]))
        nobody = asyncio.run(work(address, ""))
    assert viewer["history"]["data"][0]["id"] == "t-2" and viewer["stop"]["data"]["verb"] == "stop"
    assert viewer["targets"]["data"]["error"] == "Forbidden"
    assert all(reply["data"]["error"] == "Unauthorized" for reply in nobody.values())
    assert read.acts == [(Verb.STOP, "", False)]


def test_a_plant_elsewhere_is_shown_the_token_of_a_file(
    open_to_all: Web, read: Plant, tmp_path: Path
) -> None:
    file = tmp_path / "tokens"
    file.write_text(f"{open_to_all.origin} {TOKENS[Role.VIEWER]}\n")
    file.chmod(0o600)

    async def work() -> None:
        async with Client(over_stdio(open_to_all.origin, "--tokens", str(file))) as client:
            assert (await replied(client, "plant"))["data"]["plant"] == "demo"

    asyncio.run(work())


def test_without_its_library_it_says_how_to_get_it() -> None:
    missing = f"import sys; sys.modules['mcp'] = None; sys.argv = ['arboleda', 'mcp']; {PROGRAM}"
    ran = subprocess.run(
        [sys.executable, "-c", missing], env=ENVIRON, capture_output=True, text=True, check=False
    )
    assert ran.returncode == 1 and "'arboleda[mcp]'" in ran.stderr and "Traceback" not in ran.stderr


def test_without_a_plant_it_says_who_can_start_one(tmp_path: Path) -> None:
    async def work() -> None:
        command = ["-c", PROGRAM, "mcp", "--state", str(tmp_path)]
        nobody = StdioServerParameters(command=sys.executable, args=command, env=ENVIRON)
        async with Client(stdio_client(nobody)) as client:
            reply = await replied(client, "plant")
            assert (
                reply["refused"] and "a person can start one with `arboleda up`" in reply["data"]["sentence"]
            )

    asyncio.run(work())


def test_over_http_other_names_and_pages_of_browsers_are_refused(local: Web, read: Plant) -> None:
    call = {"jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": {"name": "stop", "arguments": {}}}
    accept = {"accept": "application/json, text/event-stream", "content-type": "application/json"}
    others = [("host", "evil.example"), ("origin", "http://evil.example"), ("origin", "http://localhost")]
    with over_http(local.origin) as address:
        answers = [httpx2.post(address, json=call, headers=accept | {name: value}) for name, value in others]
    assert [answer.status_code for answer in answers] == [421, 403, 403] and read.acts == []


def test_a_plant_file_is_tried_by_commands_within_limits_and_what_they_find_is_data(
    local: Web, read: Plant
) -> None:
    words: list[list[str]] = []
    answer = {"findings": [{"sentence": "it is open", "line": 3}], "mend": {"edits": [], "left": 0}}
    printed = {"check": json.dumps(answer, indent=1), "prove": json.dumps({"answer": {**PROOF, **answer}})}

    def command(given: Any) -> list[str]:
        words.append(list(given))
        if given[0] == "simulate":
            return [sys.executable, "-c", "print('sis_a: broke\\x1b[31m'); raise SystemExit(1)"]
        return [sys.executable, "-c", f"print({printed[given[0]]!r})"]

    async def work() -> None:
        async with in_process(local.origin, Bench(Path("plant.yaml"), command)) as client:
            broke = (await replied(client, "simulate"))["data"]
            assert broke["status"] == 1 and broke["lines"] == ["sis_a: broke\\x1b[31m"]
            checked = (await replied(client, "check"))["data"]
            assert checked == {"status": 0, "meaning": "good", **answer}
            proved = (await replied(client, "prove", recipes=["storage"], budget_s=5))["data"]
            assert {key: proved[key] for key in answer} == answer and proved["runs"] == {"done": 1, "of": 9}
            assert (await replied(client, "simulate", seeds=51))["refused"]
            assert (await replied(client, "prove", budget_s=0))["refused"]

    asyncio.run(work())
    assert words[1] == ["check", "plant.yaml", "--mend", "--json", "-"]
    assert words[2][:5] == ["prove", "--budget", "5s", "--jobs", "1"]
    assert words[2][-4:] == ["--recipe", "storage", "--", "plant.yaml"] and len(words) == 3
