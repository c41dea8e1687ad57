"""The object rocking live in its page, in the plane or in space."""

from dataclasses import replace

import numpy as np
from markupsafe import Markup

from rockfrag.assess.answer import Assessment
from rockfrag.assess.motions import MotionSet, common_pair
from rockfrag.assess.objects import Objects
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.live import carried, live_kernel
from rockfrag.report.live.space import Standing, live_in_space

LIVE = (0.0, 0.1, 0.25, 0.5, 0.75)
"""Motions that may be chosen in the live part, by how many topple the object at less shaking [-]."""


def live_of(found: Assessment) -> Markup:
    """The object under some motions, live: that which topples it first, and others by how soon they do."""
    objects, motions = found.request.objects, found.motions
    order = np.argsort(found.counted.first_levels(), kind="stable")
    places = dict.fromkeys(int(order[int(part * (order.size - 1))]) for part in LIVE)
    chosen = [i for i in places if motions.base[i].pga > 0]
    if not chosen:
        return Markup("")
    if motions.both and objects.solid(objects.body) is not None:
        return _in_space(objects, motions, chosen)
    bodies = {name: objects.system_of(body) for name, body in objects.arrangements.items()}
    return live_kernel(bodies, carried([_named(motions, motions.base[i], i) for i in chosen]))


def _in_space(objects: Objects, motions: MotionSet, chosen: list[int]) -> Markup:
    """The ways to stand that are known in space, on pedestals that stay where they are, under both components."""
    bodies, left_out = {}, []
    for name, body in objects.arrangements.items():
        solid, pedestals = objects.solid(body), body.blocks[:-1]
        if solid is None:
            left_out.append(name)
            continue
        tall = sum(block.height for block in pedestals)
        bodies[name] = Standing(solid, replace(pedestals[-1], height=tall) if pedestals else None)
    records = dict.fromkeys(next((p for p in motions.pairs if i in p), (i,)) for i in chosen)
    shaking = []
    for record in records:
        x, *others = common_pair(motions, record) if len(record) > 1 else [motions.base[record[0]]]
        shaking.append(GroundMotion(_named(motions, x, record[0]), *others))
    return live_in_space(bodies, shaking, left_out)


def _named(motions: MotionSet, motion: Motion, i: int) -> Motion:
    """A motion with the name by which a reader knows it: earthquake, station and component."""
    about = motions.ground[i]
    earthquake, station = (str(about.metadata.get(key, "")) for key in ("earthquake", "station"))
    known = f"{earthquake}, {station} ({about.name})" if earthquake and station else about.name
    return replace(motion, name=known)
