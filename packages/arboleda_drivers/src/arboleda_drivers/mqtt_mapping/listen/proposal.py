"""Proposal of a kind and of a mapping, as lines for a plant file, from what is heard of a device."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence

from arboleda_drivers.meaning import as_text, is_number
from arboleda_drivers.mqtt_mapping.virtual.saying import put
from arboleda_drivers.paths import steps

from .guess import MOST_WORDS, Guess, Heard
from .hearing import Listening, Place, Seen
from .words import word

LEAST_SILENCE_S = 5.0
SILENCE = 3  # of the longest pause, after which a device counts as lost
STATE = (
    "    # state: nothing that was heard says whether it moves; if it does, write"
    " state: {hear: TOPIC, words: {stopped: ..., moving: ...}}"
)
NO_COMMAND = (
    "    # verbs: no command was heard; write one for each thing that it can do,"
    " NAME: {send: [{topic: TOPIC, payload: ...}]}, and declare it above"
)
NO_STOP = "stop: none  # nothing that stops it was heard; if something does, delete this and write halt below"
NO_END = "    # done: nothing that was heard says so by itself; its facts and its state say so"


def proposal(heard: Listening, broker: str = "") -> Iterator[str]:
    """The lines of a kind and of a device; what cannot be known is a comment that says what to write."""
    guess = Guess(heard)
    names = _names({**guess.facts, **guess.of_itself})
    verbs = [each for each in guess.commands if not each.stops]
    yield "kinds:"
    yield "  thing:"
    yield "    facts:" if guess.facts else "    facts: {}"
    yield from (f"      {names[place]}: {_type(seen)}" for place, seen in guess.facts.items())
    yield from (f"      # {names[place]}: {_type(seen)}" for place, seen in guess.of_itself.items())
    if verbs:
        yield "    verbs:"
        yield from (line for each in verbs for line in _declared(each, guess, names))
    yield "# and of the device:"
    if verbs and not any(each.stops for each in guess.commands):
        yield NO_STOP
    yield "driver:"
    yield "  mqtt:"
    yield from ([f"    broker: {broker}"] if broker else [])
    yield from _presence(guess)
    yield from _state(guess)
    yield from _ends(guess)
    yield "    facts:" if guess.facts else "    facts: {}"
    yield from (_fact(names[place], place, seen) for place, seen in guess.facts.items())
    if guess.of_itself:
        yield "      # what it tells of itself; take out the # here and above for what a recipe needs"
    yield from (
        _fact(names[place], place, seen).replace("      ", "      # ", 1)
        for place, seen in guess.of_itself.items()
    )
    yield from _verbs(verbs, guess)


def _presence(guess: Guess) -> Iterator[str]:
    if guess.presence is not None:
        place, said = guess.presence
        yield f"    online: {{{_where(place)}, equals: {_quoted(said)}}}"
        return
    silent_s = max(LEAST_SILENCE_S, math.ceil(SILENCE * guess.longest_pause_s()))
    yield f"    silent_after_s: {silent_s:g}  # nothing was heard that says whether it is there"


def _state(guess: Guess) -> Iterator[str]:
    if guess.state is None:
        yield from [STATE] if guess.commands else []
        return
    place, states = guess.state
    known = {state: values for state, values in states.items() if state and values}
    said = ", ".join(f"{state}: {_one_or_all(values)}" for state, values in known.items())
    yield f"    state: {{{_where(place)}, words: {{{said}}}}}  # a guess: compare it with the device"
    if states[""]:
        yield f"    # state: {_one_or_all(states[''])} was heard, too; put it to stopped, moving or fault"


def _ends(guess: Guess) -> Iterator[str]:
    place, told = guess.end_place, dict(guess.ends())
    if place is None or not told:
        yield from [NO_END] if guess.commands else []
        return
    for key, values in told.items():
        id = f", id: {_quoted(guess.end_id)}" if guess.end_id else ""
        why = f", why: {_quoted(guess.end_why)}" if guess.end_why and key == "failed" else ""
        yield f"    {key}: {{{_where(place)}, equals: {_one_or_all(values)}{id}{why}}}"
    unclear = guess.unclear_ends
    if unclear:
        yield f"    # failed: {_one_or_all(unclear)} was heard there, too; put it to accepted, done or failed"
    elif "failed" not in told:
        yield f"    # failed: no failure was heard; write failed: {{{_where(place)}, equals: ...}}"


def _declared(each: Heard, guess: Guess, names: Mapping[Place, str]) -> Iterator[str]:
    """The line of a verb in the kind."""
    values = {_parameter(path): each.values(path) for path in guess.parameters(each)}
    given = "".join(f"{name}: {_listed(of)}, " for name, of in values.items()).rstrip(", ")
    shown = {name: next(_shows(of, guess, names), "") for name, of in values.items()}
    sets = ", ".join(f"{fact}: ${name}" for name, fact in shown.items() if fact)
    effect, takes_s = "process" if guess.state or guess.end_place else "switch", guess.takes_s(each)
    parts = [f"effect: {effect}", f"with: {{{given}}}" if given else "", f"sets: {{{sets}}}" if sets else ""]
    takes = 1.0 if takes_s is None else max(0.1, round(takes_s, 1))
    parts += [f"takes_s: {takes:g}", f"at_most_s: {math.ceil(3 * takes + 2)}"]
    yield f"      {each.name}: {{{', '.join(filter(None, parts))}}}"
    if not sets:
        yield f"      # sets: no fact shows what {each.name} does; if one does, write sets: {{FACT: VALUE}}"
    if effect == "process":
        yield f"      # effect: write motion if {each.name} moves something that people may touch"


def _shows(values: Sequence[object], guess: Guess, names: Mapping[Place, str]) -> Iterator[str]:
    """The facts that have taken at least two of these values, or all."""
    wanted = {word(value) for value in values}
    for place, seen in guess.facts.items():
        if len(wanted & {word(each) for each in seen.values}) >= min(2, len(wanted)):
            yield names[place]


def _verbs(verbs: Sequence[Heard], guess: Guess) -> Iterator[str]:
    if not verbs:
        yield "    verbs: {}"
        yield NO_COMMAND
        return
    yield "    verbs:"
    yield from (f"      {each.name}: {{send: [{_sent(each, guess)}]}}" for each in verbs)
    halts = [_sent(each, guess) for each in guess.commands if each.stops]
    if halts:
        yield f"    halt: [{halts[0]}]"


def _sent(each: Heard, guess: Guess) -> str:
    """The message of a command, with names in place of its parameters and of its id."""
    body: dict[str, object] = {**each.messages[0].values}
    words: dict[str, object] = {}
    for path in guess.parameters(each):
        body[path] = f"{{{_parameter(path)}}}"
        said = {word(value): value for value in each.values(path) if isinstance(value, str | bool)}
        words |= {name: value for name, value in said.items() if name != value}
    if (id := guess.id_of(each)) is not None:
        body[id] = "{number}" if all(map(is_number, each.values(id))) else "{id}"
    payload: object = "" if [*body] == [""] else {}
    for path, value in body.items():
        payload = put(payload, steps(path) if path else (), value)
    parts = [f"topic: {_quoted(each.topic)}"]
    parts += [f"payload: {json.dumps(payload, ensure_ascii=False)}"] if payload != "" else []
    parts += (
        [f"words: {{{', '.join(f'{name}: {json.dumps(of)}' for name, of in words.items())}}}"]
        if words
        else []
    )
    return f"{{{', '.join(parts)}}}"


def _parameter(path: str) -> str:
    return word(path.rpartition(".")[2]) if path else "to"


def _listed(values: Sequence[object]) -> str:
    """The type of a parameter that had these values."""
    if all(isinstance(value, bool) for value in values):
        return "bool"
    words = [word(value) if isinstance(value, str) else as_text(value) for value in values]
    return f"[{', '.join(words)}]"


def _fact(name: str, place: Place, seen: Seen) -> str:
    return f"      {name}: {{{_where(place)}{_words(seen)}}}"


def _where(place: Place) -> str:
    topic, path = place
    return f"hear: {_quoted(topic)}" + (f", path: {_quoted(path)}" if path else "")


def _names(places: Mapping[Place, Seen]) -> dict[Place, str]:
    """A name for the fact at each place: its last word, with those before it where two would be alike."""
    words = {place: _words_of(*place) for place in places}
    names: dict[Place, str] = {}
    for place, found in words.items():
        for length in range(1, len(found) + 1):
            name = "_".join(found[-length:])
            if sum(other[-length:] == found[-length:] for other in words.values()) == 1:
                break
        names[place] = name if name[:1].isalpha() else f"value_{name}"
    return names


def _words_of(topic: str, path: str) -> list[str]:
    return [part.lower() for part in re.findall(r"[A-Za-z0-9]+", f"{topic}/{path}")]


def _type(seen: Seen) -> str:
    if all(isinstance(value, bool) for value in seen.values):
        return "bool"
    if all(is_number(value) for value in seen.values):
        return "int" if all(isinstance(value, int) for value in seen.values) else "number"
    said = [word(value) or "none" for value in seen.values]
    return f"[{', '.join(said)}]" if len(set(said)) == len(said) <= MOST_WORDS else "text"


def _words(seen: Seen) -> str:
    if not _type(seen).startswith("["):
        return ""
    said = ", ".join(f"{word(value) or 'none'}: {_quoted(as_text(value))}" for value in seen.values)
    return f", words: {{{said}}}"


def _one_or_all(values: Sequence[object]) -> str:
    said = [json.dumps(value, ensure_ascii=False) for value in values]
    return said[0] if len(said) == 1 else f"[{', '.join(said)}]"


def _quoted(text: str | None) -> str:
    return json.dumps(text, ensure_ascii=False)
