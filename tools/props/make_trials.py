#!/usr/bin/env python3
"""Meshes and start poses of the experiments that need more than the shapes of the shot language.

    tools/props/make_trials.py shots/verify

writes the stones of a catenary arch, a house of steep cards, a bolt and its nut. Lengths are in the
unit of the shot that uses them. Every part is one closed surface.
"""
import math
import os
import sys

from forms import cells, extruded, lofted, ring_about_y, thread, write_objects
from make_props import card_poses, write_poses


def write_parts(path, parts, words):
    write_objects(path, parts, words, maker="make_trials.py", decimals=7, digits=8)


def catenary_arch(stones=25, half_span=3.0, rise=4.0, thickness=0.6, depth=1.2, foot=0.8):
    """Stones of equal length along y = foot + rise - a (cosh(x / a) - 1), joints across the curve."""
    low, high = 0.1, 100.0
    for _ in range(200):
        a = 0.5 * (low + high)
        # The wider the parameter, the flatter the chain.
        low, high = (a, high) if a * (math.cosh(half_span / a) - 1.0) > rise else (low, a)
    reach = a * math.sinh(half_span / a)  # half the length of the curve

    def at(s, out):
        """The point so far along the curve from the crown and so far outside it."""
        x = a * math.asinh(s / a)
        y = foot + rise - a * (math.cosh(x / a) - 1.0)
        slope = math.sinh(x / a)
        length = math.hypot(1.0, slope)
        return x + out * slope / length, y + out / length

    for i in range(stones):
        ends = [reach * (2.0 * (i + end) / stones - 1.0) for end in (0, 1)]
        planes = ([0, 0.5, 1], [-0.5, 0.0, 0.5], [-0.5, 0.0, 0.5])
        points, faces = cells(planes, lambda i, j, k: True)
        # Straight between the joints, which therefore fit whatever the curve does.
        placed = []
        for along, out, across in points:
            (x0, y0), (x1, y1) = (at(s, thickness * out) for s in ends)
            placed.append((x0 + along * (x1 - x0), y0 + along * (y1 - y0), depth * across))
        yield f"stone_{i:02d}", (placed, faces)
    for name, side in (("left", -1), ("right", 1)):
        inner, outer = (at(side * reach, thickness * out) for out in (-0.7, 0.7))
        outline = [inner, outer, (outer[0], 0.0), (inner[0], 0.0)]
        yield f"abutment_{name}", extruded(outline if side < 0 else outline[::-1], 1.4 * depth)


PITCH, TURN, ROWS = 0.25, 36, 12  # of the thread [m], points around, points along a pitch
CORE, DEPTH, PLAY = 0.5, 0.1, 0.012  # radius at its foot, height of the thread, room between [m]


def wall(height, radius_of):
    """Rows of points, from y = 0 up, around a threaded wall."""
    rows = round(height / PITCH * ROWS)
    return [ring_about_y(PITCH * j / ROWS, [radius_of(j / ROWS - i / TURN) for i in range(TURN)])
            for j in range(rows + 1)]


def bolt(height=2.0):
    return lofted(wall(height, lambda phase: CORE + DEPTH * thread(phase)), is_closed=False)


def nut(height=0.5, outer=0.85):
    """The bolt's thread with PLAY around it, within a round body."""
    inner = wall(height, lambda phase: CORE + PLAY + DEPTH * thread(phase))
    outside = [ring_about_y(PITCH * j / ROWS, [outer] * TURN) for j in range(len(inner))]
    # Up the outside, over the top, down the inside, and below back to where it began.
    return lofted(outside + inner[::-1], is_closed=True)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    write_parts(os.path.join(sys.argv[1], "catenary.obj"), catenary_arch(),
                "Twenty-five stones of an arch and what it stands on [m]")
    write_parts(os.path.join(sys.argv[1], "bolt.obj"), [("bolt", bolt())],
                "A bolt with a thread of 0.25 pitch [m]")
    write_parts(os.path.join(sys.argv[1], "nut.obj"), [("nut", nut())],
                "Its nut, with a play of 12 mm [m]")
    for name, poses in card_poses(lean=20.0):
        write_poses(os.path.join(sys.argv[1], name.replace("cards", "cards_steep") + ".poses"), poses)


if __name__ == "__main__":
    main()
