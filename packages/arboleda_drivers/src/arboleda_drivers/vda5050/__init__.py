"""Driver `vda5050`: mobile robots of any maker that speak VDA 5050.

`machine.py` is the vehicle with what it was told, `orders.py` makes what it is told, `state.py` reads what it
says, `factsheet.py` what it says that it can do, `settings.py` has the keys of the plant file.
"""
