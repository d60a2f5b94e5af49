"""The systemd unit of a plant, as text."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

WATCHDOG_S = 30  # a step takes milliseconds; a laptop that swaps may need seconds
EVERYWHERE = """\
NoNewPrivileges=yes
LockPersonality=yes
RestrictRealtime=yes
RestrictSUIDSGID=yes
RestrictNamespaces=yes
RestrictAddressFamilies=AF_UNIX AF_INET AF_INET6 AF_NETLINK
SystemCallArchitectures=native
SystemCallFilter=@system-service
UMask=0077"""
# What needs rights that the manager of a user has not got on every kernel. Devices stay open: a driver of
# one's own may need a serial line.
OF_SYSTEM = """\
ProtectSystem=strict
ProtectHome=read-only
PrivateTmp=yes
ProtectClock=yes
ProtectControlGroups=yes
ProtectHostname=yes
ProtectKernelLogs=yes
ProtectKernelModules=yes
ProtectKernelTunables=yes
CapabilityBoundingSet="""


def unit(*, plant: str, command: Sequence[str], state: Path, user: str | None) -> str:
    """The unit of a plant that `command` starts: for the whole system and its `user`, else for the caller.

    The file `environment` in the state directory, if it exists, may hold secrets that no command line should
    show, such as the broker's password.
    """
    whole = user is not None
    lines = [
        "# Written by `arboleda service install`, which writes it anew.",
        "[Unit]",
        f"Description=Arboleda: the plant {plant}",
        "Wants=network-online.target" if whole else "",
        "After=network-online.target mosquitto.service" if whole else "",
        "",
        "[Service]",
        "Type=notify",
        f"ExecStart={' '.join(map(_quoted, command))}",
        "ExecReload=/bin/kill -HUP $MAINPID",
        f"User={user}" if whole else "",
        f"WorkingDirectory={_escaped(str(state))}",
        f"EnvironmentFile=-{_escaped(str(state / 'environment'))}",
        "Environment=PYTHONUNBUFFERED=1 COLUMNS=200",
        f"SyslogIdentifier=arboleda-{plant}",
        f"WatchdogSec={WATCHDOG_S}",
        "Restart=on-failure",
        "RestartSec=5",
        "RestartPreventExitStatus=2",  # bad input is not better the next time
        "KillMode=mixed",  # the plant ends its own children once its robots stand
        "TimeoutStopSec=60",
        EVERYWHERE,
        OF_SYSTEM if whole else "",
        f'ReadWritePaths="{_escaped(str(state))}"' if whole else "",
        "",
        "[Install]",
        f"WantedBy={'multi-user.target' if whole else 'default.target'}",
    ]
    kept = [line for number, line in enumerate(lines) if line or lines[number + 1].startswith("[")]
    return "\n".join(kept) + "\n"


def _escaped(word: str) -> str:
    """A word in which systemd sees no specifier."""
    return word.replace("%", "%%")


def _quoted(word: str) -> str:
    """A word of a command line, as systemd.service(5) reads it."""
    inner = _escaped(word).replace("\\", "\\\\").replace('"', '\\"').replace("$", "$$")
    return f'"{inner}"' if inner != word or " " in word or not word else word
