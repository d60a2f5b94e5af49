"""Query parameters and bodies of routes: read as a model, and described for the API."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from fastapi import Request
from pydantic import BaseModel, ValidationError

from arboleda.model.errors import PayloadError
from arboleda.model.outside import quoted

from .answers import model_of
from .bodies import Sentence
from .openapi import SHAPES, described_later

Query = TypeVar("Query", bound=BaseModel)
Answers = dict[int | str, dict[str, Any]]
Taken = Callable[[], dict[str, Any]]
WRONG: Answers = {422: {"model": Sentence, "description": "The request is wrong."}}


def answering(answer: Any, others: Answers | None = None, takes: Taken | None = None) -> dict[str, Any]:
    """The description of a route, for its decorator: the type of its answer, None for text, its other
    answers, and the query or body that it takes, by `described` or `described_body`.

    It is made once somebody reads the description of the API.
    """
    return described_later(
        lambda: {
            "response_model": None if answer is None else model_of(answer),
            "responses": {status: _modelled(each) for status, each in (others or {}).items()},
            "openapi_extra": takes and takes(),
        }
    )


def _modelled(answer: dict[str, Any]) -> dict[str, Any]:
    return {**answer, "model": model_of(answer["model"])} if "model" in answer else answer


def query_of(request: Request, model: type[Query]) -> Query:
    """The query parameters as `model`; raises PayloadError, which names the first wrong one."""
    try:
        return model.model_validate(dict(request.query_params))
    except ValidationError as error:
        found = error.errors(include_url=False, include_context=False)[0]
        if found["type"] == "extra_forbidden":
            name = quoted(str(found["loc"][0]), 80)
            raise PayloadError(
                f"{name} is nothing to ask for; there are {', '.join(model.model_fields)}."
            ) from None
        raise wrong_parameter(found) from None


def wrong_parameter(found: Mapping[str, Any]) -> PayloadError:
    """The refusal of a part of an address, by what pydantic found wrong with it."""
    if found["type"] == "json_invalid":
        why, at = _begun(found["ctx"]["error"]), found["loc"][-1]
        return PayloadError(f"The body is no JSON: {why}, at character {at}.")
    name = quoted(str(found["loc"][-1]), 80)
    if found["type"] == "missing":
        return PayloadError(f"{name} is missing; /api/docs says what to give.")
    return PayloadError(f"{name} is {quoted(str(found['input']), 80)}: {_begun(found['msg'])}.")


def text_answer(media_type: str, about: str) -> Answers:
    """The OpenAPI description of an answer that is text of a type."""
    return {200: {"description": about, "content": {media_type: {"schema": {"type": "string"}}}}}


def described(model: type[BaseModel]) -> Taken:
    """The function that makes the OpenAPI description of the query parameters of `model`."""

    def made() -> dict[str, Any]:
        properties = model.model_json_schema()["properties"]
        rows = [{"name": name, "in": "query", "schema": each} for name, each in properties.items()]
        return {"parameters": rows}

    return made


def read_body(body: bytes, model: type[Query]) -> Query:
    """A body as `model`; raises PayloadError, which names the first wrong key."""
    try:
        return model.model_validate_json(body)
    except ValidationError as error:
        found = error.errors(include_url=False, include_context=False, include_input=False)[0]
        name = quoted(".".join(map(str, found["loc"])) or "the body", 80)
        raise PayloadError(f"{name}: {_begun(found['msg'])}; /api/docs says what is allowed.") from None


def described_body(*models: type[BaseModel], required: bool = True) -> Taken:
    """The function that makes the OpenAPI description of a body that is one of these models."""

    def made() -> dict[str, Any]:
        schemas = [model.model_json_schema(ref_template=f"{SHAPES}{{model}}") for model in models]
        schema = schemas[0] if len(schemas) == 1 else {"anyOf": schemas}
        return {"requestBody": {"content": {"application/json": {"schema": schema}}, "required": required}}

    return made


def _begun(sentence: str) -> str:
    """A sentence as it stands behind a colon; what it quotes, such as a pattern, stays as it is."""
    return sentence[:1].lower() + sentence[1:]
