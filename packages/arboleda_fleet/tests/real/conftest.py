"""A command line, nodes of ROS 2, hosts and a browser, as tests of the whole system have them."""

from tests.system.conftest import arboleda, browser, hosts, node, start

__all__ = ["arboleda", "browser", "hosts", "node", "start"]
