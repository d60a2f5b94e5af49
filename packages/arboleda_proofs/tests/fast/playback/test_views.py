"""At any moment of a record is what screens saw then."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
from tests.unit.recorder.recorded import AtOnce, Site, beginning_of

from arboleda.model.messages import Verb
from arboleda.model.recording import Limits
from arboleda.model.sentence import Sentence
from arboleda.recorder import channels, copying, files, reader, writing
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.steps import TOPIC
from arboleda.recorder.view_log import DIGEST_S
from arboleda.recorder.writing import Writing
from arboleda.views.chronicle import Chronicle
from arboleda_proofs.playback.views import Views

SPANS = ("age_s", "since_s", "deadline_s", "left_s", "elapsed_s")


def same(read: Any, shown: Any, where: str = "") -> None:
    """Assert that both are equal: spans to a tenth of a second, ages to a second."""
    key = where.rpartition(".")[2]
    if isinstance(shown, dict):
        assert isinstance(read, dict) and read.keys() == shown.keys(), where
        for name, value in shown.items():
            same(read[name], value, f"{where}.{name}")
    elif isinstance(shown, tuple | list):
        assert len(read) == len(shown), where
        for number, (one, other) in enumerate(zip(read, shown, strict=True)):
            same(one, other, f"{where}[{number}]")
    elif isinstance(shown, Sentence):
        assert isinstance(read, Sentence) and read == shown and str(read) == str(shown), where
    elif isinstance(shown, float):
        least = 1.0 if where.endswith("age_s") and "command" not in where else 0.06
        within = least if key in (*SPANS, "heard_at", "position_at", "telemetry_hz") else 1e-5
        assert read == pytest.approx(shown, abs=max(within, 1.0 if key.endswith("_at") else 0.0)), where
    else:
        assert read == shown, where


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    """A plant that works, whose files are small, with half minutes and digests of the time line."""
    return Site(tmp_path, monkeypatch)


def busy(site: Site) -> None:
    site.work("sis_a 0B 7", "sis_b 1C 3", "sis_c 2A 5", s=20.0)
    site.rig.operate(Verb.STOP, "sis_b")
    site.work(s=5.0)
    site.rig.lost = lambda publication: publication.topic == "ra_3/sensores"
    site.work(s=40.0)


@pytest.fixture(scope="module")
def ended(tmp_path_factory: pytest.TempPathFactory) -> Site:
    """A plant that was busy, and has ended."""
    with pytest.MonkeyPatch.context() as patch:
        made = Site(tmp_path_factory.mktemp("ended"), patch)
        busy(made)
        made.end()
    return made


def views_of(site: Site) -> Views:
    return Views(reader.opened(site.files[0]))


def test_every_snapshot_is_there_as_screens_and_twin_got_it(ended: Site) -> None:
    views = views_of(ended)
    for number, (at, snapshot, drawn) in enumerate(ended.seen):
        following = ended.seen[number + 1][0] if number + 1 < len(ended.seen) else None
        if following == at:
            continue
        same(views.at(at), snapshot, "snapshot")
        same({**drawn, "now": at / 1e9}, views.positions(at), "drawn")
    assert len(ended.seen) > 40


def test_where_robots_are_is_told_between_snapshots(site: Site) -> None:
    site.work("sis_a 0B 7", s=3.0)
    where = []
    for _ in range(40):
        site.work(s=0.25)
        q = site.rig.plant.dispatcher.beliefs["ra1"].q
        where.append((round(site.rig.now * 1e9), q))
    site.end()
    views = views_of(site)
    moved = 0
    for (_, before), (at, q), (_, after) in zip(where, where[1:], where[2:], strict=False):
        assert q and before and after
        told = views.positions(at)["robots"][0]["q"]
        for one, *near in zip(told, before, q, after, strict=True):
            assert min(near) - 0.06 <= one <= max(near) + 0.06
        moved += before != after
    assert moved > 5


def test_spans_grow_between_two_snapshots(ended: Site) -> None:
    views = views_of(ended)
    (silent,) = [each for each in views.at(views.ended_ns)["robots"] if each["name"] == "ra3"]
    (before,) = [each for each in views.at(views.ended_ns - 10**10)["robots"] if each["name"] == "ra3"]
    assert silent["age_s"] - before["age_s"] == pytest.approx(10.0) and silent["age_s"] > 30.0
    assert not silent["online"]


def test_a_time_line_is_that_of_the_snapshots(ended: Site) -> None:
    views, chronicle = views_of(ended), Chronicle()
    for at, snapshot, _ in ended.seen:
        chronicle.see(snapshot, at / 1e9)
    assert views.events() == list(chronicle.events) and len(chronicle.events) > 10
    for event in views.events():  # its moment shows what it says
        if event["kind"] == "cell":
            cells = {each["name"]: each for each in views.at(round(event["at"] * 1e9))["cells"]}
            assert event["what"] == cells[event["cell"]]["state"]


def test_a_plant_that_does_nothing_writes_nothing_but_whole_views(site: Site) -> None:
    site.work(s=10.0)
    began = round(site.rig.now * 1e9)
    site.work(s=65.0)
    site.end()
    assert [at for at in views_of(site).times() if at > began] == []


@pytest.mark.long
def test_files_that_follow_each_other_are_one_record_also_without_the_first(
    site: Site, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "PART_BYTES", (30_000, 30_000))
    monkeypatch.setattr(writing, "FLUSH_S", 0.0)
    for _ in range(3):
        busy(site)
    site.end()
    assert len(site.files) > 2
    views = views_of(site)
    began, told, times = views.began_ns, views.events(), views.times()
    moments = random.Random(7).sample(range(began, views.ended_ns), 20)
    seen = [views.at(at) for at in moments]
    site.files[0].unlink()
    for later in (views, views_of(site)):
        assert later.began_ns > began and later.events() == told[-len(later.events()) :]
        assert 0 < len(later.times()) < len(times) and later.times() == times[-len(later.times()) :]
        for at, snapshot in zip(moments, seen, strict=True):
            if at >= later.began_ns:
                same(later.at(at), snapshot, "snapshot")


@pytest.mark.long
def test_a_file_that_is_being_written_is_read_up_to_where_it_is(
    site: Site, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "CHUNK_BYTES", 20_000)
    busy(site)
    site.work("sis_a 0B 6", s=DIGEST_S + 10.0)
    site.end()
    whole, content = views_of(site), site.files[0].read_bytes()
    grows = tmp_path / site.files[0].name
    grows.write_bytes(content[: content.index(b"plant.yaml") + 2000])  # it has just begun
    views, events, ended = Views(reader.opened(grows)), 0, 0
    with pytest.raises(NoRecord, match="ends before anything could be seen"):
        views.at(0)
    for share in range(5, 11):
        grows.write_bytes(content[: len(content) * share // 10])
        assert views.ended_ns >= ended
        ended = views.ended_ns
        told = views.events()
        assert told == whole.events()[: len(told)] and len(told) >= events
        events = len(told)
        same(views.at(ended), whole.at(ended), "snapshot")
    assert views.times() == whole.times() and events == len(whole.events())


def test_a_copy_has_the_same_views(ended: Site, tmp_path: Path) -> None:
    views = views_of(ended)
    copying.as_mcap(reader.opened(ended.files[0]), tmp_path / "copy.mcap", (1,))
    copy = Views(reader.opened(tmp_path / "copy.mcap"))
    assert copy.events() == views.events() and copy.times() == views.times()
    assert copy.at(views.ended_ns) == views.at(views.ended_ns)
    assert copy.links(views.ended_ns) == views.links(views.ended_ns) == {}


def test_damage_is_passed_over_or_one_sentence(ended: Site, tmp_path: Path) -> None:
    content, broken = ended.files[0].read_bytes(), tmp_path / "broken.mcap"
    chance, seen = random.Random(3), 0
    for _ in range(60):
        at = chance.randrange(len(content))
        broken.write_bytes(content[:at] + bytes([content[at] ^ 0xFF]) + content[at + 1 :])
        try:
            views = Views(reader.opened(broken))
            assert views.at(views.ended_ns)["cells"] and views.events() is not None
        except NoRecord:
            continue
        seen += 1
    assert seen > 5


def test_a_record_without_views_is_a_sentence(
    site: Site, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(writing, "OURS", [each for each in channels.OURS if each.topic == TOPIC])
    old = AtOnce(Writing(tmp_path / "old", beginning_of(site.model), Limits(), least_free=0))
    old.stepped(site.rig.plant, site.rig.now, (), ())
    old.stop()
    site.end()
    (part,) = files.parts_in(tmp_path / "old")
    with pytest.raises(NoRecord, match="kept no views: replay it"):
        Views(reader.opened(part.path))
