"""Every bug of the engine: a hundred and more, planted by hand."""

from __future__ import annotations

from .engine_core_bugs import CORE_BUGS
from .engine_dispatch_bugs import DISPATCH_BUGS
from .engine_kind_bugs import KIND_BUGS
from .engine_recipe_bugs import RECIPE_BUGS
from .engine_tree_bugs import TREE_BUGS
from .engine_wire_bugs import WIRE_BUGS
from .engine_xml_bugs import XML_BUGS

ENGINE_BUGS = (
    *KIND_BUGS,
    *DISPATCH_BUGS,
    *RECIPE_BUGS,
    *TREE_BUGS,
    *XML_BUGS,
    *CORE_BUGS,
    *WIRE_BUGS,
)
