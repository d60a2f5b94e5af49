"""Faults of a virtual machine with GRBL, with a sentence on each."""

from __future__ import annotations

FAULTS = {
    "hard_limit": "whenever it moves a limit switch is hit: alarm 1, and it is locked until it is homed",
    "door": "its door is open while this is on; it stands, and goes on only when it is told to",
    "hold_pressed": "whenever it moves somebody presses feed hold at it",
    "boot": "its controller is reset while this is on: it is locked, and its place is lost",
    "unplugged": "the cable is pulled while this is on",
    "mute": "it answers nothing",
    "no_ok": "moves are made and not answered",
    "error": "moves are answered error:15",
    "torn": "every third line lacks its end",
    "noise": "stray lines come between the others",
    "garbled": "the positions of every second status are no numbers",
    "no_position": "its status has the position of the work alone",
    "late_start": "a move begins 0.3 s after its ok",
    "lie": "moves are answered, and never made",
    "short": "moves end two millimetres before their goal",
    "stall": "a move stands still half way, and the controller says that it runs",
    "deaf": "a feed hold is not taken",
    "no_reset": "a reset is not taken",
    "slow": "it moves at a tenth of its speed",
    "homing_fails": "the homing cycle finds no switch: alarm 9",
    "second_client": "whenever it moves another program sends it elsewhere",
    "asleep": "it was sent to sleep",
}
