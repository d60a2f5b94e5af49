"""Facts and state of a device as it has told them at its topics."""

from __future__ import annotations

import math

from arboleda.drivers import DeviceKind, Facts, MotionState, Value
from arboleda.wire.transport import Delivery
from arboleda_drivers.meaning import UnreadableValue, as_text
from arboleda_drivers.paths import NOTHING
from arboleda_drivers.plc.plc_snapshot import STATES

from .heard import Heard, lack
from .keys import Keys
from .link import Link


class Showing:
    """Facts and state of a device, as far as it has told them.

    A retained message counts only where its last will says that the device is there: else it is of any age.
    """

    def __init__(self, settings: Keys, kind: DeviceKind, link: Link) -> None:
        self._settings, self._kind, self._link = settings, kind, link
        self._facts: dict[str, Value] = {}
        self._unreadable: set[str] = set()
        self._since: set[str] = set()  # facts that were heard since the last order
        self._ordered_at = self._changed_at = -math.inf
        self._state: MotionState | None = None
        self._was_told = False  # its state, since the link began

    @property
    def facts(self) -> Facts:
        return tuple(self._facts.items())

    @property
    def unknown(self) -> tuple[str, ...]:
        """The facts of which it has told what cannot be read."""
        return tuple(sorted(self._unreadable))

    @property
    def was_told(self) -> bool:
        """True where its state was told since the link began, or is not heard at all."""
        return self._settings.state is None or self._was_told

    @property
    def is_whole(self) -> bool:
        """True where each fact is known, and the state as it is since the last order."""
        knows_state = self._settings.state is None or self._state is not None
        return knows_state and len(self._facts) == len(self._settings.facts)

    def forget(self) -> None:
        """Forget the state, which may have changed meanwhile."""
        self._state, self._was_told, self._ordered_at = None, False, -math.inf

    def order(self, now: float) -> None:
        """Note that it was ordered to do something."""
        self._since.clear()
        self._ordered_at = now
        self._state = None

    def has_shown(self, facts: Facts) -> bool:
        """True once each of these facts was told since the last order."""
        return self._since.issuperset(name for name, _ in facts)

    def motion(self, now: float) -> MotionState | None:
        """The motion by its state, or by what changes; None where that is not told since the last order."""
        still = self._settings.still
        if still is None:
            return self._state
        if now < self._changed_at + still.for_s:
            return MotionState.MOVING
        return MotionState.STOPPED if now >= self._ordered_at + still.for_s else None

    def see(self, now: float, message: Delivery) -> list[str]:
        """Take a message; returns sentences on what it tells that has no meaning, and on what it lacks."""
        if message.retain and self._settings.online is None:
            return []
        facts = (
            (name, heard) for name, heard in self._settings.facts.items() if self._link.is_on(heard, message)
        )
        found = [self._read(now, message, name, heard) for name, heard in facts]
        state = self._settings.state
        if self._link.is_on(state, message) and not (message.retain and self._ordered_at > -math.inf):
            assert state is not None
            found.append(self._read(now, message, "", state))
        return [each for each in found if each]

    def _read(self, now: float, message: Delivery, name: str, heard: Heard) -> str:
        """Take a fact of a message, the state without a name; returns why that is impossible, else ""."""
        try:
            if (raw := heard.raw(message.payload)) is NOTHING:
                is_known = name in self._facts if name else self._was_told
                return "" if is_known else lack(heard, message.payload)
            if not name:
                self._see_state(heard, raw)
                return ""
            self._see_fact(now, name, heard, raw)
        except UnreadableValue as error:
            return str(error)
        if not message.retain:
            self._since.add(name)
        return ""

    def _see_fact(self, now: float, name: str, heard: Heard, raw: object) -> None:
        before = self._facts.pop(name, None)
        self._unreadable.add(name)
        self._facts[name] = value = heard.read(raw, self._kind.facts[name])
        self._unreadable.discard(name)
        still = self._settings.still
        if still is not None and name in still.facts and before not in (None, value):
            self._changed_at = now

    def _see_state(self, state: Heard, raw: object) -> None:
        word, self._was_told = state.word(raw), True
        self._state = STATES.get(word or "")
        if self._state is None:
            known = ", ".join(state.words)
            raise UnreadableValue(f"{state.where} is {as_text(raw)!r}, for which there is no word ({known})")
