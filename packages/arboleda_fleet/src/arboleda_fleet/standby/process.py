"""Standby: a second process for a plant, which waits until the leader ends, and shows that it waits."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arboleda.departures.leading import LOOK_S
from arboleda.extension import ArboledaError, StartError
from arboleda.model.plant_model import PlantModel
from arboleda.runtime.build import App, Options, build
from arboleda.runtime.interrupts import heed, interruptible
from arboleda.runtime.leader import LeaderInfo, of_leader
from arboleda.runtime.standing_by import ReadAgain
from arboleda.runtime.state import StateDir, default_state
from arboleda.store.lead import OtherLeader
from arboleda.web.access.names import other_address
from arboleda.wire.status import OK, WARN

from .changed_files import is_changed, read_again
from .waiting_room import WaitingRoom

if TYPE_CHECKING:
    from arboleda.store.leadership import Leader, Leadership

LOG = logging.getLogger(__name__)
NEEDED_THEN = (
    "arboleda_fleet.postgres.memory",
    "arboleda.runtime.parts.page",
    "arboleda.dashboard.page",
    "arboleda.recorder.recorder",
    "arboleda.recorder.view_log",
    "arboleda.recorder.writing",
)
SAY_S = 1.0  # how often it says to the database that it waits
NEEDS_STORE = (
    "--standby needs a memory that both hosts reach: write `store: postgresql://USER@HOST/DATABASE` into the"
    " plant file, or give it as --store; see docs/how-to/two-hosts.md"
)


def take_over(
    model: PlantModel, parts: set[str], options: Options, tell: Callable[[str], None], again: ReadAgain
) -> App:
    """Wait until nobody leads the plant, then lead it; StartError, KeyboardInterrupt.

    `again` reads it as `model` was read, for files that were changed meanwhile by what was put to work.
    """
    store = options.store or model.store
    if not store:
        raise StartError(NEEDS_STORE)
    state = options.state_dir or default_state(model.name)
    # A person who logged in while it waited stays logged in when it leads.
    options = replace(options, web=replace(options.web, door=options.web.door_of(state)))
    while True:
        port = _wait(model, store, state, options, tell)
        options = replace(options, web=replace(options.web, usual_port=port))  # pages that are open find it
        if is_changed(options.plant_file, options.recording):
            model, recording = read_again(again, (model, options.recording), tell)
            options = replace(options, recording=recording)
        try:
            return build(model, parts, options)
        except OtherLeader:
            tell("another process was first; this one goes on waiting")


def _wait(model: PlantModel, store: str, state: Path, options: Options, tell: Callable[[str], None]) -> int:
    """Wait until nobody leads the plant; returns the port of the page that showed so meanwhile."""
    from arboleda.runtime.stores import leadership_of

    for each in NEEDED_THEN:  # so that it need not be loaded when the plant waits for it
        import_module(each)
    others = leadership_of(store, model.name)
    room = WaitingRoom(model.name, state, options.web)
    voice = options.link.standby() if options.link is not None else None
    with StateDir(state, plant=model.name, store=store) as here, interruptible():
        others.prepare()
        room.start(here.announce)
        try:
            tell(f"Page of the standby: {options.web.origin(room.port)}")
            own = partial(options.web.origin, room.port, lambda: others.own_address() or other_address())
            _until_free(others, model.name, own, _StandbyNotices(room, voice, tell))
            return room.port
        finally:
            room.stop()
            others.close()
            if voice is not None:
                voice.close()


class _StandbyNotices:
    """The receivers of a standby's news: its page, `/diagnostics` each second, people at each change."""

    def __init__(self, room: WaitingRoom, voice: Any | None, tell: Callable[[str], None]) -> None:
        self._room, self._voice, self._tell = room, voice, tell
        self._last_notice, self._last_notice_at = "", 0.0

    def waits(self, sentence: str, level: int, led: LeaderInfo | None = None) -> None:
        """Publish the sentence on which this process waits; `led` is the leader, None if nobody knows it."""
        self._room.show(sentence, led)
        now = time.monotonic()
        if self._voice is not None and (sentence != self._last_notice or now - self._last_notice_at > SAY_S):
            self._voice.say(level, sentence, {"leader": led.url if led else ""})
            self._last_notice_at = now
        if sentence != self._last_notice:
            self._tell(f"standby: {sentence}")
            self._last_notice = sentence


def _until_free(others: Leadership, plant: str, own: Callable[[], str], notices: _StandbyNotices) -> None:
    """Look for a leader again and again until there is none; a database that is away says nothing of it.
    `own()` is the address of the page of this process."""
    notice_at = 0.0
    while True:
        try:
            leader = others.leader()
            if others.is_free():
                others.wait_no_more()
                notices.waits("leads the plant from now on", OK)
                return
            if time.monotonic() - notice_at > SAY_S:
                others.wait_here(own())
                notice_at = time.monotonic()
            notices.waits(_led_by(leader), OK, of_leader(plant, leader))
        except ArboledaError as error:
            notices.waits(f"waits for the database: {error}", WARN)
        time.sleep(LOOK_S)
        heed()


def _led_by(leader: Leader) -> str:
    page = f"; its page is {leader.url}" if leader.url else ""
    return f"waits for the end of process {leader.process} on {leader.host}, which leads the plant{page}"
