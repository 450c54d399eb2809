"""A slider-crank of a multibody code, stepped through time at constant speed.

Crank, rod and piston are bodies, held together and guided by constraints; Exudyn (J. Gerstmayr,
Multibody Syst. Dyn. 2023) solves for motion and constraint forces. The rod's inertia is that of its
two masses, so that both models are of the same thing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import exudyn as exu
import numpy as np
from exudyn import utilities as bodies

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Parts(NamedTuple):
    """One cylinder's parts, SI."""

    radius: float
    rod: float
    piston_mass: float
    rod_mass: float
    to_rod_centre: float
    """From the crankpin to the rod's centre of mass."""

    @property
    def reciprocating_mass(self) -> float:
        """Piston and what the rod has at the small end."""
        return self.piston_mass + self.rod_mass * self.to_rod_centre / self.rod

    @property
    def rotating_mass(self) -> float:
        """What the rod has at the big end."""
        return self.rod_mass * (1.0 - self.to_rod_centre / self.rod)


def support_force(
    parts: Parts, omega: float, steps: int, *, implicit: bool = True
) -> NDArray[np.complex128]:
    """Return the force on the frame, along the bore + i across, from top dead centre: (steps,).

    Two turns are stepped, the second is read. ``implicit`` takes generalised alpha (index 3, the
    default), otherwise the trapezoidal rule (index 2).
    """
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    radius, rod = parts.radius, parts.rod
    ground = mbs.AddObject(bodies.ObjectGround())

    def body(
        mass: float, inertia: float, at: list[float], velocity: list[float]
    ) -> tuple[int, int]:
        node = mbs.AddNode(
            bodies.NodeRigidBody2D(referenceCoordinates=at, initialVelocities=velocity)
        )
        number = mbs.AddObject(
            bodies.ObjectRigidBody2D(physicsMass=mass, physicsInertia=inertia, nodeNumber=node)
        )
        return node, number

    def marker(number: int, x: float = 0.0) -> int:
        return int(
            mbs.AddMarker(bodies.MarkerBodyPosition(bodyNumber=number, localPosition=[x, 0, 0]))
        )

    pin_speed, share = radius * omega, parts.to_rod_centre
    crank_node, crank = body(1.0, 0.01, [0, 0, 0], [0, 0, omega])
    _, link = body(
        parts.rod_mass,
        parts.rod_mass * share * (rod - share),
        [radius + share, 0, 0],
        [0, pin_speed * (1 - share / rod), -pin_speed / rod],
    )
    piston_node = mbs.AddNode(bodies.NodePoint2D(referenceCoordinates=[radius + rod, 0]))
    piston = mbs.AddObject(
        bodies.ObjectMassPoint2D(physicsMass=parts.piston_mass, nodeNumber=piston_node)
    )
    bearing = mbs.AddObject(
        bodies.ObjectJointRevolute2D(markerNumbers=[marker(ground), marker(crank)])
    )
    mbs.AddObject(
        bodies.ObjectJointRevolute2D(markerNumbers=[marker(crank, radius), marker(link, -share)])
    )
    mbs.AddObject(
        bodies.ObjectJointRevolute2D(markerNumbers=[marker(link, rod - share), marker(piston)])
    )
    fixed = mbs.AddNode(bodies.NodePointGround())

    def coordinate(node: int, number: int) -> int:
        return int(mbs.AddMarker(bodies.MarkerNodeCoordinate(nodeNumber=node, coordinate=number)))

    guide = mbs.AddObject(
        bodies.ObjectConnectorCoordinate(
            markerNumbers=[coordinate(fixed, 0), coordinate(piston_node, 1)]
        )
    )
    mbs.AddObject(
        bodies.ObjectConnectorCoordinate(
            markerNumbers=[coordinate(fixed, 0), coordinate(crank_node, 2)],
            offset=omega,
            velocityLevel=True,
        )
    )
    force = exu.OutputVariableType.Force
    at_bearing, at_guide = (
        mbs.AddSensor(
            bodies.SensorObject(objectNumber=number, storeInternal=True, outputVariableType=kind)
        )
        for number, kind in ((bearing, force), (guide, force))
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    turn = 2 * np.pi / omega
    settings.timeIntegration.numberOfSteps = 2 * steps
    settings.timeIntegration.endTime = 2 * turn
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = turn / steps
    solver = exu.DynamicSolverType
    mbs.SolveDynamic(
        settings,
        solverType=solver.GeneralizedAlpha if implicit else solver.TrapezoidalIndex2,
        showHints=False,
    )
    on_crank, on_piston = (
        np.asarray(mbs.GetSensorStoredData(sensor))[-steps - 1 : -1]
        for sensor in (at_bearing, at_guide)
    )
    return on_crank[:, 1] + 1j * on_crank[:, 2] + 1j * on_piston[:, 1]
