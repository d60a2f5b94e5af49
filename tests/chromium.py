"""A chromium that shows nothing on a screen, and makes no more of a window than its page."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from .patience import PATIENCE_MS

# What each window makes beforehand though nobody sees it: the suggestions below its address bar, as pages of
# their own, and a process for the page that may come next. Together they are more work than the page itself.
IN_VAIN = ("WebUIOmniboxPopup", "WebUIOmniboxAimPopup", "SpareRendererForSitePerProcess")
# Of two such lists chromium takes the last, so this one has to hold what Playwright switches off, too.
BY_PLAYWRIGHT = (
    "AvoidUnnecessaryBeforeUnloadCheckSync",
    "DestroyProfileOnBrowserClose",
    "HttpsUpgrades",
    "HttpsFirstBalancedModeAutoEnable",
    "LensOverlay",
    "MediaRouter",
    "PaintHolding",
    "ThirdPartyStoragePartitioning",
    "AvoidCorsURLLoaderRestartOnRedirect",
    "OptimizationHints",
    "NetworkTimeServiceQuerying",
    "AimEnabled",
    "PreconnectToSearch",
)
# In software, each picture of the twin takes a core a twentieth of a second: no more than a few in a second.
FEW_FRAMES = """
window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 150);
window.cancelAnimationFrame = clearTimeout;
"""


# Started by root, chromium puts itself before all others, and the plants beside it get no processor.
HUMBLE = """#!/bin/sh
exec setpriv --bounding-set -sys_nice --inh-caps -sys_nice chromium "$@"
"""


@contextmanager
def browsers() -> Iterator[Any]:
    """`launch(*options)`: a browser; all of them are closed at the end."""
    from playwright.sync_api import sync_playwright

    without = f"--disable-features={','.join(BY_PLAYWRIGHT + IN_VAIN)}"
    with TemporaryDirectory() as folder, sync_playwright() as playwright:
        program = _program(Path(folder))

        def launch(*options: str) -> Any:
            return playwright.chromium.launch(
                executable_path=program, args=["--no-sandbox", without, *options]
            )

        yield launch


def _program(folder: Path) -> str | None:
    """The program that starts a chromium: by root, one that cannot have a higher priority."""
    if os.geteuid() != 0 or shutil.which("chromium") is None or shutil.which("setpriv") is None:
        return shutil.which("chromium")
    script = folder / "chromium"
    script.write_text(HUMBLE)
    script.chmod(0o755)
    return str(script)


def leave(context: Any) -> None:
    """Close the pages of a context, which itself goes with its browser.

    Now and then chromium never answers who asks it to dispose of a context, and nothing ends such a wait.
    """
    for page in context.pages:
        page.close()


@contextmanager
def people(browser: Any) -> Iterator[Callable[..., Any]]:
    """`new(**context)`: an empty page of one more person; a script that fails fails the test."""
    troubles: list[str] = []
    with ExitStack() as opened:

        def new(**context: Any) -> Any:
            made = browser.new_context(**context)
            opened.callback(leave, made)
            page = made.new_page()
            page.set_default_timeout(PATIENCE_MS)
            page.on("pageerror", lambda error: troubles.append(f"{error} {error.stack}"))
            return page

        yield new
    assert troubles == []
