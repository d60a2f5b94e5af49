"""Requests and answers about trees as XML: a text with a cell, and operations on it."""

from __future__ import annotations

from dataclasses import MISSING, Field, fields
from typing import Annotated, Any, Literal, Union, get_type_hints

from pydantic import BaseModel, create_model
from pydantic import Field as Described

from arboleda.web.schema.bodies import BodyModel
from arboleda_make.editing import operations
from arboleda_make.editing.operations import NewNode, Operation

OPERATIONS: dict[str, type] = {
    "insert": operations.Insert,
    "move": operations.Move,
    "remove": operations.Remove,
    "replace": operations.Replace,
    "wrap": operations.Wrap,
    "unwrap": operations.Unwrap,
    "set_attribute": operations.SetAttribute,
    "add_tree": operations.AddTree,
    "remove_tree": operations.RemoveTree,
    "rename_tree": operations.RenameTree,
    "extract": operations.Extract,
    "set_parameter": operations.SetParameter,
    "remove_parameter": operations.RemoveParameter,
}


class TreeForm(BodyModel):
    """Text of a file of trees, looked at for a cell."""

    cell: str = Described(description="The cell whose devices and targets its nodes are checked against.")
    text: str = Described(description="The whole file.")


class CopyForm(BodyModel):
    """Recipe in Python of a cell, and the name of its copy as a tree."""

    cell: str
    recipe: str
    name: str = Described(pattern="^[a-z][a-z0-9_]{0,39}$")


def _default(field: Field[Any]) -> Any:
    if field.default is not MISSING:
        return field.default
    return ... if field.default_factory is MISSING else {}


def _form(name: str, shape: type, **more: Any) -> type[BaseModel]:
    """The model of a request for a dataclass of operations."""
    hints = get_type_hints(shape)
    known: dict[str, Any] = {each.name: (_typed(hints[each.name]), _default(each)) for each in fields(shape)}
    form: type[BaseModel] = create_model(name, __base__=BodyModel, __doc__=shape.__doc__, **more, **known)
    return form


def _typed(hint: Any) -> Any:
    if hint is NewNode:
        return NODE
    return dict[str, str] if getattr(hint, "__args__", ()) == (str, str) else hint


NODE: Any = None
NODE = _form("NewNode", NewNode)
FORMS = {do: _form(each.__name__, each, do=(Literal[do], ...)) for do, each in OPERATIONS.items()}
AnyForm: Any = Annotated[Union[tuple(FORMS.values())], Described(discriminator="do")]  # noqa: UP007 - of a tuple
EditForm: Any = create_model("EditForm", __base__=TreeForm, operation=(AnyForm, ...))


def operation_of(form: BaseModel) -> Operation:
    """The operation that a request names."""
    data = form.model_dump()
    if "node" in data:
        data["node"] = NewNode(**data["node"])
    made: Operation = OPERATIONS[data.pop("do")](**data)
    return made
