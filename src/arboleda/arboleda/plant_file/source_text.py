"""Source of a plant's recipes as one hash, which layout, comments and the version of Python do not change."""

from __future__ import annotations

import ast
import os
from collections.abc import Iterator, Mapping
from hashlib import blake2b
from pathlib import Path

PYTHON, TREES = ".py", ".xml"
LAYOUT = frozenset({"ctx", "kind", "type_comment"})  # fields that follow from others, or mean nothing


def source_of(files: Mapping[Path, bytes], folder: Path | None) -> str:
    """The hash of the Python and the trees among the files, by their paths from the plant's folder."""
    digest = blake2b(digest_size=16)
    named = {_name(path, folder): content for path, content in files.items()}
    for name in sorted(name for name in named if name.endswith((PYTHON, TREES))):
        digest.update(name.encode("utf-8", "replace"))
        words = _of_python(named[name]) if name.endswith(PYTHON) else named[name]
        digest.update(words)
    return digest.hexdigest()


def _name(path: Path, folder: Path | None) -> str:
    return str(path) if folder is None else os.path.relpath(path, folder.absolute())


def _of_python(content: bytes) -> bytes:
    """The words of a file; its whole content where it is no Python, which its import reports."""
    try:
        return "\n".join(_words(ast.parse(content))).encode("utf-8", "surrogatepass")
    except (SyntaxError, ValueError, RecursionError):
        return content


def _words(node: ast.AST) -> Iterator[str]:
    """The words of a node and of all below it. An empty field has none: not each Python has each field."""
    yield type(node).__name__
    for name, value in ast.iter_fields(node):
        parts = value if isinstance(value, list) else [value]
        if name in LAYOUT or not any(part is not None for part in parts):
            continue
        yield f"{name}="
        for part in parts:
            if isinstance(part, ast.AST):
                yield from _words(part)
            else:
                yield repr(part)
    yield "."
