"""Overview of `--help`: the commands by purpose, each with its whole first sentence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from click import Context, HelpFormatter
from typer.core import TyperGroup

from arboleda.model.verbs import Verb

SECTIONS: Mapping[str, tuple[str, ...]] = {
    "Run a plant": ("up", "run", "submit", "status", "tasks", "oee", "token", "service", "site", "handover"),
    "Operate it": tuple(verb.value for verb in Verb),
    "Make it yours": (
        *(
            "new",
            "examples",
            "check",
            "apply",
            "versions",
            "tree",
            "nodes",
            "urdf",
            "virtual",
            "firmware-config",
            "conformance",
            "certs",
        ),
    ),
    "Put it to the test": ("simulate", "prove", "bench"),
    "Look back": ("logs", "record", "replay", "report", "backup", "restore"),
}
LONGEST = 1000  # characters of a first sentence


class WholeSentences(TyperGroup):
    """A group that lists each command with its whole first sentence."""

    def format_commands(self, ctx: Context, formatter: HelpFormatter) -> None:
        """Write the commands in sections."""
        for title, names in self.sections(ctx).items():
            with formatter.section(title):
                formatter.write_dl([(name, self._what(ctx, name)) for name in names])

    def sections(self, ctx: Context) -> Mapping[str, Sequence[str]]:
        """The commands below each heading."""
        return {"Commands": self.list_commands(ctx)}

    def _what(self, ctx: Context, name: str) -> str:
        command = self.get_command(ctx, name)
        return "" if command is None else command.get_short_help_str(LONGEST)


class Overview(WholeSentences):
    """The group of all commands."""

    def sections(self, ctx: Context) -> Mapping[str, Sequence[str]]:
        return SECTIONS
