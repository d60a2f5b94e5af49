"""`arboleda exercise`: lists exercises, writes one to a folder, gives hints, and judges works."""

from __future__ import annotations

import json
import shlex
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from arboleda.cli.language import allowed, finding_in, language, say_in
from arboleda.cli.new import WROTE, write_files
from arboleda.cli.overview import WholeSentences
from arboleda.extension import ConfigError, Phrase, say
from arboleda.plant_file.user_file import check_writable
from arboleda.runtime import invocation

from .wording import in_story

if TYPE_CHECKING:
    from .exercise import Exercise, Text
    from .judge import Verdict
    from .work import Work

TASKS = {"en": "TASK.md", "es": "TAREA.md"}
RECORD, STORY = "failed.mcap", "story.mcap"
STATUS = "Exit status: 0 all works pass, 1 one does not, 2 bad input."
PASSES = Phrase("cli.exercise.passes", "passes")
FAILS = Phrase("cli.exercise.fails", "does not pass yet")
TO_BE_SO = Phrase("cli.exercise.to_be_so", "To be so: {what}")
NOT_SO = Phrase("cli.exercise.not_so", "Not so: {what}")
EFFORT = Phrase("cli.exercise.effort", "{minutes} min, {difficulty}")
DIFFICULTIES = {
    "easy": Phrase("cli.exercise.easy", "easy"),
    "medium": Phrase("cli.exercise.medium", "medium"),
    "hard": Phrase("cli.exercise.hard", "hard"),
}
NO_HINT = Phrase("cli.exercise.no_hint", "{name} has {all} hints; there is no hint {number}")
NO_LANGUAGE = Phrase("cli.exercise.no_language", "--lang: {asked} is not there; {others}")
LANGUAGE = "ARBOLEDA_LANG"
Lang = Annotated[
    str,
    typer.Option("--lang", metavar="en|es", envvar=LANGUAGE, help="The language. [default: the locale's]"),
]
Name = Annotated[str, typer.Argument(metavar="NAME", help="An exercise; `exercise list` names all.")]

cli = typer.Typer(
    cls=WholeSentences,
    help="Exercises with a judge: cells that are not right yet, to be put right.",
    no_args_is_help=True,
    rich_markup_mode=None,
)


@cli.command("list")
def list_exercises(lang: Lang = "") -> None:
    """List the exercises, the easiest first."""
    from .exercise import catalog

    language = _language(lang)
    for each in catalog().values():
        typer.echo(f"{each.number:3}  {each.name:16}{effort(each, language):17}{each.title[language]}")
    typer.echo(f"\n{invocation.command()} exercise start NAME")


@cli.command()
def start(
    name: Name,
    folder: Annotated[
        Path | None, typer.Argument(metavar="FOLDER", help="Where to write it. [default: ./NAME]")
    ] = None,
) -> None:
    """Write an exercise to a folder: its task in English and Spanish, and the files to begin with."""
    from .exercise import exercise
    from .work import SHEET, sheet

    found, target = exercise(name), folder or Path(name)
    texts = {called: page(found, language) for language, called in TASKS.items()}
    texts |= {called: content.decode("utf-8") for called, content in found.start.items()}
    for file in write_files(target, {SHEET: sheet(found), **texts}):
        typer.echo(say(WROTE(file=str(file))))
    if found.record is not None:
        _record(found, target)
        typer.echo(say(WROTE(file=str(target / RECORD))))
    typer.echo(f"\n{invocation.command()} exercise check {shlex.quote(str(target))}")


@cli.command()
def hint(
    name: Name,
    number: Annotated[int, typer.Argument(metavar="NUMBER", min=1, help="Number of the hint, from 1.")] = 1,
    lang: Lang = "",
) -> None:
    """Give a hint for an exercise: the first one, or the one of that number."""
    from .exercise import exercise

    found = exercise(name)
    if number > len(found.hints):
        raise ConfigError((say(NO_HINT(name=name, all=len(found.hints), number=number)),))
    typer.echo(f"{number}/{len(found.hints)}  {found.hints[number - 1][_language(lang)].strip()}")
    if number < len(found.hints):
        typer.echo(f"\n{invocation.command()} exercise hint {name} {number + 1}")


@cli.command(help=f"Judge works: folders, zips, and all that is in a folder of them.\n\n{STATUS}")
def check(
    places: Annotated[
        list[Path] | None, typer.Argument(metavar="FOLDER|ZIP", help="[default: this folder]")
    ] = None,
    json_file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write all verdicts as JSON.")
    ] = None,
    stories: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Write a record of what went wrong in each work to this folder."),
    ] = None,
    lang: Lang = "",
) -> None:
    from .judge_process import judged
    from .work import works

    language = _language(lang)
    for file in [json_file] if json_file is not None else []:
        check_writable(file)
    handed_in = works(places or [Path()])
    rows = []
    for number, work in enumerate(handed_in, start=1):
        alone = len(handed_in) == 1
        verdict = judged(work, story=_story(work, number, stories, alone=alone))
        rows.append(_row(work, verdict))
        if alone:
            _tell(work, verdict, language)
        else:
            typer.echo(_line(work, verdict, language))
    passed = sum(row["passes"] for row in rows)
    if len(rows) > 1:
        typer.echo(f"\n{passed} / {len(rows)}: {say_in(language, PASSES())}")
    if json_file is not None:
        json_file.write_text(json.dumps({"works": rows}, ensure_ascii=False, indent=1) + "\n", "utf-8")
    raise typer.Exit(0 if passed == len(rows) else 1)


@cli.command()
def pack(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder of the work.")] = Path(),
    file: Annotated[
        Path | None, typer.Argument(metavar="FILE", help="The zip. [default: EXERCISE-STUDENT.zip]")
    ] = None,
    student: Annotated[
        str, typer.Option(metavar="NAME", help="Name of the student. [default: what work.yaml says]")
    ] = "",
) -> None:
    """Write a work as a zip that can be handed in: the student's files, and nothing else of the folder."""
    from dataclasses import replace

    from .work import packed, works, zip_name

    [work] = works([folder])[:1]
    work = replace(work, student=student or work.student)
    named = zip_name(work)
    target = file or Path(named)
    check_writable(target)
    packed(work, target)
    typer.echo(say(WROTE(file=str(target))))


def page(exercise: Exercise, language: str) -> str:
    """The task of an exercise as Markdown."""
    return (
        f"# {exercise.title[language]}\n\n{effort(exercise, language)}\n\n{exercise.task[language].strip()}\n"
    )


def effort(exercise: Exercise, language: str) -> str:
    """`15 min, easy`."""
    return say_in(language, EFFORT(minutes=exercise.minutes, difficulty=DIFFICULTIES[exercise.difficulty]()))


def _record(exercise: Exercise, folder: Path) -> None:
    """Write the record that belongs to an exercise."""
    from arboleda.plant_file import loader
    from arboleda_proofs.campaigns import flight
    from arboleda_proofs.campaigns.plants import Plant

    from .exercise import PLANT
    from .trial_run import run_trial

    assert exercise.record is not None
    model, files = loader.load_with_files(folder / PLANT)
    with flight.recorded(folder / RECORD, Plant(declared=model, files=files)) as flown:
        run_trial(model, exercise.record, exercise.record.faults, make_plant=flown.make_plant)


def _story(work: Work, number: int, stories: Path | None, *, alone: bool) -> Path | None:
    """The file for the record of what went wrong in a work; None where nobody has named a folder."""
    if stories is not None:
        stories.mkdir(parents=True, exist_ok=True)
        called = "".join(each if each.isalnum() else "_" for each in work.student)
        return stories / f"{number:03}-{work.exercise or 'work'}-{called}.mcap"
    if not alone or not work.where.is_dir():
        return None
    (work.where / STORY).unlink(missing_ok=True)  # that of before
    return work.where / STORY


def _row(work: Work, verdict: Verdict) -> dict[str, Any]:
    about = {"where": str(work.where), "exercise": work.exercise, "student": work.student}
    return {**about, **verdict.plain}


def _line(work: Work, verdict: Verdict, language: str) -> str:
    word = say_in(language, PASSES() if verdict.passes else FAILS())
    first = verdict.findings[0] if verdict.findings else None
    seen = "" if first is None else finding_in(language, first.evidence.partition("\n")[0])
    why = "" if first is None else f"  {_in(first.says, language)}: {seen}"
    return f"{work.student or str(work.where):24} {work.exercise:20} {word}{why}"


def _tell(work: Work, verdict: Verdict, language: str) -> None:
    for each in verdict.findings:
        typer.echo(say_in(language, TO_BE_SO(what=_in(each.says, language))))
        for line in each.evidence.splitlines():
            typer.echo(say_in(language, NOT_SO(what=finding_in(language, line))))
        typer.echo()
    story = verdict.findings[0].story if verdict.findings else ()
    if story:
        typer.echo("\n".join(in_story(each, partial(finding_in, language)) for each in story) + "\n")
    if (work.where / STORY).is_file() and not verdict.passes:
        words = (invocation.command(), "record", "replay", shlex.quote(str(work.where / STORY)), "--page")
        typer.echo(" ".join(words) + "\n")
    typer.echo(f"{work.exercise}: {say_in(language, PASSES() if verdict.passes else FAILS())}")


def _in(text: Text, language: str) -> str:
    return text.get(language, text["en"])


def _language(wish: str) -> str:
    """The language that was asked for, else that of the locale, else English; BadParameter for others."""
    from .exercise import LANGUAGES

    if wish and wish not in LANGUAGES:
        raise typer.BadParameter(say(NO_LANGUAGE(asked=repr(wish), others=allowed(wish, LANGUAGES))))
    return wish or language()


def add_to(parent: typer.Typer) -> None:
    """Add the group."""
    parent.add_typer(cli, name="exercise")
