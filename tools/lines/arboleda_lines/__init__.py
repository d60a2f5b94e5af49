"""Bad lines between drivers and their devices: in virtual time, and as relays of real lines."""
