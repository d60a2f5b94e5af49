"""Commands of the command line that this package adds."""

from __future__ import annotations

from arboleda.extension import Command

RUN = "Run a plant"
COMMANDS = {
    "oee": Command(
        "arboleda_fleet.oee.command",
        "OEE of the cells, availability x performance x quality, whether the plant runs or not.",
        RUN,
    ),
    "handover": Command(
        "arboleda_fleet.standby.command",
        "Have the standby of a plant lead it: what is at work is held, and goes on there.",
        RUN,
    ),
    "site": Command(
        "arboleda_fleet.site.command",
        "Show many plants on one page: how each stands, trouble first, tasks and OEE over all.",
        RUN,
    ),
}
