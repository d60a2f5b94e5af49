"""Location of the plant that a command talks to: its file, its state directory, and the client of both."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from arboleda.model.outside import plain
from arboleda.plant_file.shipped import shipped_name
from arboleda.runtime.endpoints import tokens_of
from arboleda.runtime.state import default_state, find_running, last_run, plants_of_databases, running_plants

if TYPE_CHECKING:
    from arboleda.model.plant_model import PlantModel
    from arboleda.store.leadership import Leadership
    from arboleda.store.task_rows import History

    from .client import PlantClient

LONGEST = 500  # characters of a line
PLANT_VARIABLE = "ARBOLEDA_PLANT"  # of the environment, instead of --plant
IN_FOLDER = Path("plant.yaml")  # as `arboleda new` calls it


def is_typed(context: typer.Context, option: str) -> bool:
    """True for an option of the command line; its variable of the environment is only a default."""
    source = context.get_parameter_source(option)
    return source is not None and source.name == "COMMANDLINE"


def plant_here(named: Path | None) -> Path | None:
    """The plant file that was named, else that of the working directory; None where there is none: the
    shipped plant."""
    return IN_FOLDER if named is None and IN_FOLDER.is_file() else named


PlantFile = Annotated[
    Path | None,
    typer.Option(
        "--plant",
        metavar="FILE",
        envvar=PLANT_VARIABLE,
        callback=plant_here,
        help=f"Plant file. [default: {IN_FOLDER} of this folder, else the shipped plant]",
    ),
]
RunningPlant = Annotated[
    Path | None,
    typer.Option(
        "--plant",
        metavar="FILE",
        envvar=PLANT_VARIABLE,
        help=f"Plant file. [default: {IN_FOLDER} of this folder if it runs, else the plant that runs]",
    ),
]
CellName = Annotated[str | None, typer.Option("--cell", help="Only for this cell. [default: for all]")]
StateFolder = Annotated[
    Path | None,
    typer.Option(
        "--state",
        metavar="DIR",
        envvar="ARBOLEDA_STATE",
        help="Where the plant keeps its state. [default: $XDG_STATE_HOME/arboleda/<plant name>]",
    ),
]


StoreAddress = Annotated[
    str,
    typer.Option(
        "--store",
        metavar="URL",
        envvar="ARBOLEDA_STORE",
        help="Database that keeps the plant's memory, postgresql://USER@HOST/DATABASE; its password is in"
        " PGPASSWORD or ~/.pgpass. [default: what the plant file says, else a file in the state directory]",
        show_default=False,
    ),
]


TokensFile = Annotated[
    Path | None,
    typer.Option(
        "--tokens",
        metavar="FILE",
        envvar="ARBOLEDA_TOKENS",
        help="Lines of ADDRESS TOKEN, or PLANT TOKEN, for a plant that another host leads; mode 0600."
        " [default: the tokens in the state directory here]",
        show_default=False,
    ),
]


def client(
    plant: Path | None, state: Path | None, store: str = "", tokens: Path | None = None
) -> PlantClient:
    """The client of the plant that runs on `state`, or on that plant file's state directory; on any host."""
    from .client import PlantClient  # loads all answers of a plant, which few of these commands ask for
    from .remote_plant import RemotePlant

    where = located(plant, state)
    elsewhere = RemotePlant(
        where,
        kept_in=lambda: _kept_in(plant, where, store),
        known=lambda: {} if tokens is None else tokens_of(tokens),
    )
    return PlantClient(where, elsewhere)


def located(plant: Path | None, state: Path | None) -> Path:
    """The `folder`; where neither is named, that of the plant file in the working directory if it runs, else
    of the shipped plant if that does, else of the only plant that runs, else of the only one that other hosts
    may lead. Of the last two it is said which it is."""
    named = folder(plant, state)
    here = None if plant or state else plant_here(None)
    if here is not None and find_running(beside := folder(here, None)) is not None:
        return beside
    if plant is not None or state is not None or find_running(named) is not None:
        return named
    found, why = running_plants(), "that runs"
    if not found and named not in (kept := plants_of_databases()):
        found, why = kept, "here whose memory is in a database"
    if len(found) != 1:
        return named
    print(plain(f"plant {found[0].name}, the only one {why}", LONGEST), file=sys.stderr)
    return found[0]


def history(plant: Path | None, state: Path | None, store: str) -> History:
    """The history of that plant's tasks, read from the store that keeps them."""
    from arboleda.runtime.stores import history_of

    where = located(plant, state)
    kept_in, name = _kept_in(plant, where, store)
    return history_of(kept_in, where, name if kept_in else name_of(plant))


def database(plant: Path | None, state: Path | None, store: str) -> Leadership:
    """The leadership of that plant; StartError if its memory is no database."""
    from arboleda.runtime.stores import leadership_of

    return leadership_of(*_kept_in(plant, located(plant, state), store))


def _kept_in(plant: Path | None, where: Path, store: str) -> tuple[str, str]:
    """The database of a plant, "" for none, and its name: that which was named, of the plant that runs there,
    of the plant file, of the last start there."""
    last, runs = last_run(where), find_running(where) is not None
    if last is not None and last.store and not store and (runs or not store_of(plant)):
        return last.store, last.plant
    kept_in = store or store_of(plant)
    if not kept_in:
        return "", ""
    if plant is None and last is not None and last.plant:
        return kept_in, last.plant
    return kept_in, _name(plant)


def store_of(plant: Path | None) -> str:
    """The database that the plant file names, "" if it names none, as the shipped one does."""
    return "" if plant is None else _model(plant).store


def folder(plant: Path | None, state: Path | None) -> Path:
    """`state`, or the state directory of that plant file."""
    return state or default_state(_name(plant))


def name_of(plant: Path | None) -> str:
    """The name of the plant of that file; "" if none is named."""
    return "" if plant is None else _name(plant)


def _name(plant: Path | None) -> str:
    return shipped_name() if plant is None else _model(plant).name


def _model(plant: Path) -> PlantModel:
    # it takes longer to load than most commands, of which few name a plant file
    from arboleda.plant_file import loader

    return loader.load(plant, recipes=False)
