"""Moving particles go on a device before their first step."""

from __future__ import annotations

from sdph.engine.ashore import mapped


def board(stepper) -> None:
    """Have the state on the device from now on, and walls; the stepper then makes anew the rest, as of a checkpoint."""
    from sdph.engine.gpu import card  # what it takes costs a run of the processor 0.4 s

    there, before = card.begun(), stepper.steps_before
    stepper.state, stepper.walls = mapped(there.send, stepper.state), mapped(there.send, stepper.walls)
    stepper.neighbours.built = mapped(there.send, stepper.neighbours.built)
    stepper.revive()
    stepper.steps_before = before
