"""The events of a cell are found without reading steps in which nothing happened."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.recorder.recorded import Site

from arboleda.model.messages import Verb
from arboleda.recorder import reader
from arboleda_proofs.playback import cell_history
from arboleda_proofs.playback.views import Views


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a cell that was held for a minute and a half in the middle of its task, and others that waited."""
    with pytest.MonkeyPatch.context() as patch:
        site = Site(tmp_path_factory.mktemp("site"), patch)
        site.work("sis_a 0B 7", s=8.0)
        site.rig.operate(Verb.HOLD, "sis_a")
        site.work(s=90.0)
        site.rig.operate(Verb.RESUME, "sis_a")
        site.work(s=30.0)
        site.end()
    return site.files[0]


@pytest.fixture
def views(file: Path, monkeypatch: pytest.MonkeyPatch) -> Views:
    monkeypatch.setattr(cell_history, "AT_ONCE_NS", 5 * 10**9)
    return Views(reader.opened(file))


def test_every_change_is_found_and_in_order(views: Views, monkeypatch: pytest.MonkeyPatch) -> None:
    found = [*cell_history.followed(views, "sis_a", views.began_ns - 1, views.ended_ns)]
    monkeypatch.setattr(cell_history, "AT_ONCE_NS", 10**15)
    every = [*cell_history.followed(views, "sis_a", views.began_ns - 1, views.ended_ns)]
    assert found == every
    times = [looked.unix_ns for looked in found]
    assert times == sorted(times) and len(times) > 12
    assert {looked.cell["state"] for looked in found} == {"idle", "execute", "holding", "held"}


def test_where_nothing_happens_nothing_is_read(views: Views, monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[int] = []
    changes = views.changes

    def counted(after_ns: int, until_ns: int) -> object:
        read.append(until_ns - after_ns)
        return changes(after_ns, until_ns)

    monkeypatch.setattr(views, "changes", counted)
    after_ns = views.began_ns + 20 * 10**9
    assert [*cell_history.followed(views, "sis_a", after_ns, after_ns + 70 * 10**9)] == []
    assert read == []
    assert [*cell_history.followed(views, "sis_a", after_ns, views.ended_ns)] != []
    assert 0 < sum(read) < 45 * 10**9
