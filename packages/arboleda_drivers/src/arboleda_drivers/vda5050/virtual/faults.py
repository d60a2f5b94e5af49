"""Faults of a virtual vehicle, with a sentence on each."""

from __future__ import annotations

FAULTS = {
    "vanish": "the connection is cut while this is on; the vehicle drives on to the end of its base",
    "power_cycle": "the vehicle is off while this is on; then it boots: no order, and its headers begin anew",
    "hush": "it is connected and tells no state",
    "frozen": "it tells the same state again and again",
    "late": "it tells each state a second late",
    "double": "it tells each state twice",
    "garbled": "its states do not fit the schema",
    "wrong_serial": "its states have the serial number of another vehicle",
    "no_route": "it refuses each order: noRouteError",
    "no_update": "it refuses each update of an order: orderUpdateError",
    "forget": "it forgets its order half way, and stands",
    "short": "it says that its order is over one node before its end",
    "lie": "it says that its order is over at once, and stays where it is",
    "obstacle": "it stands half way, and says nothing of why",
    "e_stop": "somebody presses the button at the vehicle",
    "manual": "somebody takes the vehicle over: its order is gone",
    "fatal": "it has an error of the level FATAL, and stands",
    "deaf": "a stop or a cancel is never begun",
    "action_fails": "actions end as FAILED",
    "action_stalls": "actions begin and never end",
    "lost": "it does not know its position",
    "slow": "it drives at a tenth of its speed",
}
STANDING = frozenset({"obstacle", "e_stop", "manual", "fatal"})
