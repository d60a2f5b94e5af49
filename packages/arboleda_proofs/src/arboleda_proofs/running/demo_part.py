"""The demonstration in a loop of its own, beside a plant with virtual boards."""

from __future__ import annotations

import logging
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.model.messages import TaskChanged
from arboleda.runtime.loop import Loop
from arboleda.runtime.parts.part import Crash
from arboleda.sim.devices import Alarm, Reboot
from arboleda.store.task_rows import DEMO

from .demo import Demo, DemoEnded, Task

LOG = logging.getLogger(__name__)
NOTE = (
    "Demonstration: every cell gets task after task, and now and then one fails. Look at it on the page; "
    "Ctrl-C ends the plant, a button of the page the demonstration."
)


class DemoPart:
    """DemoPart: feeds the demonstration by `saw`, and carries out its wishes by `submit` and `befall`."""

    notes = (NOTE,)

    def __init__(
        self,
        demo: Demo,
        submit: Callable[[str, str], Future[TaskChanged]],
        befall: Callable[[Reboot | Alarm], None],
        crash: Crash,
    ) -> None:
        self._demo = demo
        self._submit = submit
        self._befall = befall
        self._loop: Loop[Any, Any] = Loop("demonstration", demo, self._send, on_crash=crash)

    @property
    def is_on(self) -> bool:
        return self._demo.is_on

    def start(self) -> None:
        self._loop.start()

    def stop(self) -> None:
        self._loop.stop()

    def saw(self, snapshot: dict[str, Any]) -> None:
        self._loop.post(snapshot)

    def end(self) -> None:
        """Give no more tasks and have nothing fail any more; from any thread."""
        self._loop.post(DemoEnded())

    def _send(self, message: Task | Reboot | Alarm) -> None:
        if isinstance(message, Task):
            self._submit(message.text, DEMO).add_done_callback(_look_at)
        else:
            LOG.info("demonstration: %s", _sentence(message))
            self._befall(message)


def _look_at(answer: Future[TaskChanged]) -> None:
    """Look at a task's answer: one that was not taken is no trouble, as the next one follows."""
    try:
        answer.result()
    except ArboledaError as error:
        LOG.debug("the plant took no task of the demonstration: %s", error)


def _sentence(fault: Reboot | Alarm) -> str:
    if isinstance(fault, Reboot):
        return f"the board {fault.board} loses its power, and has it back at once"
    return f"the driver of {fault.board} reports an alarm" + ("" if fault.is_on else " no more")
