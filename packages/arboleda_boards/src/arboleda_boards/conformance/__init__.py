"""Trial of the board of an arm or a declared device by the contract: a pure judge, and its way over MQTT."""
