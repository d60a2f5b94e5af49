"""Parts of a plant by packages that are still folders of this one: their rows become entry points of their
packages. They are read beside the entry points of installed packages, and loaded by name when a plant starts.
"""

PARTS = {
    "fleet": "arboleda.runtime.standby.factories:FACTORIES",
    "make": "arboleda.runtime.make.factories:FACTORIES",
}
