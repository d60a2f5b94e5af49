"""No module of Arboleda needs at its import what Linux alone has; only `host/` asks which system this is."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from tests.packages import PACKAGES

from ..lesser_host import NOWHERE, OF_UNIX

TESTS = Path(__file__).parents[1]
PACKAGE = TESTS.parent / "src/arboleda/arboleda"
ROOTS = (PACKAGE, PACKAGES["arboleda_proofs"], PACKAGES["arboleda_make"])
HOST = PACKAGE / "host"
GUARDED = {  # not reached where there are none
    "adapters/clock.py: time.clock_gettime",
    "campaigns/proof/forks.py: os.fork",
}
NAMES = {f"{module.__name__}.{name}" for module, names in NOWHERE["win32"].items() for name in names.split()}
ASKS = {"sys.platform", "os.name"}
NAMED = re.compile(  # in the text of each module that uses one of them
    "|".join([*OF_UNIX, *(r"\b\s*\.\s*".join(map(re.escape, each.split("."))) for each in NAMES | ASKS)])
)


def uses_of_unix(path: Path) -> Iterator[str]:
    text = path.read_text(encoding="utf-8")
    if not NAMED.search(text):
        return
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in OF_UNIX)
        elif isinstance(node, ast.ImportFrom) and node.module in OF_UNIX:
            yield str(node.module)
        elif isinstance(node, ast.Attribute) and ast.unparse(node) in NAMES | ASKS:
            yield ast.unparse(node)


def test_what_not_every_system_has_stands_in_one_place() -> None:
    files = [(root, path) for root in ROOTS for path in root.rglob("*.py") if HOST not in path.parents]
    found = {f"{path.relative_to(root)}: {use}" for root, path in files for use in uses_of_unix(path)}
    assert found == GUARDED
    assert {use for path in HOST.glob("*.py") for use in uses_of_unix(path)}  # else nothing is looked for
