"""Files that leave the tab or come into it: zips of a person's texts, as base64."""

from __future__ import annotations

import base64
import io
import zipfile
from collections.abc import Iterable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from arboleda.extension import ArboledaError
from arboleda_class.exercises.work import LARGEST, MOST, Work, packed, zip_name

from .building import Texts


def handed_in(exercise: str, student: str, texts: Texts) -> dict[str, Any]:
    """The work as `arboleda exercise pack` writes it: {name, data}; ConfigError without a student's name."""
    files = {name: text.encode() for name, text in texts.items()}
    work = Work(where=Path(exercise), exercise=exercise, student=student, files=files)
    name = zip_name(work)
    with TemporaryDirectory(prefix="arboleda-") as made:
        file = Path(made, name)
        packed(work, file)
        return {"name": name, "data": base64.b64encode(file.read_bytes()).decode()}


def zipped(name: str, texts: Texts) -> dict[str, Any]:
    """The texts as a zip: {name, data}."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as pack:
        for file, text in texts.items():
            pack.writestr(f"{name}/{file}", text)
    return {"name": f"{name}.zip", "data": base64.b64encode(content.getvalue()).decode()}


def unzipped(data: str, known: Iterable[str]) -> dict[str, str]:
    """The texts of a zip whose names, below any folder, are among the known ones; ArboledaError."""
    found = {}
    try:
        with zipfile.ZipFile(io.BytesIO(base64.b64decode(data))) as pack:
            for each in pack.infolist()[:MOST]:
                name = next((name for name in known if f"/{each.filename}".endswith(f"/{name}")), None)
                if name is not None and each.file_size <= LARGEST:
                    with pack.open(each) as member:
                        found[name] = member.read(LARGEST).decode("utf-8")
    except (ValueError, RuntimeError, NotImplementedError, EOFError, zipfile.BadZipFile) as error:
        raise ArboledaError(f"the zip cannot be read: {error}") from error
    if not found:
        raise ArboledaError(f"the zip has none of the files that are here: {', '.join(known)}")
    return found
