"""Moment: what happened in one pass over the machines of a world."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from arboleda.model.messages import Event, Report
from arboleda.wire.bridge import Bridge
from arboleda.wire.hop import FromPlant
from arboleda.wire.payloads import Goal
from arboleda.wire.transport import Delivery, Publication


@dataclass(slots=True)
class BridgeStep:
    """One step of the bridge: what it took in, in order, and what it gave out."""

    bridge: Bridge
    now: float
    events: list[Any]
    out: list[Any]


@dataclass(slots=True)
class Moment:
    """All that happened in one pass over the machines, in order; emptied before the next one.

    `last_words` are what a plant that died in the middle of its step was asked and had sent by then: the
    rest of that step is nobody's. `unkept` is what leaves a plant that ends as it can keep nothing more.
    `late` is what left only when a commit had taken its time, and how many s after its step; `undelivered`
    are the commands of which the plant heard in this step that they did not leave. `outdated` are those of
    `delivered` that a bridge had published before another process led, and that arrive only after that.
    """

    requests: list[Event] = field(
        default_factory=list
    )  # tasks and operators' requests that reached the plant
    reports: list[Report] = field(default_factory=list)  # reports that reached the plant
    sent: list[Any] = field(default_factory=list)  # commands and notices of the plant
    taken: list[FromPlant] = field(default_factory=list)  # what the bridge took in from the plant and others
    published: list[tuple[str, Publication]] = field(default_factory=list)  # (client, what it published)
    ordered: list[Publication] = field(default_factory=list)  # what the bridge published of that
    delivered: list[tuple[str, Delivery]] = field(default_factory=list)  # (client, what reached it)
    outdated: list[Delivery] = field(default_factory=list)
    former: list[Any] = field(default_factory=list)  # what left a process that another one had superseded
    writes: list[Any] = field(default_factory=list)  # what a store took that two hosts reach
    executed: list[tuple[str, Goal]] = field(default_factory=list)  # (board, command it carries out)
    opened: list[str] = field(default_factory=list)  # boards whose effectors somebody else opened
    bridged: list[BridgeStep] = field(default_factory=list)  # what the bridge took in, and gave out
    put_right: list[str] = field(default_factory=list)  # boards whose robots somebody moved by hand
    last_words: list[Any] = field(default_factory=list)
    unkept: list[Any] = field(default_factory=list)
    undelivered: list[str] = field(default_factory=list)
    late: list[tuple[Any, float]] = field(default_factory=list)

    def clear(self) -> None:
        self.requests.clear()
        self.reports.clear()
        self.sent.clear()
        self.taken.clear()
        self.published.clear()
        self.ordered.clear()
        self.delivered.clear()
        self.outdated.clear()
        self.former.clear()
        self.writes.clear()
        self.executed.clear()
        self.opened.clear()
        self.bridged.clear()
        self.put_right.clear()
        self.last_words.clear()
        self.unkept.clear()
        self.undelivered.clear()
        self.late.clear()
