"""Routes by packages that are still folders of this one: their rows become entry points of their packages.
They are read beside the entry points of installed packages, and loaded by name when a server is made.
"""

ROUTES = {
    "fleet.oee": "arboleda.web.routes.oee:routes",
    "make.draft": "arboleda.web.routes.draft:routes",
    "make.make": "arboleda.web.routes.make:routes",
    "make.proposals": "arboleda.web.routes.proposals:routes",
    "make.teach": "arboleda.web.routes.teach:routes",
    "make.trees": "arboleda.web.routes.trees:routes",
    "make.versions": "arboleda.web.routes.versions:routes",
}
