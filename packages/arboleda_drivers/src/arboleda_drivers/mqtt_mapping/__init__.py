"""The driver `mqtt`: devices that speak MQTT by topics of their own.

`heard.py` reads what they say, `sent.py` makes what they are told, `settings.py` has the keys of the plant
file, `checks.py` what does not fit and how much may be believed, `machine.py` one device as a state machine.
"""
