"""The belt behind OPC UA: `arboleda virtual opcua`."""
