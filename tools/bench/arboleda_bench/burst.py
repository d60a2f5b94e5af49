"""Bursts of tasks over ROS 2: every one is accepted, or refused with the reason; none is lost.

A user publishes on `/task_request` and listens to `/task_status`, as any node would; the plant is the
shipped node `orchestrator`, its robots are played by this process and answer fast. Each task has an id of its
own. It is lost where neither its acceptance nor its refusal is told; an accepted one must end exactly once.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from . import plants
from .crew_ros import DEPTH, CrewOnRos
from .processes import Process
from .result import Aim, Figure, Result
from .scene import Scene, wait_for

CELLS = 10
MOVE_S = 0.01
TIMING = {"dwell_s": 0.0}
PACE_HZ = 20.0
QUIET_S = 10.0  # without a word about any task: no more will come
LIMIT_S = 120.0
ENDED = frozenset({"done", "failed", "cancelled"})
OVER = ENDED | {"refused"}
NONE = Aim(most=0, of_ratio=False)


@dataclass(frozen=True, kw_only=True)
class Burst:
    """So many tasks to the first `cells` cells in turn, `pace_hz` of them per second, None back to back."""

    name: str
    tasks: int
    cells: int
    pace_hz: float | None = None


BURSTS = (
    Burst(name="100 tasks at 20/s to 1 cell", tasks=100, cells=1, pace_hz=PACE_HZ),
    Burst(name="1000 tasks back to back to 10 cells", tasks=1000, cells=10),
    Burst(name="200 tasks back to back to 1 cell", tasks=200, cells=1),
)
QUICK = (
    Burst(name="20 tasks at 20/s to 1 cell", tasks=20, cells=1, pace_hz=PACE_HZ),
    Burst(name="200 tasks back to back to 10 cells", tasks=200, cells=10),
)


def run(scene: Scene) -> Result:
    file = plants.write(scene.folder / "plant.yaml", CELLS, timing=TIMING)
    node = scene.node("orchestrator", file)
    figures: list[Figure] = []
    with CrewOnRos(file, move_s=MOVE_S) as user:
        user.wait_for_the_plant(node)
        for burst in QUICK if scene.quick else BURSTS:
            scene.say(burst.name)
            figures += _measured(burst, user, node)
    return Result(
        figures=figures,
        notes=(
            f"Moves take {MOVE_S} s and the plant file says dwell_s: 0, so that the queues empty soon;"
            " queue_limit is 100 as ever.",
            f"The user's publisher has a depth of {DEPTH}; with the usual 10, DDS forgets unsent ones.",
        ),
    )


def _measured(burst: Burst, user: CrewOnRos, node: Process) -> list[Figure]:
    ids = _request_all(burst, user)
    _await_rest(ids, user, node)
    states = _states(user)
    accepted = [id for id in ids if "queued" in states.get(id, ())]
    refused = [id for id in ids if "refused" in states.get(id, ())]
    lost = len(ids) - len(accepted) - len(refused)
    wrong = sum(sum(states[id][state] for state in ENDED) != 1 for id in accepted)
    return [
        Figure(name=f"{burst.name}: accepted", unit="", ours=len(accepted)),
        Figure(name=f"{burst.name}: refused with the reason", unit="", ours=len(refused)),
        Figure(name=f"{burst.name}: lost", unit="", ours=lost, aim=NONE),
        Figure(name=f"{burst.name}: accepted, not ended once", unit="", ours=wrong, aim=NONE),
    ]


def _request_all(burst: Burst, user: CrewOnRos) -> Sequence[str]:
    """Ask for all tasks of a burst; return their ids."""
    began = time.monotonic()
    ids = [f"b{time.monotonic_ns()}-{number}" for number in range(burst.tasks)]
    for number, id in enumerate(ids):
        if burst.pace_hz is not None:
            time.sleep(max(0.0, began + number / burst.pace_hz - time.monotonic()))
        user.ask(f"{user.cells[number % burst.cells]} 0B {number % 9} #{id}")
    return ids


def _await_rest(ids: Sequence[str], user: CrewOnRos, node: Process) -> None:
    """Wait until every task has ended or was refused, or until nothing was reported of any for QUIET_S."""
    heard, since = -1, time.monotonic()

    def rests() -> bool:
        nonlocal heard, since
        if len(user.changes) == heard:
            return time.monotonic() - since >= QUIET_S
        heard, since = len(user.changes), time.monotonic()
        states = _states(user)
        return all(OVER & states.get(id, Counter()).keys() for id in ids)

    wait_for(rests, "the last task", node.check, LIMIT_S)


def _states(user: CrewOnRos) -> dict[str, Counter[str]]:
    """The number of reports of each state, by the task's id; in a refusal the id stands in the text."""
    states: dict[str, Counter[str]] = {}
    for change in list(user.changes):
        id = change["id"] or change["text"].rpartition("#")[2]
        if change["state"] != "refused" or change["sentence"]:
            states.setdefault(id, Counter())[change["state"]] += 1
    return states
