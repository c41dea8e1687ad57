"""MuJoCo, another program: contacts are springs and dampers solved for at each small step.

It knows no pivots, contact states or impact maps.
"""

import math

import numpy as np

from rockfrag.system.blocks import Block, Body, Column

G = 9.81


def _box(name: str, block: Block, z: float) -> str:
    return f"""
    <body name="{name}" pos="0 0 {z + block.height / 2}">
      <joint name="{name}x" type="slide" axis="1 0 0"/>
      <joint type="slide" axis="0 0 1"/>
      <joint name="{name}r" type="hinge" axis="0 1 0"/>
      <geom type="box" size="{block.width / 2} {block.width / 2} {block.height / 2}" mass="{block.mass}"/>
    </body>"""


def mujoco_model(
    body: Body | Column, timestep: float, stiff: bool, friction: float
) -> object:
    """Bodies in a vertical plane on a floor, with the same friction at every interface."""
    import mujoco

    blocks = body.blocks
    under = np.cumsum([0.0, *(block.height for block in blocks)])
    boxes = "".join(_box(f"b{i}", block, under[i]) for i, block in enumerate(blocks))
    contact = f'solref="{2 * timestep} 1"' if stiff else ""
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <option timestep="{timestep}" cone="elliptic" impratio="100" gravity="0 0 -{G}"/>
  <default><geom condim="3" friction="{friction} 0.005 0.0001" {contact}/></default>
  <worldbody><geom type="plane" size="50 50 1"/>{boxes}</worldbody>
</mujoco>""")


def mujoco_outcome(body, acceleration, dt, timestep=0.001, stiff=True, friction=3.0):
    """Whether a body falls; ``stiff`` takes contacts as stiff as the step allows, MuJoCo's default is softer.

    With the friction of the default nothing slides.
    """
    model = mujoco_model(body, timestep, stiff, friction)
    masses = [block.mass for block in body.blocks]
    return falls(model, masses, acceleration, dt)


def falls(model, masses, acceleration, dt) -> bool:
    """Roll a model out in compiled code by the second, the ground's acceleration as a force on each body."""
    import mujoco
    from mujoco import rollout

    timestep = model.opt.timestep
    data = mujoco.MjData(model)
    spec = mujoco.mjtState.mjSTATE_QFRC_APPLIED
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS
    time = np.arange(round(len(acceleration) * dt / timestep)) * timestep
    a = np.interp(
        time, np.arange(len(acceleration) + 1) * dt, np.append(acceleration, 0.0)
    )
    force = np.zeros((1, time.size, model.nv))
    for i, mass in enumerate(masses):
        force[0, :, 3 * i] = -mass * a
    state = np.empty(mujoco.mj_stateSize(model, full))
    mujoco.mj_getState(model, data, state, full)
    second = round(1 / timestep)
    moving = np.flatnonzero(np.abs(a) > 0.05 * G)
    # what comes before any block could move is skipped
    first = max(0, int(moving[0]) - second) if moving.size else time.size
    for k in range(first, time.size, second):
        states, _ = rollout.rollout(
            model, data, state, force[:, k : k + second], control_spec=int(spec)
        )
        state = states[0, -1]
        # at each instant: what has tripped over a kerb comes to rest on it, perhaps before a right angle
        angles = states[0][:, 1 + np.arange(len(masses)) * 3 + 2]
        if (np.abs(angles) > math.pi / 2).any():
            return True
    return False


def held_model(block: Block, friction: float, walls=(), cords=(), timestep=0.001):
    """A block in a vertical plane between walls or kerbs (boxes that stay), and in cords (tendons that only pull).

    ``walls`` and ``cords`` are those of a system; contacts as stiff as the step allows.
    """
    import mujoco

    boxes, pairs, sites, tendons = "", "", "", ""
    stiff = f'solref="{2 * timestep} 1"'
    for i, wall in enumerate(walls):
        high = min(wall.height, 5.0) / 2
        mu = wall.friction.kinetic if wall.friction else 0.0
        place = wall.side * (wall.distance + 0.5)
        boxes += (
            f'<geom name="w{i}" type="box" size=".5 1 {high}" pos="{place} 0 {high}"/>'
        )
        pairs += f'<pair geom1="w{i}" geom2="g" condim="3" friction="{max(mu, 1e-5)} {max(mu, 1e-5)}" {stiff}/>'
    for i, cord in enumerate(cords):
        (x, _, z), (far, _, high) = cord.point, cord.anchor
        length = math.hypot(far - x, high - z) + cord.slack
        boxes += f'<site name="a{i}" pos="{far} 0 {high}"/>'
        sites += f'<site name="p{i}" pos="{x} 0 {z - block.height / 2}"/>'
        tendons += f"""<spatial springlength="0 {length}" stiffness="{cord.stiffness}" damping="0">
        <site site="a{i}"/><site site="p{i}"/></spatial>"""
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <option timestep="{timestep}" cone="elliptic" impratio="100" gravity="0 0 -{G}"/>
  <default><geom contype="0" conaffinity="0"/></default>
  <worldbody><geom name="floor" type="plane" size="50 50 1"/>{boxes}
    <body name="b" pos="0 0 {block.height / 2}">
      <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 1 0"/>
      <geom name="g" type="box" size="{block.width / 2} {block.width / 2} {block.height / 2}" mass="{block.mass}"/>
      {sites}
    </body>
  </worldbody>
  <contact><pair geom1="floor" geom2="g" condim="3" friction="{friction} {friction}" {stiff}/>{pairs}</contact>
  <tendon>{tendons}</tendon>
</mujoco>""")
