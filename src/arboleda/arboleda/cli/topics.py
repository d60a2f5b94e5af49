"""`arboleda help`: the commands of a topic, or the help of a command."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from arboleda.model.sentence import Phrase

from .language import allowed, say

NO_TOPIC = Phrase("cli.help.no_topic", "'{topic}' is neither a topic nor a command; {others}")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command("help")(topics)


def topics(
    context: typer.Context,
    topic: Annotated[str, typer.Argument(metavar="TOPIC", help="A topic, e.g. operate; or a command.")] = "",
) -> None:
    """List the commands of a topic, or explain a command."""
    root = context.find_root()
    overview: Any = root.command
    if not topic:
        print(root.get_help())
    elif topic in overview.topics():
        print(overview.topic_help(root, topic))
    elif topic in overview.commands:
        overview.get_command(root, topic).main(
            ["--help"], prog_name=f"{root.info_name} {topic}", standalone_mode=False
        )
    else:
        others = allowed(topic, overview.topics())
        raise typer.BadParameter(say(NO_TOPIC(topic=topic, others=others)), param_hint="TOPIC")
