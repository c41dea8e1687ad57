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
    """MuJoCo, the ground's acceleration as a force on each body, rolled out in compiled code by the second.

    ``stiff`` takes contacts as stiff as the step allows; MuJoCo's default is softer.  With the friction of the
    default nothing slides.
    """
    import mujoco
    from mujoco import rollout

    model = mujoco_model(body, timestep, stiff, friction)
    data = mujoco.MjData(model)
    spec = mujoco.mjtState.mjSTATE_QFRC_APPLIED
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS
    blocks = body.blocks
    time = np.arange(round(len(acceleration) * dt / timestep)) * timestep
    a = np.interp(
        time, np.arange(len(acceleration) + 1) * dt, np.append(acceleration, 0.0)
    )
    force = np.zeros((1, time.size, model.nv))
    for i, block in enumerate(blocks):
        force[0, :, 3 * i] = -block.mass * a
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
        angles = state[1 + np.arange(len(blocks)) * 3 + 2]
        if (np.abs(angles) > math.pi / 2).any():
            return True
    return False
