"""Speed of Yade's concrete model (CPM), for the bench: yade -n -x -j1 yade_concrete.py OUT.json

A dense hexagonal packing of about 25,000 equal spheres, each bonded to its 12 touching neighbours and the 6 next
nearest (interaction detection factor 1.5), is pulled along z. Every sphere starts with the velocity of a uniform
extension, so that no wave runs through the specimen; the two end layers keep theirs. Runs of a fixed number
of steps are timed, by the processor time they take, in two states: intact, and cracked, reached by a faster pull.

The packing is regular, so neighbours stand close in memory: the best that Yade can have.
"""

import json
import sys
import time

from yade import pack, utils

RADIUS = 1e-3  # m
SIDE = 53e-3  # of the square cross section, m
HEIGHT = 57e-3  # m
TIMED_STEPS = 50
REPETITIONS = 5
WARM_UP_STEPS = 20
CRACKED_SHARE = 0.2  # of the interactions


def make_packing():
    O.materials.append(CpmMat(young=30e9, poisson=0.2, density=4800, frictionAngle=0.8, sigmaT=3.5e6,
                              epsCrackOnset=1e-4, relDuctility=30))
    corner = (SIDE, SIDE, HEIGHT)
    O.bodies.append(pack.regularHexa(pack.inAlignedBox((0, 0, 0), corner), radius=RADIUS, gap=0))


def bond():
    O.engines = [
        ForceResetter(),
        # bounds are enlarged a little, so that sorting is not needed again while spheres hardly move
        InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.5, label="bounds")],
                              verletDist=0.05 * RADIUS, label="collider"),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=1.5, label="geometry")],
                        [Ip2_CpmMat_CpmMat_CpmPhys(cohesiveThresholdIter=10)],
                        [Law2_ScGeom_CpmPhys_Cpm()]),
        NewtonIntegrator(damping=0.3),
    ]
    O.dt = 0.5 * utils.PWaveTimeStep()
    O.step()
    bounds.aabbEnlargeFactor = geometry.interactionDetectionFactor = 1.0


def pull(rate):
    """Sets the velocities of a uniform extension at a rate, 1/s; the end layers keep theirs."""
    low, high = 2.5 * RADIUS, max(b.state.pos[2] for b in O.bodies) - 1.5 * RADIUS
    for body in O.bodies:
        z = body.state.pos[2]
        body.state.vel = (0, 0, rate * (z - 0.5 * HEIGHT))
        if z < low or z > high:
            body.state.blockedDOFs = "xyzXYZ"


def damaged_share():
    damaged = sum(i.phys.omega > 0 for i in O.interactions if i.isReal)
    return damaged / O.interactions.countReal()


def measure(state):
    O.run(WARM_UP_STEPS, True)
    damaged, sorts = damaged_share(), collider.numAction
    seconds = []
    for _ in range(REPETITIONS):
        begin = time.process_time()
        O.run(TIMED_STEPS, True)
        seconds.append(time.process_time() - begin)
    return {"state": state, "interactions": O.interactions.countReal(), "damaged": [damaged, damaged_share()],
            "steps": TIMED_STEPS, "seconds": seconds, "collider_runs": collider.numAction - sorts}


def crack():
    pull(rate=20.0)
    while damaged_share() < CRACKED_SHARE:
        O.run(10, True)
    pull(rate=0.1)


make_packing()
bond()
pull(rate=0.1)
intact = measure("intact")
crack()
result = {"program": "Yade " + yade.config.version, "spheres": len(O.bodies), "states": [intact, measure("cracked")]}
with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump(result, file, indent=1)
