"""VDA 5050 over MQTT: the driver's connection, and the messages as the standard's schemas have them."""
