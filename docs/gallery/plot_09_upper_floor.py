"""
What does an upper floor do to the motion?
==========================================

A building of four storeys amplifies what its period lets through. Light objects that stand on its floors
feel the floor spectra on the right.
"""

import matplotlib.pyplot as plt
import numpy as np

from rockfrag import response_spectrum
from rockfrag.building import (
    ModalDamping,
    ShearBuilding,
    floor_motions,
    stiffnesses_for_period,
)
from rockfrag.motions import evolutionary, scale_to_pga

masses, heights = (300e3,) * 4, (3.5,) * 4
building = ShearBuilding(
    masses,
    heights,
    stiffnesses_for_period(masses, heights, first_period=0.35),
    damping=ModalDamping(0.05),
    floors={"ground": 0, "second floor": 2, "attic": 4},
)
ground = scale_to_pga(
    evolutionary(
        3,
        arias_m_s=1.0,
        d5_95_s=8.0,
        mid_s=4.0,
        mid_hz=2.5,
        slope_hz_s=-0.1,
        filter_damping=0.3,
    ),
    0.25,
)
motions = floor_motions(building, ground)

figure, (left, right) = plt.subplots(1, 2, figsize=(7.4, 3.2))
periods = np.geomspace(0.05, 3.0, 120)
for motion, colour in zip(motions, ("#0072B2", "#E69F00", "#D55E00"), strict=True):
    left.plot(
        motion.time,
        motion.acceleration / 9.81,
        linewidth=0.7,
        color=colour,
        zorder=-motion.metadata["level"],
    )
    spectrum = response_spectrum(motion, periods)
    right.semilogx(
        periods,
        spectrum.acceleration / 9.81,
        color=colour,
        label=motion.metadata["floor"],
    )
left.set(xlabel="time [s]", ylabel="acceleration [g]", xlim=(0, 15))
right.set(xlabel="period [s]", ylabel="spectral acceleration [g]")
right.legend(fontsize=8)
