"""Everything between particles and gas: the gas door, kernel transfer, messages, transports, gas solvers."""
