"""The HTTP API as a part."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from arboleda.adapters.web import Api, Operate
from arboleda.core import view
from arboleda.core.messages import TaskChanged


class WebPart:
    """Listens on any free port of this machine, and has it announced."""

    def __init__(
        self,
        snapshot: Callable[[], dict[str, Any]],
        find: Callable[[str], dict[str, Any] | None],
        submit: Callable[[str], Future[TaskChanged]],
        operate: Operate,
        announce: Callable[[int], None],
    ) -> None:
        self.port = 0
        self._announce = announce
        self._api = Api(snapshot, find, lambda text: _plain(submit(text)), operate)

    def start(self) -> None:
        self.port = self._api.start()
        self._announce(self.port)

    def stop(self) -> None:
        self._api.stop()


def _plain(answer: Future[TaskChanged]) -> Future[dict[str, Any]]:
    plain: Future[dict[str, Any]] = Future()
    answer.add_done_callback(lambda known: plain.set_result(view.change(known.result())))
    return plain
