"""A ROS domain nobody else on this machine uses, so that runs beside each other never hear each other."""

import contextlib
import socket
from collections.abc import Iterator

_FIRST_PORT = 32768  # one TCP port per domain: whoever holds it owns the domain
_DOMAINS = range(1, 100)  # above 101 the ports of DDS collide with ephemeral ones


@contextlib.contextmanager
def reserved_domain() -> Iterator[int]:
    """A ROS domain id that nobody else on this machine reserves as long as the block runs.

    Raises:
        RuntimeError: all of them are in use.
    """
    for domain in _DOMAINS:
        with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as holder:
            try:
                holder.bind(("127.0.0.1", _FIRST_PORT + domain))
            except OSError:
                continue
            yield domain
            return
    raise RuntimeError(f"all ROS domains {_DOMAINS} are in use")
