"""People and programs that have asked a plant for something, and wait for its answer."""

from __future__ import annotations

from concurrent.futures import Future
from typing import Any
from uuid import uuid4

from arboleda.store.task_rows import ROS


class Askers:
    """Whoever waits for an answer, by the id of the request."""

    def __init__(self) -> None:
        self._waiting: dict[str, Future[Any]] = {}
        self._ways: dict[str, str] = {}

    def expect(self, way: str = ROS) -> tuple[Future[Any], str]:
        """A future, and the id of the request whose answer it will hold; the request comes by `way`."""
        answer, request_id = Future[Any](), uuid4().hex
        self._waiting[request_id], self._ways[request_id] = answer, way
        return answer, request_id

    def way_of(self, request_id: str | None) -> str:
        """The way by which a request came; that of ROS 2 if nobody here waits for its answer."""
        return self._ways.get(request_id or "", ROS)

    def answer(self, request_id: str | None, reply: Any) -> None:
        """Give whoever waits his answer, or the error for which there is none."""
        self._ways.pop(request_id or "", None)
        waiting = self._waiting.pop(request_id or "", None)
        if waiting is None:
            return
        if isinstance(reply, Exception):
            waiting.set_exception(reply)
        else:
            waiting.set_result(reply)
