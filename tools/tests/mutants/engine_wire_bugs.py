"""Bugs of the engine: the bridge, and what it knows of boards."""

from __future__ import annotations

from .engine_bug import bug

BRIDGE, BOARD, LINK = "wire/bridge.py", "wire/board.py", "wire/link.py"

WIRE_BUGS = (
    bug(
        BRIDGE,
        "A command of an earlier plant is obeyed.",
        "return None if int(match[1]) == self._plant_epoch else refusals.OLD_EPOCH",
        "return None",
    ),
    bug(
        BRIDGE,
        "A command that waited too long is sent.",
        "late = self.now - at > self._stale_after_s",
        "late = self.now - at > 100 * self._stale_after_s",
    ),
    bug(
        BRIDGE,
        "A stop that waited too long is refused.",
        "return refusals.NO_LINK if late and not isinstance(command, Stop) else None",
        "return refusals.NO_LINK if late else None",
    ),
    bug(
        BRIDGE,
        "Boards at work get no heartbeat.",
        "return [board.beat() for board in self._boards.values() if board.in_motion]",
        "return [board.beat() for board in self._boards.values() if not board.in_motion]",
    ),
    bug(
        BRIDGE,
        "An old plant's heartbeat counts.",
        "        if heartbeat.epoch < self._plant_epoch:\n            return []\n",
        "",
    ),
    bug(
        BOARD,
        "A stop does not latch.",
        "            self._latched = command.mode is StopMode.LATCH\n",
        "            self._latched = False\n",
    ),
    bug(
        BOARD,
        "A command that comes twice is sent twice.",
        "        if self.labels.repeated(command.id):\n            return []\n",
        "",
    ),
    bug(
        LINK,
        "Telemetry that was overtaken counts.",
        "        if self._overtaken(telemetry) and not self._counts_anew(at, telemetry.seq):\n"
        "            return LinkUpdate.OLD\n",
        "",
    ),
    bug(
        LINK,
        "A boot is not noticed.",
        "        if rebooted or were_twins:  # after twins nobody knows what the board has heard\n"
        "            return LinkUpdate.REBOOT\n",
        "",
    ),
)
