"""The plant as a server of OPC UA, which others browse and nobody writes to."""
