"""Lesson 10: a whole plant from its file: a task refused, one done, one failed and recovered, one retried."""

from __future__ import annotations

import json
from argparse import ArgumentParser
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from tempfile import TemporaryDirectory
from typing import Any

from paho.mqtt.client import Client
from paho.mqtt.enums import CallbackAPIVersion

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.cli.session import ros_link
from arboleda.drivers import MotionState
from arboleda.extension import Sentence, load
from arboleda.runtime.build import App, Options, build
from arboleda_class.lessons import spoken

PLANT = Path(__file__).parent / "plants" / "lessons.yaml"
PATIENCE_S = 60.0

Snapshot = dict[str, Any]


class Plant:
    """The plant, what its tasks come to, and what its cells do; everything that changes is printed."""

    def __init__(self, app: App) -> None:
        self.app = app
        self.states: dict[str, str] = {}
        self._news: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._steps: dict[str, str] = {}
        self._robots: dict[str, Snapshot] = {}
        self._told: set[object] = set()
        app.listen(lambda change: self._news.put(lambda: self._changed(change)))
        app.watch(lambda snapshot: self._news.put(lambda: self._stepped(snapshot)))

    def submit(self, text: str) -> None:
        """Ask for a task; the answer is printed when it comes."""
        print(f"submit {text!r}", flush=True)
        self.app.plant.submit(text)

    def wait(self, arrived: Callable[[], object]) -> None:
        """Until what the plant told makes it true."""
        while not arrived():
            try:
                self._news.get(timeout=PATIENCE_S)()
            except Empty:
                raise SystemExit(f"nothing happened for {PATIENCE_S:g} s") from None

    def wait_for_move(self, cell: str, arm: str, step: str) -> None:
        """Until the cell is at that step and its arm moves: the command comes a little before the move."""
        self.wait(lambda: self._steps[cell] == step and self._robots[arm]["state"] == MotionState.MOVING)

    def wait_for_robots(self) -> None:
        """Until every robot is there and ready."""
        self.wait(lambda: self._robots and all(each["obstacle"] is None for each in self._robots.values()))

    def wait_for_end(self, *ids: str) -> None:
        self.wait(lambda: all(self.states.get(id) in ("done", "failed", "cancelled") for id in ids))

    def _changed(self, change: Any) -> None:
        name = change.task or change.request
        self.states[name or ""] = change.state.value
        because = f": {change.sentence}" if change.sentence else ""
        print(f"  {change.text}: {change.state.value}{because}", flush=True)

    def _stepped(self, snapshot: Snapshot) -> None:
        self._robots = {robot["name"]: robot for robot in snapshot["robots"]}
        for cell in snapshot["cells"]:
            name, step = cell["name"], cell["step"]
            if step and step.key == "step.in_recovery" and str(step) != self._steps.get(name):
                print(f"  {name}: {step}", flush=True)
            self._steps[name] = str(step or "")
            for said in {row["feedback"] for row in cell["tree"]} - self._told:
                self._told.add(said)
                if isinstance(said, Sentence) and said.key == "command.again":
                    print(f"  {said}", flush=True)


class Stranger:
    """Somebody else on the broker."""

    def __init__(self, host: str, port: int) -> None:
        self._client = Client(CallbackAPIVersion.VERSION2)
        self._client.connect(host, port)
        self._client.loop_start()

    def halt(self, board: str) -> None:
        """Halt a board; the plant did not ask for it."""
        print(f"a stranger halts {board}", flush=True)
        self._client.publish(f"{board}/paro", json.dumps({"paro": 2, "seq": 0, "epoca": 0}), qos=1)

    def leave(self) -> None:
        self._client.disconnect()
        self._client.loop_stop()


def lesson(plant: Plant, stranger: Stranger) -> None:
    plant.wait_for_robots()
    print("A task that names a station that is not there:")
    plant.submit("sis_a 0B 99")
    plant.wait(lambda: "refused" in plant.states.values())

    print("Two cells at work at the same time:")
    plant.submit("sis_a 0B 7 #lot1")
    plant.submit("sis_b 1B 3 #lot2")
    plant.wait_for_end("lot1", "lot2")

    print("A move that is cut short in sis_a, which tries nothing again:")
    plant.submit("sis_a 0B 0 #lot3")
    plant.wait_for_move("sis_a", "ra1", "move to station 0")
    stranger.halt("ra_1")
    plant.wait_for_end("lot3")

    print("The cell has recovered and goes on:")
    plant.submit("sis_a 2B 0 #lot4")
    plant.wait_for_end("lot4")

    print("The same in sis_b, which tries a step once more:")
    plant.submit("sis_b 0B 0 #lot5")
    plant.wait_for_move("sis_b", "ra2", "move to station 0")
    stranger.halt("ra_2")
    plant.wait_for_end("lot5")
    print(
        f"So it ended: {', '.join(f'{id} {state}' for id, state in plant.states.items() if id[:3] == 'lot')}"
    )


def main() -> None:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("--ros", action="store_true", help="join plant and bridge over ROS 2")
    parser.add_argument("--rate", type=float, default=2.0, help="how much faster the robots are [default: 2]")
    words = parser.parse_args()
    link = ros_link(lan=False) if words.ros else None
    broker = EmbeddedBroker(port=0)
    address = broker.start()
    with TemporaryDirectory() as folder, suppress(KeyboardInterrupt):
        options = Options(link=link, broker=str(address), rate=words.rate, state_dir=Path(folder))
        app = build(load(PLANT), {"devices", "bridge", "orchestrator"}, options)
        plant = Plant(app)
        app.start()
        stranger = Stranger(address.host, address.port)
        try:
            lesson(plant, stranger)
        finally:
            stranger.leave()
            app.stop()
    broker.stop()


if __name__ == "__main__":
    spoken(main)
