"""The kernels: compiled functions that integrate bodies through motions (``docs/kernels.md``).

A case is a body × motion × scale.  It is at rest until the ground lifts it (``case.next_uplift`` skips to that
instant), rocks in a contact state (``contact_states`` has their table), and goes from one to the next by contact
events: a contact opens (``contact_states.release``) or closes (``impact``), until the body rests again, has
fallen, or its motion is over and what is left of its energy cannot overturn it.  Impacts that accumulate are ended
at once where that is proved to change nothing (``chatter``).

Data are records with named fields; what belongs together is handed on as a named tuple, Ensemble, Motions and
Worker by reference (``by_reference``).  Types are inferred by numba from records and tuples that annotations
cannot name, so mypy is kept out of these modules, but not of ``jit``; what Python hands to them is typed where it
is made.
"""
