"""People at the plant: every verb at any time on any scope, tasks asked for twice, texts that are none."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.drivers import shown
from arboleda.engine import HISTORY
from arboleda.engine.inspection import Task, tasks_of
from arboleda.model.messages import OperatorRequest, TaskState, Verb
from arboleda.model.plant_model import Cell, PlantModel, is_homed_by_word
from arboleda.model.verbs import PARTS, STATION, WORK, Arguments, Devices, Scope
from arboleda.recipes import Recipe, Sentence
from arboleda.rig import hands
from arboleda.rig.world import World

from ..chance import Dice
from ..people import ShortForms, any_text
from . import targets
from .kind import Fault, Kind, Words, all_alike, kind, no_words, words

WHOLE_PLANT, NOWHERE = "", "nowhere"
BY_HAND = "by hand"
OF_THE_CELL = {
    "its running task": (TaskState.RUNNING,),
    "a queued task": (TaskState.QUEUED,),
    "an ended task": (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED),
}
SPARE = 50  # tasks beyond those that are remembered
# nobody is asked here, who teaches does more than to say so, and `do` is said where it is advised
SAID = tuple(
    verb
    for verb in Verb
    if Scope.PERSON not in verb.row.scopes and not verb.row.mode and WORK not in verb.arguments
)
WEIGHTS = {Verb.STOP: 0.3, Verb.HOLD: 0.6, Verb.CANCEL: 0.8}


def _scopes(model: PlantModel) -> tuple[str, ...]:
    return (WHOLE_PLANT, *targets.cells(model), *model.robots, NOWHERE)


def _zones(model: PlantModel) -> tuple[str, ...]:
    return (*model.zones, NOWHERE)


def _homings(model: PlantModel, target: str) -> tuple[str, ...]:
    """Verbs for homing; by hand only for robots that cannot report a homing, as people are asked then."""
    robot = model.robots.get(target)
    by_itself = robot is None or (robot.says_homed and not is_homed_by_word(robot))
    return ("",) if by_itself else ("", BY_HAND)


def _cancellings(model: PlantModel, target: str) -> tuple[str, ...]:
    return ("", *OF_THE_CELL) if target in targets.cells(model) else ("",)


def _unloadings(model: PlantModel, target: str) -> tuple[str, ...]:
    """Scopes for unloading: a whole rack, one of its stations, and one that does not exist."""
    stations = len(model.cell(target).stations) if target in targets.cells(model) else 0
    return ("", *map(str, range(stations + 1))) if stations else ("",)


def _cells_with_places(model: PlantModel) -> tuple[str, ...]:
    """The cells with places that people do not keep anyway."""
    return tuple(cell.name for cell in model.cells if any(not place.by_people for place in cell.places))


def _places(model: PlantModel, target: str) -> tuple[str, ...]:
    """The places of a cell, and one that it does not have."""
    return (*(place.target for place in model.cell(target).places), NOWHERE)


def _operate(verb: Verb) -> Callable[[World, Fault], None]:
    def begin(world: World, fault: Fault) -> None:
        if fault.word == BY_HAND:
            hands.BY_HAND[verb](world.manual, fault.target)
        else:
            world.tell(_request(world, verb, fault))

    return begin


def _request(world: World, verb: Verb, fault: Fault) -> OperatorRequest:
    scope = _task(world, fault) if fault.word in OF_THE_CELL else fault.target
    return OperatorRequest(at=world.now, verb=verb, scope=scope, arguments=_arguments(verb, fault.word))


def _arguments(verb: Verb, word: str) -> Arguments:
    if not word or word in OF_THE_CELL:
        return ()
    if not word.isdigit():
        return (("place", word),)
    return (("station", int(word)),) if STATION in verb.arguments else ()


def _refuse(verb: Verb) -> Callable[[World, Fault], Sentence | None]:
    def refusal(world: World, fault: Fault) -> Sentence | None:
        is_by_hand = fault.word == BY_HAND  # which is done before it is said
        return None if is_by_hand else world.plant.refusal(_request(world, verb, fault))

    return refusal


def _task(world: World, fault: Fault) -> str:
    """The id of one of a cell's tasks; an id that never existed if the cell has none."""
    ids = [task.id for task in _tasks_of(world, fault.target) if task.state in OF_THE_CELL[fault.word]]
    return Dice(fault.seed, "task").pick(ids) if ids else "t-0-0"


def _tasks_of(world: World, cell: str) -> list[Task]:
    return [task for task in tasks_of(world.plant).values() if task.order.cell == cell]


def _words(verb: Verb) -> Words:
    """The forms in which somebody may say a verb."""
    if Scope.TASK in verb.row.scopes:
        return _cancellings
    if STATION in verb.arguments:
        return _unloadings
    if PARTS in verb.arguments:
        return _places
    return _homings if verb.row.by_hand and verb.row.devices is Devices.MOVERS else no_words


def _targets(verb: Verb) -> Callable[[PlantModel], tuple[str, ...]]:
    """The scopes on which somebody may say a verb."""
    if PARTS in verb.arguments:
        return _cells_with_places
    return _zones if Scope.ZONE in verb.row.scopes else _scopes


def _verb(verb: Verb) -> Kind:
    return Kind(
        name=f"operator_{verb.value}",
        sentence=f"An operator says {verb.value}, whether it fits or not.",
        begin=_operate(verb),
        targets=_targets(verb),
        words=_words(verb),
        weight=WEIGHTS.get(verb, 1.0),
        refusal=_refuse(verb),
    )


@kind(targets=targets.cells, words=words("text", "id", "other text", "known id"), weight=0.5)
def double_submit(world: World, fault: Fault) -> None:
    """Somebody asks twice for a task: by its text, by its id, or by an id that was given to another."""
    for text in AGAIN[fault.word](world, fault):
        world.request_task(text)


def _text(world: World, fault: Fault, dice: Dice) -> str:
    cell = world.model.cell(fault.target)
    short = ShortForms.of(cell)
    return any_text(cell, dice) if short is None or len(cell.recipes) > 2 else short.default(dice)


def _same_text(world: World, fault: Fault) -> list[str]:
    return [_text(world, fault, Dice(fault.seed, "text"))] * 2


def _same_id(world: World, fault: Fault) -> list[str]:
    return [f"{_text(world, fault, Dice(fault.seed, 'text'))} #lot{fault.seed}"] * 2


def _other_text(world: World, fault: Fault) -> list[str]:
    return [f"{text} #lot{fault.seed}" for text in (_same_text(world, fault)[0], _another_text(world, fault))]


def _another_text(world: World, fault: Fault) -> str:
    cell = world.model.cell(fault.target)
    short = ShortForms.of(cell)
    if short is None or len(cell.recipes) > 2:
        return any_text(cell, Dice(fault.seed, "another"))
    return short.plain


def _known_id(world: World, fault: Fault) -> list[str]:
    """The id of one of the cell's tasks, in whatever state that is now; a new id if there is none."""
    known = [f"{task.order.text} #{task.id}" for task in _tasks_of(world, fault.target) if task.order.id]
    return [Dice(fault.seed, "known").pick(known)] if known else _same_id(world, fault)


AGAIN: dict[str, Callable[[World, Fault], list[str]]] = {
    "text": _same_text,
    "id": _same_id,
    "other text": _other_text,
    "known id": _known_id,
}

BAD_TEXTS: dict[str, Callable[[ShortForms], str]] = {
    "nothing": lambda short: "",
    "blanks": lambda short: " \t\n ",
    "a cell": lambda short: short.cell.name,
    "no cell": lambda short: short.plain.replace(short.cell.name, "nobody", 1),
    "no path": lambda short: f"{short.cell.name} ?? 0",
    "no station": lambda short: short.first("999999"),
    "a foreign digit": lambda short: short.first("\uff10"),
    "no such id": lambda short: f"{short.plain} #t-1-1",
    "an empty id": lambda short: f"{short.plain} #",
    "too many words": lambda short: short.first("0", "now"),
    "too long": lambda short: f"{short.plain} " * 100,
    "a control character": lambda short: short.plain.replace(" ", "\x00 ", 1),
}


BAD_NUMBERS = ("a number too high", "a number too low")


def _short(model: PlantModel) -> tuple[str, ...]:
    """The cells whose tasks have a short form."""
    return tuple(cell.name for cell in model.cells if ShortForms.of(cell) is not None)


def _misread(model: PlantModel) -> tuple[str, ...]:
    """Those, and the cells with a recipe that takes a number."""
    short = _short(model)
    counts = (cell.name for cell in model.cells if cell.name not in short and _counting(cell))
    return (*short, *counts)


def _counting(cell: Cell) -> list[Recipe]:
    """The recipes of a cell that take a number within limits."""
    return [each for each in cell.recipes if any(one.limits(cell) for one in each.parameters)]


def _bad_words(model: PlantModel, target: str) -> tuple[str, ...]:
    return tuple(BAD_TEXTS) if target in _short(model) else BAD_NUMBERS


@kind(targets=_misread, words=_bad_words, alike=all_alike)
def bad_task(world: World, fault: Fault) -> None:
    """Somebody asks for a task in words that mean none, or with a number beyond its limits."""
    cell = world.model.cell(fault.target)
    short = ShortForms.of(cell)
    if short is not None and fault.word in BAD_TEXTS:
        world.request_task(BAD_TEXTS[fault.word](short))
    else:
        world.request_task(_beyond(cell, Dice(fault.seed, "beyond"), is_high=fault.word == BAD_NUMBERS[0]))


def _beyond(cell: Cell, dice: Dice, *, is_high: bool) -> str:
    """The text of a task with a number that lies beyond its limits."""
    recipe = dice.pick(_counting(cell))
    words: list[str] = []
    for each in recipe.parameters:
        limits = each.limits(cell)
        end = None if limits is None else limits.upper + 1 if is_high else limits.lower - 1
        words.append(dice.pick(list(each.words(cell))) if end is None else shown(end))
    return " ".join([cell.name, recipe.name, *words])


@kind(targets=_short, weight=0.0)
def flood_of_tasks(world: World, fault: Fault) -> None:
    """Somebody asks for more tasks than a plant remembers, and takes each back; never drawn: it is slow."""
    short = ShortForms.of(world.model.cell(fault.target))
    assert short is not None
    for number in range(HISTORY + SPARE):
        id = f"flood-{fault.seed}-{number}"
        world.request_task(f"{short.plain} #{id}")
        world.request_verb(Verb.CANCEL, id)


KINDS = (*map(_verb, SAID), double_submit, bad_task, flood_of_tasks)
