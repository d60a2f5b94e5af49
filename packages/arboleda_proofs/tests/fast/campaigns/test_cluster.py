"""Campaigns on workers of other hosts, which are played by an executor that does at once what it is given."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import CancelledError, Future
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from distributed.scheduler import KilledWorker
from rich.console import Console
from tests.unit.cli.test_refusals import Typed
from tests.unit.cli.test_refusals import typed as typed

from arboleda.extension import ArboledaError, StartError
from arboleda.plant_file import loader
from arboleda_proofs.campaigns import crews, far_work
from arboleda_proofs.campaigns.campaign import Batch, Campaign, Passed, SoFar
from arboleda_proofs.campaigns.cluster import Cluster
from arboleda_proofs.campaigns.far_work import Abandoned, Done
from arboleda_proofs.campaigns.plants import Plant, PlantRotation
from arboleda_proofs.campaigns.proof.calm import calm_runs
from arboleda_proofs.campaigns.proof.proof import Proof
from arboleda_proofs.campaigns.proof.scenario import scenarios
from arboleda_proofs.campaigns.same_code import code, difference, packages
from arboleda_proofs.campaigns.setting import Setting

EXAMPLES = Path(__file__).parents[5] / "examples"
ADDRESS = "tcp://laptop:8786"
Play = Callable[..., Any]


@dataclass(frozen=True)
class Ended:
    """Result of a run."""

    seed: int
    broken: bool


@dataclass(frozen=True)
class Doubles:
    """Runs of which that of `breaks` breaks something; each simulates a minute."""

    breaks: int = -1

    def run(self, seed: int, *, tick: Passed | None = None) -> Ended:
        assert tick is not None
        tick(1, 2, 3)
        return Ended(seed, seed == self.breaks)


@dataclass
class Host:
    """Worker on another host: its threads, files of it that are others, and how it does what it is given."""

    threads: int = 1
    files: Mapping[str, str] = field(default_factory=dict)
    play: Play = lambda work, *given: work(*given)
    states: dict[str, Any] = field(default_factory=lambda: {"run": SimpleNamespace(state="executing")})


@dataclass
class Played:
    """Client of a scheduler whose workers are `hosts`, and its executor; `asked`: what they were given."""

    hosts: dict[str, Host]
    patch: pytest.MonkeyPatch
    asked: list[tuple[str, str, Sequence[int]]] = field(default_factory=list)
    hear: Callable[[Any], None] = lambda event: None
    is_closed: bool = False

    def nthreads(self) -> Mapping[str, int]:
        return {address: each.threads for address, each in self.hosts.items()}

    def get_executor(self, *, pure: bool) -> Played:
        assert not pure, "equal portions would be one"
        return self

    def subscribe_topic(self, name: str, hear: Callable[[Any], None]) -> None:
        self.hear = hear

    def unsubscribe_topic(self, name: str) -> None:
        self.hear = lambda event: None

    def shutdown(self, *, wait: bool) -> None:
        assert not wait, "a person who ends a campaign does not wait for its runs"

    def close(self, timeout: float) -> None:
        self.is_closed = True

    def get_current_task(self) -> str:
        return "run"

    def log_event(self, name: str, passed: Sequence[int]) -> None:
        self.hear((0.0, passed))

    def submit(self, work: Any, *given: Any, workers: list[str], **options: bool) -> Future[Any]:
        address = next(each for each in workers if each in self.hosts)
        host, future = self.hosts[address], Future[Any]()
        self.asked.append((address, work.__name__, given[2] if work is far_work.run else ()))
        self.state = SimpleNamespace(tasks=host.states)
        self.patch.setattr(far_work, "get_worker", lambda: self)
        self.patch.setattr(far_work, "code", lambda names: {**code(names), **host.files})
        try:
            future.set_result(host.play(work, *given))
        except Exception as error:  # noqa: BLE001 - it is told to who asked
            future.set_exception(error)
        return future


@dataclass
class Stage:
    """Cluster of played workers, and what was said of them."""

    client: Any
    cluster: Cluster
    said: list[str]

    def results(self, seeds: Sequence[int], **options: Any) -> list[Ended]:
        with self.campaign(seeds, **options) as campaign:
            return list(campaign.results())

    def campaign(self, seeds: Sequence[int], runs: Any = Doubles(), **options: Any) -> Campaign[Ended]:
        return self.cluster.campaign(Batch(runs=runs, seeds=seeds, tick=lambda: None, **options))

    @property
    def portions(self) -> list[tuple[str, Sequence[int]]]:
        return [(address, seeds) for address, work, seeds in self.client.asked if work == "run"]


@pytest.fixture
def staged(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Stage]:
    def go(**hosts: Host) -> Stage:
        client: Any = Played(hosts, monkeypatch)
        said: list[str] = []
        return Stage(client, Cluster(client, ADDRESS, said.append), said)

    return go


@pytest.fixture
def no_patience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arboleda_proofs.campaigns.cluster.LEFT_S", 0.0)
    monkeypatch.setattr("arboleda_proofs.campaigns.cluster.TICK_S", 0.0)


def test_each_seed_has_one_result_whoever_runs_it(staged: Callable[..., Stage]) -> None:
    stage = staged(one=Host(), other=Host())
    assert sorted(each.seed for each in stage.results(range(300))) == [*range(300)]
    assert stage.cluster.jobs == 2 and not stage.said


def test_short_runs_are_handed_out_in_portions_and_long_ones_alone(staged: Callable[..., Stage]) -> None:
    def lasts(seconds: float) -> Play:
        def play(work: Any, *given: Any) -> Any:
            done = work(*given)
            return replace(done, seconds=seconds * len(given[2])) if isinstance(done, Done) else done

        return play

    for seconds, most in ((0.001, 64), (0.3, 6), (5.0, 1)):
        stage = staged(one=Host(play=lasts(seconds)))
        stage.results(range(200), ahead=1)
        sizes = [len(seeds) for _, seeds in stage.portions]
        assert sizes[0] == 1 and max(sizes) == most, seconds


def test_after_a_failure_nothing_begins(staged: Callable[..., Stage]) -> None:
    results = staged(one=Host()).results(range(9), runs=Doubles(breaks=0), until_failure=True, ahead=1)
    assert results == [Ended(0, True)]


@pytest.mark.parametrize(
    ("host", "sentence"),
    [
        (Host(files={"Python": "3.9"}), "has Python 3.9, and here is {0.major}.{0.minor}"),
        (Host(files={"Arboleda": "0.0.9"}), "has Arboleda 0.0.9, and here is 0.1.0"),
        (Host(files={"arboleda/extension.py": "7"}), "has another arboleda/extension.py than this machine"),
        (Host(files={"arboleda/zones.py": "7"}), "has another arboleda/zones.py than this machine"),
        (Host(threads=4), "has 4 threads, and runs need a process each: start it with --nthreads 1"),
    ],
)
def test_a_worker_that_is_another_gets_no_runs_and_is_named_once(
    staged: Callable[..., Stage], host: Host, sentence: str
) -> None:
    stage = staged(other=host, same=Host())
    for _ in range(2):
        assert len(stage.results(range(20))) == 20
    assert {address for address, _ in stage.portions} == {"same"}
    assert stage.said == [f"other gets no runs: it {sentence.format(sys.version_info)}"]


def test_a_worker_without_arboleda_is_named(staged: Callable[..., Stage]) -> None:
    def play(work: Any, *given: Any) -> Any:
        raise ModuleNotFoundError("No module named 'arboleda_proofs'")

    stage = staged(other=Host(play=play), same=Host())
    assert len(stage.results(range(3))) == 3
    assert stage.said == ["other gets no runs: it cannot do such runs: No module named 'arboleda_proofs'"]


@pytest.mark.parametrize("hosts", [{}, {"one": Host(threads=2)}])
def test_without_a_worker_for_it_a_campaign_ends(staged: Callable[..., Stage], hosts: Any) -> None:
    sentence = f"{ADDRESS} has no worker for these runs; start some: dask worker {ADDRESS} --nworkers -1"
    with pytest.raises(ArboledaError, match=sentence):
        staged(**hosts).results(range(3))


def test_a_scheduler_without_workers_is_refused_at_once_and_left_at_the_end(
    staged: Callable[..., Stage],
) -> None:
    with pytest.raises(ArboledaError, match="has no worker for these runs"), staged().cluster:
        pytest.fail("it went on")
    stage = staged(one=Host())
    with stage.cluster as cluster:
        assert cluster.jobs == 1
    assert stage.client.is_closed


def test_a_worker_that_comes_later_gets_runs_once_it_is_ready(
    staged: Callable[..., Stage], no_patience: None
) -> None:
    stage = staged(one=Host())
    with stage.campaign(range(500), ahead=1) as campaign:
        results = campaign.results()
        first = next(results)
        stage.client.hosts["later"] = stage.client.hosts.pop("one")
        assert sorted(each.seed for each in [first, *results]) == [*range(500)]
    assert ("later", "prepare", ()) in stage.client.asked


def test_runs_that_nobody_was_ready_for_are_handed_out_again(staged: Callable[..., Stage]) -> None:
    unready = ["once"]

    def play(work: Any, *given: Any) -> Any:
        return None if work is far_work.run and unready and unready.pop() else work(*given)

    stage = staged(one=Host(play=play))
    assert sorted(each.seed for each in stage.results(range(9), ahead=1)) == [*range(9)]
    assert [seeds for _, seeds in stage.portions[:2]] == [(0,), (0,)]
    assert far_work.run("another campaign", 0, [1]) is None


def test_what_passed_is_counted_once_though_a_portion_is_begun_again(staged: Callable[..., Stage]) -> None:
    stage, seen = staged(one=Host()), list[SoFar]()

    def play(work: Any, *given: Any) -> Any:
        if work is far_work.run:
            stage.client.hear((0.0, [given[1], 5, 5, 5]))  # of a worker that dies with it
            seen.append(campaign.so_far)
            stage.client.hear((0.0, [given[1], 1, 0, 0]))
            seen.append(campaign.so_far)
            stage.client.hear((0.0, [given[1] - 1, 7, 7, 7]))  # too late
        return work(*given)

    stage.client.hosts["one"].play = play
    with stage.campaign([1, 2], ahead=1) as campaign:
        assert len(list(campaign.results())) == 2
        assert campaign.so_far == SoFar(2, 4, 6)
    assert seen == [SoFar(5, 5, 5), SoFar(1, 0, 0), SoFar(6, 7, 8), SoFar(2, 2, 3)]


@pytest.mark.parametrize("state", ["cancelled", None])
def test_a_run_that_nobody_waits_for_ends(staged: Callable[..., Stage], state: str | None) -> None:
    states = {} if state is None else {"run": SimpleNamespace(state=state)}
    with pytest.raises(Abandoned):
        staged(one=Host(states=states)).results([1])


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (KilledWorker("run", None, 3), "the same runs killed one worker after the other"),
        (CancelledError(), f"the scheduler {ADDRESS} does not answer any more"),
        (ArboledaError("a run was killed"), "a run was killed"),
    ],
)
def test_what_ends_a_campaign_is_said(
    staged: Callable[..., Stage], error: BaseException, sentence: str
) -> None:
    def play(work: Any, *given: Any) -> Any:
        if work is far_work.run:
            raise error
        return work(*given)

    with pytest.raises(ArboledaError, match=sentence):
        staged(one=Host(play=play)).results([1])


def test_a_scheduler_that_goes_is_said(staged: Callable[..., Stage], monkeypatch: pytest.MonkeyPatch) -> None:
    stage = staged(one=Host())

    def gone() -> None:
        raise OSError("no route to host")

    monkeypatch.setattr(stage.client, "nthreads", gone)
    with pytest.raises(ArboledaError, match="does not answer any more"):
        assert stage.cluster.jobs


def plant_of(example: str) -> Plant:
    model, files = loader.load_with_files(EXAMPLES / example / "plant.yaml")
    return Plant(declared=model, files=files)


def at_another_host(runs: Any, plants: Sequence[Plant], monkeypatch: pytest.MonkeyPatch, *seeds: int) -> Any:
    """What comes of runs that were packed, and unpacked from nothing but the bytes."""
    client = Played({}, monkeypatch)
    client.state = SimpleNamespace(tasks=Host().states)
    monkeypatch.setattr(far_work, "get_worker", lambda: client)
    assert far_work.prepare("a campaign", far_work.packed(runs, plants)) == ""
    done = far_work.run("a campaign", 0, seeds)
    assert done is not None
    return done.results


def test_seeds_come_to_the_same_where_the_plant_was_read_from_what_travelled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plants = (plant_of("lab_bench"), plant_of("machine_tending"))
    setting = Setting(plants=PlantRotation(plants=plants), cycles=1, level="few")
    for seed, result in zip((2, 3), at_another_host(setting, plants, monkeypatch, 2, 3), strict=True):
        assert result.digest == setting.run(seed).digest


def test_portions_of_a_proof_come_to_the_same_there(monkeypatch: pytest.MonkeyPatch) -> None:
    plant = plant_of("lab_bench")
    calm = tuple(calm_runs(plant.model, [*scenarios(plant.model, ("weigh",))][:1]))
    proof = Proof(model=plant.model, calm=calm, kinds=("refuses",))
    assert len(proof.portions) > 1
    assert at_another_host(proof, (plant,), monkeypatch, 0, 1) == [proof.run(0), proof.run(1)]


def test_a_plant_that_cannot_be_read_there_is_refused() -> None:
    plant = plant_of("lab_bench")
    torn = replace(plant, files=replace(plant.files, contents={plant.files.plant: b"name: [\n"}))
    setting = Setting(plants=PlantRotation(plants=(torn,)), cycles=1, level="none")
    assert far_work.prepare("torn", far_work.packed(setting, (torn,))).startswith("cannot read the plant: ")


def test_code_is_compared_where_both_have_it() -> None:
    ours = code(packages(("json", "far_away")))
    mine = "arboleda_proofs/campaigns/cluster.py"
    assert {"Python", "Arboleda", "arboleda/extension.py", mine} <= ours.keys()
    assert difference(ours, ours) == ""
    without = {name: digest for name, digest in ours.items() if not name.startswith("arboleda_proofs/")}
    assert difference(ours, without) == "" and difference(without, ours).startswith("has another arboleda_pr")


def test_the_library_is_asked_for_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "arboleda_proofs.campaigns.cluster", None)
    with pytest.raises(StartError, match=r"--on needs the library distributed: .*'arboleda\[cluster\]'`"):
        crews.crew(None, ADDRESS, Console())


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("simulate", "--worker"), "--worker and --store are gone"),
        (("simulate", "--store", "postgresql://there/plants"), "arboleda simulate --on tcp://HOST:8786"),
        (("simulate", "--on", ADDRESS, "--jobs", "2"), "not with --jobs, --trace, --record"),
        (("simulate", "--on", ADDRESS, "--trace"), "not with --jobs, --trace, --record"),
        (("prove", "--on", ADDRESS, "--jobs", "2"), "leave out --jobs"),
    ],
)
def test_options_that_say_another_thing_are_refused(
    typed: Typed, words: tuple[str, ...], sentence: str
) -> None:
    status, said = typed(*words)
    assert status == 2 and sentence in " ".join(said.split()), said
