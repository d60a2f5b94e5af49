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
    from arboleda.cli.plant_options import PlantFile as PlantFile, RunningPlant as RunningPlant
    from arboleda.cli.plant_options import StateFolder as StateFolder, StoreAddress as StoreAddress
    from arboleda.cli.plant_options import TokensFile as TokensFile, client as client
    from arboleda.cli.working import working as working
    from arboleda.client.answers.tasks import Done as Done, Task as Task
    from arboleda.dashboard.asset_files import Assets as Assets
    from arboleda.dashboard.faces import Face as Face
    from arboleda.dashboard.faces.moment import Moment as Moment
    from arboleda.dashboard.package_page import Act as Act, Asked as Asked, Chart as Chart, Field as Field
    from arboleda.dashboard.package_page import Page as Page, Rows as Rows, Tab as Tab, Value as Value
    from arboleda.dashboard.package_page.items import Item as Item
    from arboleda.dashboard.page_api import Layout as Layout, PageApi as PageApi
    from arboleda.dashboard.page_part import PageAct as PageAct, PagePart as PagePart, Place as Place
    from arboleda.dashboard.page_part import Request as Request, Section as Section, Spot as Spot
    from arboleda.dashboard.tags import act_button as act_button, live as live, rows as rows, tag as tag
    from arboleda.dashboard.wording import Text as Text, Words as Words, words as words
    from arboleda.host.distributions import API as API
    from arboleda.model.errors import ArboledaError as ArboledaError, ConfigError as ConfigError
    from arboleda.model.errors import PayloadError as PayloadError, Refused as Refused
    from arboleda.model.errors import StartError as StartError
    from arboleda.model.sentence import Phrase as Phrase, Sentence as Sentence
    from arboleda.plant_file.loader import load as load
    from arboleda.runtime.extensions.alarms import RaisedAlarm as RaisedAlarm
    from arboleda.runtime.extensions.part import Part as Part
    from arboleda.runtime.extensions.plant import Device as Device, Plant as Plant
    from arboleda.runtime.extensions.table import Table as Table
    from arboleda.web.access.auth import Role as Role
    from arboleda.web.access.needs import needs as needs
    from arboleda.web.access.takes import takes as takes
    from arboleda.web.plant_api import PlantApi as PlantApi

HOMES = {
    "host.distributions": ("API",),
    "cli.commands": ("Command",),
    "cli.language": ("say",),
    "cli.plant_options": ("PlantFile", "RunningPlant", "StateFolder", "StoreAddress", "TokensFile", "client"),
    "cli.working": ("working",),
    "client.answers.tasks": ("Done", "Task"),
    "dashboard.asset_files": ("Assets",),
    "dashboard.faces": ("Face",),
    "dashboard.faces.moment": ("Moment",),
    "dashboard.package_page": ("Act", "Asked", "Chart", "Field", "Page", "Rows", "Tab", "Value"),
    "dashboard.package_page.items": ("Item",),
    "dashboard.page_api": ("Layout", "PageApi"),
    "dashboard.page_part": ("PageAct", "PagePart", "Place", "Request", "Section", "Spot"),
    "dashboard.tags": ("act_button", "live", "rows", "tag"),
    "dashboard.wording": ("Text", "Words", "words"),
    "model.errors": ("ArboledaError", "ConfigError", "PayloadError", "Refused", "StartError"),
    "model.sentence": ("Phrase", "Sentence"),
    "plant_file.loader": ("load",),
    "runtime.extensions.alarms": ("RaisedAlarm",),
    "runtime.extensions.part": ("Part",),
    "runtime.extensions.plant": ("Device", "Plant"),
    "runtime.extensions.table": ("Table",),
    "web.access.auth": ("Role",),
    "web.access.needs": ("needs",),
    "web.access.takes": ("takes",),
    "web.plant_api": ("PlantApi",),
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
