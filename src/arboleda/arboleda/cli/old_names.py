"""Names that commands had, which go on, or say what does it now, for one minor version.

None of them is in help or completion.
"""

from __future__ import annotations

from collections.abc import Mapping

import typer

from arboleda.model.sentence import Phrase

from .language import say

OLD_NAMES: Mapping[str, tuple[str, ...]] = {
    "automatic": ("teach", "--end"),
    "logs": ("record", "logs"),
    "replay": ("record", "replay"),
    "run": ("up", "--once"),
    "unload": ("load", "--out"),
    "versions": ("apply", "--list"),
}
GONE: Mapping[str, Phrase] = {
    "certs": Phrase(
        "cli.gone.certs", "`arboleda certs` is gone: mkcert makes certificates; see docs/how-to/tls.md"
    ),
}
BAD_INPUT = 2
IS_CALLED = Phrase(
    "cli.old_name",
    "`arboleda {old}` is called `arboleda {new}`; the old name ends with the next minor version",
)


def in_new_names(words: list[str]) -> list[str]:
    """The words behind `arboleda`, where they begin with an old name with the new one instead, which is said
    on standard error; typer.Exit where nothing took its place."""
    name, *others = words
    if name in GONE:
        typer.echo(say(GONE[name]()), err=True)
        raise typer.Exit(BAD_INPUT)
    if name not in OLD_NAMES:
        return words
    new = OLD_NAMES[name]
    typer.echo(say(IS_CALLED(old=name, new=" ".join(new))), err=True)
    return [*new, *others]
