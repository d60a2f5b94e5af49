"""Names for packages that add to Arboleda. Devices, recipes and clients have modules of their own:
`arboleda.kinds`, `arboleda.drivers`, `arboleda.recipes`, `arboleda.client`.

A package says for which API it is written, `"arboleda.api": ["1 = its_package"]` among its entry points;
that is read before anything of it is imported. A name goes on for two minor versions after it is
deprecated.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from arboleda.host.distributions import API as API

if TYPE_CHECKING:
    from arboleda.cli.commands import Command as Command
    from arboleda.cli.language import say as say
    from arboleda.cli.plant_options import RunningPlant as RunningPlant, StateFolder as StateFolder
    from arboleda.cli.plant_options import client as client
    from arboleda.client.answers.tasks import Done as Done, Task as Task
    from arboleda.dashboard.asset_files import Assets as Assets
    from arboleda.dashboard.faces.moment import Moment as Moment
    from arboleda.dashboard.package_page import Act as Act, Asked as Asked, Chart as Chart, Field as Field
    from arboleda.dashboard.package_page import Page as Page, Rows as Rows, Tab as Tab, Value as Value
    from arboleda.dashboard.page_part import PageAct as PageAct, PagePart as PagePart, Place as Place
    from arboleda.dashboard.page_part import Request as Request, Section as Section, Spot as Spot
    from arboleda.dashboard.tags import act_button as act_button, live as live, rows as rows, tag as tag
    from arboleda.host.distributions import API as API
    from arboleda.model.errors import ArboledaError as ArboledaError, Refused as Refused
    from arboleda.model.errors import StartError as StartError
    from arboleda.model.sentence import Phrase as Phrase, Sentence as Sentence
    from arboleda.runtime.extensions.part import Part as Part
    from arboleda.runtime.extensions.plant import Device as Device, Plant as Plant
    from arboleda.runtime.extensions.table import Table as Table
    from arboleda.web.access.auth import Role as Role
    from arboleda.web.access.needs import needs as needs
    from arboleda.web.access.takes import takes as takes

HOMES = {
    "host.distributions": ("API",),
    "cli.commands": ("Command",),
    "cli.language": ("say",),
    "cli.plant_options": ("RunningPlant", "StateFolder", "client"),
    "client.answers.tasks": ("Done", "Task"),
    "dashboard.asset_files": ("Assets",),
    "dashboard.faces.moment": ("Moment",),
    "dashboard.package_page": ("Act", "Asked", "Chart", "Field", "Page", "Rows", "Tab", "Value"),
    "dashboard.page_part": ("PageAct", "PagePart", "Place", "Request", "Section", "Spot"),
    "dashboard.tags": ("act_button", "live", "rows", "tag"),
    "model.errors": ("ArboledaError", "Refused", "StartError"),
    "model.sentence": ("Phrase", "Sentence"),
    "runtime.extensions.part": ("Part",),
    "runtime.extensions.plant": ("Device", "Plant"),
    "runtime.extensions.table": ("Table",),
    "web.access.auth": ("Role",),
    "web.access.needs": ("needs",),
    "web.access.takes": ("takes",),
}
"""The modules that have the names, which load once somebody asks for one: a command needs no page."""

__all__ = sorted(name for names in HOMES.values() for name in names)


def __getattr__(name: str) -> Any:
    for home, names in HOMES.items():
        if name in names:
            return getattr(import_module(f"{__package__}.{home}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
