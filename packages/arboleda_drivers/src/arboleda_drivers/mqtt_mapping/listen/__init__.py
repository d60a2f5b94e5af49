"""`arboleda topics listen`: what is heard beside a device, as a mapping to begin with."""
