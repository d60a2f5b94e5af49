"""`arboleda site`: many plants on one page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from arboleda.extension import StartError
from arboleda.runtime.state import state_root
from arboleda.runtime.stores import leaders_of
from arboleda.runtime.web_options import WebOptions
from arboleda.web.access.names import listen_address, public_origin

if TYPE_CHECKING:  # they take a while to load, and only who shows a page needs them
    from arboleda.adapters.server_tls import ServerTls
    from arboleda.runtime.endpoints import Find

Addresses = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="ADDRESS",
        help="Where plants are, e.g. http://127.0.0.1:8080. [default: those that run on this machine]",
        show_default=False,
    ),
]
Store = Annotated[
    str,
    typer.Option(
        "--store",
        metavar="URL",
        envvar="ARBOLEDA_STORE",
        help="Every plant of this database, postgresql://USER@HOST/DATABASE, wherever it is led now.",
        show_default=False,
    ),
]
Tokens = Annotated[
    Path | None,
    typer.Option(
        "--tokens",
        metavar="FILE",
        envvar="ARBOLEDA_TOKENS",
        help="Lines of ADDRESS TOKEN, or PLANT TOKEN, for plants of other machines that want one; mode 0600.",
    ),
]
Host = Annotated[
    str,
    typer.Option(
        metavar="ADDRESS", help="Where the page listens; on a network everybody needs a token of the site."
    ),
]
Port = Annotated[
    int | None,
    typer.Option(
        metavar="N", min=0, max=65535, help="Its port. [default: 8080, or a free one if it is taken]"
    ),
]
PublicUrl = Annotated[
    str | None,
    typer.Option(metavar="URL", help="Address of a proxy before the page; everybody then needs a token."),
]
TlsCert = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE", envvar="ARBOLEDA_TLS_CERT", help="Certificate with which the page speaks TLS."
    ),
]
TlsKey = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        envvar="ARBOLEDA_TLS_KEY",
        help="Key of that certificate. [default: in the file of --tls-cert]",
        show_default=False,
    ),
]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(site)


def site(
    addresses: Addresses = None,
    store: Store = "",
    tokens: Tokens = None,
    host: Host = "127.0.0.1",
    port: Port = None,
    public_url: PublicUrl = None,
    tls_cert: TlsCert = None,
    tls_key: TlsKey = None,
) -> None:
    """Show many plants on one page: how each stands, trouble first, tasks and OEE over all.

    It gives a task to any of them, and stops (software) one or all, which is no safety function. Plants of
    this machine are shown the token that their state directory has, as by the other commands.

    Exit status: 0 ended by Ctrl-C, 1 the page cannot be shown, 2 bad input.
    """
    try:
        options = WebOptions(
            host=listen_address(host),
            port=port,
            public_url=public_origin(public_url) if public_url else None,
            tls=_tls(tls_cert, tls_key),
        )
        find = _find(addresses or [], store, tokens)
    except StartError as error:
        raise typer.BadParameter(str(error)) from error
    from .server import serve  # the page takes a while to load, and only this command needs it

    serve(find, options, state_root() / "arboleda-site")


def _tls(certificate: Path | None, key: Path | None) -> ServerTls | None:
    if certificate is None:
        return None
    from arboleda.adapters.server_tls import server_tls

    return server_tls(certificate, key)


def _find(addresses: list[str], store: str, file: Path | None) -> Find:
    """The function that finds the plants that the options name; StartError."""
    from arboleda.runtime import endpoints

    known = {} if file is None else endpoints.tokens_of(file)
    found = [endpoints.named(addresses)] if addresses else []
    if store:
        found.append(endpoints.of_database(leaders_of(store)))
    if not found:
        found.append(endpoints.of_this_machine)
    return endpoints.with_tokens(lambda: [place for find in found for place in find()], known)
