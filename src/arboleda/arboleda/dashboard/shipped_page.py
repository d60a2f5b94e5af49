"""Parts of the page by packages that are still folders of this one: their rows become entry points of their
packages. They are read beside the entry points of installed packages, and loaded by name when a page is made.
"""

PAGE = {
    "fleet": "arboleda.dashboard.fleet.page_part:PAGE",
}
