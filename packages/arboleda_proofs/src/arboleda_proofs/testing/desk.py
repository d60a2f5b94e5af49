"""Desk at which a test asks for tasks and acts as an operator, with the plant's answers."""

from __future__ import annotations

from arboleda.model.messages import OperatorAnswer, TaskChanged, TaskRequest, TaskState, Verb
from arboleda.model.verbs import Arguments
from arboleda.rig.hands import BEFOREHAND
from arboleda.rig.manual_work import BY_HAND_S
from arboleda.rig.world import World

NO_ANSWER = "the plant did not answer"
ASKED = "asked"  # a task that the plant has said nothing of yet
ENDED = frozenset(
    state.value for state in (TaskState.REFUSED, TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED)
)


class Handle:
    """A task that a test asked for, with the plant's last word on it; it changes while the simulation runs.

    `state` is asked, refused, queued, running, done, failed or cancelled, `history` all it was in; `id` is
    None until the plant takes the task; `reason` and `sentence` say why it failed, was refused or waits.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self.id: str | None = None
        self.state = ASKED
        self.reason: str | None = None
        self.sentence = ""
        self.history: list[str] = []

    def __repr__(self) -> str:
        why = ": ".join(word for word in (self.reason, self.sentence) if word)
        return f"<task {self.text!r} {self.state}{f' ({why})' if why else ''}>"

    @property
    def ended(self) -> bool:
        """True once the task has ended or was refused."""
        return self.state in ENDED

    def follow(self, change: TaskChanged) -> None:
        """Take in what the plant says of it."""
        self.id = change.task or None
        self.state = change.state.value
        self.reason = change.reason.value if change.reason else None
        self.sentence = str(change.sentence)
        if self.history[-1:] != [self.state]:
            self.history.append(self.state)


class Desk:
    """Asks the plant of a world for tasks, and follows what becomes of them."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._handles: dict[str, Handle] = {}
        self._by_id: dict[str, list[Handle]] = {}
        self._answers: list[OperatorAnswer] = []
        world.watchers.append(self._look)

    @property
    def tasks(self) -> list[Handle]:
        """All tasks that were asked for so far."""
        return list(self._handles.values())

    def submit(self, text: str) -> Handle:
        """Ask for a task and let the plant answer."""
        handle = Handle(text)
        request = f"test-{len(self._handles) + 1}"
        self._handles[request] = handle
        self._world.tell(TaskRequest(at=self._world.now, text=text, request=request))
        self._world.settle()
        return handle

    def operate(self, verb: Verb, scope: str, *, by_hand: bool, arguments: Arguments) -> str | None:
        """Act as an operator; return the plant's reason for a refusal, or None if it did as asked."""
        if by_hand:
            BEFOREHAND[verb](self._world.manual, scope)
            self._world.advance(BY_HAND_S)
        self._answers.clear()
        self._world.request_verb(verb, scope, by_hand=by_hand, arguments=arguments)
        self._world.settle()
        mine = [each for each in self._answers if (each.verb, each.scope) == (verb, scope)]
        refusal = mine[0].refusal if mine else NO_ANSWER
        return None if refusal is None else str(refusal)

    def _look(self) -> None:
        for message in self._world.moment.sent:
            if isinstance(message, TaskChanged):
                self._follow(message)
            elif isinstance(message, OperatorAnswer):
                self._answers.append(message)

    def _follow(self, change: TaskChanged) -> None:
        followers = self._by_id.setdefault(change.task, []) if change.task else []
        request = self._handles.get(change.request or "")
        if request is not None and request not in followers:
            followers.append(request)
        for handle in followers:
            handle.follow(change)
