"""The robots' descriptions: numbers in `robots/*.yaml`, drawn as URDF by `urdf/*.xacro`."""
