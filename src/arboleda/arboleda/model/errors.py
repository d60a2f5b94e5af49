"""The error tree.

ArboledaError            one sentence for a person; never shown as a traceback
├── TextError            a task text that names something the plant does not have
├── QueueFull            a task that is not taken now: no room in the cell's queue, or the plant ends
├── IllegalTransition    a state table was fed a pair it does not list
├── ConfigError          a plant file or a robot file, all problems at once
├── PayloadError         bytes or a message that break the wire contract
├── Refused              something that is not done as things are, such as while somebody else edits
└── StartError           a part of the plant cannot start (port taken, library missing, ...)
"""

from __future__ import annotations

from .sentence import Sentence, as_sentence


class ArboledaError(Exception):
    """Error that Arboleda reports: one sentence that an operator can act on, or its text."""

    @property
    def sentence(self) -> Sentence:
        return as_sentence(self)


class TextError(ArboledaError):
    """The task text is refused; the sentence names the wrong word and what is allowed."""


class QueueFull(ArboledaError):
    """The plant does not take this task now, but may later; the sentence says why, as how many wait."""


class IllegalTransition(ArboledaError):
    """A state table has no row for this pair; nothing changed."""


class ConfigError(ArboledaError):
    """A file is refused as a whole; `problems` is a tuple of `file:line:column: sentence` lines."""

    def __init__(self, problems: tuple[str, ...]) -> None:
        super().__init__("\n".join(problems))
        self.problems = problems


class PayloadError(ArboledaError):
    """A message from outside breaks the contract and is refused whole."""


class Refused(ArboledaError):
    """Refusal of a request as things are; nothing was changed, and the sentence says why."""


class StartError(ArboledaError):
    """A part of the plant cannot start; the sentence says what to do."""
