"""Models of answers, which describe the API, made of the types that the client in Python returns."""

from __future__ import annotations

from dataclasses import MISSING, fields, is_dataclass
from functools import cache
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel, ConfigDict, Field, create_model


class ResponseModel(BaseModel):
    """Answer of the API; more keys may be added to it."""

    model_config = ConfigDict(extra="allow")


def model_of(answer: Any) -> Any:
    """The model of a dataclass of `arboleda.client.answers`, or of a type made of them, as `list[Task]`."""
    if isinstance(answer, type) and is_dataclass(answer):
        return _model(answer)
    of, args = get_origin(answer), get_args(answer)
    if of is Annotated:
        model = model_of(args[0])
        for beside in args[1:]:
            model = Annotated[model, Field(description=beside)] if isinstance(beside, str) else beside
        return model
    inner = tuple(model_of(each) for each in args)
    if of in (Union, UnionType):
        return Union[inner]  # noqa: UP007 - of a tuple
    return of[inner] if of else answer


@cache
def _model(answer: Any) -> type[BaseModel]:
    hints = get_type_hints(answer, include_extras=True)
    made: dict[str, Any] = {}
    for each in fields(answer):
        default = ... if each.default is MISSING else each.default
        default = default if each.default_factory is MISSING else each.default_factory()
        made[each.name] = (model_of(hints[each.name]), Field(default, **each.metadata))
    model: type[BaseModel] = create_model(
        answer.__name__, __base__=ResponseModel, __doc__=answer.__doc__, **made
    )
    return model
