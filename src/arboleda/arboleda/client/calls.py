"""Calls: methods that both clients have, declared once. On one that blocks they return the result, on one of
asyncio something to await."""

from __future__ import annotations

import inspect
import re
from collections.abc import AsyncGenerator, AsyncIterator, Callable, Coroutine, Iterator
from functools import update_wrapper, wraps
from typing import Any, Concatenate, Generic, ParamSpec, TypeVar, get_origin, overload

from .errors import NoAnswer
from .http import TIMEOUT_S, at_once, each_at_once
from .line import Call, Line, path_of
from .reading import read

P = ParamSpec("P")
Result = TypeVar("Result")
Item = TypeVar("Item")
MODULES = re.compile(r"\b[a-z_]+(\.[a-z_]+)*\.(?=[A-Z])")  # before the name of a class


class Routes:
    """Routes of a plant as methods, each declared by `route`; `of` is the plant, or a line to one."""

    def __init__(self, of: Routes | Line) -> None:
        self._line: Line = of._line if isinstance(of, Routes) else of


class Blocking(Routes):
    """Routes whose methods return results: those of a Plant."""


class Awaiting(Routes):
    """Routes whose methods return something to await: those of an AsyncPlant."""


class Flow(Generic[P, Result]):
    """Method that asks a plant, perhaps several times; `routes` are those that it uses."""

    def __init__(
        self, work: Callable[Concatenate[Any, P], Coroutine[Any, Any, Result]], routes: tuple[str, ...] = ()
    ) -> None:
        self.work = work
        self.routes = routes
        self.__doc__ = work.__doc__

    @overload
    def __get__(self, side: None, owner: type) -> Flow[P, Result]: ...

    @overload
    def __get__(self, side: Blocking, owner: type) -> Callable[P, Result]: ...

    @overload
    def __get__(self, side: Awaiting, owner: type) -> Callable[P, Coroutine[Any, Any, Result]]: ...

    def __get__(self, side: Routes | None, owner: type) -> Any:
        if side is None:
            return self

        def call(*args: P.args, **named: P.kwargs) -> Any:
            work = self.work(side, *args, **named)
            return at_once(work) if isinstance(side, Blocking) else work

        return update_wrapper(call, self.work)


class Following(Generic[P, Item]):
    """Method that gives items as they come: an iterator, or one of asyncio."""

    def __init__(self, work: Callable[Concatenate[Any, P], AsyncGenerator[Item, None]], route: str) -> None:
        self.work = work
        self.routes = (route,)
        self.__doc__ = work.__doc__

    @overload
    def __get__(self, side: None, owner: type) -> Following[P, Item]: ...

    @overload
    def __get__(self, side: Blocking, owner: type) -> Callable[P, Iterator[Item]]: ...

    @overload
    def __get__(self, side: Awaiting, owner: type) -> Callable[P, AsyncIterator[Item]]: ...

    def __get__(self, side: Routes | None, owner: type) -> Any:
        if side is None:
            return self

        def call(*args: P.args, **named: P.kwargs) -> Any:
            items = self.work(side, *args, **named)
            return each_at_once(items) if isinstance(side, Blocking) else items

        return update_wrapper(call, self.work)


class Route(Flow[P, Result]):
    """Method that is one route of the API: what it is given goes into its path, query or body by name, and
    what it is not given is left to the plant."""

    def __init__(
        self,
        method: str,
        path: str,
        answer: type[Result],
        declared: Callable[Concatenate[Any, P], None],
        within_s: float,
    ) -> None:
        self.method, self.path, self.answer, self.within_s = method, path, answer, within_s
        self._signature = inspect.signature(declared)

        @wraps(declared)
        async def work(side: Routes, /, *args: Any, **named: Any) -> Any:
            call = self.call(side, *args, **named)
            if answer is str:
                return (await side._line.reply(call)).text
            return read_answer(answer, await side._line.data(call))

        returned = getattr(answer, "__name__", str(answer)) if get_origin(answer) is None else str(answer)
        shown = self._signature.replace(return_annotation=MODULES.sub("", returned))
        vars(work)["__signature__"] = shown  # for `help` and the reference
        super().__init__(work, (f"{method} {path}",))

    @property
    def parameters(self) -> list[str]:
        """The names of what it is given."""
        return list(self._signature.parameters)[1:]

    def call(self, side: Routes, *args: Any, **named: Any) -> Call:
        """The request of a client for these arguments."""
        given = dict(list(self._signature.bind(None, *args, **named).arguments.items())[1:])
        in_path = {name: given.pop(name) for name in list(given) if f"{{{name}}}" in self.path}
        reads = self.method == "GET"
        takes_body = not reads and len(self.parameters) > len(in_path)
        return Call(
            method=self.method,
            path=path_of(self.path, in_path),
            query=given if reads else {},
            body=given if takes_body else None,
            is_repeatable=reads,
            within_s=self.within_s,
        )


def read_answer(wanted: type[Result], data: Any) -> Result:
    """An answer as its type; NoAnswer for one that no plant would give."""
    try:
        answer: Result = read(wanted, data)
        return answer
    except ValueError as error:
        sentence = f"What answers is no plant, or one of another version: {error}."
        raise NoAnswer(sentence, may_have_heard=True) from error


def route(
    method: str, path: str, answer: type[Result], *, within_s: float = TIMEOUT_S
) -> Callable[[Callable[Concatenate[Any, P], None]], Route[P, Result]]:
    """Decorator that makes a method of a route, as of `route("GET", "/api/orders/{number}", Order)`; the
    function only declares what it takes. `answer` is a frozen dataclass or a type made of such."""
    return lambda declared: Route(method, path, answer, declared, within_s)


def flow(
    *routes: str,
) -> Callable[[Callable[Concatenate[Any, P], Coroutine[Any, Any, Result]]], Flow[P, Result]]:
    """Decorator that makes a method of a coroutine."""
    return lambda work: Flow(work, routes)


def following(
    route: str,
) -> Callable[[Callable[Concatenate[Any, P], AsyncGenerator[Item, None]]], Following[P, Item]]:
    """Decorator that makes a method of an asynchronous generator."""
    return lambda work: Following(work, route)
