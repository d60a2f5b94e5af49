"""Runs benchmarks one after the other and shows what they found."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from datetime import datetime
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.text import Text

from arboleda.extension import ArboledaError
from arboleda.model.errors import ConfigError
from arboleda.plant_file.user_file import check_writable
from arboleda_proofs.campaigns.screen import console, progress

from . import catalog, report
from .report import Run
from .result import Result
from .revision import revision
from .scene import Scene

DONE, FAILED, INTERRUPTED = 0, 1, 130


def run(names: Sequence[str], *, quick: bool, file: Path | None, listed: bool) -> int:
    """Run the named benchmarks, or all of them; the figures go to the screen and to `file`.

    Returns the exit status; raises ConfigError for an unknown name, or a file that cannot be written.
    """
    screen = console()
    if listed:
        for name in catalog.NAMES:
            screen.print(Text(f"{name:<10} {catalog.about(name)}"), soft_wrap=True)
        return DONE
    _check(names, file)
    try:
        return _all(names or catalog.NAMES, screen, quick, file)
    except KeyboardInterrupt:
        screen.print("interrupted; what was measured so far is above")
        return INTERRUPTED


def _all(names: Sequence[str], screen: Console, quick: bool, file: Path | None) -> int:
    """Run all, also if one of them lacks something; return the exit status."""
    runs: list[Run] = []
    for name in names:
        began, load = datetime.now().astimezone(), os.getloadavg()[0]
        try:
            result = _one(name, screen, quick)
        except ArboledaError as error:
            outcome: Result | str = str(error)
            screen.print(Text(f"{name} was not measured: {error}\n", style="red"), soft_wrap=True)
        else:
            outcome = result
            _show(name, result, screen)
        runs.append(Run(name=name, began=began, load=load, revision=revision(), outcome=outcome))
        if file is not None:
            _write(file, report.as_json(runs, quick=quick))
    return FAILED if any(isinstance(each.outcome, str) for each in runs) else DONE


def _one(name: str, screen: Console, quick: bool) -> Result:
    bench = catalog.module(name)
    with progress(screen, name, None) as show, Scene(quick=quick, say=lambda said: show(said, 0)) as scene:
        result: Result = bench.run(scene)
        return result


def _show(name: str, result: Result, screen: Console) -> None:
    screen.print(Text.assemble((name, "bold"), f": {catalog.about(name)}"), soft_wrap=True)
    screen.print(report.table(result))
    for line in result.notes:
        screen.print(Text(line, style="dim"), soft_wrap=True)
    screen.print()


def _check(names: Sequence[str], file: Path | None) -> None:
    unknown = [name for name in names if name not in catalog.NAMES]
    for name in unknown:
        near = get_close_matches(name, catalog.NAMES, 1)
        meant = f" (did you mean {near[0]}?)" if near else ""
        raise ConfigError((f"there is no benchmark '{name}'{meant}; there are {', '.join(catalog.NAMES)}",))
    if file is not None:
        check_writable(file)


def _write(file: Path, content: dict[str, Any]) -> None:
    try:
        file.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
    except OSError as error:
        raise ConfigError((f"{file}: cannot be written: {error.strerror}",)) from None
