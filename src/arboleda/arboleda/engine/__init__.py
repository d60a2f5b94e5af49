"""Engine of a plant: its cells, their tasks, trees and commands; pure.

For who builds on the engine: trees and leaves of one's own, a plant that runs in a test. A recipe is easier
written with `arboleda.recipes`.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any
from warnings import warn

from arboleda.core.acts import OperatorAct
from arboleda.core.cell import CellRun
from arboleda.core.choosing import Prospect, best
from arboleda.core.envelope import unsettled
from arboleda.core.intake import HISTORY
from arboleda.core.operator import ACTS_TOLD
from arboleda.core.plant import AWAY, Plant
from arboleda.core.reasons import BY_OPERATOR
from arboleda.core.reasons import of_hold as why_held
from arboleda.core.reasons import of_waiting as why_waiting
from arboleda.core.teaching import Teaching
from arboleda.dispatch.belief import Belief
from arboleda.dispatch.fact_memory import FACT_VALUES
from arboleda.dispatch.ledger import OPEN, Entry, State
from arboleda.dispatch.outlet import UNSENT
from arboleda.dispatch.zones import Zones
from arboleda.trees.cell_time import LEAST_S, CellTime
from arboleda.trees.context import Context
from arboleda.trees.failures import Failures
from arboleda.trees.leaves import (
    RETRYABLE,
    Act,
    Announce,
    Approach,
    Await,
    Carry,
    Dwell,
    Leaf,
    Require,
    TakeDevices,
    TakeZones,
    Unless,
    title_of,
    titled,
)
from arboleda.trees.node_state import Keeps
from arboleda.trees.part_places import Places
from arboleda.trees.paths import follow
from arboleda.trees.steps import (
    MAIN,
    RECOVERY,
    framed,
    go_home,
    grip,
    interlocked,
    is_frame,
    leave_devices,
    let_go,
    recovery,
    selector,
    sequence,
    take_devices,
    task,
    tour,
    unchecked_grip,
    visit_from_anywhere,
)
from arboleda.trees.tree_run import step_of

__all__ = [
    "ACTS_TOLD",
    "AWAY",
    "BY_OPERATOR",
    "FACT_VALUES",
    "HISTORY",
    "LEAST_S",
    "MAIN",
    "OPEN",
    "RECOVERY",
    "RETRYABLE",
    "UNSENT",
    "Act",
    "Announce",
    "Approach",
    "Await",
    "Belief",
    "Carry",
    "CellRun",
    "CellTime",
    "Context",
    "Dwell",
    "Entry",
    "Failures",
    "Keeps",
    "Leaf",
    "OperatorAct",
    "Places",
    "Plant",
    "Prospect",
    "Require",
    "State",
    "TakeDevices",
    "TakeZones",
    "Teaching",
    "Unless",
    "Zones",
    "best",
    "follow",
    "framed",
    "go_home",
    "grip",
    "interlocked",
    "is_frame",
    "leave_devices",
    "let_go",
    "recovery",
    "selector",
    "sequence",
    "step_of",
    "take_devices",
    "task",
    "title_of",
    "titled",
    "tour",
    "unchecked_grip",
    "unsettled",
    "visit_from_anywhere",
    "why_held",
    "why_waiting",
]
MODULES = {
    "paths": "arboleda.trees.paths",
    "reasons": "arboleda.core.reasons",
    "steps": "arboleda.trees.steps",
}
"""Modules that were names of this one, for two minor versions."""


def __getattr__(name: str) -> Any:
    if name not in MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    warn(f"take what you use of `{name}` from `{__name__}` itself", DeprecationWarning, stacklevel=2)
    return import_module(MODULES[name])
