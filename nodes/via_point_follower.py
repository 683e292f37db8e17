"""A turtle on a round trip: list parameters, and a check across parameters.

A parameter's own limits are in its declaration. A condition on several parameters is checked when the node is made;
`read_only` keeps it true from then on.
"""

from itertools import cycle
from typing import Any

import graphflow
from graphflow import Param, ParameterError

from .position_controller import Point, PositionController


class ViaPointFollower(PositionController):
    """Visit the points (via_x[0], via_y[0]), (via_x[1], via_y[1]), ... and start over."""

    via_x = Param([2.0, 5.0, 8.0, 1.0, 9.0, 2.0], unit="m", doc="The points' x.", read_only=True)
    via_y = Param([1.0, 9.0, 1.0, 6.0, 6.0, 1.0], unit="m", doc="The points' y.", read_only=True)

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        if not len(self.via_x) == len(self.via_y) > 0:
            raise ParameterError(
                f"via_x has {len(self.via_x)} numbers but via_y has {len(self.via_y)}: "
                "give the same number of each, at least one"
            )
        self.points = cycle(map(Point, self.via_x, self.via_y))
        self.go_to(next(self.points))

    async def arrived(self) -> None:
        assert self.goal is not None
        self.log.info("arrived at (%g, %g)", *self.goal)
        self.go_to(next(self.points))


if __name__ == "__main__":
    graphflow.run(ViaPointFollower)
