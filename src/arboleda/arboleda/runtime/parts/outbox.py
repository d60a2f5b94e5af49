"""Outbox: hands alarms to a receiver outside, in order, in a thread of its own; nobody waits for it."""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable
from typing import Any, Protocol

from arboleda.adapters.webhook import DeliveryRefused, NotDelivered

LOG = logging.getLogger(__name__)
LIMIT = 1000  # alarms that may wait
FIRST_RETRY_S, LAST_RETRY_S = 1.0, 60.0
END_S = 3.0  # for waiting alarms to arrive at the end of the plant
Alarm = dict[str, Any]


class Receiver(Protocol):
    """The receiver of alarms; `str()` names it, with nothing secret."""

    def post(self, what: Alarm) -> None:
        """Return once it is taken; NotDelivered to be asked again, DeliveryRefused for good."""

    def close(self) -> None: ...


class Outbox:
    """Hands each alarm over until it is taken, with the number of those that were dropped before it.

    If `limit` alarms wait, the oldest is dropped. The log says once when dropping or a failure to deliver
    begins, and once when it is over.
    """

    def __init__(
        self,
        receiver: Receiver,
        *,
        limit: int = LIMIT,
        wait: Callable[[threading.Event, float], object] = threading.Event.wait,
    ) -> None:
        self._receiver = receiver
        self._limit = limit
        self._wait = wait
        self._waiting: deque[Alarm] = deque()
        self._dropped = 0  # since the last one that was taken
        self._gap = ("", "")  # the first and the last of those
        self._news = threading.Condition()
        self._ending = threading.Event()
        self._blocked = False  # whether the log names the receiver's trouble
        self._thread = threading.Thread(target=self._work, name=f"alarms to {receiver}", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def put(self, alarm: Alarm) -> None:
        """Queue an alarm; from any thread, never blocks."""
        with self._news:
            if len(self._waiting) >= self._limit:
                lost = self._waiting.popleft()["id"]
                self._dropped += 1
                self._gap = (self._gap[0] if self._dropped > 1 else lost, lost)
                if self._dropped == 1:
                    LOG.warning("%d alarms wait for %s: the oldest are dropped", self._limit, self._receiver)
            self._waiting.append(alarm)
            self._news.notify()

    def end(self) -> None:
        """Try the waiting alarms once more without pauses; returns at once."""
        self._ending.set()
        with self._news:
            self._news.notify()

    def stop(self) -> None:
        """Wait until all alarms have arrived, at most END_S, and log the others; idempotent."""
        self.end()
        if self._thread.ident is None:
            return
        self._thread.join(END_S)
        with self._news:
            undelivered = [alarm["id"] for alarm in self._waiting]
            dropped, self._dropped = self._dropped, 0
            self._waiting.clear()
        if dropped:
            LOG.warning("%d alarms for %s were dropped: %s to %s", dropped, self._receiver, *self._gap)
        if undelivered:
            LOG.warning(
                "%d alarms did not reach %s: %s to %s",
                len(undelivered),
                self._receiver,
                undelivered[0],
                undelivered[-1],
            )

    def _work(self) -> None:
        pause_s = FIRST_RETRY_S
        while (alarm := self._next()) is not None:
            if self._handed_over(alarm):
                pause_s = FIRST_RETRY_S
            elif self._ending.is_set():
                break
            else:
                self._wait(self._ending, pause_s)
                pause_s = min(2 * pause_s, LAST_RETRY_S)
        self._receiver.close()

    def _next(self) -> Alarm | None:
        """The oldest alarm, which stays in the queue until it is taken. None at the end."""
        with self._news:
            while not self._waiting:
                if self._ending.is_set():
                    return None
                self._news.wait()
            return self._waiting[0] | {"dropped": self._dropped}

    def _handed_over(self, alarm: Alarm) -> bool:
        """True if the receiver is done with the alarm, even by refusing it."""
        try:
            self._receiver.post(alarm)
        except DeliveryRefused as error:
            LOG.warning("%s refuses the alarm %s (%s): it is dropped", self._receiver, alarm["id"], error)
        except NotDelivered as error:
            self._tell(error)
            return False
        except Exception as error:  # noqa: BLE001 - whatever a library raises, the next try may do
            self._tell(error)
            return False
        else:
            self._note_delivery(alarm["dropped"])
        with self._news:
            if self._waiting and self._waiting[0]["id"] == alarm["id"]:
                self._waiting.popleft()
            else:  # it was dropped to make room while it was on its way, and has arrived
                self._dropped = max(self._dropped - 1, 0)
        return True

    def _tell(self, error: Exception) -> None:
        if not self._blocked:
            LOG.warning("alarms do not reach %s (%s); they wait, trying again", self._receiver, error)
        self._blocked = True

    def _note_delivery(self, dropped: int) -> None:
        """Note that an alarm has arrived, and with it the number of those dropped before it."""
        if self._blocked:
            LOG.warning("alarms reach %s again", self._receiver)
        self._blocked = False
        if dropped:
            LOG.warning("%d alarms for %s were dropped: %s to %s", dropped, self._receiver, *self._gap)
        with self._news:
            self._dropped = max(self._dropped - dropped, 0)
