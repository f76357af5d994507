"""What a good designer holds to, as settings: from when something is worth building, and how it is.

None of them is mechanics: each could be a little more or less.  They stand here with their reasons,
apart from the tolerances and steps of the methods that use them.
"""

from __future__ import annotations

from math import pi

# -- what is looked at -----------------------------------------------------------------------------

AIMED_FROM = 0.5
"""Share of its yardstick from which something is tried against a figure that shakes: what costs
little is worth building there too."""
LITTLE_MASS = 0.05
"""Over the mass of the moving links: what may be added against a figure that is not large."""
MOST_ADDED_MASS = 1 / 3
"""Over the mass of the moving links of a row: what is added at most unasked."""

# -- what is worth it ------------------------------------------------------------------------------

LEAST_GAIN = 0.15
"""Share of an aim that has to go for any change of masses, mounts or levers to be worth a drawing;
less drowns in what is not known of masses.  So much has to go of the figure that is large too, in
the measure in which it is: an RMS may fall while the peak, for which bearings and screws are
chosen, hardly does."""
LEAST_GAIN_OF_ADDED = 0.25
"""The same where mass is added: a part more, with screws and clearance of its own.  Bearings,
screws and feet come in steps of a quarter (the preferred numbers R 10 of ISO 3), so that less
changes none of them, and a person hardly feels it."""
MASS_PRICE = 1.0
"""Share of the aim that has to go for a mass as large as that of the moving links, for less in
proportion: which frame, bearings and drive carry as well."""
LEAST_NET_GAIN = 0.05
"""What has to be left of the share that goes, less the price of mass: where both are about equal,
nobody makes a drawing."""
PEAK_PRICE = 2 / 3
"""Share of a peak that has to go for a mass as large as that of the moving links: peaks fall less
than RMS."""
WORTH_NAMING = 0.3
"""Share of its aim from which what is not drawn here, such as a shaft more, is named."""
ENOUGH_OF_BEST = 0.5
"""Share of the most that any remedy brings from which a simpler one is offered."""
ALL_BUT_GONE = 0.9
"""Share of an aim that a change takes away from which nobody changes the mounts as well."""
FALLEN = 0.1
"""Share that is gone of another large figure from which it is said that it falls as well."""
NOTICED = 0.01
"""Share of an objective from which a change of it is reported."""
HEAVY = 0.5
"""Added mass over that of all links from which it is called large."""

# -- what may grow ---------------------------------------------------------------------------------

HEADLINE_GROWTH = 1.01
"""Times its value before, that a headline figure may be after."""
PART_GROWTH = 1.05
"""The same of a single joint or component: the life of a bearing falls by a seventh."""
TRIFLE = 0.1
"""Share of its yardstick up to which a figure may grow."""
GROWTH_OF_GAIN = 0.1
"""Growth of a figure that is as good as nothing beside the share of the aim that is gone, each over
what is large of its kind."""
SMALL_FIGURE = 0.75
"""What stays so small, over what is large of its kind, may grow more,"""
GROWTH_OF_SAVED = 0.5
"""by this part of what is saved."""
COUPLE_FROM_NOTHING = 0.1
"""Of a couple after a change: what it was less before, it was as good as nothing."""

# -- room and shapes -------------------------------------------------------------------------------

CLEARANCE = 0.02
"""Over the size of the largest link, and together with `LEAST_CLEARANCE`: a counterweight's from
the edge of a body, and from the middle of a pin whose radius is not given."""
LEAST_CLEARANCE = 2e-3
"""m; alone from a pin's edge."""
REACH_OF_LARGEST_LINK = 0.25
"""Over the size of the largest link: how far a counterweight is assumed to reach at most, where its
link does not reach farther."""
REACH_OF_LINK = 2.0
"""Over the reach of its own link, up to this times the share of the largest link."""
REACH_OF_CRANK = 2.5
"""Over the throw of a crank that turns, as webs and discs of cranks do, within what the machine
sweeps."""
OVER_SOIL = 0.05
"""m over the soil, below which no counterweight reaches: hills that are planted, clods and stubble
pass there.  A choice, as no file says how high they stand; a plan's own room takes its place."""
LARGEST_PLATE = 0.6
"""m: beyond which nobody cuts a counterweight of plate."""
THICKNESS_OF_REACH = 0.3
"""Of a plate over the largest radius of its room."""
THICKNESS_OF_LINK = 3.0
"""Of a plate over the thickness of the link that carries it."""
THICKEST_PLATE = 0.03
"""m, beyond which no workshop screws it on."""
PLATES = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""Thicknesses of plate, times a power of ten, mm: those in stock, of which a plate is cut."""
ROOM_ABOUT_PIN = 0.05
"""m: reach of a counterweight on a link that has no other point than its pin, or the size of the
machine where that is less: nothing else says how far such a link may reach."""
HUB = 0.25
"""Inner radius of a sector over its outer one: inside is the shaft."""
MOST_TAKEN = 0.5
"""Share of a link's mass that is taken off it at most: the rest bears its load."""
HOLE_RADII = (5e-3, 10e-3, 15e-3, 20e-3, 30e-3, 40e-3)
"""m, of holes that take mass off: a drill makes the smaller ones, a hole saw the others."""

# -- gauges ----------------------------------------------------------------------------------------

QUIET_GAUGE = 1 / 3
"""Share of what the loudest gauge reads, each over its limit, below which a gauge is not what a
change is for: it may not grow, but to quiet it would cost what the loudest needs."""

# -- mounts ----------------------------------------------------------------------------------------

AMPLIFIED = 1.5
"""A resonance lies beside a speed where its mode makes so many times the motion of it that stiff
or soft mounts alone would leave: with less, a mass that halves the force does as much."""
AMPLIFIED_LEFT = 2.0
"""The same with other mounts, which have to bring something anyway, and may come nearer."""
STIFFNESS_FACTORS = (1 / 2, 1 / 3, 1 / 4, 2.0, 3.0, 4.0)
"""Times the stiffness of the mounts that are tried; softer ones isolate, and come first."""
SHARE_OF_ENERGY = 0.1
"""Of the energy of a mode, from which a mount takes part in it."""
SHARE_OF_READING = 0.3
"""Of the velocity that a gauge reads, RMS: a mode that an order moves by less is not what makes it
read so much.  Without it the reading is some 5 % less, as orders add by their squares."""
MASSES_BESIDE_MOUNTS = 2 / 3
"""Share of what other mounts bring from which a change of masses is worth it as well: beside a
resonance mass moves the frequency too, so that less is a matter of luck."""

# -- flywheels -------------------------------------------------------------------------------------

MISSED_INERTIA = 0.1
"""Share of a flywheel's inertia that nobody misses."""
SHAFT_RATIOS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 24)
"""Turns of a flywheel's shaft in one of the crank: of a crank that turns slowly, as of a press, it
sits on the shaft of the motor or of a belt, where the square of the ratio less will do.  The shaft
of a motor that the file gives comes first of those that are faster than the crank."""
RIM_SPEED = 40.0
"""m/s, that a disc's edge may have: usual for cast iron, safe for steel."""
THINNEST_DISC, THICKEST_DISC = 1 / 30, 1 / 3
"""Thickness of a disc over its diameter: a thinner one flutters, and cannot be turned true."""
HEAVIEST_FLYWHEEL, HEAVIEST_ASIDE = 2.0, 1.0
"""Mass of a flywheel over that of the moving links beyond which a faster shaft is looked at: on the
crank, and on a shaft that the machine may have for it."""
SLOW_CRANK = 0.5
"""Acceleration of the crank's end over gravity up to which a weight on it acts by being heavy."""

# -- cylinders -------------------------------------------------------------------------------------

CYLINDER_PRESSURE = 200e5
"""Pa, at which a bore is sized: 200 bar, as of tractors and small hydraulic units."""
THIN_ROD, THICK_ROD = 0.45, 0.75
"""Rod over bore: of the usual thin one, and the most that leaves an area to pull with."""
BUCKLING_SAFETY = 3.5
"""Over the load at which a rod with pins at both ends buckles."""
DEAD_BORES = 3.0
"""Bores that piston, gland and both eyes take of the closed length."""
LONGER_LEVERS = (1.1, 1.2, 1.3)
"""Times the distance of a pin from the pivot that are tried."""

# -- lengths, shafts and pistons -------------------------------------------------------------------

POOR_TRANSMISSION = 1.1
"""Times the distance of the usual limit from 90 deg, from which a transmission angle is poor: at
35 deg."""
LENGTH_CHANGES = (-0.05, 0.05, -0.1, 0.1, -0.2, 0.2)
"""Shares by which a length is changed to mend it."""
LEAST_MENDED = pi / 60
"""rad, 3 deg, by which a transmission angle has to get better."""
WORTH_SHAFTS = 8.0
"""Times its yardstick from which a shaking force is worth two more shafts."""
ARMS = (2, 3, 4)
"""Arms on a carrier that are looked at, the fewest first."""
PISTON_SHARE = 0.5
"""Share of the shaking force (RMS) from which what turns against the crank is that of a piston."""
ABOUT_HALF = 0.1
"""Of what reciprocates, by which a share of it is taken for half."""
