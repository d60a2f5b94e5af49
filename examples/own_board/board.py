"""A board for a device that a plant file declares: what it must hear, refuse and say over MQTT.

    python board.py --broker 127.0.0.1:1883

`Board` has the rules, the same for every device; `VERBS`, `FACTS` and `_begin` are the device, here a valve
that only waits. On a real one `_begin` sets outputs, and an input, not the time, says that something is over.
"""

from __future__ import annotations

import argparse
import json
import math
import queue
import random
import re
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import Any

SILENCE_S, PERIOD_S = 1.0, 0.1
FRESH_S, MARK_S = 2.0, 0.25  # how long what it told is news, and how exactly it remembers when
UINT32 = 2**32 - 1
AHEAD_S, HORIZON = 366 * 86_400, 4_102_444_800  # no plant starts a year after the last one, or after 2100
NAME = re.compile(r"[A-Za-z0-9_.-]{1,32}", re.ASCII)
TEXT = re.compile(r"[ !#-\[\]-~\u00a1-\ud7ff\ue000-\U0010ffff]*")  # letters of any language, no controls
LONGEST = 32  # bytes of a text in UTF-8
Out = Callable[[str, bytes], None]  # channel, payload

VERBS: dict[str, dict[str, Any]] = {
    "open": {"work": True, "takes_s": 0.5, "sets": {"lid": "open"}},
    "close": {"work": True, "takes_s": 0.5, "sets": {"lid": "closed"}},
    "dose": {"work": True, "takes_s": 1.5, "with": {"ml": (5, 10)}, "needs": {"lid": "open"}},
    "level": {"work": False, "takes_s": 0.2},
}
FACTS: dict[str, Any] = {"lid": "closed", "ml": 0.0}


class Bad(Exception):
    """A message that breaks the contract; it is refused whole and changes nothing."""


class Board:
    """Messages in, messages out, with a time that is handed to it; `boot` is another number each time."""

    def __init__(self, out: Out, *, boot: int, now: float) -> None:
        self._out = out
        self._boot, self._number, self._now = boot, 0, now
        self._facts = dict(FACTS)
        self._epoch: int | None = None  # of the numbers in `_ids`
        self._least: int | None = None  # the oldest that still counts: of the newest beat or command
        self._recent: deque[int] = deque(maxlen=8)  # the last accepted; one of them again is a copy
        self._ids: dict[str, Any] = {}  # ack, hecho, rechazo, respuesta, fallos: all of this epoch
        self._work: tuple[dict[str, Any], float] | None = None  # an order, and when it is over
        self._query: tuple[dict[str, Any], float] | None = None
        self._marks: deque[tuple[float, int]] = deque(maxlen=8)  # when it told which number
        self._latched = self._beaten = False
        self._alive_at = self._said_at = now

    @property
    def due(self) -> float:
        """When `pass_time` is to be called at the latest."""
        ends = [each[1] for each in (self._work, self._query) if each is not None]
        watch = [self._alive_at + SILENCE_S] if self._work is not None and self._beaten else []
        return min([*ends, *watch, self._said_at + PERIOD_S])

    def pass_time(self, now: float) -> None:
        self._now = now
        if self._work is not None and self._work[1] <= now:
            order, _ = self._work
            self._work = None
            self._facts |= VERBS[order["verbo"]].get("sets") or order["valores"]
            self._note(order, hecho=order["seq"], ficha_hecho=order.get("ficha"))
        if self._query is not None and self._query[1] <= now:
            order, _ = self._query
            self._query = None
            self._note(order, respuesta="enough", respuesta_seq=order["seq"])
        if self._work is not None and self._beaten and self._alive_at + SILENCE_S <= now:
            self._give_up("silencio")
        if self._said_at + PERIOD_S <= now:
            self.say()

    def receive(self, channel: str, payload: bytes, *, retained: bool, now: float) -> None:
        """One message of `orden`, `paro` or `latido`."""
        self.pass_time(now)
        try:
            said = read(channel, payload)
        except Bad:
            self._refuse("formato", *numbers_in(payload))
            return
        if retained:
            self._refuse("retenido", said.get("seq"), said.get("epoca"))
        elif channel == "latido":
            self._hear_beat(said["epoca"])
        else:
            self._obey(channel, said)

    def say(self) -> None:
        """Telemetry: ten times a second, and at once where something has changed."""
        self._said_at, self._number = self._now, self._number + 1
        if not self._marks or self._now - self._marks[-1][0] >= MARK_S:
            self._marks.append((self._now, self._number))
        state = 1 if self._work is not None else 4 if self._latched else 0
        said = {"estado": state, "seq": self._number, "arranque": self._boot}
        numbers = self._ids if self._epoch is None else {"epoca_ack": self._epoch, **self._ids}
        if self._least != self._epoch:
            numbers = {**numbers, "epoca_min": self._least}
        self._out(
            "sensores", json.dumps({**said, **numbers, "datos": self._facts}, separators=(",", ":")).encode()
        )

    def _hear_beat(self, epoch: int) -> None:
        ahead = HORIZON if self._least is None else min(self._least + AHEAD_S, HORIZON)
        if epoch > ahead:
            self._refuse("formato", None, epoch)
            return
        self._least = max(epoch, self._least or 0)
        if epoch == self._least:
            self._beaten = True
            self._alive_at = self._now if self._epoch in (None, epoch) else self._alive_at

    def _obey(self, channel: str, said: dict[str, Any]) -> None:
        if said.get("paro") in (1, 2):  # whatever its number: a stop is never too late
            self._work = None
            self._latched = self._latched or said["paro"] == 1
        seq, epoch = said.get("seq"), said.get("epoca")
        if epoch == self._epoch and seq in self._recent:
            self.say()
            return
        word = self._old(seq, epoch) or (self._objection(said) if channel == "orden" else None)
        if word is not None:
            self._refuse(word, seq, epoch)
            return
        self._recent.append(seq)
        self._keep(ack=seq, ficha_ack=said.get("ficha") if channel == "orden" else None)
        self._alive_at = self._now
        if said.get("paro") == 0:
            self._latched = False
        elif channel == "orden":
            self._begin(said)
        self.say()

    def _old(self, seq: int | None, epoch: int | None) -> str | None:
        """The word for a number that is not above the last one; a newer epoch begins to count anew."""
        if seq is None or epoch is None:
            return "formato"
        if self._least is not None and epoch < self._least:
            return "viejo"
        if self._epoch is None or epoch > self._epoch:
            self._epoch, self._least, self._ids = epoch, epoch, {}
            self._recent.clear()
            return None
        return "viejo" if (epoch, seq) <= (self._epoch, self._ids.get("ack", -1)) else None

    def _in_time(self, heard: int) -> bool:
        """Whether it told this number lately. An older one is of an order that waited on its way."""
        fresh = (number for at, number in self._marks if self._now - at <= FRESH_S)
        return next(fresh, UINT32) <= heard <= self._number

    def _objection(self, order: dict[str, Any]) -> str | None:
        verb = VERBS.get(order["verbo"])
        if verb is None or not fits(verb.get("with", {}), order["valores"]):
            return "formato"
        if verb["work"] and self._latched:
            return "paro"
        if verb["work"] and self._work is not None:
            return "ocupado"
        if any(self._facts[name] != value for name, value in verb.get("needs", {}).items()):
            return "condicion"
        return "tarde" if "visto" in order and not self._in_time(order["visto"]) else None

    def _begin(self, order: dict[str, Any]) -> None:
        """On a real board outputs are set here."""
        verb = VERBS[order["verbo"]]
        deed = (order, self._now + verb["takes_s"])
        if verb["work"]:
            self._work = deed
        else:
            self._query = deed

    def _give_up(self, word: str) -> None:
        """The board itself ends what it does, and says so with a word."""
        assert self._work is not None
        order, _ = self._work
        self._work = None
        before = self._ids.get("fallos", []) if order["epoca"] == self._epoch else []
        self._note(order, fallos=[*before, [order["seq"], word]][-3:])

    def _note(self, order: dict[str, Any], **ids: Any) -> None:
        if order["epoca"] == self._epoch:  # one of an older epoch is nobody's news any more
            self._keep(**ids)
        self.say()

    def _keep(self, **ids: Any) -> None:
        """Say this from now on; None: no more."""
        self._ids = {key: each for key, each in {**self._ids, **ids}.items() if each is not None}

    def _refuse(self, word: str, seq: int | None, epoch: int | None) -> None:
        ours = seq is not None and (word == "viejo" or self._epoch in (None, epoch))
        self._ids |= {"rechazo": word, "rechazo_seq": seq if ours else 0}
        self.say()


def read(channel: str, payload: bytes) -> dict[str, Any]:
    """The message, with `valores` where it is an order; Bad where anything is wrong with it."""
    said = parse(payload)
    if channel != "latido" and ("seq" in said) != ("epoca" in said):
        raise Bad("seq and epoca go together")
    for name in {"seq", "epoca"} & said.keys() | ({"epoca"} if channel == "latido" else set()):
        whole(said.get(name), UINT32)
    if channel == "paro":
        whole(said.get("paro"), 2)
    elif channel == "orden":
        named(said.get("verbo"))
        whole(said.get("visto", 0), UINT32)
        named(said.get("ficha", "-"), 12)
        values = said.setdefault("valores", {})
        if not isinstance(values, dict):
            raise Bad("valores is no object")
        for name, value in values.items():
            named(name)
            plain(value)
    return said


def parse(payload: bytes) -> dict[str, Any]:
    """One JSON object of at most 512 bytes, no key twice."""
    if len(payload) > 512:
        raise Bad("too long")
    try:
        said = json.loads(payload.decode("utf-8"), object_pairs_hook=once, parse_constant=never)
    except (ValueError, RecursionError) as error:
        raise Bad(str(error)) from error
    if not isinstance(said, dict):
        raise Bad("no object")
    return said


def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    if len(dict(pairs)) < len(pairs):
        raise ValueError("a key is there twice")
    return dict(pairs)


def never(constant: str) -> None:
    raise ValueError(f"{constant} is no JSON")


def whole(value: Any, top: int) -> None:
    if type(value) is not int or not 0 <= value <= top:
        raise Bad("no whole number")


def named(value: Any, longest: int = 32) -> None:
    if not isinstance(value, str) or len(value) > longest or not NAME.fullmatch(value):
        raise Bad("no name")


def plain(value: Any) -> None:
    """A value of an order: yes or no, a number, a short text."""
    if isinstance(value, bool):
        return
    number = type(value) is int and abs(value) <= UINT32
    number = number or (type(value) is float and math.isfinite(value) and abs(value) <= 1e9)
    text = isinstance(value, str) and TEXT.fullmatch(value) and len(value.encode()) <= LONGEST
    if not number and not text:
        raise Bad("no value")


def fits(allowed: dict[str, tuple[Any, ...]], values: dict[str, Any]) -> bool:
    return values.keys() == allowed.keys() and all(values[name] in allowed[name] for name in allowed)


def numbers_in(payload: bytes) -> tuple[int | None, int | None]:
    """seq and epoca of a message that is refused whole, as far as they can be read."""
    try:
        said = parse(payload)
        for name in ("seq", "epoca"):
            whole(said.get(name), UINT32)
    except Bad:
        return None, None
    return said["seq"], said["epoca"]


def run(name: str, host: str, port: int) -> None:
    """The board on a broker, for ever: one thread does it all, what arrives waits in a queue."""
    from paho.mqtt.client import Client
    from paho.mqtt.enums import CallbackAPIVersion

    inbox: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
    client = Client(CallbackAPIVersion.VERSION2, client_id=name, clean_session=True)
    client.will_set(f"{name}/conexion", b"0", qos=1, retain=True)  # the broker says so when the board is gone
    board = Board(
        lambda channel, said: void(client.publish(f"{name}/{channel}", said, qos=0)),
        boot=random.getrandbits(32),
        now=time.monotonic(),
    )

    def connected(*_: Any) -> None:
        client.subscribe([(f"{name}/{channel}", 1) for channel in ("orden", "paro", "latido")])
        client.publish(f"{name}/conexion", b"1", qos=1, retain=True)
        inbox.put(board.say)

    def heard(_client: Any, _data: Any, message: Any) -> None:
        channel, payload, retained = message.topic.rpartition("/")[2], message.payload, message.retain
        inbox.put(lambda: board.receive(channel, payload, retained=retained, now=time.monotonic()))

    client.on_connect, client.on_message = connected, heard
    client.connect_async(host, port, keepalive=5)
    client.loop_start()
    print(f"{name} goes to the broker {host}:{port}", flush=True)
    while True:
        try:
            inbox.get(timeout=max(0.001, board.due - time.monotonic()))()
        except queue.Empty:
            board.pass_time(time.monotonic())


def void(_: object) -> None: ...


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--broker", default="127.0.0.1:1883")
    parser.add_argument("--name", default="valve_1")
    told = parser.parse_args()
    host, _, port = told.broker.rpartition(":")
    with suppress(KeyboardInterrupt):
        run(told.name, host, int(port))
