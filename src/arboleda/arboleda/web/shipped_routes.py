"""Routes by packages that are still folders of this one: their rows become entry points of their packages.
They are read beside the entry points of installed packages, and loaded by name when a server is made.
"""

ROUTES = {
    "fleet.oee": "arboleda.web.routes.oee:routes",
}
