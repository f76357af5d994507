"""One full analysis of a four-bar at 360 crank angles, beside its peers, in one process.

The peers do less: the solve of the nine free-body equations is handed a matrix and right-hand
side that somebody else has filled in; SymPy's function returns shaking force, shaking moment and
drive torque, but no joint forces; Pinocchio's rnea treats the same links as an open chain and
returns no joint forces either, in a loop over the crank angles, since it takes one at a time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

import equipoise as eq
from peers import optional
from timing import in_turn, report

sp = optional("sympy", "sympy")
pin = optional("pinocchio", "pinocchio")

ANGLES = 360
MACHINE = eq.load("yamashita-1")


def everything() -> list[object]:
    """Motion of every link and point, and every force, of a machine that is known already."""
    analysis = eq.analyze(MACHINE, ANGLES)
    motion, forces = analysis.motion, analysis.forces
    links = [(x.angle, x.angular_velocity, x.angular_acceleration) for x in motion.links.values()]
    points = [(p.place, p.velocity, p.acceleration_vector) for p in motion.points.values()]
    return [
        links,
        points,
        forces.shaking_force,
        forces.shaking_moment,
        forces.weight,
        forces.drive_torque,
        forces.frame_force,
        forces.frame_moment,
        forces.joints,
    ]


def with_joint_forces() -> list[object]:
    """Shaking force and moment, drive torque, joint forces."""
    forces = eq.analyze(MACHINE, ANGLES).forces
    return [forces.shaking_force, forces.shaking_moment, forces.drive_torque, forces.joints]


def first_sight() -> object:
    """The same for a machine that has not been assembled and followed through its cycle yet."""
    return eq.analyze(replace(MACHINE), ANGLES).forces.joints


def free_bodies() -> Callable[[], object]:
    """The nine equations of Lee and Kim at every crank angle, filled in beforehand."""
    motion = eq.move(MACHINE, ANGLES)
    place = {name: point.place for name, point in motion.points.items()}
    matrix, right = np.zeros((ANGLES, 9, 9)), np.zeros((ANGLES, 9, 1))
    joints = (("A", None, 0), ("B", 0, 1), ("C", 1, 2), ("D", None, 2))
    for k, link in enumerate(MACHINE.links):
        center = motion.mass_centers[link]
        for j, (pin, by, on) in enumerate(joints):
            sign = (on == k) - (by == k)
            lever = place[pin] - center.place
            matrix[:, 3 * k, 2 * j] = matrix[:, 3 * k + 1, 2 * j + 1] = sign
            matrix[:, 3 * k + 2, 2 * j] = -sign * lever.imag
            matrix[:, 3 * k + 2, 2 * j + 1] = sign * lever.real
        body = MACHINE.links[link]
        force = body.mass * (center.acceleration_vector - complex(*MACHINE.gravity))
        right[:, 3 * k, 0], right[:, 3 * k + 1, 0] = force.real, force.imag
        right[:, 3 * k + 2, 0] = body.inertia * motion.links[link].angular_acceleration
    matrix[:, 2, 8] = 1.0
    torque = np.linalg.solve(matrix, right)[:, 8, 0]
    assert np.allclose(torque, eq.analyze(MACHINE, ANGLES).forces.drive_torque, rtol=1e-9)
    return lambda: np.linalg.solve(matrix, right)


def sympy_function() -> Callable[[], object]:
    """Closed form of the four-bar by SymPy, common subexpressions taken out."""
    theta, speed = sp.symbols("theta omega", real=True)
    points = {name: link.points for name, link in MACHINE.links.items()}
    b, c, d = points["crank"]["B"][0], points["coupler"]["C"][0], points["rocker"]["C"][0]
    dx, dy = MACHINE.frame["D"]
    dist2 = (dx - b * sp.cos(theta)) ** 2 + (dy - b * sp.sin(theta)) ** 2
    base = sp.atan2(dy - b * sp.sin(theta), dx - b * sp.cos(theta))
    coupler = base + sp.acos((c**2 + dist2 - d**2) / (2 * c * sp.sqrt(dist2)))
    rocker = base + sp.pi - sp.acos((d**2 + dist2 - c**2) / (2 * d * sp.sqrt(dist2)))
    angles = {"crank": theta, "coupler": coupler, "rocker": rocker}
    starts = {
        "crank": (0, 0),
        "coupler": (b * sp.cos(theta), b * sp.sin(theta)),
        "rocker": (dx, dy),
    }
    momentum = sp.zeros(2, 1)
    spin = kinetic = potential = 0
    for name, link in MACHINE.links.items():
        x, y = link.center_of_mass
        turn = sp.Matrix(
            [
                [sp.cos(angles[name]), -sp.sin(angles[name])],
                [sp.sin(angles[name]), sp.cos(angles[name])],
            ]
        )
        place = sp.Matrix(starts[name]) + turn * sp.Matrix([x, y])
        rate, turning = place.diff(theta), sp.diff(angles[name], theta)
        momentum += link.mass * rate
        spin += link.mass * (place[0] * rate[1] - place[1] * rate[0]) + link.inertia * turning
        kinetic += (link.mass * rate.dot(rate) + link.inertia * turning**2) / 2
        potential += link.mass * 9.80665 * place[1]
    outputs = [
        *(-momentum.diff(theta) * speed**2),
        -sp.diff(spin, theta) * speed**2,
        sp.diff(kinetic, theta) * speed**2 + sp.diff(potential, theta),
    ]
    compiled = sp.lambdify((theta, speed), outputs, "numpy", cse=True)
    grid = np.arange(ANGLES) * (2 * np.pi / ANGLES)
    drive = MACHINE.drive.speed
    assert np.allclose(compiled(grid, drive)[3], full_forces().drive_torque, rtol=1e-7, atol=1e-9)
    return lambda: compiled(grid, drive)


def full_forces() -> eq.mechanism.Forces:
    return eq.analyze(MACHINE, ANGLES).forces


def pinocchio_loop() -> Callable[[], object]:
    """Inverse dynamics of crank and coupler as an open chain, one crank angle after the other."""
    model = pin.Model()
    parent, offset = 0, 0.0
    for name in ("crank", "coupler", "rocker"):
        link = MACHINE.links[name]
        placement = pin.SE3(np.eye(3), np.array([offset, 0.0, 0.0]))
        joint = model.addJoint(parent, pin.JointModelRZ(), placement, name)
        body = pin.Inertia(
            link.mass, np.array([*link.center_of_mass, 0.0]), np.diag([link.inertia] * 3)
        )
        model.appendBodyToJoint(joint, body, pin.SE3.Identity())
        parent, offset = joint, max(x for x, _ in link.points.values())
    data = model.createData()
    motion = eq.move(MACHINE, ANGLES)
    columns = [
        np.stack([getattr(motion.links[name], key) for name in MACHINE.links], axis=1)
        for key in ("angle", "angular_velocity", "angular_acceleration")
    ]
    rows = list(zip(*columns, strict=True))
    return lambda: [pin.rnea(model, data, q, v, a) for q, v, a in rows]


if __name__ == "__main__":
    tasks = {
        "9 x 9 solve, filled in": free_bodies(),
        "equipoise, all of every link and point too": everything,
        "equipoise, analysis with joint forces": with_joint_forces,
        "equipoise, a machine seen for the first time": first_sight,
    }
    if sp is not None:
        tasks["sympy lambdify(cse=True)"] = sympy_function()
    if pin is not None:
        tasks["pinocchio rnea, loop"] = pinocchio_loop()
    report(in_turn(tasks, rounds=300), "9 x 9 solve, filled in", 1e-6, "us")
