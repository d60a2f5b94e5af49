"""Commands of the command line that this package adds."""

from __future__ import annotations

from arboleda.extension import Command

COMMANDS = {
    "virtual": Command(
        "arboleda_drivers.virtual.command",
        "Play the controller of another maker over its own protocol, with motion and with faults.",
    ),
    "topics": Command(
        "arboleda_drivers.mqtt_mapping.listen.command",
        "Find out by which MQTT topics a device speaks.",
    ),
}
