"""Reasons why a name of a plant file is brought by nobody, with what to install.

Each start keeps in the default state directory of its plant which package brought what.
"""

from __future__ import annotations

import json
from contextlib import suppress

from arboleda.drivers.port import GROUP as DRIVERS
from arboleda.host.packages import why_left_out
from arboleda.host.state_folders import default_state
from arboleda.model.outside import plain

from . import package_drivers
from .document import Document
from .shapes import is_plant_name

FILE = "packages.json"
LONGEST = 200  # characters of a distribution's name and version
CAME_FROM = "{name} came from {package}, which is not installed: pip install {distribution}"


def why_nobody(document: Document, group: str, name: str) -> str:
    """The reason why nobody brings what has this name in a group of entry points; "" where none is known."""
    if reason := why_left_out(group, name):
        return reason
    if group == DRIVERS and name in package_drivers.ALL:
        return package_drivers.not_installed(name)
    package = _remembered(document, group, name)
    distribution = package.partition(" ")[0]
    return CAME_FROM.format(name=name, package=package, distribution=distribution) if package else ""


def _remembered(document: Document, group: str, name: str) -> str:
    """The distribution, with its version, that brought this to the last start of the plant; "" for none."""
    plant = document.value(("name",))
    if isinstance(plant, str) and is_plant_name(plant):
        with suppress(OSError, ValueError, KeyError, TypeError, AttributeError):
            kept = json.loads((default_state(plant) / FILE).read_bytes())
            return plain(kept[group][name], LONGEST)
    return ""
