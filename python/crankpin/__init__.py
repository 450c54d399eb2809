"""Shaking forces, rocking moments and torques of piston engines.

From the moving parts of one cylinder and the positions of the cylinders on the crankshaft: force,
moment and torque per engine order and over crank angle, swept over bank angle, firing order, rod
ratio, pin offset and speed.

SI units; angles in degrees in arguments whose names end in ``_deg``, speeds in rpm. Seen from the
flywheel x points right, y up, z from the front to the flywheel, and the crank turns
counter-clockwise. Classes of results are in :mod:`crankpin.results`.
"""

import crankpin._support.interrupted  # noqa: F401 - Ctrl-C, before anything takes time

# isort: split
from crankpin._support import lazy

__all__, __getattr__, __dir__ = lazy.attach(__name__, __file__)
