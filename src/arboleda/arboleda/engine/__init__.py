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
