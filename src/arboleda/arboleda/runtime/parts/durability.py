"""Durability of what a plant has written: syncs it in a thread, and then tells whoever waits for that."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from arboleda.adapters import clock
from arboleda.departures.leaving import MOST_UNSYNCED_S, SYNCED_WITHIN_S
from arboleda.store.plant_memory import PlantMemory


class Durability:
    """Mark of what is durable: all up to number `durable` of the `written` changes.

    `tell(message, None)` is called in the thread, once all that was written before the message is durable.
    A sync that fails calls `fail(error)`, and is the last one: the rest is told with that error. Before
    `start` and after `stop` whoever needs something durable syncs it himself.
    """

    def __init__(
        self,
        store: PlantMemory | None,
        tell: Callable[[Any, Exception | None], None],
        fail: Callable[[Exception], None],
    ) -> None:
        self.written = 0
        self.durable = 0
        self._store = store
        self._tell = tell
        self._fail = fail
        self._owed = 0  # the last write that has to be durable before a command leaves
        self._since: float | None = None  # when the first write was made that is not durable
        self._since_sync: float | None = None  # the same, of those that came after the last sync had begun
        self._untold: deque[tuple[int, Any]] = deque()
        self._hurried = 0  # the last write for which somebody waits
        self._failure: Exception | None = None
        self._changed = threading.Condition()
        self._syncing = threading.Lock()
        self._runs = False
        self._thread = threading.Thread(target=self._run, name="durability", daemon=True)

    def start(self) -> None:
        self._runs = True
        self._thread.start()

    def stop(self) -> None:
        """Sync and tell what is left, and end; idempotent."""
        with self._changed:
            self._runs = False
            self._changed.notify_all()
        if self._thread.ident is not None and self._thread is not threading.current_thread():
            self._thread.join()

    def wrote(self, *, precedes_commands: bool) -> None:
        """Count a change that was written; if it `precedes_commands`, none leaves before it is durable."""
        now = clock.seconds()
        with self._changed:
            self.written += 1
            if precedes_commands:
                self._owed = self.written
            if self._since is None:
                self._since = now
            if self._since_sync is None:
                self._since_sync = now

    def tell(self, message: Any) -> None:
        """Tell a message once all that was written by now is durable."""
        self._untold.append((self.written, message))
        if not self._runs:
            self._advance(self.written)

    def wake(self) -> None:
        """Have the thread begin with what a step has left to it, once the commands of the step have left."""
        if self._untold or self.written > self.durable:
            with self._changed:
                self._changed.notify_all()

    def let_commands_leave(self) -> None:
        """Return once a command may leave; raises what a sync raises.

        That is at once, unless a write precedes commands, or one has not been durable for MOST_UNSYNCED_S.
        """
        since = self._since
        is_late = since is not None and clock.seconds() - since > MOST_UNSYNCED_S
        number = self.written if is_late else self._owed
        failure = self._failure if self.durable >= number else self._sync(number)
        if failure is not None:
            raise failure

    def hurry(self) -> int:
        """Have all that was written by now made durable at once; its number, to compare with `durable`."""
        if not self._runs:
            self._advance(self.written)
        with self._changed:
            self._hurried = self.written
            self._changed.notify_all()
            return self.written

    def reach(self, number: int, within_s: float) -> bool:
        """Wait until a write is durable; True if it is."""
        with self._changed:
            over = self._changed.wait_for(lambda: self.durable >= number or self._failure, within_s)
            return bool(over) and self.durable >= number

    def _run(self) -> None:
        while self._sleep():
            self._advance(self.written)
            if self._store is not None and self._failure is None:
                self._store.fold()
        self._advance(self.written)

    def _sleep(self) -> bool:
        """Sleep until something is to be synced or told; False at the end."""
        with self._changed:
            self._changed.wait_for(lambda: self._is_urgent or self._lags)
            self._changed.wait_for(lambda: self._is_urgent, SYNCED_WITHIN_S)
            return self._runs

    @property
    def _lags(self) -> bool:
        return self.written > self.durable and self._failure is None

    @property
    def _is_urgent(self) -> bool:
        return not self._runs or bool(self._untold) or (self._lags and self._hurried > self.durable)

    def _advance(self, number: int) -> None:
        """Make writes durable, and tell what waited for them."""
        failure = self._sync(number)
        while self._untold and (failure is not None or self._untold[0][0] <= self.durable):
            needs, message = self._untold.popleft()
            try:
                self._tell(message, None if needs <= self.durable else failure)
            except Exception as error:  # noqa: BLE001 - whoever is told cannot keep others from being told
                self._fail(error)

    def _sync(self, number: int) -> Exception | None:
        """Make all up to a write durable, in whichever thread; the error if that failed, now or before."""
        if self.durable >= number or self._store is None:
            return self._failure
        with self._syncing:
            if self.durable >= number or self._failure is not None:  # another thread was faster
                return self._failure
            with self._changed:
                upto, self._since_sync = self.written, None
            try:
                self._store.sync()
            except Exception as error:  # noqa: BLE001 - whatever it is, nothing more can be kept
                self._failure = error
                self._fail(error)
            else:
                self.durable = upto
            with self._changed:
                self._since = self._since_sync
                self._changed.notify_all()
            return self._failure
