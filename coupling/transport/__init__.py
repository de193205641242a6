"""What both transports of messages stand on."""
