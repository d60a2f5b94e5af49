"""An approval in the very moment of a change, which another thread makes."""

from __future__ import annotations

import threading
from contextlib import suppress
from pathlib import Path

import pytest
from packages.arboleda_make.tests.fast.scenario.assistant_site import REST, TREE, Site

from arboleda_make.drafts.api import DraftRefused

OTHER = TREE.format(name="Rest", steps="<Sequence><lamp_dark/></Sequence>")


def proposed(site: Site, tree: str) -> str:
    row = {"name": "light", "by": "bot", "words": "", "recipes": ["rest"], "values": [], "removed": []}
    return str(site.desk.propose({**row, "trees": {"rest.xml": tree}})["hash"])


@pytest.mark.parametrize("change", ["another proposal", "another file"])
def test_an_approval_beside_a_change_is_of_its_own_content_or_refused(tmp_path: Path, change: str) -> None:
    site = Site(tmp_path)
    first = proposed(site, TREE.format(name="Rest", steps="<Sequence><loader_home/><lamp_shine/></Sequence>"))
    start = threading.Barrier(2)

    def make() -> None:
        start.wait()
        if change == "another proposal":
            with suppress(DraftRefused):  # where the files are being written
                proposed(site, OTHER)  # in the place of the first
        else:
            (site.folder / "shine.xml").write_text(OTHER.replace("Rest", "Shine"))

    thread, told = threading.Thread(target=make), {}
    thread.start()
    start.wait()
    with suppress(DraftRefused):
        told = site.desk.approve(first, "Ana")
    thread.join()
    content = (site.folder / "rest.xml").read_text()
    if told.get("stage") == "approved":
        assert content == site.desk.shown(first)["trees"]["rest.xml"]
    else:
        assert content == REST and site.revisions == []
