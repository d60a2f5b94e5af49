"""World for tests: each act takes effect at once, and everything that happened is kept."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from py_trees.common import Status

from arboleda.model.messages import Event, OperatorAnswer, TaskChanged, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import PLANT, World
from arboleda.views import view
from arboleda.wire.transport import Publication


class Rig(World):
    """A plant at `now` seconds; messages take no time, `wait` moves it from deadline to deadline.

    `lost` and `carry` are the network: which messages it loses, and what it makes of each of the others.
    `to_boards` is every command that reached a board, with its time.
    """

    def __init__(self, model: PlantModel, *, now: float = 100.0, epoch: int = 1000) -> None:
        self.changes: list[TaskChanged] = []
        self.answers: list[OperatorAnswer] = []
        self.sent: list[Any] = []
        self.to_boards: list[tuple[float, Publication]] = []
        self.lost: Callable[[Publication], bool] = lambda publication: False
        self.carry: Callable[[Publication], Iterable[Publication]] = lambda publication: [publication]
        super().__init__(model, now=now, epoch=epoch, watchers=[self._keep], carriers=[self._network])

    def submit(self, text: str) -> TaskChanged:
        """Ask for a task; return the plant's answer."""
        before = len(self.changes)
        self.request_task(text)
        return next(change for change in self.changes[before:] if change.request == text)

    def operate(
        self, verb: Verb, scope: str = "", *, by_hand: bool = False, **arguments: int | str
    ) -> str | None:
        """Act as an operator; return the reason of a refusal, or None if it was done."""
        self.request_verb(verb, scope, by_hand=by_hand, arguments=tuple(arguments.items()))
        refusal = self.answers[-1].refusal
        return None if refusal is None else str(refusal)

    def tell(self, event: Event) -> None:
        super().tell(event)
        self.settle()

    def crash(self, process: str = PLANT) -> None:
        super().crash(process)
        self.settle()

    def power_off(self, board: str, *, will_after_s: float = 0.0) -> None:
        super().power_off(board, will_after_s=will_after_s)
        self.settle()

    def power_on(self, board: str) -> None:
        super().power_on(board)
        self.settle()

    def stop_broker(self) -> None:
        super().stop_broker()
        self.settle()

    def start_broker(self) -> None:
        super().start_broker()
        self.settle()

    def inject(self, publication: Publication) -> None:
        """Publish a message as a foreign client."""
        self.publish(publication)
        self.settle()

    def wait(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let at most `seconds` pass; return True as soon as `until` comes true."""
        return self.advance(seconds, until)

    def outcomes(self) -> dict[str, TaskChanged]:
        """The last change of every accepted task, by task id."""
        return {change.task: change for change in self.changes if change.task}

    def leaf(self, cell: str) -> str | None:
        """The leaf that runs in a cell, with the nodes that it is part of: `main/effector on/switch`."""
        tree = self.plant.cells[cell].tree
        running = [node for node in tree.iterate() if node.status is Status.RUNNING] if tree else []
        recipes = {recipe.name for recipe in self.model.cell(cell).recipes}
        names = [node.name for node in reversed(running) if node.name not in recipes]
        return "/".join(names) or None

    def runs(self, cell: str, leaf: str) -> bool:
        """True if a leaf runs in the cell whose path of names ends in this way."""
        return f"/{self.leaf(cell)}".endswith(f"/{leaf}")

    def wait_for(self, cell: str, leaf: str, seconds: float = 60.0) -> None:
        """Let time pass until this leaf runs."""
        assert self.wait(seconds, until=lambda: self.runs(cell, leaf)), f"{leaf} never ran in {cell}"

    def snapshot(self) -> dict[str, Any]:
        """The rows that a screen would show now."""
        return view.snapshot(self.plant)

    def _network(self, publication: Publication) -> Iterable[Publication]:
        return [] if self.lost(publication) else self.carry(publication)

    def _keep(self) -> None:
        assert self.plant.sleepers() == [], "a tree runs with nothing left to wake it"
        for message in self.moment.sent:
            self.sent.append(message)
            if isinstance(message, TaskChanged):
                self.changes.append(message)
            elif isinstance(message, OperatorAnswer):
                self.answers.append(message)
        for client, delivery in self.moment.delivered:
            if client in self.boards and not delivery.topic.endswith("/latido"):
                publication = Publication(topic=delivery.topic, payload=delivery.payload)
                self.to_boards.append((delivery.at, publication))
