"""Trees and models as text, in the form of BehaviorTree.CPP 4."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape

from .nodes import Kind, Port

INDENT = "  "
SPELLED = {
    "string": "std::string",
    "unsigned": "unsigned int",
    "msec": "unsigned int",
    "status": "BT::NodeStatus",
}


@dataclass(frozen=True)
class Tag:
    """Element to be written; `text` is its content in the place of children."""

    name: str
    attributes: Mapping[str, str] = field(default_factory=dict)
    children: Sequence[Tag] = ()
    text: str = ""


def document(children: Sequence[Tag], **attributes: str) -> str:
    """The text of a whole file."""
    root = Tag("root", {"BTCPP_format": "4", **attributes}, children)
    return "\n".join(['<?xml version="1.0" encoding="UTF-8"?>', *_lines(root, 0), ""])


def models(kinds: Iterable[Kind]) -> Tag:
    """The TreeNodesModel of these kinds, as an editor needs it."""
    return Tag("TreeNodesModel", children=[_model(each) for each in kinds])


def _model(kind: Kind) -> Tag:
    ports = [_port(each) for each in (kind.ports or {}).values()]
    return Tag(kind.category.value, {"ID": kind.name}, ports)


def _port(port: Port) -> Tag:
    attributes = {"name": port.name}
    if port.type:
        attributes["type"] = SPELLED.get(port.type, port.type)
    if port.default is not None:
        attributes["default"] = port.default
    words = f": {', '.join(port.words)}" if port.words and port.words != tuple(port.about.split(", ")) else ""
    return Tag(port.direction.value, attributes, text=f"{port.about}{words}")


def _lines(tag: Tag, depth: int) -> list[str]:
    margin = INDENT * depth
    head = " ".join(
        [tag.name, *(f'{name}="{attribute_value(value)}"' for name, value in tag.attributes.items())]
    )
    if tag.children:
        inner = [line for child in tag.children for line in _lines(child, depth + 1)]
        return [f"{margin}<{head}>", *inner, f"{margin}</{tag.name}>"]
    if tag.text:
        return [f"{margin}<{head}>{escape(tag.text, quote=False)}</{tag.name}>"]
    return [f"{margin}<{head}/>"]


def attribute_value(text: str) -> str:
    """A value as an attribute. Line ends become references: a reader turns raw ones into blanks."""
    return escape(text).replace("&#x27;", "'").replace("\n", "&#10;").replace("\t", "&#9;")
