"""Words by which devices tell what they do, and what is sent to them, as public firmware has them."""

from __future__ import annotations

import re

from arboleda_drivers.meaning import as_text


def _all(words: str) -> frozenset[str]:
    return frozenset(words.split())


THERE = ("online", "connected", "true", "1", "yes", "up", "alive", "here", "ready")
STOPPED = _all(
    "idle stopped stop rest resting ready standby waiting still parked docked halted free"
    " standing paused complete finished done operational"
)
MOVING = _all("busy run move work active print clean dose executing started")
FAULT = _all("fault error alarm failed jammed stuck estop broken")
DONE = _all("done finished complete completed success succeeded ok")
FAILED = _all("failed fail failure error err nok broke broken aborted rejected refused denied jammed timeout")
ACCEPTED = _all("accepted taken started ack received queued")
STOPS = _all("stop halt abort cancel kill estop")

PRESENCE = re.compile(r"lwt|availab|online|status|connect|alive|presence|here|birth|will", re.IGNORECASE)
COMMAND = re.compile(
    r"(^|/)(cmnd|cmd|commands?|set|do|orders?|requests?|req|goto|control|action|rpc|call|api)(/|$)",
    re.IGNORECASE,
)
ID = re.compile(r"(^|\.)(id|seq|nr|num|number|cid|token|msg_?id|task_?id|correlation_?id)$", re.IGNORECASE)
VERB = re.compile(r"(^|\.)(act|action|cmd|command|verb|method|op|operation|type)$", re.IGNORECASE)
WHY = re.compile(r"(^|\.)(why|reason|cause|text|message|note|error|detail|info)$", re.IGNORECASE)
ITSELF = re.compile(
    r"rssi|uptime|ssid|\bmac|\bip\b|version|heap|lqi|linkquality|time|firmware|\bfw|vcc|sleep|mqtt|wifi|loadavg",
    re.IGNORECASE,
)
"""Names of what a device tells of itself, which no recipe asks for."""


def word(value: object) -> str:
    """A value as a word of a plant file: small letters, digits and _."""
    found = "_".join(re.findall(r"[a-z0-9]+", as_text(value).lower()))
    return found if found[:1].isalpha() or not isinstance(value, str) else f"v_{found}".rstrip("_")


def is_moving(value: object) -> bool:
    """True for a word of a device at work."""
    said = word(value)
    return said not in STOPPED and (said in MOVING or said.endswith("ing"))
