"""Process beside a plant: a request about a draft on its input, lines of JSON on its output."""

from __future__ import annotations

import json
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from arboleda.extension import ArboledaError, ConfigError
from arboleda.host.limits import give_way
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import in_json
from arboleda.plant_file import loader
from arboleda.plant_file.draft import Shade, shaded

KINDNESS = 10  # that of `nice`: whatever the plant does comes first


@dataclass(frozen=True, kw_only=True)
class Errand:
    """Errand: what is to be done with a draft that stands in `shade`; results go into `folder`."""

    shade: Shade
    folder: Path
    wanted: dict[str, Any]

    def plant(self) -> tuple[PlantModel, PlantFiles]:
        """The draft as a plant, and the files that were read for it; ArboledaError with all its problems."""
        try:
            return loader.load_with_files(self.shade.plant_file)
        except ConfigError as error:
            raise ArboledaError("\n".join(map(self.shade.shortened, error.problems))) from None


def say(**what: Any) -> None:
    """Tell the plant something: how far it is, or the sentence why there is no result."""
    print(json.dumps(what), file=sys.__stdout__, flush=True)


@contextmanager
def errand() -> Iterator[Errand]:
    """The errand on the input; where it cannot be done, the reason is said."""
    give_way(KINDNESS)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the plant, and that ends this
    request = json.load(sys.stdin)
    sys.stdout = sys.stderr  # what a plant's Python prints is no answer
    files = PlantFiles(
        plant=request["plant"],
        contents={name: text.encode("utf-8", "surrogateescape") for name, text in request["files"].items()},
    )
    try:
        with shaded(files, Path(request["plant_file"])) as shade:
            yield Errand(shade=shade, folder=Path(request["folder"]), wanted=request["wanted"])
            say(ended=True)
    except ArboledaError as error:
        say(failed=str(error))


def write(file: Path, what: Any) -> None:
    """Write plain data, whole or not at all."""
    fresh = file.with_suffix(".new")
    fresh.write_text(json.dumps(what, ensure_ascii=False, default=in_json), "utf-8")
    fresh.replace(file)
