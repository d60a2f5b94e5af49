"""Parts of this package on the page of a plant, and their scripts and style sheets."""

from __future__ import annotations

from tests.unit.dashboard.test_page_parts import html, loaded, tabs

from arboleda.dashboard import shell
from arboleda.dashboard.asset_files import own
from arboleda.dashboard.wording import words
from arboleda.web.access.auth import Role


def test_they_lie_below_those_of_the_page() -> None:
    head = shell.head(words("en"), own("page.js"), added=loaded().assets)
    below = own("").rstrip("/")
    assert f'"{below}/arboleda_make.page-' in head and "/part.js" in head and "/draw.css" in head


def test_they_share_a_place_of_the_page() -> None:
    places = tabs(html(loaded()))
    assert ("make", ["make", "draw", "teach"]) in places[:3]
    assert {"make", "draw", "teach"} <= {tab for tab, _ in places[3:]}


def test_a_viewer_sees_no_part_that_is_for_operators() -> None:
    viewed = html(loaded(), Role.VIEWER.value)
    assert "part-draw" in viewed and "part-make" not in viewed and "part-teach" not in viewed
