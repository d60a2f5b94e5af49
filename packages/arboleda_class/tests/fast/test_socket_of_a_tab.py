"""In a tab the page's scripts have a socket, too, with all that they use of it."""

from __future__ import annotations

import re
from pathlib import Path

from arboleda.dashboard import lone_page
from arboleda_class import playground

PAGE = Path(lone_page.__file__).parent / "assets"
OF_A_TAB = Path(playground.__file__).parent / "static/plant.js"


def test_the_socket_of_a_tab_has_what_the_scripts_of_the_page_use_of_it() -> None:
    scripts = "".join(each.read_text("utf-8") for each in sorted(PAGE.glob("*.js")))
    used = set(re.findall(r"window\.socket\??\.(\w+)", scripts))
    (socket,) = re.findall(r"window\.socket = \{(.*?)\};", OF_A_TAB.read_text("utf-8"))
    assert {"connected", "on"} <= used <= set(re.findall(r"\w+", socket))
