"""Firefox without a window, told what to do over WebDriver BiDi, which it speaks by itself.

Playwright drives a Firefox of its own making alone, and geckodriver is in no registry that tests use.
"""

from __future__ import annotations

import json
import re
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

from .patience import LONG_S, PATIENCE_S

LISTENING = re.compile(r"WebDriver BiDi listening on (ws://\S+)")
OPTIONS = "--headless", "--no-remote", "--remote-debugging-port", "0"
# A first start shows pages of its own, and asks its maker for news.
PREFERENCES = {
    "browser.aboutwelcome.enabled": False,
    "browser.shell.checkDefaultBrowser": False,
    "browser.startup.page": 0,
    "datareporting.policy.dataSubmissionEnabled": False,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
    "app.update.enabled": False,
    "extensions.update.enabled": False,
    "services.settings.server": "data:,",
}


class Trouble(Exception):
    """What Firefox refused, or what a script in the page threw."""


class Page:
    """A tab: an address, and scripts in it."""

    def __init__(self, link: ClientConnection) -> None:
        self._link = link
        self._number = 0
        self.asked: list[str] = []  # addresses that the page asked for
        self._command("session.new", capabilities={})
        self._command("session.subscribe", events=["network.beforeRequestSent"])
        self._tab = self._command("browsingContext.getTree")["contexts"][0]["context"]

    def goto(self, address: str) -> None:
        self._command("browsingContext.navigate", context=self._tab, url=address, wait="complete")

    def view(self, width: int, height: int) -> None:
        """Make the page as large as a screen."""
        size = {"width": width, "height": height}
        self._command("browsingContext.setViewport", context=self._tab, viewport=size)

    def evaluate(self, script: str, *arguments: Any) -> Any:
        """What an expression comes to, or a function of these arguments; both may be promises."""
        call = f"(async () => JSON.stringify(await ({script})(...{json.dumps(arguments)})))()"
        plain = f"(async () => JSON.stringify(await ({script})))()"
        found = self._command(
            "script.evaluate",
            expression=call if arguments else plain,
            target={"context": self._tab},
            awaitPromise=True,
        )
        if found["type"] == "exception":
            raise Trouble(found["exceptionDetails"]["text"])
        return json.loads(found["result"].get("value", "null"))

    def wait_for(self, condition: str) -> None:
        """Wait until an expression is true in the page."""
        self.evaluate(
            f"new Promise(done => {{ const look = () => ({condition}) ? done(true) : setTimeout(look, 50);"
            " look(); })"
        )

    def click(self, selector: str) -> None:
        """Press an element once it is there and can be pressed."""
        self.wait_for(f"document.querySelector({json.dumps(selector)})?.matches(':enabled, :not(button)')")
        self.evaluate("selector => { document.querySelector(selector).click(); }", selector)

    def _command(self, method: str, **parameters: Any) -> Any:
        self._number += 1
        self._link.send(json.dumps({"id": self._number, "method": method, "params": parameters}))
        while True:
            said = json.loads(self._link.recv(timeout=LONG_S))
            if said.get("method") == "network.beforeRequestSent":
                self.asked.append(said["params"]["request"]["url"])
            if said.get("id") == self._number:
                break
        if said["type"] == "error":
            raise Trouble(f"{method}: {said['message']}")
        return said["result"]


@contextmanager
def firefox(command: str, profile: Path) -> Iterator[Page]:
    """A page of a Firefox with a profile of its own, which ends with it."""
    lines = (f"user_pref({json.dumps(name)}, {json.dumps(value)});" for name, value in PREFERENCES.items())
    (profile / "user.js").write_text("\n".join(lines))
    with (profile / "log").open("w+") as log:
        started = [command, *OPTIONS, "--profile", str(profile)]
        process = subprocess.Popen(started, stdout=subprocess.DEVNULL, stderr=log)
        try:
            with connect(f"{_address(process, profile / 'log')}/session", max_size=None) as link:
                yield Page(link)
        finally:
            process.terminate()
            process.wait(PATIENCE_S)


def _address(process: subprocess.Popen[bytes], log: Path) -> str:
    """Where a Firefox listens, once it says so."""
    ends = time.monotonic() + PATIENCE_S
    while (found := LISTENING.search(log.read_text())) is None:
        assert process.poll() is None, log.read_text()
        assert time.monotonic() < ends, "it does not listen"
        time.sleep(0.05)
    return found[1]
