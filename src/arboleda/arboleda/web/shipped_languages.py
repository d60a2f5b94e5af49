"""Words by packages that are still folders of this one: their rows become entry points of their packages.
They are read beside the entry points of installed packages.
"""

LANGUAGES = {
    "fleet": "arboleda.dashboard.fleet",
}
