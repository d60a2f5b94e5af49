"""Faults of hosts and links, as a table: the beginning of each, which returns its end."""

from __future__ import annotations

import math
import random
import signal
import subprocess
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

from ..processes import PATIENCE_S, UP
from .cast import BRIDGE, BROKER, DATA, FLOOR, HOSTS, Cast, HostPlant
from .network import Network

HOUR_S, DAY_S = 3600.0, 86_400.0
End = Callable[[], None]
Link = tuple[str, str]


@dataclass(frozen=True, kw_only=True)
class Scene:
    """Scene of a fault: the plants that lead and wait, and the chance that it may draw from."""

    network: Network
    cast: Cast
    leader: HostPlant
    standby: HostPlant
    dice: random.Random


@dataclass(frozen=True, kw_only=True)
class Fault:
    """`takes_over`: another process leads before it ends. `ends`: a plant may end by it with a sentence."""

    name: str
    begin: Callable[[Scene], End]
    takes_over: bool = False
    ends: bool = False


def _nothing() -> None:
    """It is over by itself."""


def _kill(scene: Scene) -> End:
    scene.leader.kill()
    return _nothing


def _freeze(scene: Scene) -> End:
    scene.leader.freeze(on=True)
    return lambda: scene.leader.freeze(on=False)


def _handover(scene: Scene) -> End:
    command = [sys.executable, "-c", UP, "handover", "--store", scene.cast.store]
    subprocess.run([*scene.network.on(DATA), *command], timeout=PATIENCE_S, capture_output=True, check=True)
    return _nothing


def _kill_standby(scene: Scene) -> End:
    scene.standby.kill()
    return _nothing


def _cut_all(links: Callable[[Scene], list[Link]], scene: Scene) -> End:
    return _cut(scene, links(scene))


def _cut(scene: Scene, links: Iterable[Link]) -> End:
    scene.network.spoil(links)
    return scene.network.heal


def _weather(scene: Scene, loss: float, delay_s: float) -> End:
    """Every link of the leader's host is bad, both ways."""
    here = scene.leader.host
    links = [link for other in HOSTS if other != here for link in ((here, other), (other, here))]
    scene.network.spoil(links, loss=loss, delay_s=delay_s)
    return scene.network.heal


def _restart_bridge(scene: Scene) -> End:
    scene.cast.restart_bridge()
    return _nothing


def _restart_broker(scene: Scene) -> End:
    scene.cast.restart_broker()
    return _nothing


def _restart_database(how: signal.Signals, longest_s: float) -> Callable[[Scene], End]:
    def begin(scene: Scene) -> End:
        scene.cast.restart_database(how, scene.dice.random() * longest_s)
        return _nothing

    return begin


def _freeze_database(scene: Scene) -> End:
    scene.cast.database.freeze(on=True)
    return lambda: scene.cast.database.freeze(on=False)


def _between(name: str, one: Callable[[Scene], str], other: str, *, takes_over: bool = False) -> list[Fault]:
    """A link that is cut: there, back, and both ways."""
    ways: dict[str, Callable[[Scene], list[Link]]] = {
        f"{name} -> {other}": lambda scene: [(one(scene), other)],
        f"{other} -> {name}": lambda scene: [(other, one(scene))],
        f"{name} <-> {other}": lambda scene: [(one(scene), other), (other, one(scene))],
    }
    return [
        Fault(
            name=f"cut {way}",
            begin=partial(_cut_all, links),
            takes_over=takes_over,
            ends=takes_over,
        )
        for way, links in ways.items()
    ]


def _step_one(one: Callable[[Scene], str], ahead_s: Callable[[random.Random], float], scene: Scene) -> End:
    return _step(scene, one(scene), ahead_s(scene.dice))


def _step(scene: Scene, host: str, ahead_s: float) -> End:
    scene.network.clocks.step(host, ahead_s)
    return lambda: scene.network.clocks.step(host, 0.0)


def _drawn_s(dice: random.Random) -> float:
    """A second, or up to a day, ahead or behind."""
    return dice.choice((-1.0, 1.0)) * dice.choice((1.0, math.exp(dice.uniform(0.0, math.log(DAY_S)))))


def _clock(name: str, one: Callable[[Scene], str]) -> list[Fault]:
    """The clock of a host is stepped, and set right again."""
    how: dict[str, Callable[[random.Random], float]] = {
        "an hour on": lambda _: HOUR_S,
        "an hour back": lambda _: -HOUR_S,
        "by a drawn time": _drawn_s,
    }
    return [
        Fault(
            name=f"clock of {name} {words}",
            begin=partial(_step_one, one, ahead_s),
        )
        for words, ahead_s in how.items()
    ]


def _killed_meanwhile(one: Callable[[Scene], str], ahead_s: float) -> Callable[[Scene], End]:
    """The clock of a host is stepped, and at once the leader dies."""

    def begin(scene: Scene) -> End:
        over = _step(scene, one(scene), ahead_s)
        scene.leader.kill()
        return over

    return begin


def _bridge_killed_meanwhile(scene: Scene) -> End:
    over = _step(scene, BRIDGE, -HOUR_S)
    scene.cast.restart_bridge()
    return over


CLOCKS = (
    *_clock("leader", lambda scene: scene.leader.host),
    *_clock("standby", lambda scene: scene.standby.host),
    *_clock("database", lambda scene: DATA),
    *_clock("bridge", lambda scene: BRIDGE),
    *_clock("floor", lambda scene: FLOOR),
    *(
        Fault(
            name=f"killed, clock of {name} an hour {words}",
            begin=_killed_meanwhile(one, ahead_s),
            takes_over=True,
            ends=True,
        )
        for name, one in (("standby", lambda scene: scene.standby.host), ("database", lambda scene: DATA))
        for words, ahead_s in (("on", HOUR_S), ("back", -HOUR_S))
    ),
    Fault(name="bridge killed, its clock an hour back", begin=_bridge_killed_meanwhile),
)
FAULTS = (
    Fault(name="killed", begin=_kill, takes_over=True, ends=True),
    Fault(name="frozen", begin=_freeze, takes_over=True, ends=True),
    Fault(name="handover", begin=_handover, takes_over=True, ends=True),
    Fault(name="standby killed", begin=_kill_standby, ends=True),
    *_between("leader", lambda scene: scene.leader.host, DATA, takes_over=True),
    *_between("leader", lambda scene: scene.leader.host, BRIDGE),
    *_between("standby", lambda scene: scene.standby.host, DATA),
    *_between("bridge", lambda scene: BRIDGE, BROKER),
    *_between("broker", lambda scene: BROKER, FLOOR),
    Fault(name="late by 50 ms", begin=lambda scene: _weather(scene, 0.0, 0.05)),
    Fault(name="5 % lost", begin=lambda scene: _weather(scene, 0.05, 0.0), ends=True),
    Fault(name="late by 200 ms, 10 % lost", begin=lambda scene: _weather(scene, 0.1, 0.2), ends=True),
    Fault(name="bridge killed", begin=_restart_bridge),
    Fault(name="broker killed", begin=_restart_broker),
    Fault(name="database restarted", begin=_restart_database(signal.SIGINT, 0.8), ends=True),
    Fault(name="database crashed", begin=_restart_database(signal.SIGQUIT, 4.0), ends=True),
    Fault(name="database frozen", begin=_freeze_database, ends=True),
    *CLOCKS,
)
