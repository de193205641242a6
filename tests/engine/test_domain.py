"""Values of copies are brought up to date as they are, numbers of particles and their kinds too."""

import numpy as np

from sdph.engine.domain import Domain
from sdph.engine.world import World


class Asked:
    """Stands for messages under way, and for their class."""

    @staticmethod
    def Waitall(asked):
        assert len(asked) == 2


class Echo:
    """A neighbour that has sent what it is sent, byte by byte, as MPI does."""

    def Irecv(self, room, rank):
        self.room = room
        return Asked()

    def Isend(self, values, rank):
        self.room.view(np.uint8)[: values.nbytes] = values.view(np.uint8)
        return Asked()


def test_whole_numbers_go_among_processes_as_they_are():
    world = World()
    world.number, world.comm = 2, Echo()
    domain = Domain(world, 1.0, (0.0, 0.0))
    domain.sends, domain.gets = {1: np.array([1, 0])}, {1: np.array([2, 3])}
    kind, number = np.array([3, 1, 0, 0], np.int8), np.array([2**40 + 1, 7, 0, 0])
    place = np.array([[0.5, 1.0], [2.0, 3.0], [0.0, 0.0], [0.0, 0.0]])
    domain.refresh(kind)
    domain.refresh(number)
    domain.refresh(place, np.zeros(0), kind)
    assert kind.tolist() == [3, 1, 1, 3] and number.tolist() == [2**40 + 1, 7, 7, 2**40 + 1]
    assert place[2:].tolist() == [[2.0, 3.0], [0.5, 1.0]]
    assert domain.mine_of(place).tolist() == [[0.5, 1.0], [2.0, 3.0]]
