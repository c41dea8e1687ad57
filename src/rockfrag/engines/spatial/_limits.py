"""What counts as none and what is counted: limits and numbers that several kernels of the engine in space share.

In: nothing. Out: limits of gaps [m] and velocities [m/s], what may end a step, and places of counters. Theory:
``docs/space.md``, "Steps" and "Friction and impacts".
"""

from rockfrag.engines.spatial import _forces as forces

TOUCH = 1e-10  # gap below which a point touches [m]
FLAT = 1e-9  # sine of the tilt below which a body is flat [-]
CLOSE = 1e-6  # velocity after an impact below which a point stays closed at first [m/s]
# the velocity that points slip above when the mode is chosen [m/s]
AT_REST = forces.SLIP_FLOOR
# velocity above which points that touch leave when the mode is chosen [m/s]
LEAVES = 1e-8
NO_LIMIT = 1e300  # margin of what cannot happen
# what ends a step: a point lands or opens, sticks no more or slips no more, a tie turns taut or slack, or breaks
LANDS, OPENS, LEAVES_CONE, SLIP_ENDS, TIE_TURNS, TIE_BREAKS = 1, 2, 3, 4, 5, 6
NOTHING = 0

# places of s.counters: impacts; problems of contacts with several solutions, and with none; points that began to
# slide; flights; modes that no forces allow (Painlevé)
COUNTERS = 6
IMPACTS, AMBIGUOUS, UNSOLVED, SLIDINGS, FLIGHTS, JAMS = range(COUNTERS)
