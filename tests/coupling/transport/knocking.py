"""Who calls a gas server's door, as the gas solver does."""

import contextlib
import socket
import time

PATIENCE = 5.0  # s


def connected(address: str) -> socket.socket:
    """A connection to `address`; a door of a Unix socket with as many waiting as it has room for is tried again."""
    if not address.startswith("unix:"):
        _, host, port = address.split(":")
        return socket.create_connection((host, int(port)), PATIENCE)
    caller, end = socket.socket(socket.AF_UNIX), time.monotonic() + PATIENCE
    caller.settimeout(PATIENCE)  # also where nobody takes who waits at the door
    while time.monotonic() < end:
        with contextlib.suppress(BlockingIOError):
            caller.connect(address.removeprefix("unix:"))
            return caller
        time.sleep(0.01)
    raise TimeoutError(f"{address}: no room at the door for {PATIENCE:g} s")
