"""Screens of a plant that runs: what people see of it is durable before they see it."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from typing import Any, Protocol

from arboleda.adapters import clock
from arboleda.engine import Plant
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda.model.sentence import Phrase
from arboleda.recorder.chapter import Chapter
from arboleda.views import diagnostics, twin_view, view
from arboleda.views.resting_cells import RestingCells

from ..loop import Loop, StepInFlight
from .keeping import Keeping
from .listeners import LeaveOut, Listeners
from .plant_log import log_defect
from .router import PlantPort
from .slices import PAUSE_S, Slices

VIEW_S = 1.0
# A snapshot takes as long as several steps: it waits until whoever was sent a command had the processor.
SETTLE_S = 0.01
SHARE = 0.1  # of the thread's time for snapshots, at most: one of 100 busy cells takes as long as 500 steps
READ_S = 1.0  # from a step on, for a reader to wait for its commits
GLANCE_S = 0.03  # the same in the server's thread, where the next stop waits, too

NOT_KEPT = Phrase(
    "plant.not_kept", "the plant has not kept yet what it did last, so it cannot tell of it; ask again later"
)


class FlightRecorder(Protocol):
    """The writer of the flight record: gets each step and each snapshot in the plant's thread.

    `trouble` is the reason for which it stopped. `add` takes a chapter of the report of a task, in any
    thread; `wrote` are told of its task once it is written.
    """

    trouble: str
    wrote: list[Callable[[str], None]]

    def stepped(self, plant: Plant, now: float, events: Sequence[Any], messages: Sequence[Any]) -> None: ...
    def saw(self, snapshot: dict[str, Any], drawn: dict[str, Any]) -> None: ...
    def knows(self, digest: str, files: PlantFiles) -> None: ...
    def add(self, chapter: Chapter) -> None: ...


class RosPort(PlantPort, Protocol):
    """The plant's port on ROS 2, which carries snapshots too and knows whether it is alone."""

    @property
    def watched(self) -> bool: ...
    @property
    def diagnosed(self) -> bool: ...
    def check_alone(self) -> None: ...
    def publish_view(self, view: dict[str, Any]) -> Iterator[None]: ...
    def publish_diagnostics(self, statuses: Iterable[diagnostics.Diagnostic]) -> Iterator[None]: ...


class KeptStateUnknown(ArboledaError):
    """Nobody can tell now how much of the plant is kept."""

    def __init__(self) -> None:
        super().__init__(NOT_KEPT())


class Screens:
    """Screens: `watchers` are told of snapshots after steps; all others ask for what they see.

    Once nothing can be kept any more, all see the last snapshot of what was kept.
    """

    def __init__(
        self,
        plant: Plant,
        loop: Loop[Any, Any],
        keeping: Keeping,
        leave_out: LeaveOut,
    ) -> None:
        self.watchers: Listeners[dict[str, Any]] = Listeners(leave_out)
        self.recorder: FlightRecorder | None = None
        self.ros: RosPort | None = None
        self.diagnoses: list[
            Callable[[], diagnostics.Diagnostic]
        ] = []  # of parts other than robots and cells
        self.beside: Callable[[], Mapping[str, Any]] = dict  # what a snapshot has beside the plant's own
        self._plant = plant
        self._loop = loop
        self._keeping = keeping
        self._durability = keeping.durability
        self._shown = (-1, 0.0)
        self._show_after = 0.0
        self._resting = RestingCells()
        self._kept: dict[str, Any] = {}  # the last snapshot of what was kept, as screens got it
        self._blind = ""  # the defect for which screens saw nothing last
        self._show_at: float | None = None  # while there is a change that nobody was shown
        self._showing: Slices[None] | None = None  # a snapshot that is being made and shown
        self._shown_from = 0  # the number of the write that has to be durable before it is shown

    def open(self) -> None:
        """Make a snapshot for those who look before the first one that screens get."""
        try:
            self._kept = {**view.snapshot(self._plant), **self.beside()}
        except Exception as error:  # noqa: BLE001 - a screen that cannot be drawn must not end the plant
            log_defect("the screens", error)

    def snapshot(self, within_s: float = READ_S) -> dict[str, Any]:
        """A snapshot of what is kept, made in slices between which the plant is stepped; not in its thread.

        While the plant waits longer for its disk, it is the last snapshot that screens got.
        """
        slices = Slices(view.in_parts(self._plant, self._resting.part))
        try:
            while not self._read(lambda _plant: slices.cut(clock.seconds()), within_s):
                time.sleep(PAUSE_S)
            self._require_durable(within_s)
        except StepInFlight:
            return self._last_kept
        return {**slices.result, **self.beside()}

    def _read(self, fn: Callable[[Plant], Any], within_s: float) -> Any:
        """`fn(plant)` once all of the plant is kept; StepInFlight if it is not in time, or never will be."""

        def look(plant: Plant) -> Any:
            if self._keeping.failure is not None:
                raise StepInFlight
            return fn(plant)

        return self._loop.read_handed_on(look, within_s)

    def _require_durable(self, within_s: float) -> None:
        """Wait until all that was read is durable; raises StepInFlight if it is not in time."""
        if not self._durability.reach(self._durability.hurry(), within_s):
            raise StepInFlight

    @property
    def _last_kept(self) -> dict[str, Any]:
        """The last snapshot that screens got; KeptStateUnknown if there is none."""
        if not self._kept:
            raise KeptStateUnknown
        return self._kept if self._keeping.failure is None else {**self._kept, "ending": True}

    @property
    def stepped_at(self) -> float:
        """The time of the plant's last step, on its clock; it makes one for each of its heartbeats."""
        now: float = self._loop.read(lambda plant: plant.now)
        return now

    def positions(self) -> dict[str, Any]:
        """The positions of everything that moves; `now` is on the plant's clock."""
        return {"now": clock.seconds(), **self._loop.read(twin_view.positions)}

    def find(self, task: str) -> dict[str, Any] | None:
        """A task as it is kept; KeptStateUnknown if that is unknown now."""
        try:
            found: dict[str, Any] | None = self._read(lambda plant: view.task_by_id(plant, task), READ_S)
            self._require_durable(READ_S)
        except StepInFlight:
            found = next((row for row in self._last_kept["tasks"] if row["id"] == task), None)
            if found is None:
                raise KeptStateUnknown from None
        return found

    def stepped(self, now: float) -> None:
        """Show what a step has changed, a while after it; in the plant's thread."""
        if self._showing is not None:
            self._show_on(now)
        if self._showing is not None:
            return
        version, shown_at = self._shown
        if version == self._plant.version and (now - shown_at < VIEW_S or not self._watched):
            return
        if self._show_at is None:
            self._show_at = max(now + SETTLE_S, self._show_after)
        if now < self._show_at and not self._plant.intake.closed:  # what is shown at the end may be the last
            self._loop.wake_by(self._show_at)
        else:
            self._show(now)

    @property
    def _watched(self) -> bool:
        """True if somebody wants to see the age of the displayed data."""
        return bool(self.watchers) or (self.ros is not None and self.ros.watched)

    @property
    def _waits_to_show(self) -> bool:
        """True while a snapshot is made of what is not durable yet."""
        return self._durability.durable < self._shown_from and self._keeping.failure is None

    def _show(self, now: float) -> None:
        self._shown, self._show_at = (self._plant.version, now), None
        self._showing = Slices(self._publication())
        self._show_on(now)

    def _show_on(self, now: float) -> None:
        """Show the next slice of the snapshot, or all that is left of it once the plant ends."""
        assert self._showing is not None
        waits = self._waits_to_show
        if (waits or now < self._showing.due) and not self._plant.intake.closed:
            self._loop.wake_by(now + SETTLE_S if waits else self._showing.due)
            return
        try:
            while not self._showing.cut(now) and self._plant.intake.closed:
                pass
        except Exception as error:  # noqa: BLE001 - a screen that cannot be drawn must not end the plant
            if repr(error) != self._blind:
                log_defect("the screens", error)
            self._blind = repr(error)
        if self._showing.over:
            _, begun = self._shown
            self._show_after = begun + self._showing.spent_s / SHARE
            self._showing = None
        else:
            self._loop.wake_by(self._showing.due)

    def _publication(self) -> Generator[None, None, None]:
        """Make a snapshot and show it to all who watch, in parts between which the plant may be stepped."""
        snapshot = yield from view.in_parts(self._plant, self._resting.part)
        snapshot.update(self.beside())
        self._shown_from = self._durability.hurry()
        while self._waits_to_show and not self._plant.intake.closed:
            yield  # this slice ends soon, and the next one waits
        if self._keeping.failure is not None or not self._durability.reach(self._shown_from, READ_S):
            if not self._kept:
                return
            snapshot = self._last_kept
        before, self._kept = self._kept, snapshot
        if self.recorder is not None and not self.recorder.trouble:
            drawn = yield from twin_view.in_parts(self._plant)
            self.recorder.saw(snapshot, drawn)
        yield from self.watchers.telling(snapshot)
        if self.ros is not None:
            yield from self.ros.publish_view(snapshot)
            if self.ros.diagnosed:
                recorder = [] if self.recorder is None else [diagnostics.record(self.recorder.trouble)]
                found = (*diagnostics.diagnostics(snapshot), *recorder, *(each() for each in self.diagnoses))
                yield from self.ros.publish_diagnostics(found)
        rows = [row for kind in ("cells", "robots", "tasks") for row in before.get(kind, ())]
        del before
        while rows:  # to give back the memory of them all at once takes as long as some slices
            rows.pop()
            yield
