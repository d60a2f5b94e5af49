"""The processor time of one step of the plant, one tick of a tree and one view, without any network.

A storage task runs in a plant of one cell; nothing else is in the process and time is moved by hand. Measured
in microseconds of processor time of this thread, each the median of many:

- a step with a report that repeats the last one: what a robot that does nothing says ten times a second;
- a step with a report of an arm that moves: only its position is new, so no tree is ticked;
- a step with the report that ends a move: the tree is ticked until it rests, and the next command leaves;
- one waking of the tree while it runs and nothing has changed: what we put around py_trees' tick;
- one view while the task runs, after such a report, as the orchestrator makes it: cells to which nothing has
  happened are remembered from the last one;
- the same where nothing has happened to any cell, as where several people look at once.

The floor is `tick_once` of py_trees, which the user of a ticked tree calls at every period, of the very same
tree (the shipped storage recipe) in the same state: a move under way. For the report that ends a move it is
the tick that finds the move done and sends the next command; what the report proves was booked before.
The rows for 100 cells, of which one is busy, show what the size of a plant costs; they have no aim.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from statistics import median
from time import thread_time_ns
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.drivers import Command, FollowPath, MoveJoints, Report
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load
from arboleda.testing.storage_layout import StorageLayout
from arboleda.views import view
from arboleda.views.resting_cells import RestingCells

from . import plants
from .obedient import Yard, command_in, is_over
from .result import Aim, Figure, Result
from .scene import Scene

AIM = Aim(most=4)
VIEW = "view"  # it is for people, and has no aim: nothing compares with it
BATCH = 10  # calls between two looks at the clock, which takes half a microsecond itself
MANY = 100  # cells
FURTHER_RAD = 1e-4
Costs = tuple[float, float]  # ours and the floor, us
Finish = Callable[[Yard, Report], tuple[float, list[Any]]]


def run(scene: Scene) -> Result:
    calls = 500 if scene.quick else 5000
    figures: list[Figure] = []
    for cells in (1, MANY):
        scene.say("a plant of one cell" if cells == 1 else f"a plant of {cells} cells")
        model = load(plants.write(scene.folder / f"plant_{cells}.yaml", cells))
        where = "" if cells == 1 else f", {cells} cells"
        for name, (ours, floor) in _costs(model, calls if cells == 1 else calls // 5):
            aim = AIM if cells == 1 and not name.startswith(VIEW) else None
            figures.append(Figure(name=f"{name}{where}", unit="us", ours=ours, floor=floor, aim=aim))
    note = f"medians of {calls} calls, a fifth of them with {MANY} cells; the floor is tick_once of the tree"
    return Result(figures=figures, notes=(note,))


def _costs(model: PlantModel, calls: int) -> Iterator[tuple[str, Costs]]:
    yard = Yard(model)
    move = until_a_move(yard)
    tick = _cost(_tree(yard).tick_once, calls)
    yield "step: a report that repeats the last", (_cost_of_reports(yard, move, calls, 0.0), tick)
    yield "step: a report of a moving arm", (_cost_of_reports(yard, move, calls, FURTHER_RAD), tick)
    yield "step: the report that ends a move", _ends_of_moves(Yard(model), calls)
    yield "waking of a tree that waits on", (_cost(_run(yard).tick, calls), tick)
    resting = RestingCells()

    def look() -> object:
        return view.snapshot(yard.plant, resting.part)

    yield VIEW, (_cost_after_reports(yard, move, look, calls), tick)
    yield "view, nothing new", (_cost(look, calls), tick)


def _cost(act: Callable[[], object], calls: int) -> float:
    """The median processor time of one call, us."""
    return median(_cost_of_batch([act] * BATCH) for _ in range(calls // BATCH))


def _cost_of_batch(acts: Sequence[Callable[[], object]]) -> float:
    begin = thread_time_ns()
    for act in acts:
        act()
    return (thread_time_ns() - begin) / len(acts) / 1000


def _cost_of_reports(yard: Yard, move: Command, calls: int, by_rad: float) -> float:
    """The median time of a step with one report of an arm under way, a bit further on in each."""
    return median(_cost_of_batch(_steps(yard, move, by_rad)) for _ in range(calls // BATCH))


def _cost_after_reports(yard: Yard, move: Command, act: Callable[[], object], calls: int) -> float:
    """The median time of a call after a report of an arm under way, a bit further on in each."""
    costs = []
    for _ in range(calls):
        _step(yard, move.robot, FURTHER_RAD)()
        costs.append(_cost_of_batch([act]))
    return median(costs)


def _steps(yard: Yard, move: Command, by_rad: float) -> list[Callable[[], object]]:
    return [_step(yard, move.robot, by_rad) for _ in range(BATCH)]


def _step(yard: Yard, arm: str, by_rad: float) -> Callable[[], object]:
    first, *others = yard.words[arm].q or ()
    report = yard.say(replace(yard.words[arm], q=(first + by_rad, *others)))
    return lambda: yard.plant.step(report.at, (report,))


def _ends_of_moves(yard: Yard, calls: int) -> Costs:
    """Cycles in turn: one with the plant's steps measured, one with the tree's ticks."""
    ours: list[float] = []
    floor: list[float] = []
    while len(floor) < calls // 2:
        ours += _cycle(yard, _timed_step)
        floor += _cycle(yard, _timed_tick)
    return median(ours), median(floor)


def _cycle(yard: Yard, finish: Finish) -> list[float]:
    """Run one task; return the cost of each end of a move that another command follows."""
    costs: list[float] = []
    out = begin_task(yard)
    while not is_over(out):
        command = command_in(out)
        if command is not None and leads_on(yard, command):
            yard.step(yard.accepts(command))
            cost, out = finish(yard, yard.finishes(command))
            costs.append(cost)
        else:
            out = go_on(yard, command)
    return costs


def _timed_step(yard: Yard, report: Report) -> tuple[float, list[Any]]:
    begin = thread_time_ns()
    out = yard.step(report)
    return (thread_time_ns() - begin) / 1000, out


def _timed_tick(yard: Yard, report: Report) -> tuple[float, list[Any]]:
    yard.step()
    yard.plant.dispatcher.report(report, yard.now)
    tree = _tree(yard)
    begin = thread_time_ns()
    tree.tick_once()
    return (thread_time_ns() - begin) / 1000, yard.step()


def until_a_move(yard: Yard) -> MoveJoints:
    """Bring a storage task to the arm's first move, with that under way."""
    out = begin_task(yard)
    while not isinstance(command := command_in(out), MoveJoints):
        out = go_on(yard, command)
    yard.step(yard.accepts(command))
    return command


def begin_task(yard: Yard) -> list[Any]:
    yard.roll_call()
    return yard.ask(f"{yard.plant.model.cells[0].name} 0B 7")


def go_on(yard: Yard, command: Command | None) -> list[Any]:
    """Have the robot carry out the command, or let time pass."""
    if command is None:
        return yard.sleep()
    yard.step(yard.accepts(command))
    return yard.step(yard.finishes(command))


def leads_on(yard: Yard, command: Command) -> bool:
    """True if a command is a move that another command follows at once."""
    home = StorageLayout(yard.plant.model.cells[0]).home
    return isinstance(command, FollowPath) or (isinstance(command, MoveJoints) and command.q != home.q)


def _run(yard: Yard) -> Any:
    return yard.plant.cells[yard.plant.model.cells[0].name].run


def _tree(yard: Yard) -> Behaviour:
    tree: Behaviour = _run(yard).tree
    return tree
