"""The example of Node-RED with a real Node-RED, into which its flow is imported, at a mosquitto."""

from __future__ import annotations

import json
import socket
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.contract.conftest import Mosquitto, Peer
from tests.packages import ROOT

pytestmark = [pytest.mark.system, pytest.mark.requires("node")]

PROGRAM = Path(sys.prefix, "npm/node_modules/node-red/red.js")
EXAMPLE = ROOT / "examples/own_topics"
ONLINE = "            online: {hear: pump/online"
BOOTS_S = 60.0


class Bench:
    """Node-RED with the flow, the plant file that reaches it, and what is said at the broker."""

    def __init__(
        self, start: Callable[..., Any], node: str, broker: Mosquitto, folder: Path, spy: Peer
    ) -> None:
        self.plant, self.wire = folder / "node_red.yaml", spy.inbox
        address = f"{broker.address.host}:{broker.address.port}"
        _copy(folder, "recipes.py", "", "")
        _copy(folder, "node_red.yaml", ONLINE, f'            broker: "{address}"\n{ONLINE}')
        _copy(folder, "node_red_flow.json", '"1883"', f'"{broker.address.port}"')
        settings = {
            "uiHost": "127.0.0.1",
            "uiPort": _free_port(),
            "httpAdminRoot": False,
            "httpNodeRoot": False,
            "flowFile": str(folder / "node_red_flow.json"),
            "credentialSecret": False,
        }
        (folder / "settings.js").write_text(f"module.exports = {json.dumps(settings)};", "utf-8")
        words = (str(PROGRAM), "--userDir", str(folder / "user"), "--settings", str(folder / "settings.js"))
        self.node_red = start(node, *words)
        self.node_red.wait_for("Started flows", patience_s=BOOTS_S)
        self.hears("pump/online", b"true")

    def hears(self, topic: str, payload: bytes) -> None:
        self.wire.wait(
            lambda inbox: any((each.topic, each.payload) == (topic, payload) for each in inbox.deliveries)
        )

    def told(self, topic: str) -> list[Any]:
        """All messages of a topic so far."""
        return [json.loads(each.payload) for each in self.wire.deliveries if each.topic == topic]


def _copy(folder: Path, name: str, old: str, new: str) -> None:
    text = (EXAMPLE / name).read_text("utf-8")
    assert old in text
    (folder / name).write_text(text.replace(old, new), "utf-8")


def _free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


@pytest.fixture
def bench(
    start: Callable[..., Any],
    require: Callable[[str], str],
    mosquitto: Callable[..., Mosquitto],
    peer: Callable[..., Peer],
    tmp_path: Path,
) -> Bench:
    if not PROGRAM.is_file():
        pytest.skip("node-red is not installed: make test-tools")
    broker = mosquitto()
    broker.start()
    spy = peer("spy", broker.address, subscriptions=["pump/#"]).up()
    return Bench(start, require("node"), broker, tmp_path, spy)


def test_a_flow_doses_is_stopped_doses_again_and_is_gone(bench: Bench, arboleda: Callable[..., Any]) -> None:
    plant = ("--plant", str(bench.plant))
    up = arboleda("up", "bench dose 5 #first", *plant, "--boards", "real", "--no-ros")
    up.wait_for("done      bench 5")
    (first,) = bench.told("pump/done")
    assert first["is"] == "done" and bench.told("pump/dose")[0]["id"] == first["id"]
    arboleda("submit", "bench dose 10 #second", *plant).wait()
    bench.wire.wait(lambda inbox: bench.told("pump/state")[-1] == {"is": "dosing", "ml": 5})
    assert arboleda("stop", "bench", *plant).wait() == 0
    bench.wire.wait(lambda inbox: bench.told("pump/state")[-1] == {"is": "idle", "ml": 5})
    for verb in ("clear", "reset", "resume"):
        assert arboleda(verb, "bench", *plant).wait() == 0
    arboleda("submit", "bench dose 10 #third", *plant).wait()
    bench.wire.wait(lambda inbox: bench.told("pump/state")[-1] == {"is": "idle", "ml": 10})
    up.wait_for("done      bench 10")
    assert [each["is"] for each in bench.told("pump/done")] == ["done", "done"]
    arboleda("submit", "bench dose 5 #fourth", *plant).wait()
    bench.wire.wait(lambda inbox: bench.told("pump/state")[-1] == {"is": "dosing", "ml": 10})
    bench.node_red.kill()
    up.wait_for("it is there while it says")
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output
