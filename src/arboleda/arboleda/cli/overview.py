"""Overview of `--help`: the commands by purpose, each with its whole first sentence."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import Any

import typer
from typer.core import TyperGroup

from arboleda.model.verbs import Verb

from .commands import LoadedCommands, commands
from .help_language import WrongUse, complain, first_sentence, speaking, translated
from .language import help_words

SECTIONS: Mapping[str, tuple[str, ...]] = {
    "Run a plant": (
        *("up", "run", "submit", "status", "tasks", "oee", "token", "service", "site", "handover", "mcp"),
    ),
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
            "certs",
        ),
    ),
    "Put it to the test": ("simulate", "prove", "fault", "bench"),
    "Learn it": (),  # of packages alone, which have their place here
    "Look back": ("logs", "record", "replay", "report", "backup", "restore"),
}
BAD_INPUT = 2
LONGEST = 1000  # characters of a first sentence


class WholeSentences(TyperGroup):
    """A group that lists each command with its whole first sentence, in the language of the terminal."""

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """A command, whose help is in the language of the terminal."""
        command = super().get_command(ctx, cmd_name)
        if command is not None:
            command.context_class = speaking(command.context_class)
        return command

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the commands in sections."""
        for title, names in self.sections(ctx).items():
            with formatter.section(help_words("sections").get(title, title)):
                formatter.write_dl([(name, self._what(ctx, name)) for name in names])

    def sections(self, ctx: Any) -> Mapping[str, Sequence[str]]:
        """The commands below each heading."""
        return {"Commands": self.list_commands(ctx)}

    def _what(self, ctx: Any, name: str) -> str:
        command = self.get_command(ctx, name)
        if command is None:
            return ""
        english: str = command.get_short_help_str(LONGEST)
        if not help_words("help"):
            return english
        return translated(command.short_help) if command.short_help else first_sentence(command.help or "")


class Overview(WholeSentences):
    """The group of all commands: none is loaded to list them."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.commands: Any = LoadedCommands()

    def list_commands(self, ctx: Any) -> list[str]:
        """Names of all commands."""
        return list(commands())

    def sections(self, ctx: Any) -> Mapping[str, Sequence[str]]:
        listed = {name for names in SECTIONS.values() for name in names}
        sections = {
            title: tuple(name for name in names if name in commands()) for title, names in SECTIONS.items()
        }
        for name, command in commands().items():
            if name not in listed:
                sections[command.section] = (*sections.get(command.section, ()), name)
        return {title: names for title, names in sections.items() if names}

    def _what(self, ctx: Any, name: str) -> str:
        """The sentence of a command; in another language the first of the paragraph that begins with it."""
        brief, known = commands()[name].brief, help_words("help")
        if brief in known or not known:
            return translated(brief)
        return first_sentence(next((text for text in known if text.startswith(f"{brief} ")), brief))

    def main(self, *args: Any, **extra: Any) -> Any:
        """Run a command, and say in the language of the terminal what is wrong with its arguments."""
        self.context_class = speaking(self.context_class)
        if not (extra.get("standalone_mode", True) and help_words("help")):
            return super().main(*args, **extra)
        try:
            status = super().main(*args, **extra | {"standalone_mode": False})
        except WrongUse as error:
            complain(error)
            sys.exit(BAD_INPUT)
        except typer.Abort:
            typer.echo(help_words("frame")["Aborted"], err=True)
            sys.exit(1)
        sys.exit(status if isinstance(status, int) else 0)
