"""The command `arboleda check`: what is wrong with a plant file, or with trees, and what would mend it."""

from __future__ import annotations

import json as plain_json
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from arboleda.host.packages import extra
from arboleda.model.packages import MAKE, TREES
from arboleda.model.sentence import Phrase
from arboleda.plant_check import advance_check, checks, unstated
from arboleda.plant_check.check_answer import check_answer
from arboleda.plant_check.findings import Source
from arboleda.plant_file import drivers, extensions, loader
from arboleda.plant_file.recipe_forms import is_tree_file
from arboleda.plant_file.user_file import check_writable

from .commands import tell_left_out
from .language import finding, say
from .plant_options import IN_FOLDER, PLANT_VARIABLE, CellName, is_typed, plant_here
from .working import working

MEND_S = 120.0  # a mend is looked for so long
TO_SCREEN = "-"
PROBLEMS = 2  # exit status
NO_FILE = Phrase("cli.check.no_file", "there is no {file} in this folder; name the file to check")
FOR_TREES = Phrase("cli.check.for_trees", "--plant and --cell are for files of trees, *.xml")
FOR_PLANTS = Phrase("cli.check.for_plants", "--json and --mend are for plant files")
NOTE = Phrase("cli.check.note", "{file}: note: {note}")
GOOD = Phrase("cli.check.good", "{file}: good: plant {plant}; cells {cells}")
WARNING = Phrase("cli.check.warning", "{file}: warning: {warning}")
MEND_IS = Phrase("cli.check.mend", "{file}: mend: {mend}")
NO_MEND = Phrase(
    "cli.check.no_mend",
    "no mend is known: of all that is likely here nothing that was tried makes it better",
)

Json = Annotated[
    Path | None,
    typer.Option("--json", metavar="FILE", help="Write what is found as data; -: to the screen, alone."),
]
Mend = Annotated[
    bool,
    typer.Option(
        "--mend",
        help=f"Look for a change of the files that mends it, for at most {MEND_S:g} s: each is tried.",
    ),
]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(check)


def check(
    context: typer.Context,
    file: Annotated[
        Path | None,
        typer.Argument(
            metavar="FILE",
            help="The plant file to check, or a file of trees, *.xml or *.btproj. "
            f"[default: {IN_FOLDER} of this folder]",
        ),
    ] = None,
    plant: Annotated[
        Path | None,
        typer.Option(
            "--plant",
            metavar="FILE",
            envvar=PLANT_VARIABLE,
            help="The plant whose devices a tree is to tell what to do; alone, the plant to check.",
        ),
    ] = None,
    cell: CellName = None,
    ends: Annotated[
        bool, typer.Option("--ends", help="Say what holds once a task of each recipe is done.")
    ] = False,
    show: Annotated[
        bool,
        typer.Option(
            "--show", help="Show the messages of each device whose messages are named, with examples."
        ),
    ] = False,
    json: Json = None,
    mend: Mend = False,
) -> None:
    """Check a plant file, or behavior trees in the XML of BehaviorTree.CPP; every problem at once, each with
    its line. Exit status: 0 good, 2 problems.

    Trees are checked without a plant: leaves that nobody here knows are listed, not refused. With --plant
    they have to be nodes of its devices, which `arboleda nodes` lists.
    """
    tell_left_out()
    if file is None:
        file, plant = plant_here(plant), None
    if file is None:
        raise typer.BadParameter(say(NO_FILE(file=str(IN_FOLDER))))
    if is_tree_file(file):
        if json is not None or mend:
            raise typer.BadParameter(say(FOR_PLANTS()))
        of_trees = extra("check", TREES, str(file))
        with working():
            model = None if plant is None else loader.load(plant)
            lines = of_trees(file, model, cell)
        print(finding("\n".join(lines)))
        return
    if (plant is not None and is_typed(context, "plant")) or cell is not None:
        raise typer.BadParameter(say(FOR_TREES()))
    if json is not None or mend:
        _as_data(file, json, mend=mend)
    if json is None or str(json) != TO_SCREEN:
        _in_words(file, ends=ends, show=show)


def _as_data(file: Path, json: Path | None, *, mend: bool) -> None:
    """Write the answer where that is wanted, and say what would mend it; alone on the screen it ends the
    command after problems."""
    mending = extra("mend", MAKE, "--mend") if mend else None
    to_screen = json is not None and str(json) == TO_SCREEN
    if json is not None and not to_screen:
        check_writable(json)
    with working():
        answer = check_answer(file, mending=mending and partial(mending, within_s=MEND_S))
    text = plain_json.dumps(answer.plain, indent=1, ensure_ascii=False)
    if to_screen:
        print(text)
    elif json is not None:
        json.write_text(f"{text}\n", "utf-8")
    if mend and answer.findings and not to_screen:
        words = say(NO_MEND()) if answer.mend is None else finding(answer.mend.words)
        print(say(MEND_IS(file=str(file), mend=words)))
    if to_screen and any(each.source is Source.PROBLEM for each in answer.findings):
        raise typer.Exit(PROBLEMS)


def _in_words(file: Path, *, ends: bool, show: bool) -> None:
    """Print what the plant is, and what it is warned of; ConfigError with every problem."""
    with working():
        model, missed = loader.load_with_offers(file)
    for note in (*loader.notes(model), *unstated.notes(model), *extensions.notes(model)):
        print(say(NOTE(file=str(file), note=finding(note))))
    for warning in checks.warnings(model):
        print(say(WARNING(file=str(file), warning=finding(warning))))
    cells = tuple(cell.name for cell in model.cells)
    print(say(GOOD(file=str(file), plant=model.name, cells=cells)))
    lines = [*loader.offers(model, missed), *(advance_check.ends(model) if ends else ())]
    for line in (*lines, *(drivers.messages_of(model) if show else ())):
        print(f"  {finding(line)}")
