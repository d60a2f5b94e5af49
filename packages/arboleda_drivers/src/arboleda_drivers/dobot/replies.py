"""Lines of a controller's dashboard: a command is text, its reply `ErrorID,{values},Command(...);`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from arboleda_drivers.connections.link import LinkBroken

LONGEST = 8192  # characters without an end
REPLY = re.compile(r"\s*(0|-?[1-9]\d{0,8}),\{(.*?)\},(\w{1,40})\((.*)\)\s*", re.DOTALL)
# The example in the maker's README_V4.pdf, 3.40, lacks the brace that ends the values.
ERRORS_REPLY = re.compile(
    r"\s*(0|-?[1-9]\d{0,8}),\{(\[.*\]),(GetErrorID)\(()\)\s*", re.DOTALL | re.IGNORECASE
)
OTHER_MODE = "Control Mode Is Not Tcp"
ALARMS = re.compile(r"-?\d{1,9}")

REFUSALS = {
    -1: "not_executed",
    -2: "alarm",
    -3: "robot_stop_button",
    -4: "power_off",
    -5: "script_running",
    -6: "wrong_motion_type",
    -7: "script_paused",
    -8: "licence_expired",
    -10000: "unknown_command",
    -20000: "wrong_number_of_values",
}
"""The word for the plant of each ErrorID of the controller, by the maker's README_V4.pdf, section 5."""
OF_VALUES = {
    -30000: "wrong_type_of_value",
    -40000: "value_out_of_range",
    -50000: "wrong_type_of_option",
    -60000: "option_out_of_range",
}
"""The words for those whose last digits are the place of the value, from 1; it is 1 for any with a name."""
MEANINGS = {  # of the alarms that an operator meets most; the maker lists some thousand
    16: "near the singularity of the shoulder",
    17: "no joints reach that pose",
    18: "outside of the working space",
    **{48 + joint: f"joint {joint + 1} too fast" for joint in range(6)},
    116: "the stop button at the robot is pressed",
    132: "a stop by software of the robot's own",
    133: "a stop by a safety input",
}


@dataclass(frozen=True, kw_only=True)
class Reply:
    """Reply of the controller to one command; `error` 0 means that it took it."""

    error: int
    values: str
    command: str

    @property
    def word(self) -> str:
        """The word for the reason of a refusal."""
        if self is NOT_TCP:
            return "not_in_tcp_mode"
        place = -self.error % 1000
        if place and self.error + place in OF_VALUES:
            return f"{OF_VALUES[self.error + place]}_{place}"
        return REFUSALS.get(self.error, f"error {self.error}")

    @property
    def number(self) -> int | None:
        """The id given to a queued command, or the one number of an answer."""
        return int(self.values) if re.fullmatch(r"\d{1,18}", self.values) else None

    @property
    def alarms(self) -> tuple[int, ...]:
        """The ids of the alarms in a reply to GetErrorID, without the zeros for none."""
        return tuple(number for each in ALARMS.findall(self.values) if (number := int(each)) != 0)


NOT_TCP = Reply(error=-1, values="", command="")
"""Stands for the text, in no form of a reply, by which the controller says that it is not in its TCP mode."""


class NotAReply(LinkBroken):
    """Line that is no reply; after it nobody knows to which command the next reply belongs."""


class ReplyReader:
    """Splitter of the dashboard's stream into replies."""

    def __init__(self) -> None:
        self._rest = ""

    def feed(self, data: bytes) -> list[Reply]:
        """The replies that are complete now; raises NotAReply for one that cannot be read."""
        text = self._rest + data.decode("ascii", "replace")
        while OTHER_MODE in text:
            before, _, text = text.partition(OTHER_MODE)
            if before.strip(" \r\n\t;\0"):
                raise NotAReply("it says that it is not in TCP mode in the middle of a reply")
            text = text.lstrip(" \r\n\t;.")
            self._rest = text
            return [NOT_TCP, *self.feed(b"")]
        *whole, self._rest = text.split(";")
        if len(self._rest) > LONGEST:
            raise NotAReply("a reply does not end")
        return [_reply(each) for each in whole]


def _reply(text: str) -> Reply:
    found = REPLY.fullmatch(text) or ERRORS_REPLY.fullmatch(text)
    if found is None:
        raise NotAReply(f"{text[:60]!r} is no reply")
    return Reply(error=int(found[1]), values=found[2].strip(), command=found[3])


def named(alarms: Sequence[int]) -> str:
    """The alarms by number, with their meanings as far as known here."""
    return ", ".join(
        f"alarm {each}: {MEANINGS[each]}" if each in MEANINGS else f"alarm {each}" for each in alarms
    )
