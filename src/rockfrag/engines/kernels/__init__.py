"""The kernels: compiled functions that integrate bodies through motions.

**The life of a case.**  A case is a body × motion × scale.  It is at rest until the ground lifts it
(``case.next_uplift`` skips to that instant), rocks in a contact state (``contact_states`` has their table),
and goes from one to the next by
contact events: a contact opens (``contact_states.release``) or closes (``impact``), until the body rests again,
has fallen, or its motion is over and what is left of its energy cannot overturn it.  Impacts that accumulate are
ended at once where that is proved to change nothing (``chatter``).

**Who calls whom.**

====================================  =========================================================================
called from Python                    calls
====================================  =========================================================================
``single.integrate``: one history         ``taylor.fill_series`` from contact event to contact event; ``roots``
find the next one;
                                      ``single.resolve_impact`` and ``contact_states`` say what follows;
                                      ``record`` keeps it
``lanes.scheduler.integrate_stacks``      ``stack_one.advance`` and ``stack_two.advance``: one step of sixteen
cases;
                                      ``stack_case``: contact events, rest, the next case; ``stack_constants``
                                      once a body
``lanes.block.integrate_blocks``          ``block.advance``: one step of 64 lone blocks, and all the rest in one
file ``record.fill_energies``              ``equations``
``record.fill_sines``                 ``elementary``
====================================  =========================================================================

All of them stand on ``equations`` (the two-block model), ``taylor`` (series), ``roots`` (instants),
``contact_states``, ``impact``, ``chatter``, ``elementary`` (sine and its like) and ``geometry`` (bodies as they
stand), the last two in plain Python that bodies use too; ``jit`` says how they are compiled.

**Data** are records with named fields: BODY, STATE (``equations``), SERIES (``taylor``), CASE
(``stack_case``), LANE (of every kind of lane, a row of numbers for each field), OUTCOME (``case``), SAMPLE,
CONTACT_EVENT, SUMMARY (``record``); what belongs
together is handed on as a named tuple: Ensemble and Motions (``case``) and Worker (the memory of a thread), these
by reference (``by_reference``); Shaking, Step, Ahead.

**Types** are inferred by numba from records and tuples that annotations cannot name, so mypy is kept out of
these modules (but not of ``jit``, ``elementary`` and ``geometry``); what Python hands to them is typed where it is
made.

``docs/kernels.md`` says how to change them.
"""
