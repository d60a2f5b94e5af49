"""Guess of the parts of a device's messages: its presence, state, ends, commands and facts.

A place is told by its words and names, as public firmware has them, and by what follows a command.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

from arboleda_drivers.meaning import as_text, is_number

from . import words
from .hearing import Listening, Message, Place, Seen

LATER_S = 60.0  # in which what follows a command belongs to it
SOON_S = 2.0  # in which a device begins with a command, or refuses it
MOST_WORDS = 8  # that a fact may have; more are any text
ENDS = {"accepted": words.ACCEPTED, "done": words.DONE, "failed": words.FAILED}


@dataclass(frozen=True, kw_only=True)
class Heard:
    """Command that was heard: one verb, or what stops the device."""

    topic: str
    messages: list[Message] = field(default_factory=list)
    verb: Place | None = None  # where the verb is named in it

    @property
    def name(self) -> str:
        """The name of the verb, from what names it in the message, else from its topic."""
        if self.verb is not None:
            return words.word(self.messages[0].values[self.verb[1]])
        return words.word(self.topic.rpartition("/")[2])

    @property
    def paths(self) -> Sequence[str]:
        return [*self.messages[0].values]

    def values(self, path: str) -> list[object]:
        """The values at a path, each once."""
        return [*dict.fromkeys(each.values[path] for each in self.messages)]

    @property
    def stops(self) -> bool:
        """True where it tells a device to stop."""
        said = {words.word(value) for each in self.messages for value in each.values.values()}
        return bool(words.STOPS & {*said, words.word(self.topic.rpartition("/")[2])})


class Guess:
    """Guess by all that was heard."""

    def __init__(self, heard: Listening) -> None:
        self._heard = heard

    @cached_property
    def presence(self) -> tuple[Place, str] | None:
        """The place where it says that it is there, and the word for that."""
        for (topic, path), seen in self._heard.places.items():
            said = next((text for text in map(as_text, seen.values) if text.lower() in words.THERE), None)
            if seen.retained and said is not None and words.PRESENCE.search(topic):
                return (topic, path), said
        return None

    @cached_property
    def commands(self) -> list[Heard]:
        """The commands that were heard, one for each verb."""
        found: dict[tuple[object, ...], Heard] = {}
        topics = {each.topic for each in self._heard.messages if self._is_told_on(each.topic)}
        for message in (each for each in self._heard.messages if each.topic in topics):
            verb = next((path for path in message.values if words.VERB.search(path)), None)
            stops = verb is None and words.STOPS & {words.word(each) for each in message.values.values()}
            named = None if verb is None else message.values[verb]
            key = (message.topic, *message.values, named, bool(stops))
            at = None if verb is None else (message.topic, verb)
            found.setdefault(key, Heard(topic=message.topic, verb=at)).messages.append(message)
        return [*found.values()]

    def _is_told_on(self, topic: str) -> bool:
        """True for a topic of commands: by its name, or as each of its messages has an answer."""
        if topic in self._says:
            return False
        if words.COMMAND.search(topic) or words.word(topic.rpartition("/")[2]) in words.STOPS:
            return True
        times = [each.at for each in self._heard.messages if each.topic == topic and not each.retained]
        answered = [any(at <= then <= at + SOON_S for then in self._reactions) for at in times]
        return bool(times) and all(answered)

    @cached_property
    def _says(self) -> set[str]:
        """Topics on which a device tells its presence, an end, or that it moves."""
        told = words.DONE | words.FAILED | words.ACCEPTED
        found = set() if self.presence is None else {self.presence[0][0]}
        for (topic, _), seen in self._heard.places.items():
            if any(words.word(each) in told or words.is_moving(each) for each in seen.values):
                found.add(topic)
        return found

    @cached_property
    def _reactions(self) -> list[float]:
        """Times at which it told an end, or began to move."""
        found = []
        for place, seen in self._heard.places.items():
            told = words.DONE | words.FAILED | words.ACCEPTED
            ends = place[0] in self._says and any(words.word(each) in told for each in seen.values)
            of_end = (each.at for each in self._heard.messages if ends and each.topic == place[0])
            found += [*of_end, *(at for at, value in self._heard.course(place) if words.is_moving(value))]
        return found

    @cached_property
    def state(self) -> tuple[Place, dict[str, list[object]]] | None:
        """The place of its state, and the values for each state; what is unclear is for `""`."""
        for place, seen in self._told():
            if any(map(words.is_moving, seen.values)) and not _all_numbers(seen):
                return place, self._states(place, seen)
        return next(self._states_by_course(), None)

    def _states(self, place: Place, seen: Seen) -> dict[str, list[object]]:
        found: dict[str, list[object]] = {"stopped": [], "moving": [], "fault": [], "": []}
        for value in seen.values:
            said = words.word(value)
            known = {"fault": said in words.FAULT, "stopped": said in words.STOPPED}
            state = "moving" if words.is_moving(value) else next((each for each in known if known[each]), "")
            found[state].append(value)
        if not found["stopped"]:  # it stands before the first command, if anything does
            first = next((value for _, value in self._heard.course(place) if value in found[""]), None)
            found["stopped"] = [value for value in found[""] if value == first]
            found[""] = [value for value in found[""] if value != first]
        return found

    def _states_by_course(self) -> Iterator[tuple[Place, dict[str, list[object]]]]:
        """Places that change after a command and come back by themselves."""
        sent = [message.at for each in self.commands for message in each.messages]
        for place, seen in self._told():
            course = [*self._heard.course(place)]
            if _all_numbers(seen) or not 2 <= len(seen.values) <= MOST_WORDS:
                continue
            for before, during, after in zip(course, course[1:], course[2:], strict=False):
                follows = any(before[0] <= at <= during[0] <= at + LATER_S for at in sent)
                by_itself = not any(during[0] < at <= after[0] for at in sent)
                if follows and by_itself and before[1] == after[1]:
                    other = [each for each in seen.values if each not in (before[1], during[1])]
                    yield place, {"stopped": [before[1]], "moving": [during[1]], "fault": [], "": other}
                    return

    def _told(self) -> Iterator[tuple[Place, Seen]]:
        """The places of what the device tells, but for its presence and ends."""
        sent = {each.topic for each in self.commands}
        for place, seen in self._heard.places.items():
            is_presence = self.presence is not None and place == self.presence[0]
            if place[0] not in sent and not is_presence and place != self.end_place:
                yield place, seen

    @cached_property
    def end_place(self) -> Place | None:
        """The place at which it says what became of a command."""
        sent = {each.topic for each in self.commands}
        for place, seen in self._heard.places.items():
            said = {words.word(value) for value in seen.values if not is_number(value)}
            told = said & (words.DONE | words.FAILED)
            if told and place[0] not in sent and not any(map(words.is_moving, seen.values)):
                return None if self.presence is not None and place == self.presence[0] else place
        return None

    def ends(self) -> Iterator[tuple[str, list[object]]]:
        """The conditions `accepted`, `done` and `failed` with the values that say them."""
        if self.end_place is not None:
            for key, known in ENDS.items():
                values = self._heard.places[self.end_place].values
                if said := [value for value in values if words.word(value) in known]:
                    yield key, said

    @property
    def unclear_ends(self) -> list[object]:
        """Values at the place of ends of which nobody knows what they say."""
        if self.end_place is None:
            return []
        known = [value for _, values in self.ends() for value in values]
        return [value for value in self._heard.places[self.end_place].values if value not in known]

    def id_of(self, command: Heard) -> str | None:
        """The path of the id or number of each command: one that ends name, else one that is called so."""
        for path in command.paths:
            values = [as_text(each.values[path]) for each in command.messages]
            if self._echoes({*values}) is not None and len({*values}) == len(values):
                return path
        return next((path for path in command.paths if words.ID.search(path)), None)

    def parameters(self, command: Heard) -> list[str]:
        """The paths of values that differ from message to message; "" for a text alone."""
        id = self.id_of(command)
        return [path for path in command.paths if path != id and len(command.values(path)) > 1]

    @cached_property
    def end_id(self) -> str | None:
        """The path at which ends name their command; None for none."""
        for command in self.commands:
            if (id := self.id_of(command)) is not None:
                return self._echoes({as_text(each) for each in command.values(id)})
        return None

    def _echoes(self, sent: set[str]) -> str | None:
        """The path beside the end at which these values come back, and no others."""
        for path in self._beside_end:
            assert self.end_place is not None
            told = {as_text(each) for each in self._heard.places[self.end_place[0], path].values}
            if told <= sent:
                return path
        return None

    @property
    def end_why(self) -> str | None:
        """The path at which failures say why; None for none."""
        return next((path for path in self._beside_end if words.WHY.search(path)), None)

    @property
    def _beside_end(self) -> list[str]:
        end = self.end_place
        return [] if end is None else [path for topic, path in self._heard.places if topic == end[0] != path]

    @cached_property
    def facts(self) -> dict[Place, Seen]:
        """The places of facts, those first that changed most, without what a device tells of itself."""
        return {place: seen for place, seen in self._facts if not _is_of_itself(place)}

    @property
    def of_itself(self) -> dict[Place, Seen]:
        """The places of what a device tells of itself."""
        return {place: seen for place, seen in self._facts if _is_of_itself(place)}

    @property
    def _facts(self) -> list[tuple[Place, Seen]]:
        state = None if self.state is None else self.state[0]
        ends = None if self.end_place is None else self.end_place[0]
        found = [(place, seen) for place, seen in self._told() if place != state and place[0] != ends]
        return sorted(found, key=lambda each: _worth(each[1]), reverse=True)

    def takes_s(self, command: Heard) -> float | None:
        """The longest time from a command of this kind to its end as it was heard, s; None for none."""
        ends = [*self._ends_at()]
        times = [
            next((end - each.at for end in ends if each.at < end <= each.at + LATER_S), None)
            for each in command.messages
        ]
        return max((each for each in times if each is not None), default=None)

    def _ends_at(self) -> Iterator[float]:
        """Times at which something was said to have ended."""
        done = {as_text(value) for key, values in self.ends() if key == "done" for value in values}
        if self.end_place is not None and done:
            for message in self._heard.messages:
                value = message.values.get(self.end_place[1])
                if message.topic == self.end_place[0] and value is not None and as_text(value) in done:
                    yield message.at
        elif self.state is not None:
            place, states = self.state
            yield from (at for at, value in self._heard.course(place) if value in states["stopped"])

    def longest_pause_s(self) -> float:
        """The longest time between two messages of the device that were not retained, s; 0.0 for none."""
        sent = {each.topic for each in self.commands}
        times = [each.at for each in self._heard.messages if not each.retained and each.topic not in sent]
        return max((after - before for before, after in pairwise(times)), default=0.0)


def _is_of_itself(place: Place) -> bool:
    topic, path = place
    return bool(words.ITSELF.search(path or topic.rpartition("/")[2]))


def _all_numbers(seen: Seen) -> bool:
    return all(is_number(value) for value in seen.values)


def _worth(seen: Seen) -> tuple[bool, bool, int]:
    """Few words that changed are worth most, then numbers that did, then what said one value only."""
    changed, is_words = len(seen.values) > 1, not _all_numbers(seen) and len(seen.values) <= MOST_WORDS
    return changed, is_words, seen.count
