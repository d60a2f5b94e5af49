"""Faults of any virtual action server, with a sentence on each."""

from __future__ import annotations

FAULTS = {
    "vanish": "there is no server and nothing is measured while this is on; then it is started anew",
    "double": "a second server of the same name is there",
    "refuse": "goals are refused",
    "late_answer": "a goal begins at once, and is accepted 3 s late",
    "no_result": "a goal ends, and no result is sent",
    "late_result": "a result is sent a second late",
    "lie": "a goal is said to have succeeded at once, and nothing moves",
    "early": "a goal is said to have succeeded at once, and the way to it follows",
    "short": "a goal is said to have succeeded a tenth of its way before its end",
    "stall": "it stands still half way, and says nothing of it",
    "abort": "a goal is aborted half way",
    "other_client": "half way another client's goal takes the place of it, and leads to where it stands",
    "refuse_cancel": "a cancel is refused",
    "deaf": "a cancel is accepted, and nothing stops",
    "mute": "nothing is measured",
    "frozen": "the same is said to be measured again and again, at the same time",
    "stuck": "the same is said to be measured again and again, at new times",
    "no_number": "what is measured is no number",
    "slow": "it moves at a tenth of its speed",
}
