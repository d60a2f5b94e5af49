"""Commands to devices: when one may leave, what a report proves of it, who holds which zone; pure."""
