"""The reference integrator: slow, tight and plain, to judge the fast one by.

Nothing is shared with the kernels but the bodies.
"""

from rockfrag.rocking.reference.integrator import simulate_reference
from rockfrag.rocking.reference.response import ReferenceEvent, ReferenceResponse

__all__ = ["ReferenceEvent", "ReferenceResponse", "simulate_reference"]
