"""Proposals of assistants: content with one hash, approved by a person and by nothing else."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from arboleda.model.assistants import AssistantLimits, Assistants, hours
from arboleda.model.messages import RevisionAnswer
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.draft import DraftCheck
from arboleda.plant_file.versions import Versions
from arboleda.runtime import at_work
from arboleda.store.task_rows import ASSISTANT
from arboleda_make.drafts.api import DraftRefused
from arboleda_make.drafts.plant_folder import PlantFolder
from arboleda_make.proposals.desk import MOST_OPEN, ProposalDesk
from arboleda_make.versions.desk import VersionDesk

AT = "2026-11-25T20:00:00+00:00"
PLANT = b"""name: lab
uses: [rest.xml, own.py]
cells:
  cell:
    devices:
      arm: {kind: arm, driver: {plc: {password: hidden}}}
    targets:
      home: {arm: {mm: 0}}
"""
REST = b'<root BTCPP_format="4"><BehaviorTree ID="Rest"><arm_home/></BehaviorTree></root>\n'
OTHER = REST.decode().replace("<arm_home/>", "<Sequence><arm_home/></Sequence>")
FILES = {"plant.yaml": PLANT, "rest.xml": REST, "own.py": b"1"}


class Plant:
    """Plant that takes what it is told, and remembers that."""

    def __init__(self) -> None:
        self.revisions: list[Any] = []
        self.tasks: list[tuple[str, ...]] = []
        self.rows: list[Any] = []
        self.known: dict[str, Any] = {}
        limits = AssistantLimits(cells=("cell",), at_once=1, hours=hours("08:00-18:00"))
        self.model = SimpleNamespace(
            assistants=Assistants.SUBMIT,
            assistant_limits=limits,
            recipes=[SimpleNamespace(name="rest"), SimpleNamespace(name="own")],
        )
        self.plant = SimpleNamespace(cells={}, model=self.model)

    def revise(self, put: Any) -> Future[RevisionAnswer]:
        self.revisions.append(put)
        done: Future[RevisionAnswer] = Future()
        done.set_result(RevisionAnswer(version=put.version))
        return done

    def read(self, look: Callable[[Any], Any]) -> Any:
        return look(SimpleNamespace(intake=SimpleNamespace(orders=self.orders, tasks=self.known)))

    def orders(self, text: str) -> list[Any]:
        cell, recipe, *ids = text.split(" ")
        return [SimpleNamespace(cell=cell, recipe=recipe, id=ids[0] if ids else None)]

    def history(self, query: Any) -> list[Any]:
        return self.rows

    def submit(self, *given: str) -> Future[dict[str, Any]]:
        self.tasks.append(given)
        done: Future[dict[str, Any]] = Future()
        done.set_result({"id": "t-1", "state": "queued"})
        return done


class Bench:
    """Desk over files in a folder; `problems` are what the check says, `meanwhile` happens during a check."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder, self.state = folder, folder / "state"
        self.problems: tuple[str, ...] = ()
        self.meanwhile: Callable[[], object] = lambda: None
        self.now = datetime(2026, 11, 26, 12, 0)
        self.plant = Plant()
        for name, content in FILES.items():
            (folder / name).write_bytes(content)
        self.state.mkdir()
        at_work.keep(self.state, PlantFiles(plant="plant.yaml", contents=FILES), AT)
        monkeypatch.setattr(
            "arboleda_make.versions.desk.loader.load_with_files",
            lambda file, runs: (self.plant.model, self.on_disk()),
        )
        self.versions = VersionDesk(
            PlantFolder(folder / "plant.yaml", self.state),
            self.state,
            self.plant,  # type: ignore[arg-type]
            as_it_runs=lambda model: model,
            check=self.check,
        )
        self.desk = self.opened()

    def opened(self) -> ProposalDesk:
        """The desk, as each start of the plant has one."""
        return ProposalDesk(
            PlantFolder(self.folder / "plant.yaml", self.state),
            self.state,
            self.versions,
            SimpleNamespace(check=self.check, stop=lambda: None),  # type: ignore[arg-type]
            self.plant,  # type: ignore[arg-type]
            lambda: self.now,
        )

    def on_disk(self) -> PlantFiles:
        names = [each.name for each in self.folder.iterdir() if each.is_file()]
        return PlantFiles(
            plant="plant.yaml", contents={name: (self.folder / name).read_bytes() for name in sorted(names)}
        )

    def check(self, files: PlantFiles, plant_file: Path) -> DraftCheck:
        self.meanwhile()
        if self.problems:
            return DraftCheck(problems=self.problems)
        whole = {**self.on_disk().contents, **files.contents}
        return DraftCheck(read=replace(files, contents=whole), warnings=("careful",))

    def propose(self, **wanted: Any) -> dict[str, Any]:
        usual: dict[str, Any] = {
            "name": "calmer",
            "by": "bot",
            "words": "slower is better",
            "trees": {"rest.xml": OTHER},
            "values": [],
            "removed": [],
            "recipes": ["rest"],
        }
        return self.desk.propose({**usual, **wanted})


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Bench:
    return Bench(tmp_path, monkeypatch)


def test_a_proposal_changes_no_file_and_tells_the_plant_nothing(bench: Bench) -> None:
    told = bench.propose()
    assert told["stage"] == "open" and told["warnings"] == ["careful"] and told["fits"]
    assert (bench.folder / "rest.xml").read_bytes() == REST and not bench.plant.revisions
    shown = bench.desk.shown(told["hash"])
    assert shown["words"] == "slower is better" and shown["differing"] == ["rest.xml"]
    gone, came = shown["differences"]["rest.xml"].splitlines()[-2:]
    assert gone.startswith("-<root") and came.startswith("+<root") and "<Sequence>" in came
    assert shown["pictures"]["rest.xml"].startswith("<svg ") and shown["proof_state"] == {"state": "idle"}


def test_what_is_decided_is_not_simulated_any_more(bench: Bench) -> None:
    hash = bench.propose()["hash"]
    assert bench.desk.shown(hash)["simulation_state"] == {"state": "idle"}
    bench.desk.reject(hash, "Ana", "no")
    with pytest.raises(DraftRefused, match="rejected already"):
        bench.desk.simulate(hash, 1, 1)


def test_what_check_objects_to_is_not_kept(bench: Bench) -> None:
    bench.problems = ("rest.xml:1:1: no",)
    told = bench.propose()
    assert told == {"hash": None, "problems": ("rest.xml:1:1: no",), "warnings": ()}
    assert bench.desk.listed() == []


def test_an_approval_puts_that_content_to_work_and_says_who_proposed_and_who_approved(bench: Bench) -> None:
    hash = bench.propose()["hash"]
    told = bench.desk.approve(hash, "Ana")
    assert told["stage"] == "approved" and told["version"] == 2 and told["decided_by"] == "Ana"
    assert (bench.folder / "rest.xml").read_text() == OTHER
    (put,) = bench.plant.revisions
    assert put.by == f"Ana, who approved proposal {hash[:12]} by 'bot'"
    kept = Versions(bench.folder / "plant.yaml").find(2)
    assert kept.by == "Ana" and kept.note == f"proposal 'calmer' {hash[:12]} by 'bot'"


def test_an_approval_that_was_answered_is_there_after_a_kill(bench: Bench) -> None:
    hash = bench.propose()["hash"]
    bench.desk.approve(hash, "Ana")
    (row,) = bench.opened().listed()
    assert (row["hash"], row["stage"], row["decided_by"], row["version"]) == (hash, "approved", "Ana", 2)
    again = bench.opened().approve(hash, "Ben")  # the same once more changes nothing
    assert again["decided_by"] == "Ana" and len(bench.plant.revisions) == 1


def test_an_approval_that_was_cut_off_before_the_files_goes_on_when_it_is_given_again(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    hash = bench.propose()["hash"]

    class Killed(BaseException):
        pass

    def killed(self: Versions, version: Any) -> None:
        raise Killed

    with monkeypatch.context() as patch:
        patch.setattr(Versions, "keep", killed)
        with pytest.raises(Killed):
            bench.desk.approve(hash, "Ana")
    assert (bench.folder / "rest.xml").read_bytes() == REST
    desk = bench.opened()
    assert desk.listed()[0]["stage"] == "approved"
    assert desk.approve(hash, "Ben")["decided_by"] == "Ana"
    assert (bench.folder / "rest.xml").read_text() == OTHER


def test_a_reason_for_a_rejection_is_there_for_the_assistant_and_it_is_final(bench: Bench) -> None:
    hash = bench.propose()["hash"]
    bench.desk.reject(hash, "Ana", "the tray is not empty")
    assert bench.propose()["reason"] == "the tray is not empty"  # the same content is no new proposal
    with pytest.raises(DraftRefused, match="rejected already by Ana: the tray is not empty"):
        bench.desk.approve(hash, "Ben")
    assert not bench.plant.revisions


def test_a_later_proposal_of_that_name_takes_the_place_of_the_one_before(bench: Bench) -> None:
    first = bench.propose()["hash"]
    second = bench.propose(trees={"rest.xml": OTHER.replace("Sequence", "Fallback")})["hash"]
    assert first != second
    with pytest.raises(DraftRefused, match=f"replaced already: {second}"):
        bench.desk.approve(first, "Ana")
    assert bench.desk.approve(second, "Ana")["stage"] == "approved"


def test_what_its_assistant_took_back_can_be_proposed_again(bench: Bench) -> None:
    first = bench.propose()["hash"]
    second = bench.propose(trees={"rest.xml": OTHER.replace("Sequence", "Fallback")})["hash"]
    assert bench.propose()["hash"] == first
    stages = {each["hash"]: each["stage"] for each in bench.desk.listed()}
    assert stages == {first: "open", second: "replaced"}
    bench.desk.withdraw(first)
    assert bench.propose()["stage"] == "open" and bench.desk.approve(first, "Ana")["stage"] == "approved"


def test_what_a_person_decides_while_the_same_is_proposed_again_stays(bench: Bench) -> None:
    hash = bench.propose()["hash"]
    bench.desk.withdraw(hash)

    def decide() -> None:
        bench.meanwhile = lambda: None
        bench.desk.reject(bench.propose()["hash"], "Ana", "no")

    bench.meanwhile = decide
    assert bench.propose()["stage"] == "rejected"


def test_a_task_whose_answer_was_lost_can_be_given_again(bench: Bench) -> None:
    bench.desk.approve(bench.propose()["hash"], "Ana")
    bench.plant.rows, bench.plant.known = [SimpleNamespace(asked_by=ASSISTANT)], {"#a": None}
    assert bench.desk.submit("cell rest #a", "bot")["state"] == "queued"
    with pytest.raises(DraftRefused, match="allows 1 at once"):
        bench.desk.submit("cell rest #b", "bot")


def test_a_withdrawn_one_cannot_be_approved(bench: Bench) -> None:
    hash = bench.propose()["hash"]
    assert bench.desk.withdraw(hash)["stage"] == "withdrawn"
    with pytest.raises(DraftRefused, match="withdrawn"):
        bench.desk.approve(hash, "Ana")


def test_another_version_of_the_plant_needs_a_new_proposal(bench: Bench) -> None:
    hash = bench.propose()["hash"]
    (bench.folder / "rest.xml").write_bytes(REST + b"<!-- -->")
    with pytest.raises(DraftRefused, match="somebody edited them"):
        bench.desk.approve(hash, "Ana")
    bench.versions.put_files("Ben")
    with pytest.raises(DraftRefused, match="another version of the plant"):
        bench.desk.approve(hash, "Ana")
    assert bench.desk.listed()[0]["stage"] == "open" and not bench.desk.listed()[0]["fits"]


def test_python_that_became_another_needs_a_new_proposal(bench: Bench) -> None:
    hash = bench.propose()["hash"]
    (bench.folder / "own.py").write_bytes(b"2")
    with pytest.raises(DraftRefused, match=r"somebody edited them.*own\.py"):
        bench.desk.approve(hash, "Ana")


def test_files_that_change_while_an_approval_is_checked_are_not_written_over(bench: Bench) -> None:
    hash = bench.propose()["hash"]
    bench.meanwhile = lambda: (bench.folder / "rest.xml").write_bytes(b"mine")
    with pytest.raises(DraftRefused, match="somebody edited them"):
        bench.desk.approve(hash, "Ana")
    assert (bench.folder / "rest.xml").read_bytes() == b"mine" and not bench.plant.revisions
    assert bench.desk.listed()[0]["stage"] == "open"


@pytest.mark.parametrize("change", ["words", "content"])
def test_a_proposal_that_was_changed_on_the_disk_cannot_be_approved(bench: Bench, change: str) -> None:
    hash = bench.propose()["hash"]
    file = bench.state / "proposals" / f"{hash}.json"
    text = file.read_text()
    file.write_text(text.replace("<Sequence>", "<Fallback>") if change == "content" else text[:-20])
    with pytest.raises(DraftRefused, match="is not what was proposed any more"):
        bench.desk.approve(hash, "Ana")
    assert not bench.plant.revisions


@pytest.mark.parametrize(
    "place",
    [
        ("assistants",),
        ("foreign_commands",),
        ("store",),
        ("uses",),
        ("cells", "cell"),
        ("cells", "cell", "on_restart"),
        ("cells", "cell", "targets"),
        ("cells", "cell", "devices"),
        ("cells", "cell", "devices", "arm"),
        ("cells", "cell", "devices", "arm", "driver"),
        ("kinds",),
    ],
)
def test_what_is_for_people_cannot_be_proposed(bench: Bench, place: tuple[str, ...]) -> None:
    with pytest.raises(DraftRefused, match=r"for people|people change"):
        bench.propose(values=[(place, "submit")])
    with pytest.raises(DraftRefused, match="for people"):
        bench.propose(removed=[place])


@pytest.mark.parametrize("name", ["own.py", "../x.xml", "/etc/x.xml", ".arboleda/x.xml", "-x.xml", "x.yaml"])
def test_only_trees_in_the_plants_folder_can_be_proposed(bench: Bench, name: str) -> None:
    with pytest.raises(DraftRefused):
        bench.propose(trees={name: OTHER})


def test_settings_of_drivers_are_not_for_assistants(bench: Bench) -> None:
    base = bench.desk.base()
    assert base["cells"]["cell"] == {"targets": {"home": {"arm": {"mm": 0}}}, "devices": {"arm": "arm"}}
    assert "hidden" not in str(base)


def test_a_target_and_a_new_kind_can_be_proposed(bench: Bench) -> None:
    values = [(("cells", "cell", "targets", "nest"), {"arm": {"mm": 5}}), (("kinds", "lamp"), {"facts": {}})]
    told = bench.propose(trees={}, values=values)
    assert told["changes"] == ["cell cell, target nest of arm: new, mm 5", "new kind lamp"]


def test_nothing_is_proposed_where_the_file_does_not_let_that(bench: Bench) -> None:
    for level in (Assistants.OFF, Assistants.READ):
        bench.plant.model.assistants = level
        with pytest.raises(DraftRefused, match=f"assistants: {level.value}"):
            bench.propose()


def test_there_is_an_end_to_what_waits_for_people(bench: Bench) -> None:
    for number in range(MOST_OPEN):
        bench.propose(name=f"n{number}", trees={f"t{number}.xml": OTHER}, recipes=[])
    with pytest.raises(DraftRefused, match="withdraw one first"):
        bench.propose()


def test_a_recipe_that_is_none_cannot_be_asked_for(bench: Bench) -> None:
    with pytest.raises(DraftRefused, match=r"'rset' is no recipe .*did you mean rest"):
        bench.propose(recipes=["rset"])
    with pytest.raises(DraftRefused, match="it changes nothing"):
        bench.propose(trees={}, recipes=[])


def test_a_task_is_given_only_of_a_recipe_that_is_approved_as_it_is_at_work(bench: Bench) -> None:
    with pytest.raises(DraftRefused, match="nobody has approved rest as it is at work"):
        bench.desk.submit("cell rest", "bot")
    hash = bench.propose()["hash"]
    with pytest.raises(DraftRefused, match="nobody has approved rest"):
        bench.desk.submit("cell rest", "bot")
    bench.desk.approve(hash, "Ana")
    with pytest.raises(DraftRefused, match="nobody has approved own"):
        bench.desk.submit("cell own", "bot")
    assert bench.desk.submit("cell rest", "bot")["state"] == "queued"
    ((text, way, why, version),) = bench.plant.tasks
    assert (text, way, version) == ("cell rest", ASSISTANT, bench.versions.at_work().digest)
    assert why == f"given by 'bot'; the recipe was approved by Ana as {hash[:12]}"
    (bench.folder / "rest.xml").write_bytes(REST + b"<!-- -->")
    bench.versions.put_files("Ben")
    with pytest.raises(DraftRefused, match="nobody has approved rest as it is at work"):
        bench.desk.submit("cell rest", "bot")
    assert len(bench.plant.tasks) == 1


def test_a_recipe_at_work_can_be_asked_for_without_any_change(bench: Bench) -> None:
    hash = bench.propose(trees={}, recipes=["own"])["hash"]
    told = bench.desk.approve(hash, "Ana")
    assert told["stage"] == "approved" and told["version"] is None and not bench.plant.revisions
    assert bench.desk.submit("cell own", "bot")["state"] == "queued"


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (lambda bench: setattr(bench.plant.model, "assistants", Assistants.PROPOSE), "assistants: propose"),
        (lambda bench: setattr(bench, "now", datetime(2026, 11, 26, 18, 0)), "from 08:00-18:00"),
        (lambda bench: setattr(bench, "now", datetime(2026, 11, 26, 7, 59)), "it is 07:59"),
        (
            lambda bench: setattr(bench.plant, "rows", [SimpleNamespace(asked_by=ASSISTANT)]),
            "allows 1 at once",
        ),
        (
            lambda bench: setattr(bench.plant.model, "assistant_limits", AssistantLimits(cells=("another",))),
            "no tasks to cell",
        ),
    ],
)
def test_the_limits_of_the_plant_file_hold(bench: Bench, change: Callable[[Bench], None], why: str) -> None:
    bench.desk.approve(bench.propose()["hash"], "Ana")
    change(bench)
    with pytest.raises(DraftRefused, match=why):
        bench.desk.submit("cell rest", "bot")
    assert not bench.plant.tasks
