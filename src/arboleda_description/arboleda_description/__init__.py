"""What the robots are made of: numbers in `robots/*.yaml`, drawn as URDF by `urdf/*.xacro`."""
