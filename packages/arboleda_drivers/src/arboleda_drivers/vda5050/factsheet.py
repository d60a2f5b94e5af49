"""Factsheet of a vehicle, and what its plant needs that the factsheet does not offer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from arboleda.drivers import Device, Robot

from .orders import as_the_standard_writes
from .settings import Settings
from .state import Body

WHERE = {"NODE": "at a node", "EDGE": "on an edge", "INSTANT": "at once"}


@dataclass(frozen=True, kw_only=True)
class Ability:
    """Action that a vehicle offers: its scopes, and its parameters, each optional or required."""

    scopes: frozenset[str]
    parameters: Mapping[str, bool]


@dataclass(frozen=True, kw_only=True)
class RequiredAction:
    """Action that the plant may need of a vehicle; `by` names its purpose."""

    by: str
    type: str
    scope: str
    parameters: frozenset[str] = frozenset()


@dataclass(frozen=True, kw_only=True)
class Factsheet:
    """Abilities and limits of a vehicle; `most_nodes` of an order and `longest_id` are None if unlimited."""

    actions: Mapping[str, Ability]
    most_nodes: int | None
    longest_id: int | None
    only_digits: bool


def read(body: Body) -> Factsheet:
    """The factsheet in a message that fits the schema of its version."""
    limits, features = body["protocolLimits"], body["protocolFeatures"]
    strings = limits.get("maxStringLens") or limits.get("maximumStringLengths") or {}
    arrays = limits.get("maxArrayLens") or limits.get("maximumArrayLengths") or {}
    edges = arrays.get("order.edges")
    nodes = [most for most in (arrays.get("order.nodes"), edges and edges + 1) if most]  # 0 is no limit
    actions = features.get("agvActions") or features.get("mobileRobotActions") or ()
    return Factsheet(
        actions={each["actionType"]: _ability(each) for each in actions},
        most_nodes=min(nodes, default=None),
        longest_id=strings.get("idLen") or strings.get("maximumIdLength") or None,
        only_digits=strings.get("idNumericalOnly", False),
    )


def _ability(action: Body) -> Ability:
    parameters = {each["key"]: each.get("isOptional", False) for each in action.get("actionParameters", ())}
    return Ability(scopes=frozenset(action["actionScopes"]), parameters=parameters)


def wanted(devices: Iterable[Robot], settings: Settings) -> Iterator[RequiredAction]:
    """All actions that a vehicle with these devices may be given."""
    for type in ("cancelOrder", "startPause", "stopPause"):
        yield RequiredAction(by="stops", type=type, scope="INSTANT")
    for edge in settings.edges:
        by = f"the edge between {' and '.join(edge.between)}"
        yield _wanted(by, edge.action, edge.values, "EDGE")
    for device in devices:
        for verb in device.kind.verbs.values() if isinstance(device, Device) else ():
            scope = "INSTANT" if verb.name in settings.instant else "NODE"
            yield _wanted(f"{device.name} {verb.name}", verb.name, dict(verb.parameters), scope)


def _wanted(by: str, verb: str, values: Iterable[str], scope: str) -> RequiredAction:
    named = frozenset(map(as_the_standard_writes, values))
    return RequiredAction(by=by, type=as_the_standard_writes(verb), scope=scope, parameters=named)


def lacks(sheet: Factsheet, wanted: Iterable[RequiredAction], ids: Iterable[str]) -> Iterator[str]:
    """A sentence on each action or limit that the vehicle does not meet; `ids` are the plant's."""
    for each in wanted:
        yield from _lacks_for(each, sheet)
    longest = max(ids, key=len)
    if sheet.longest_id is not None and len(longest) > sheet.longest_id:
        yield f"its ids may have {sheet.longest_id} characters; {longest} has {len(longest)}"
    if sheet.only_digits:
        yield f"its ids may only have digits; {longest} has more"
    if sheet.most_nodes == 1:
        yield "its orders may have one node, so it cannot be sent to another"


def _lacks_for(wanted: RequiredAction, sheet: Factsheet) -> Iterator[str]:
    ability = sheet.actions.get(wanted.type)
    where = WHERE[wanted.scope]
    if ability is None or wanted.scope not in ability.scopes:
        there = ", ".join(name for name, each in sheet.actions.items() if wanted.scope in each.scopes)
        yield f"it has no action {wanted.type} {where}, which is for {wanted.by}; it has {there or 'none'}"
        return
    needed = [name for name, can_do_without in ability.parameters.items() if not can_do_without]
    for name in sorted({*needed} - wanted.parameters):
        yield f"its action {wanted.type} needs a value {name}, which {wanted.by} does not give"
    for name in sorted(wanted.parameters - {*ability.parameters}):
        there = ", ".join(ability.parameters) or "none"
        yield f"its action {wanted.type} has no value {name}, which {wanted.by} gives; it has {there}"
