"""Insides of the engine for who judges a plant, teaches it or tries a change of it; nothing else needs them.

Each function reads one thing of a plant or of a cell, as it is now. It costs as much as to read the
attribute: a judge asks thousands of times a second.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from operator import attrgetter

from arboleda.core.cell import CellRun
from arboleda.core.choosing import LAST, UNKNOWN_S
from arboleda.core.intake import Intake
from arboleda.core.news import News
from arboleda.core.plant import HEARTBEAT_S, SETTLES_IN, Plant
from arboleda.core.reasons import HELD, HELD_STRANDED
from arboleda.core.teaching import HOLD_S, Teaching
from arboleda.core.verbs.releasing import RELEASING
from arboleda.dispatch.belief import (
    BACK_AT_ZERO,
    FAULTY,
    FENCED,
    MOVING,
    OFFLINE,
    STOPPED,
    UNANSWERED,
    UNHEARD,
    UNHOMED,
    Belief,
)
from arboleda.dispatch.effectors import Effectors
from arboleda.dispatch.fact_memory import FactMemory
from arboleda.dispatch.latches import Latches
from arboleda.dispatch.ledger import TABLE, Entry, Feed, Ledger
from arboleda.dispatch.obstacles import Obstacles
from arboleda.dispatch.stillness import ReportMoment, Stillness
from arboleda.model.commands import LABELS, Command, Position, Question
from arboleda.model.grips import Grip, Grips
from arboleda.model.messages import Notice
from arboleda.model.task import UNCHECKED, Task
from arboleda.resume.trail import Trail
from arboleda.resume.walk_back import MORE, WalkBack
from arboleda.trees.cell_time import CellTime
from arboleda.trees.part_places import EMPTY, Places, trouble_in
from arboleda.trees.parts import Parts
from arboleda.trees.tree_run import IN_RECOVERY, path_of

__all__ = [
    "BACK_AT_ZERO",
    "EMPTY",
    "FAULTY",
    "FENCED",
    "HEARTBEAT_S",
    "HELD",
    "HELD_STRANDED",
    "HOLD_S",
    "IN_RECOVERY",
    "LABELS",
    "LAST",
    "MORE",
    "MOVING",
    "OFFLINE",
    "RELEASING",
    "SETTLES_IN",
    "STOPPED",
    "TABLE",
    "UNANSWERED",
    "UNCHECKED",
    "UNHEARD",
    "UNHOMED",
    "UNKNOWN_S",
    "Feed",
    "Grip",
    "Ledger",
    "News",
    "Question",
    "ReportMoment",
    "Stillness",
    "Task",
    "Trail",
    "asking_of",
    "beliefs_of",
    "effectors_of",
    "facts_of",
    "grips_of",
    "intake_of",
    "is_ending",
    "latches_of",
    "ledger_of",
    "not_given_count_of",
    "not_given_of",
    "obstacles_of",
    "outbox_of",
    "parts_of",
    "path_of",
    "places_of",
    "reached_of",
    "tasks_of",
    "teaching_of",
    "time_of",
    "trouble_in",
    "walk_of",
]

beliefs_of: Callable[[Plant], Mapping[str, Belief]] = attrgetter("dispatcher.beliefs")
"""The beliefs of a plant about each robot, by its name."""
ledger_of: Callable[[Plant], Ledger] = attrgetter("dispatcher.ledger")
"""The commands of a plant."""
obstacles_of: Callable[[Plant], Obstacles] = attrgetter("dispatcher.obstacles")
"""The reasons for which robots of a plant take no command."""
effectors_of: Callable[[Plant], Effectors] = attrgetter("dispatcher.effectors")
"""The effectors of a plant."""
grips_of: Callable[[Plant], Grips] = attrgetter("dispatcher.effectors.grips")
"""The parts that the effectors of a plant may hold."""
latches_of: Callable[[Plant], Latches] = attrgetter("dispatcher.latches")
"""The stops (software) of the robots of a plant."""
outbox_of: Callable[[Plant], Sequence[Command | Notice]] = attrgetter("dispatcher.outbox")
"""The messages that a plant is about to send; none between its steps."""
facts_of: Callable[[Plant], FactMemory] = attrgetter("dispatcher.memory")
"""The facts that outlive a plant."""
reached_of: Callable[[Plant], Mapping[str, Position]] = attrgetter("dispatcher.whereabouts.reached")
"""The goal of the last motion of each robot that has reached it."""
not_given_of: Callable[[Plant], Sequence[Entry]] = attrgetter("dispatcher.not_given")
"""The last commands that something kept a plant from giving."""
not_given_count_of: Callable[[Plant], int] = attrgetter("dispatcher.not_given_count")
"""The number of commands that something kept a plant from giving, in this start."""
intake_of: Callable[[Plant], Intake] = attrgetter("intake")
"""The intake of a plant, which takes the texts of tasks."""
tasks_of: Callable[[Plant], Mapping[str, Task]] = attrgetter("intake.tasks")
"""The tasks that a plant remembers, by id."""
is_ending: Callable[[Plant], bool] = attrgetter("intake.closed")
"""True for a plant that takes no more tasks because it ends."""
asking_of: Callable[[Plant], tuple[tuple[str, frozenset[str]], ...]] = attrgetter("zones.queue.waiting")
"""The robots that wait for zones, with these, in the order of asking."""
places_of: Callable[[CellRun], Places] = attrgetter("context.places")
"""The parts at the places of a cell."""
parts_of: Callable[[CellRun], Parts] = attrgetter("context.parts")
"""The parts that the robots of a cell hold."""
time_of: Callable[[CellRun], CellTime] = attrgetter("context.time")
"""The time of a cell."""
teaching_of: Callable[[CellRun], Teaching | None] = attrgetter("manual.teaching")
"""The teaching of a cell; None where nobody teaches it."""
walk_of: Callable[[CellRun], WalkBack | None] = attrgetter("keeping.walk")
"""The way back to where an earlier start left the task of a cell; None where there is none."""
