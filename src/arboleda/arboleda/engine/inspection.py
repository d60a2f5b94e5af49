"""Insides of the engine that only who judges a plant looks at; nothing that runs one needs them."""

from __future__ import annotations

from arboleda.core.choosing import LAST, UNKNOWN_S
from arboleda.core.news import News
from arboleda.core.plant import HEARTBEAT_S, SETTLES_IN
from arboleda.core.reasons import HELD, HELD_STRANDED
from arboleda.core.teaching import HOLD_S
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
)
from arboleda.dispatch.ledger import TABLE, Feed, Ledger
from arboleda.dispatch.stillness import ReportMoment, Stillness
from arboleda.resume.trail import Trail
from arboleda.resume.walk_back import MORE
from arboleda.trees.part_places import EMPTY, trouble_in
from arboleda.trees.tree_run import IN_RECOVERY, path_of
