"""Telemetry and commands per second through the MQTT bridge, and how long each takes at half of that.

Ours is the shipped node `mqtt_bridge` with a plant of 10 cells at evidence `ids`. Both its ends are in this
process: the boards of the 10 arms, at a mosquitto of the benchmark's own, and the plant's side on ROS 2.

- Telemetry: an arm's board reports that it has moved on; it has come through when its `status` is here, where
  it is not even unpacked. Boards are present, and every report differs from the last in all its joints.
- Goals: a goal on `command`, as the plant gives it; it has come through when the board has its `juntas`.
  Meanwhile the plant beats and the boards report twice a second, without which the bridge would send nothing.

A rate is that of a saturated bridge: four messages of each arm are always under way, and each that comes out
makes room for the next, so no queue overflows (what is lost all the same, the notes say). Latencies are those
of messages at equal distances, half as many as ours gets through, the same for the floor. The processor time
is that of the bridge's process per message of the saturated runs; a busy machine changes it less than the
rates.

The floor is a bare node with the same executor and one paho client, and does as little as it can: JSON is
parsed with `json`, messages are filled at once and published from the callback. It publishes the same four
messages per report (`status` with the same values, `motion_state`, `joint_states`, `piece_detected`) with the
same QoS, and two per goal (the beat that must come before a move, QoS 0, and the goal, QoS 1, one in flight
as the contract wants it), and beats with the plant. It checks nothing and knows no presence, staleness,
epochs, latches or repeats. It works in a namespace and at a broker of its own, so that both run at once and
are measured in turns.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from statistics import median

from arboleda.plant_file.loader import load
from arboleda.testing.storage_layout import StorageLayout
from arboleda_ros.link import connect

from . import plants
from .bridge_ends import Ends
from .flow import Flow
from .processes import Process
from .result import Aim, Figure, Result, percentile
from .scene import Scene

CELLS = 10
AIM = Aim(least=0.5)


@dataclass
class Way:
    """One direction of one bridge, and what was measured of it."""

    process: Process
    flow: Flow
    rates: list[float] = field(default_factory=list)
    costs: list[float] = field(default_factory=list)
    took: list[float] = field(default_factory=list)

    @property
    def lost(self) -> int:
        return self.flow.sent - self.flow.arrived

    def saturate(self, seconds: float) -> None:
        """Add a rate, and the processor time per message meanwhile."""
        arrived, cpu_s = self.flow.arrived, self.process.cpu_s
        self.rates.append(self.flow.rate(seconds))
        self.costs.append((self.process.cpu_s - cpu_s) / (self.flow.arrived - arrived))


def run(scene: Scene) -> Result:
    """Both bridges at once, measured in turns."""
    plant = plants.write(scene.folder / "plant.yaml", CELLS)
    brokers = scene.mosquitto(), scene.mosquitto()
    processes = (
        scene.node("mqtt_bridge", plant, broker=brokers[0]),
        scene.python(
            "arboleda_bench.floor_bridge", str(plant), brokers[1], "--ros-args", "-r", "__ns:=/floor"
        ),
    )
    arms, link = [StorageLayout(cell).arm for cell in load(plant).cells], connect()
    ends: list[Ends] = []
    try:
        node = link.node("ends")
        ends += [
            Ends(node, arms, broker, space) for broker, space in zip(brokers, ("", "floor/"), strict=True)
        ]
        link.start()
        return _measured(scene, ends, processes)
    finally:
        for each in ends:
            each.close()
        link.close()


def _measured(scene: Scene, ends: Sequence[Ends], processes: Sequence[Process]) -> Result:
    scene.say("starting")
    for each, process in zip(ends, processes, strict=True):
        each.open(process.check)
    figures: list[Figure] = []
    notes: list[str] = []
    for name in ("telemetry", "goals"):
        ours, floor = (Way(p, getattr(e, name)) for e, p in zip(ends, processes, strict=True))
        _measure(scene, name, ours, floor)
        figures += _figures(name, ours, floor)
        notes.append(_note(name, ours, floor))
    return Result(figures=figures, notes=notes)


def _measure(scene: Scene, name: str, ours: Way, floor: Way) -> None:
    turns, seconds = (1, 0.5) if scene.quick else (4, 1.5)
    for turn in range(turns):
        scene.say(f"{name}, turn {turn + 1} of {turns}")
        floor.saturate(seconds)
        ours.saturate(seconds)
    half = median(ours.rates) / 2
    for turn in range(turns):
        scene.say(f"{name} at half load, turn {turn + 1} of {turns}")
        floor.took += floor.flow.latencies(half, seconds)
        ours.took += ours.flow.latencies(half, seconds)


def _figures(name: str, ours: Way, floor: Way) -> list[Figure]:
    def both(what: str, unit: str, of: Callable[[Way], float], aim: Aim | None = None) -> Figure:
        return Figure(name=f"{name}, {what}", unit=unit, ours=of(ours), floor=of(floor), aim=aim)

    return [
        both("saturated", "/s", lambda way: median(way.rates), AIM),
        both("processor time each", "us", lambda way: 1e6 * median(way.costs)),
        both("p50 at half load", "ms", lambda way: 1000 * percentile(way.took, 50)),
        both("p99 at half load", "ms", lambda way: 1000 * percentile(way.took, 99)),
    ]


def _note(name: str, ours: Way, floor: Way) -> str:
    half = median(ours.rates) / 2
    return (
        f"{name}: half load is {half:.0f} per second, {len(ours.took)} messages of ours; "
        f"of {ours.flow.sent} and {floor.flow.sent} messages in all, {ours.lost} and {floor.lost} were lost"
    )
