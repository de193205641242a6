"""Transports of messages between particles and gas: sockets and files, on one wire format."""
