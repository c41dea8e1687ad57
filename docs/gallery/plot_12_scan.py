"""
How does a scanned object stand?
================================

A mesh gives mass properties, the polygon on which the object stands, and the angle at which it balances in
every direction. Here the mesh is a slanted column made in the script; ``read_shape("scan.stl", …)`` reads
one of yours.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import trimesh

from rockfrag.system import read_shape

column = trimesh.creation.cylinder(radius=0.18, height=1.1, sections=24)
column.apply_translation([0, 0, 0.55])
column.vertices[:, 0] += 0.06 * column.vertices[:, 2]  # it leans
with tempfile.TemporaryDirectory() as folder:
    column.export(Path(folder) / "column.stl")
    shape = read_shape(Path(folder) / "column.stl", density=2700.0)
print(f"mass {shape.mass:.0f} kg, centre of gravity at height {shape.cg_height:.2f} m")

directions = np.arange(0, 361, 15)
angles = [
    np.degrees(shape.block(float(d), tolerance=0.002).critical_angle(+1))
    for d in directions
]

figure, axes = plt.subplots(figsize=(4, 4), subplot_kw={"projection": "polar"})
axes.plot(np.radians(directions), angles, "o-", markersize=3)
axes.set_rgrids([5, 10, 15, 20])
axes.set_title("angle at which it balances [°]", fontsize=10)
