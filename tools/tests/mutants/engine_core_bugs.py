"""Bugs of the engine: cells, their states and queues, and the choice among them."""

from __future__ import annotations

from .engine_bug import bug

CELL, STEPS, HELD = "core/cell.py", "core/cell_steps.py", "core/verbs/held_cells.py"

CORE_BUGS = (
    bug(
        CELL,
        "A hold halts nothing.",
        "        self.context.time.pause()\n        self.context.commands.cancel_motions()\n\n    def lose",
        "        self.context.time.pause()\n\n    def lose",
    ),
    bug(
        CELL,
        "A held cell's time goes on.",
        "        self.context.time.pause()\n        self.context.commands.cancel_motions()\n\n    def lose",
        "        self.context.commands.cancel_motions()\n\n    def lose",
    ),
    bug(
        CELL,
        "Resume gives the interrupted step not anew.",
        "        for act in self.run.interrupted():\n            act.send()\n",
        "        self.run.interrupted()\n",
    ),
    bug(
        CELL,
        "A stop leaves the queue running.",
        "        self.queue.paused = True\n        self.manual.end(STOPPED",
        "        self.manual.end(STOPPED",
    ),
    bug(
        STEPS,
        "A cell is held although something still moves.",
        "    if any(entry.halts for entry in run.context.commands.open()):\n        return False\n",
        "",
    ),
    bug(
        "core/plant.py",
        "A cell that is held counts as at work, for those who wait behind it.",
        "        return executes or bool(self.dispatcher.ledger.of_robot(holder))\n",
        "        return True\n",
    ),
    bug(
        CELL,
        "A cancelled task counts as failed.",
        "self._finish(task, TaskState.CANCELLED if cancelled else TaskState.FAILED)",
        "self._finish(task, TaskState.FAILED)",
    ),
    bug(
        CELL,
        "A recovery that failed leaves the cell ready.",
        "            self.stuck(last)\n        else:",
        "            self.become(Cause.ENDED)\n        else:",
    ),
    bug(
        HELD,
        "A task that has failed is not recovered from once it is abandoned.",
        "    cell.task.fail(cell.trouble or given_up)\n    cell.recover()\n",
        "    cell.interrupt(cell.trouble or given_up)\n    cell.become(Cause.ENDED)\n",
    ),
    bug(
        "core/verbs/releasing.py",
        "An operator who opens a hand strands nobody.",
        "        run.lose(NO_PART(arm=robot), run.trouble or lost)\n",
        "        run.trouble = run.trouble or (lost if run.task else None)\n",
    ),
    bug(
        CELL,
        "Supplies are not filled for the next task.",
        "        self.context.places.begin()\n",
        "",
    ),
    bug(
        CELL,
        "The failures of the last task are those of the next.",
        "        self._changed(task)\n        self.context.start_afresh()\n",
        "        self._changed(task)\n",
    ),
    bug(
        "core/readiness.py",
        "A cell starts with a part in its hand.",
        "        failures += [astray[1] if astray else None, self.part_in_hand()]\n",
        "        failures += [astray[1] if astray else None]\n",
    ),
    bug(
        "core/readiness.py",
        "A cell starts with a robot astray.",
        "        failures += [astray[1] if astray else None, self.part_in_hand()]\n",
        "        failures += [self.part_in_hand()]\n",
    ),
    bug(
        "core/task_queue.py",
        "A queue takes one more than its limit.",
        "return len(self) >= self._cell.queue_limit",
        "return len(self) > self._cell.queue_limit",
    ),
    bug(
        "core/choosing.py",
        "A cell that is full is chosen.",
        "return self.is_full, self.hindrance is not None, self.seconds",
        "return self.hindrance is not None, self.seconds",
    ),
    bug(
        "departures/leading.py",
        "A leader is sure of itself for too long.",
        "self._until = sent_at + SURE_S",
        "self._until = sent_at + 1.2 * SURE_S",
    ),
)
