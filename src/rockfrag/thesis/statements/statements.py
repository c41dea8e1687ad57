"""The 58 statements of the thesis that the pipeline tests, in our own words, by their numbers.

The number of a statement never changes: code, tables and report refer to it.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Statement:
    """One statement of the thesis.

    Parameters
    ----------
    number
        Its number, 1 to 58 (written C1 to C58).
    text
        What it says, shortly.
    source
        Chapter or section of the thesis, and the equation, table or figure where there is one.
    """

    number: int
    text: str
    source: str


_ROWS = (
    # theory
    (
        1,
        "a block starts to rock once the ground accelerates by more than (b/h) g",
        "2.1.1, eq. 2.1",
    ),
    (
        2,
        "a stack starts to rock at the accelerations of Table 4.1",
        "2.2.1, eq. 2.21-2.25; Tab. 4.1",
    ),
    (
        3,
        "the specimens have the critical angles, radii and frequencies of Table 3.1",
        "3.1, Tab. 3.1",
    ),
    (4, "the restitution depends on slenderness only, not on size or velocity", "2.1.1, eq. 2.14"),
    (5, "the restitution of real blocks differs from the computed one", "2.1.1, eq. 2.14"),
    (6, "the period of free rocking depends on the amplitude", "2.1.2, eq. 2.20"),
    (7, "the linearised equation holds for slender blocks, H/B > 3", "2.1.1, eq. 2.9"),
    (8, "the response is very sensitive to small changes of size, slenderness or input", "1"),
    (9, "a stack at rest starts in pattern 3 or pattern 4", "2.2.1"),
    (10, "transitions without an impact start only from patterns 3 and 4", "2.2.3"),
    (
        11,
        "where the impact solution is impossible the blocks stay together",
        "2.2.4, eq. 2.79-2.86",
    ),
    (12, "from pattern 4a an impact usually leads to 4b, possibly to 1b", "2.2.4, eq. 2.85-2.86"),
    (13, "energy is lost at impacts only; velocities are continuous elsewhere", "2.1.1, 2.2.3"),
    (14, "rotations of the rocking spectrum fall nearly monotonically with 2π/p", "2.3"),
    (15, "the oscillator's displacement grows with period and tends to the ground's", "2.3"),
    (16, "there are period ranges where the displacement hardly depends on damping", "2.3"),
    (17, "the rocking spectrum is very sensitive to slenderness", "2.3"),
    (
        18,
        "oscillator spectra rank two records alike at any damping, rocking spectra need not",
        "2.3",
    ),
    (19, "the response spectrum is no proxy for rocking", "2.3"),
    (20, "a rocking block is infinitely stiff, then its stiffness is negative", "2.3, Tab. 2.2"),
    (21, "pattern 4 starts at a smaller acceleration than pattern 3", "4.1, Tab. 4.1"),
    (22, "the threshold of pattern 4 is the single block's", "4.1, Tab. 4.1"),
    (23, "both blocks of a stack need more excitation to rock than a single block", "4.1"),
    (24, "the acceleration that starts rocking falls with slenderness", "4.1"),
    # experiment
    (25, "overturning acceleration falls almost linearly with slenderness", "4.2, Fig. 4.1"),
    (26, "the trend with slenderness is the same with and without pedestal", "4.2, Fig. 4.1; 5"),
    (27, "the relative decrease of the mean is nearly equal with and without pedestal", "4.2"),
    (28, "the relative decrease differs by floor", "4.2, Fig. 4.2"),
    (29, "overturning acceleration is generally higher with the pedestal", "4.3, Fig. 4.3"),
    (30, "the stack is more slender than the tower and yet stronger", "4.3"),
    (31, "the increase with the pedestal is not correlated with slenderness", "4.3, Fig. 4.4"),
    (32, "the increase with the pedestal is largest for T3", "4.3, Fig. 4.4"),
    (33, "for T2 the pedestal has nearly the opposite effect, still a slight increase", "4.3"),
    (34, "the increase is noticeable on the ground floor only", "4.3, Fig. 4.6"),
    (35, "on the ground floor the mean increases with the pedestal", "4.3, 4.4, Fig. 4.6"),
    (36, "on the 3rd floor the mean slightly decreases with the pedestal", "4.3, Fig. 4.6"),
    (37, "on the 5th floor the mean slightly decreases with the pedestal", "4.3, Fig. 4.6"),
    (38, "each tower shows the floors' signs, except T1 on the 3rd floor", "4.3, 4.4, Fig. 4.6b"),
    (39, "on the ground floor T1's increase is much greater than T2's and T3's", "4.3, Fig. 4.6b"),
    (40, "on the 5th floor T1's decrease is much greater than T2's and T3's", "4.3, Fig. 4.6b"),
    (41, "the relative change is largest on the ground floor", "4.4, Fig. 4.5"),
    (42, "with the pedestal the mean is largest on the 5th floor", "4.4, Fig. 4.6"),
    (43, "without the pedestal the mean is largest on the ground floor", "4.4, Fig. 4.6"),
    (44, "the 3rd floor has the smallest mean for every tower, with and without pedestal", "4.4"),
    (45, "with the pedestal more is endured in Friuli, Kobe and Loma Prieta", "4.4, Fig. 4.7"),
    (46, "with the pedestal less is endured in Northridge", "4.4, Fig. 4.7; 5"),
    (47, "the increase is the most distinguished for Loma Prieta", "4.4, Fig. 4.7"),
    (48, "Friuli's increase is significant, Loma Prieta's and Kobe's much smaller", "5"),
    (49, "towers are in general more stable atop the pedestal", "5"),
    (50, "on the upper floors the pedestal lowers the acceleration, with few exceptions", "5"),
    (51, "the increase on the ground floor is significant", "5"),
    (52, "no correlation between the input motion and the effect can be found", "5"),
    (53, "more slender structures overturn under smaller excitation", "5"),
    (54, "trends should not be extrapolated to other geometries", "5"),
    (
        55,
        "each specimen met twelve motions; the figure is the one just before overturning",
        "3.3, 3.4",
    ),
    (56, "maximum acceleration follows from the shaker's force over the moved mass", "3.4"),
    (57, "nothing but rocking occurs", "abstract; 3.1, 3.2"),
    (58, "excluding sliding is the worst case", "abstract"),
)

STATEMENTS: dict[int, Statement] = {row[0]: Statement(*row) for row in _ROWS}
"""Statement by number, C1 to C58."""
