"""State machine of a virtual device that speaks by its mapping."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from arboleda.drivers import Device, FactType, OnStop, Value, VerbCommand, Work
from arboleda.wire.transport import Publication
from arboleda_drivers.meaning import UnreadableValue
from arboleda_drivers.mqtt_mapping.heard import NAME, Heard, Says, reply_to
from arboleda_drivers.mqtt_mapping.keys import Keys
from arboleda_drivers.mqtt_mapping.sent import DEVICE, ID, NUMBER, Sent

from .saying import Said, messages, of_says

TELLS_S = 1.0  # period in which it repeats all that it says
FAULTS = {
    "vanish": "its connection is cut while this is on; it works on",
    "deaf": "it hears nothing",
    "mute": "it says nothing, and its connection stays",
    "refuse": "it says of each order that it has failed, and does nothing",
    "stick": "what it begins never ends",
    "lie": "it says that it is done, and has done nothing",
    "double": "it says everything twice",
    "slow": "it takes ten times as long",
}


@dataclass(kw_only=True)
class Doing:
    """Order under way, with the id or number by which it was sent, and when it ends."""

    command: VerbCommand
    id: object
    ends_at: float


class VirtualMapped:
    """State machine of a virtual device; `heard` and `step` return what it publishes."""

    def __init__(self, device: Device, settings: Keys, faults: Collection[str] = ()) -> None:
        self._device, self._settings, self._faults = device, settings, faults
        self._name = settings.name_of(device.name)
        self.facts: dict[str, Value] = {name: of.samples[0] for name, of in device.kind.facts.items()}
        self.doing: Doing | None = None
        self.latched = False
        self._boots = 1
        self._tell_at = -math.inf
        self._said: dict[str, object] = {}  # of verbs that are sent as several messages
        self.begun = 0  # orders
        self.done: list[str] = []  # verbs that it has done

    @property
    def topics(self) -> tuple[str, ...]:
        """The topics to which it listens."""
        sent = [each for verb in self._settings.verbs.values() for each in verb.send]
        sent += [*self._settings.ask, *self._settings.halt, *self._settings.latch, *self._settings.clear]
        return tuple(dict.fromkeys(_filter(each.topic, self._name) for each in sent))

    @property
    def next_deadline(self) -> float:
        """The time at which it does something by itself, s."""
        return min(self._tell_at, math.inf if self.doing is None else self.doing.ends_at)

    def will(self) -> Publication | None:
        """The message that a broker publishes once its connection is cut."""
        return self._presence(is_there=False)

    def begin(self) -> list[Publication]:
        """Messages as it connects."""
        there = self._presence(is_there=True)
        return [*([] if there is None else [there]), *self._all()]

    def _presence(self, *, is_there: bool) -> Publication | None:
        online = self._settings.online
        if online is None:
            return None
        says = online.values[0] if online.values else "online"
        ((topic, payload),) = messages([(online, online.path, says if is_there else "offline")], self._name)
        return Publication(topic, payload, 1, True)

    def step(self, now: float) -> list[Publication]:
        """Do what is due."""
        out = []
        doing = self.doing
        if doing is not None and now >= doing.ends_at:
            self.doing = None
            out += self._end(doing)
        if now >= self._tell_at:
            self._tell_at = now + TELLS_S
            out += self._all()
        return self._spoken(out)

    def heard(self, now: float, topic: str, payload: bytes, about: bytes = b"") -> list[Publication]:
        """Take a message; `about` is its correlation data, which the answer has again."""
        if {"deaf", "vanish"} & {*self._faults}:
            return []
        settings = self._settings
        for sent, is_stop in ((settings.halt, True), (settings.latch, True), (settings.clear, False)):
            if any(self._values(each, topic, payload) is not None for each in sent):
                return self._spoken(self._stop() if is_stop else self._all())
        for name in settings.verbs:
            if (found := self._order(name, topic, payload)) is not None:
                command, id = found
                return self._spoken(self._take(now, command, about.decode(errors="replace") or id))
        return self._spoken(self._all())  # it is asked, or told something strange

    def _stop(self) -> list[Publication]:
        doing = self.doing
        if doing is not None and not (
            isinstance(doing.command, Work) and doing.command.on_stop is OnStop.FINISH
        ):
            self.doing = None
        return self._all()

    def _order(self, verb: str, topic: str, payload: bytes) -> tuple[VerbCommand, object] | None:
        """The order that is whole with this message, and its id; None for none."""
        sent = self._settings.verbs[verb].send
        found = [self._values(each, topic, payload) for each in sent]
        given = next((each for each in found if each is not None), None)
        if given is None:
            return None
        self._said |= given
        if found[-1] is None:
            return None  # more of it follows
        said, self._said = self._said, {}
        definition = self._device.kind.verbs[verb]
        read = {name: self._value(said.get(name), of, sent) for name, of in definition.parameters}
        values = {name: value for name, value in read.items() if value is not None}
        if len(values) < len(read):
            return None
        command = self._device.kind.command(id="", robot=self._device.name, verb=verb, values=values)
        assert isinstance(command, VerbCommand)
        return command, said.get(NUMBER, said.get(ID, ""))

    def _values(self, sent: Sent, topic: str, payload: bytes) -> dict[str, object] | None:
        try:
            found = sent.values(topic, payload)
        except UnreadableValue:
            return None
        return None if found is None or found.get(DEVICE, self._name) != self._name else found

    def _value(self, raw: object, of: FactType, sent: Sequence[Sent]) -> Value | None:
        words = {word: value for each in sent for word, value in each.words.items()}
        try:
            return Heard(hear="sent", words=words).read(raw, of)
        except UnreadableValue:
            return None

    def _take(self, now: float, command: VerbCommand, id: object) -> list[Publication]:
        settings, verb = self._settings, command.verb
        if self.doing is not None or "refuse" in self._faults:
            return self._says(settings.fails(verb), id, "busy" if self.doing else "refused")
        self.begun += 1
        takes_s = command.takes_s * (10 if "slow" in self._faults else 1)
        ends_at = math.inf if "stick" in self._faults else now + takes_s
        self.doing = Doing(command=command, id=id, ends_at=now if "lie" in self._faults else ends_at)
        return [*self._says(settings.accepts(verb), id), *self._all()]

    def _end(self, doing: Doing) -> list[Publication]:
        command, settings = doing.command, self._settings
        if "lie" not in self._faults:
            self.facts |= dict(command.sets)
            self.done.append(command.verb)
        out = self._all()
        verb = settings.verbs[command.verb]
        if verb.answer is not None:
            answer = command.definition.answer_type.samples[0]
            said: list[Said] = [(verb.answer, verb.answer.path, verb.answer.shown(answer))]
            said += [(verb.answer, verb.id, doing.id)] if verb.id else []
            return [*out, *self._published(said, doing.id)]
        return [*out, *self._says(settings.ends(command.verb), doing.id)]

    def _says(self, says: Says | None, id: object, why: str = "") -> list[Publication]:
        return [] if says is None else self._published([*of_says(says, id, why)], id)

    def _all(self) -> list[Publication]:
        """Its facts and its state."""
        settings = self._settings
        beside = self._beside_state
        said: list[Said] = [
            (heard, heard.path, heard.shown(self.facts[name]))
            for name, heard in settings.facts.items()
            if name not in beside
        ]
        if settings.state is not None:
            word = "moving" if self.doing is not None and isinstance(self.doing.command, Work) else "stopped"
            meant = settings.state.words[word]
            texts = meant if isinstance(meant, list | tuple) else [meant]
            shown = next((each for each in texts if self._agrees(each)), texts[0])
            said.append((settings.state, settings.state.path, shown))
        if settings.boot is not None:
            said.append((settings.boot, settings.boot.path, self._boots))
        return self._published(said)

    @property
    def _beside_state(self) -> dict[str, Heard]:
        """The facts that are heard by the same value as the state."""
        state = self._settings.state
        where = None if state is None else (state.hear, state.path, state.pattern)
        facts = self._settings.facts.items()
        return {name: heard for name, heard in facts if (heard.hear, heard.path, heard.pattern) == where}

    def _agrees(self, shown: object) -> bool:
        """True for a value of the state by which the facts are heard as they are."""
        try:
            return all(
                heard.read(shown, self._device.kind.facts[name]) == self.facts[name]
                for name, heard in self._beside_state.items()
            )
        except UnreadableValue:
            return False

    def _published(self, said: Sequence[Said], id: object = "") -> list[Publication]:
        reply, about = reply_to(self._name), str(id).encode()
        return [
            Publication(topic, payload, 0, about=about if topic == reply else b"")
            for topic, payload in messages(said, self._name)
        ]

    def _spoken(self, out: list[Publication]) -> list[Publication]:
        if {"mute", "vanish"} & {*self._faults}:
            return []
        return out * 2 if "double" in self._faults else out


def _filter(topic: str, device: str) -> str:
    """The topic to subscribe to for one with names in it."""
    levels = topic.replace(f"{{{DEVICE}}}", device).split("/")
    return "/".join("+" if NAME.search(level) else level for level in levels)
