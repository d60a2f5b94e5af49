"""Engine of a plant as all other rooms see it: what dispatch, trees and core offer them; pure."""

from __future__ import annotations

from arboleda.core import reasons
from arboleda.core.acts import OperatorAct
from arboleda.core.cell import CellRun
from arboleda.core.choosing import Prospect, best
from arboleda.core.envelope import unsettled
from arboleda.core.intake import HISTORY
from arboleda.core.operator import ACTS_TOLD
from arboleda.core.plant import AWAY, Plant
from arboleda.core.reasons import BY_OPERATOR
from arboleda.core.teaching import Teaching
from arboleda.core.verbs.scopes import PLANT, scope_of, scopes
from arboleda.dispatch.belief import Belief
from arboleda.dispatch.effectors import EMPTIED
from arboleda.dispatch.evidence import QUIET_S
from arboleda.dispatch.fact_memory import Memory
from arboleda.dispatch.latches import CLEARED, LATCHED
from arboleda.dispatch.ledger import OPEN, Entry, State
from arboleda.dispatch.outlet import UNSENT
from arboleda.dispatch.whereabouts import DISPLACED
from arboleda.dispatch.zones import Zones
from arboleda.trees import paths, steps
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
from arboleda.trees.node_state import Keeps, failure_kept, read_failure
from arboleda.trees.part_places import Places
from arboleda.trees.steps import HOME_AGAIN, MAIN, PHASES, RECOVERY, framed, is_frame
from arboleda.trees.tree_run import step_of

__all__ = [
    "ACTS_TOLD",
    "AWAY",
    "BY_OPERATOR",
    "CLEARED",
    "DISPLACED",
    "EMPTIED",
    "HISTORY",
    "HOME_AGAIN",
    "LATCHED",
    "LEAST_S",
    "MAIN",
    "OPEN",
    "PHASES",
    "PLANT",
    "QUIET_S",
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
    "Memory",
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
    "failure_kept",
    "framed",
    "is_frame",
    "paths",
    "read_failure",
    "reasons",
    "scope_of",
    "scopes",
    "step_of",
    "steps",
    "title_of",
    "titled",
    "unsettled",
]
