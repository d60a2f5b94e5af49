"""The belt behind Modbus TCP or RTU: `arboleda virtual modbus`."""
