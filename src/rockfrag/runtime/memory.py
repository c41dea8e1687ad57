"""How much memory a process may have."""

import os

from rockfrag.base.errors import InputError

LEAST_MEMORY = 4 * 2**30
"""Bytes of addresses that a process of a run may have to reserve; a small study's take half of them."""


def check_memory() -> None:
    """Refuse a limit of memory (``ulimit -v``) under which no process of a run could work.

    Libraries of linear algebra wait for ever where they are refused memory while they are loaded.
    """
    if os.name != "posix":
        return
    import resource

    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if limit != resource.RLIM_INFINITY and limit < LEAST_MEMORY:
        raise InputError(
            f"a process may reserve {limit / 2**20:.0f} MiB of memory here, and a run needs "
            f"{LEAST_MEMORY / 2**20:.0f}; raise the limit with 'ulimit -v {LEAST_MEMORY // 2**10}'."
        )
