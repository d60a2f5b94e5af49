"""Bugs of the engine: kinds of devices, and of robots that move."""

from __future__ import annotations

from .engine_bug import bug

DECLARED = "kinds/declared.py"

KIND_BUGS = (
    bug(
        DECLARED,
        "A word that a fact does not have is taken.",
        "if not fits or (self.words and value not in self.words):",
        "if not fits:",
    ),
    bug(
        DECLARED,
        "A number has no upper limit.",
        "self.lower <= value <= self.upper",
        "self.lower <= value",
    ),
    bug(
        DECLARED,
        "A slower device gets no more time.",
        "at_most_s=self.at_most_s / min(rate, 1.0),",
        "at_most_s=self.at_most_s * min(rate, 1.0),",
    ),
    bug(
        DECLARED,
        "A faster device is not faster.",
        "            takes_s=self.takes_s / rate,\n",
        "            takes_s=self.takes_s * rate,\n",
    ),
    bug(
        DECLARED,
        "The verb that lets go grips.",
        "return {name: False if name == held else type.first",
        "return {name: True if name == held else type.first",
    ),
    bug(
        DECLARED,
        "A placeholder stays in what a verb sets.",
        "(name, values[value.name] if isinstance(value, Slot) else value) for name, value in self.sets",
        "(name, self._typical(value)) for name, value in self.sets",
    ),
    bug(
        DECLARED,
        "Values go to the device in the order in which the recipe gives them.",
        "in_order = tuple((name, values[name]) for name, _ in known.parameters)",
        "in_order = tuple(values.items())",
    ),
    bug(
        DECLARED,
        "A virtual device always gives the first answer.",
        "        if call.definition.virtual is None:\n            return type.first\n",
        "        return type.first\n",
        argued="the judge asks the same function, and which answer a virtual device gives is its own affair",
    ),
    bug(
        DECLARED,
        "A value that is not known is not refused.",
        "        unknown = next((name for name in values if name not in dict(verb.parameters)), None)\n",
        "        unknown = None\n",
    ),
    bug(
        DECLARED,
        "Work goes on through a stop.",
        "    @property\n    def on_stop(self) -> OnStop:\n        return self.definition.on_stop",
        "    @property\n    def on_stop(self) -> OnStop:\n        return OnStop.FINISH",
    ),
    bug(
        DECLARED,
        "Work that finishes is halted.",
        "    @property\n    def on_stop(self) -> OnStop:\n        return self.definition.on_stop",
        "    @property\n    def on_stop(self) -> OnStop:\n        return OnStop.HALT",
    ),
    bug(
        DECLARED,
        "A verb forgets its needs.",
        "        return self.definition.needs\n",
        "        return ()\n",
    ),
    bug(
        DECLARED,
        "A switch that lets go is booked as one that grips.",
        "return bool(dict(self.sets)[self.definition.held[0]]) if self.definition.holds else None",
        "return True if self.definition.holds else None",
    ),
    bug(
        DECLARED,
        "A switch of a part is no grip.",
        "return bool(dict(self.sets)[self.definition.held[0]]) if self.definition.holds else None",
        "return None",
    ),
    bug(
        DECLARED,
        "No verb works on a part.",
        "        return self.definition.works_on_part\n",
        "        return False\n",
    ),
    bug(
        DECLARED,
        "What a device cannot say is taken.",
        '            if not type.takes(value):\n                return f"{name} is',
        '            if type.words and not type.takes(value):\n                return f"{name} is',
    ),
    bug(
        DECLARED,
        "A device that only works by itself does no work.",
        "verb.effect in (Effect.MOTION, Effect.PROCESS) for",
        "verb.effect is Effect.MOTION for",
    ),
    bug(
        DECLARED,
        "A process is carried out as a switch.",
        "    Effect.PROCESS: ProcessCall,\n",
        "    Effect.PROCESS: SwitchCall,\n",
    ),
    bug(
        "kinds/moving.py",
        "Millimetres are taken for centimetres.",
        '"mm": 0.001}',
        '"mm": 0.01}',
    ),
    bug(
        "kinds/mobile/grid.py",
        "A way over the grid leaves out where it begins.",
        "        while way[-1] != start:\n            way.append(came_from[way[-1]])",
        "        while came_from[way[-1]] != start:\n            way.append(came_from[way[-1]])",
    ),
    bug(
        "kinds/joints/motion.py",
        "One joint at its goal is enough.",
        "            if not abs(value - goal) <= tolerance:\n                return False\n"
        "        return True",
        "            if abs(value - goal) <= tolerance:\n                return True\n        return False",
    ),
    bug(
        "kinds/joints/motion.py",
        "The slowest joint does not count for the time of a move.",
        "return min(self._longest_s, max(joint.travel_s(there - here)",
        "return min(self._longest_s, min(joint.travel_s(there - here)",
    ),
    bug(
        "kinds/person.py",
        "Whoever asks a person waits for ever.",
        "        return self.patience_s\n",
        "        return 10 * self.patience_s\n",
    ),
)
