"""Exercises: what belongs to each, and how their judge finds; all of their works are in ../exercises."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from tests.lengths import length
from typer.testing import CliRunner

from arboleda.cli.language import finding_in
from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError
from arboleda.model.messages import TaskState
from arboleda_class.exercises import judge_process
from arboleda_class.exercises.command import DIFFICULTIES, effort
from arboleda_class.exercises.exercise import LANGUAGES, Exercise, catalog, exercise
from arboleda_class.exercises.wording import befell, in_english, often, task_is, task_is_to
from arboleda_class.exercises.work import SHEET, packed, works
from arboleda_proofs.campaigns.proof.outcome import End
from arboleda_proofs.simulator.faults import KINDS, Fault

from ..exercises.works import Sample, handed_in, samples, two

LEAST = {True: 3, False: 10}  # works of each exercise that are right, and wrong ones
QUICK = length(("query_first", "night"), ("query_first", "need", "night"))
BOMB = (
    "a: &a [1, 2]\n"
    + "".join(
        f"{name}: &{name} [{', '.join([f'*{before}'] * 9)}]\n"
        for before, name in zip("abcdefgh", "bcdefghi", strict=True)
    )
    + "exercise: *i\n"
)


@pytest.mark.parametrize("each", catalog().values(), ids=lambda each: each.name)
def test_an_exercise_has_all_that_belongs_to_it(each: Exercise) -> None:
    texts = [each.title, each.task, *each.hints, *(trial.says for trial in each.trials)]
    assert all(set(text) == set(LANGUAGES) and all(text.values()) for text in texts)
    assert each.trials and len(each.hints) >= 2 and set(each.yours) <= set(each.start)
    assert all(fault.fault.kind in KINDS for trial in each.trials for fault in trial.faults)
    assert each.minutes > 0 and each.difficulty in DIFFICULTIES
    assert all(len(trial.ends) == len(trial.tasks) for trial in each.trials)
    assert all(set(proving.kinds) <= set(KINDS) for proving in each.proving)


def test_the_exercises_are_numbered_one_after_the_other() -> None:
    assert [each.number for each in catalog().values()] == list(range(1, 19))


@pytest.mark.parametrize(("language", "page"), [("en", "exercises.md"), ("es", "exercises.es.md")])
def test_how_to_pages_list_the_exercises_with_their_titles(language: str, page: str) -> None:
    text = (Path(__file__).parents[4] / "docs/how-to" / page).read_text("utf-8")
    rows = [
        f"| `{each.name}` | {each.title[language]} | {effort(each, language)} |"
        for each in catalog().values()
    ]
    assert [line for line in text.splitlines() if line in rows] == rows


@pytest.mark.parametrize("name", catalog())
def test_works_of_an_exercise_are_many_and_differ(name: str) -> None:
    for right, least in LEAST.items():
        of_kind = [each for each in samples(name) if each.right is right]
        assert len({str(each.files) for each in of_kind}) == len(of_kind) >= least


@pytest.mark.long
@pytest.mark.parametrize("work", [each for name in QUICK for each in two(name)], ids=str)
def test_a_work_is_judged_as_it_is(work: Sample) -> None:
    verdict = work.judged()
    assert verdict.passes is work.right
    assert verdict.passes or verdict.findings[0].evidence


def test_a_packed_work_is_the_work_and_nothing_beside_it(tmp_path: Path) -> None:
    folder = handed_in(tmp_path, "need", "Ana")
    (folder / "private.txt").write_text("mine", "utf-8")
    [work] = works([folder])
    packed(work, tmp_path / "work.zip")
    [again] = works([tmp_path / "work.zip"])
    assert (again.exercise, again.student, again.files) == ("need", "Ana", work.files)
    with zipfile.ZipFile(tmp_path / "work.zip") as pack:
        assert sorted(pack.namelist()) == ["need/plant.yaml", "need/work.yaml"]


def test_a_folder_has_the_works_below_it_and_the_zips(tmp_path: Path) -> None:
    packed(works([handed_in(tmp_path / "a", "need", "Ana")])[0], tmp_path / "a.zip")
    handed_in(tmp_path / "b", "retry", "Bea")
    found = [(each.student, each.exercise, each.trouble) for each in works([tmp_path])]
    assert found == [("Ana", "need", ""), ("Ana", "need", ""), ("Bea", "retry", "")]
    with pytest.raises(ConfigError, match="has no work"):
        works([tmp_path / "nowhere"])


@pytest.mark.parametrize(
    ("files", "trouble"),
    [
        ({SHEET: "exercise: need\n"}, "plant.yaml is missing"),
        ({SHEET: "exercise: wishes\n"}, "there is no exercise wishes"),
        ({SHEET: "- 1\n"}, "does not say which exercise"),
        ({SHEET: "exercise: [\n"}, "does not say which exercise"),
        ({SHEET: BOMB}, "does not say which exercise"),
    ],
)
def test_a_work_that_cannot_be_judged_says_why(tmp_path: Path, files: dict[str, str], trouble: str) -> None:
    for name, text in files.items():
        (tmp_path / name).write_text(text, "utf-8")
    [work] = works([tmp_path])
    assert trouble in work.trouble
    assert [each.evidence for each in judge_process.judged(work).findings] == [work.trouble]


def test_a_zip_is_read_and_never_unpacked(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "far.zip", "w") as pack:
        pack.writestr(f"../../{SHEET}", "exercise: need\nstudent: Bea\n")
        pack.writestr("../../plant.yaml", "name: x\n")
    (tmp_path / "none.zip").write_text("no zip", "utf-8")
    far, none = works([tmp_path])
    assert far.files == {"plant.yaml": b"name: x\n"} and not far.trouble
    assert "cannot be read" in none.trouble
    assert sorted(each.name for each in tmp_path.iterdir()) == ["far.zip", "none.zip"]
    assert not (tmp_path.parent.parent / SHEET).exists()


def test_a_plant_that_was_changed_elsewhere_does_not_pass() -> None:
    [right] = [each for each in samples("need") if each.right][:1]
    changed = right.files["plant.yaml"].replace(b"takes_s: 3", b"takes_s: 0.1")
    verdict = Sample(exercise="need", right=False, about="", files={"plant.yaml": changed}).judged()
    assert "kinds.press.verbs.press.takes_s of plant.yaml was changed" in verdict.findings[0].evidence


def kinds_in(each: Exercise) -> set[str]:
    """The kinds of the faults with which an exercise is judged."""
    trials = [*each.trials, *([each.record] if each.record else [])]
    tried = {fault.fault.kind for trial in trials for fault in trial.faults}
    return tried | {kind for proving in each.proving for kind in proving.kinds}


def check(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(cli, ["exercise", *arguments], env={"ARBOLEDA_LANG": "", "LANG": "C"})
    return done.exit_code, done.output


def refusal(*arguments: str) -> str:
    return str(CliRunner().invoke(cli, ["exercise", *arguments]).exception)


def test_an_exercise_is_listed_written_and_hinted_at(tmp_path: Path) -> None:
    assert "retry           10 min, easy     Add a retry" in check("list")[1]
    assert "retry           10 min, fácil    Agregar un reintento" in check("list", "--lang", "es")[1]
    assert check("start", "night", str(tmp_path / "night"))[0] == 0
    assert {each.name for each in (tmp_path / "night").iterdir()} == {
        *("work.yaml", "TASK.md", "TAREA.md", "failed.mcap"),
        *exercise("night").start,
    }
    assert check("hint", "night")[1].startswith("1/3  How did the task end")
    assert "has 3 hints" in refusal("hint", "night", "4")
    assert "there is no exercise 'nihgt'" in refusal("start", "nihgt")


def test_every_state_and_end_of_a_task_has_a_sentence_of_its_own() -> None:
    ends = dict.fromkeys(each.value for kind in (TaskState, End) for each in kind)
    open_ends = [each for each in ends if task_is("it", each) == "it has not ended"]
    assert open_ends == [End.UNFINISHED.value]
    assert len({task_is("it", each) for each in ends}) == len(ends)


def test_every_end_that_an_exercise_allows_can_be_said() -> None:
    for each in catalog().values():
        allowed = [*(words for trial in each.trials for words in trial.ends)]
        allowed += [words for proving in each.proving for words in proving.ends.values()]
        assert all(task_is_to("it", words).startswith("it is to ") for words in allowed), each.name


@pytest.mark.parametrize(
    ("english", "spanish"),
    [
        (often("lamp light true", 1, 0, 0), "'lamp light true' no debe hacerse; se hace una vez"),
        (often("camera look", 1, 2, 3), "'camera look' debe hacerse de 2 a 3 veces; se hace una vez"),
        (often("pump dispense", 0, 2, 2), "'pump dispense' debe hacerse 2 veces; no se hace"),
        (often("ana", 0, 1, 1), "a ana se le debe preguntar una vez, y no se le pregunta"),
        (
            f"{task_is_to('bench inspect', ['failed', 'held'])}; {task_is('it', 'done')}",
            "bench inspect debe fallar o debe quedar retenida; se ha hecho",
        ),
        (
            f"{task_is_to('bench inspect', ['done'])}; {task_is('it', 'failed')}: "
            + in_english("camera: gave up (atasco) while doing look"),
            "bench inspect debe hacerse; ha fallado: "
            "camera: se dio por vencido (atascado) mientras estaba con la orden «look»",
        ),
        (
            in_english("scale: refused the command for doing weigh (ocupado)"),
            "scale: orden rechazada, con la orden «weigh» (ocupado)",
        ),
        (
            "box is to have 1 part at the end; it has 0 parts",
            "box debe tener 1 pieza al final; tiene 0 piezas",
        ),
    ],
)
def test_a_verdict_is_whole_in_both_languages(english: str, spanish: str) -> None:
    assert not any(word in english for word in ("1 times", "0 times", "atasco", "ocupado"))
    assert finding_in("es", english) == spanish


@pytest.mark.parametrize("kind", sorted({kind for each in catalog().values() for kind in kinds_in(each)}))
def test_a_fault_of_an_exercise_has_a_sentence(kind: str) -> None:
    line = befell(Fault(kind=kind, target="oven", word="", at=0.0, seconds=2.5, amount=4.0))
    assert line.startswith("FAULT for 2.5 s: ") and f"{kind} oven" not in line
    what = line.removeprefix("FAULT for 2.5 s: ")
    assert finding_in("es", what) != what
    assert finding_in("es", line) == f"FALLO durante 2.5 s: {finding_in('es', what)}"
