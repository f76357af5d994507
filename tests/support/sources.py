"""What numbers are compared with: papers, standards, textbooks, other programs and second routes.

In the order of the page.
"""

from __future__ import annotations

from support.conformance import Source

KIM_CHUNG = Source(
    "Kim and Chung",
    """K. U. Kim, C. J. Chung, "An analytical method for kinematic analysis of the planting
    mechanism of a rice transplanter", Seoul National University, about 1977. They read
    the angles of joints off a protractor at every tenth degree of the crank. *Their readings* is
    what their own equations give with these angles up to half a degree off. Crank angles are their
    theta2.""",
    ('Table 2 calls both soil crossings "entry position"',
     "Table 2 has largest acceleration in degrees; it is in m/s2"),
)  # fmt: skip
YAMASHITA = Source(
    "Yamashita, Ichikawa and Mori",
    """M. Yamashita, M. Ichikawa, K. Mori, "Studies on control of vibrations originating in
    rice transplanting mechanism consisting of the four bar linkage" (in Japanese), about 1982. Of
    the open differences 19 are one: what Table 4 has more than their own data give is a bump of
    0.4 m/s2 near 47 deg.""",
    ("section 5-2 has three crank angles at which coupler.center_y is without effect; the fourth,"
     " 330.6 deg, is missed",
     "the sentence before (60) to (62) calls the line theta_(i+1) = m theta_i + n; in the equations"
     " n is the slope and m the intercept",),
)  # fmt: skip
LEE_KIM = Source(
    "Lee and Kim",
    """J. K. Lee, K. U. Kim, "Dynamic balancing of crank-type transplanting mechanism of rice
    transplanter" (in Korean), Seoul National University, about 1990. The pitch radius r_g4 of
    the gear on the rocker and the gears' moments of inertia, part of (26), are not printed. Here
    the radius is 50 mm, which gives the energy of mechanism B, and the gears are without mass.""",
    ("the summary has the counterweight faster than the rocker; by Table 4 it is slower, n < 1",),
)
NAGAMINE_IRIE = Source(
    "Nagamine and Irie",
    """M. Nagamine, T. Irie, "On the vibration characteristics of a brush cutter" (in
    Japanese), Bulletin of the Faculty of Engineering, Hokkaido University 56 (1970), pp. 39-47,
    <https://hdl.handle.net/2115/40993>. Most of its figures are read off curves.""",
    ("section 3.3 calls the stiffness of two hands, 2 x 51 kgf/cm, k1; it is k2",),
)
ISO_5349 = Source(
    "ISO 5349",
    """[1] ISO 5349-1:2001, "Mechanical vibration - Measurement and evaluation of human
    exposure to hand-transmitted vibration - Part 1: General requirements"; [2] ISO 5349-2:2001,
    "Part 2: Practical guidance for measurement at the workplace". The standards themselves are
    not at hand. Table A.2 is read in annex 3 of the Japanese notification No. 3, which quotes it;
    the examples, 5.3 and Table C.1 in the tests and pictures of phonometry
    (<https://github.com/jmrplens/phonometry>), written from the standards; 4.4 in what
    booksellers show of AS ISO 5349.1:2013.""",
)
ISO_8041 = Source(
    "ISO 8041",
    """ISO 8041-1:2017, "Human response to vibration - Measuring instrumentation - Part 1:
    General purpose vibration meters". The standard itself is not at hand: Table 3 is read in the
    reference manual of the Larson Davis HVM200, Table 3.1 (of the edition of 2005); Tables 1, 4,
    5 and B.6 in the test data of phonometry, transcribed from the standard. Both agree with each
    other and with Table A.2 of ISO 5349-1.""",
)
RULES = Source(
    "Rules on exposure",
    """[3] Directive 2002/44/EC, in the consolidated text of 26 July 2019. [4] Notifications
    Kihatsu 0710 No. 1, 2 and 3 of the Japanese Ministry of Health, Labour and Welfare, 10 July
    2009; that T is 200/a^2 and at most two hours, makers print, as Husqvarna. [5] ISO 22867; that
    both modes count alike, the manual of the Stihl FS 40, 20.6. [6] Health and Safety Executive,
    "Hand-arm vibration at work" (L140), from memory.""",
)
BEAMS = Source(
    "Roots of beams",
    """lambda L of uniform beams in bending, roots of the frequency equations of the textbook,
    to ten digits. Clamps and pins are springs here, which give way by some 1e-9 of a root.""",
)
BODIES = Source(
    "Moments of inertia",
    """F. P. Beer, E. R. Johnston, "Vector mechanics for engineers", inside of the back cover,
    and polar sums of these.""",
)
CLOSED_FORMS = Source(
    "Closed forms",
    "Machines so simple that the answer can be written down: series, triangles, circles.",
)
MUJOCO = Source(
    "MuJoCo",
    """Every link loose, the motion forced upon it, and inverse dynamics at 24 crank angles; and
    exported files as they are.""",
)
PINOCCHIO = Source(
    "Pinocchio",
    """An open tree of hinges, cut where loops close, and recursive Newton-Euler at 24 crank angles;
    and exported trees.""",
)
EXUDYN = Source(
    "Exudyn",
    """The bundled `exudyn-slider-crank` on its mounts, built anew from its numbers and
    integrated in time, with the error of the steps taken out. Made with version 1.13.""",
)
ADAMS = Source(
    "MSC Adams",
    """An inverse dynamics run of a four-bar, of which the repository
    MBDS/multibody-state-estimation (<https://github.com/MBDS/multibody-state-estimation>, BSD
    licence) keeps the result and the links; the crank swings by 1.2 (1 - cos 2t).""",
)
ROSS = Source(
    "ROSS",
    """The shaft of a brush cutter with six stations as a rotor of 12, 24 and 48 elements,
    with the error of their length taken out. Made with version 2.3, which brings a hundred
    packages: these tests are skipped where the extra `bench` is not installed.""",
)
FINITE_ELEMENTS = Source(
    "Finite elements",
    """Random tools by elements written anew for the tests, extrapolated from three meshes of
    up to 192.""",
)
NEWTON = Source(
    "Newton's method",
    """All constraints at once, from random guesses: positions, velocities and accelerations
    of all links and points.""",
)
FREE_BODIES = Source(
    "Free bodies",
    "Every link cut free, and all equilibria solved at once, with weight, loads, springs and soil.",
)
IN_TIME = Source(
    "Free bodies in time",
    """A linkage on its support, cut free at every instant and followed in time until it comes
    back: (37) to (43) of Yamashita, Ichikawa and Mori, written anew.""",
)
SERIES = Source(
    "Fourier series",
    """Figures of planting, stays, loops and cusps by angles, cosines and series in long doubles;
    the length of a hole to 1e-7 where the finger's foot dips below the surface.""",
)
BLIND_SEARCH = Source(
    "Other optima",
    """Plans of balancing by differential evolution over all that they free, polished, and as convex
    programs in other matrices by CVXPY. Random plans are of random machines.""",
)
FILTER = Source(
    "The filter of Wh", "Polynomials of SciPy, and the filter's equations integrated in time."
)
