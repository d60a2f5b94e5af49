"""Faults of a virtual Dobot, with a sentence on each."""

from __future__ import annotations

FAULTS = {
    "stop_button": "the button at the robot is pressed: it brakes and is disabled, and alarm 116 stays",
    "collision": "whenever the arm moves it hits something: it brakes, mode 11 until that is cleared",
    "alarm": "whenever the arm moves it brakes with alarm 17, in mode 9, until that is cleared",
    "power_off": "the arm has no power: mode 3, and commands are answered -4",
    "power_cycle": "the controller is off while this is on; then it boots: disabled, and its ids begin anew",
    "script": "a script runs in the controller: mode 7, and moves are answered -5",
    "not_tcp": "the controller is not in TCP mode: commands are answered with that sentence",
    "second_client": "whenever the arm moves, another client's move takes the place of it",
    "refuse": "moves are answered -1",
    "no_replies": "what the dashboard is told is done and not answered",
    "late_replies": "the dashboard answers a second late",
    "nonsense_replies": "the dashboard answers what is no reply",
    "no_brace": "GetErrorID is answered as in an example of the maker's document, without its last brace",
    "wrong_number": "a move is answered with the number of the one before",
    "hang_up": "the connections end whenever a move is told, which is begun nevertheless",
    "mute": "the feedback port sends nothing",
    "frozen": "the feedback port sends the same frame again and again",
    "garbled": "the feedback has a wrong test value",
    "torn": "every second frame lacks its last hundred bytes",
    "late_start": "a move is named as the current one at once, and begins 0.2 s later",
    "lie": "a move is said to be over at once, and the arm stays where it is",
    "short": "moves end two degrees before their goal",
    "stall": "a move stands still half way, and the controller says that it runs",
    "deaf": "a stop is answered, and the arm moves on",
    "stuck_output": "tool outputs do not switch",
    "slow": "the arm moves at a tenth of its speed",
}
