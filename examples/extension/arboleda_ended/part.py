"""The part that counts ended tasks, and its table in the memory of the plant."""

from arboleda.model.messages import ENDED
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.runtime.registry import Factory, Phase
from arboleda.store.package_table import PackageTable


class EndedTasks:
    def __init__(self, cells, table):
        self.table = table
        self.kept = table.rows()  # those of earlier starts
        self.counts = {cell: int(self.kept.get(cell, 0)) for cell in cells}

    def start(self):
        pass

    def stop(self):
        self.keep()

    def changed(self, change):
        """A task changed: told in a thread that must not wait."""
        if change.state in ENDED:
            self.counts[change.cell] = self.counts.get(change.cell, 0) + 1

    def keep(self, _plant=None):
        """Write what is new; called in the thread of the plant, which has its memory."""
        new = {cell: str(count) for cell, count in [*self.counts.items()] if count}
        if new != self.kept:
            self.table.put(new)
            self.kept = new


def ended(assembly):
    plant = assembly.ask(Orchestrator)
    if plant is None:  # a process without the plant, as a node of boards
        return
    cells = [cell.name for cell in assembly.model.cells]
    part = EndedTasks(cells, PackageTable(assembly.holdings.memory, "ended"))
    plant.listeners.append(part.changed)
    plant.observers.append(part.keep)
    assembly.offer(EndedTasks, part)  # the route asks for it
    assembly.links.add(lambda: {"ended": {**part.counts}})  # the page shows it
    yield part


PARTS = [Factory(phase=Phase.RECORD, make=ended)]
