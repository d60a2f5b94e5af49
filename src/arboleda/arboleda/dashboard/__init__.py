"""The page that people look at and operate the plant from: NiceGUI over snapshots of the plant."""
