#!/usr/bin/env python3
"""Start poses for heaps: bodies scattered evenly in upright cylinders, none touching another.

Prints a pose file (x y z qw qx qy qz a line) for each kind of body into --output, one file a kind:

    tools/scatter_poses.py --seed 1 --column 0,0,20,30,330 --tilt 0.2 \\
        --kind ring:500:2.0 --output shots/poses/rings_paper_500

writes shots/poses/rings_paper_500_ring.poses: 500 rings that fit balls of radius 2.0, with centres
so that the balls stay inside a column of radius 20 about x = z = 0 from y = 30 to y = 330. Balls
that do not overlap hold bodies that do not, whichever way they are turned. --tilt limits by how
much the body's y axis leans from upright [rad]; without it any orientation is as likely.
"""
import argparse
import math
import random


def orientation(draw, tilt):
    """A quaternion w x y z: uniform, or a random heading with a lean of at most `tilt`."""
    if tilt is None:
        q = [draw.gauss(0.0, 1.0) for _ in range(4)]
        length = math.sqrt(sum(c * c for c in q))
        return [c / length for c in q]
    lean, towards = tilt * draw.random(), 2.0 * math.pi * draw.random()
    heading = 2.0 * math.pi * draw.random()
    c, s = math.cos(0.5 * heading), math.sin(0.5 * heading)
    a, b = math.cos(0.5 * lean), math.sin(0.5 * lean)
    x, z = b * math.cos(towards), b * math.sin(towards)
    # (a, x, 0, z) after (c, 0, s, 0).
    return [a * c, x * c - z * s, a * s, z * c + x * s]


class Grid:
    """Balls by cell, so that a new one is held only against its neighbours."""

    def __init__(self, cell):
        self.cell, self.balls = cell, {}

    def key(self, p):
        return tuple(math.floor(c / self.cell) for c in p)

    def is_free(self, p, radius):
        i, j, k = self.key(p)
        for n in ((i + a, j + b, k + c) for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1)):
            for q, r in self.balls.get(n, ()):
                if math.dist(p, q) < radius + r:
                    return False
        return True

    def add(self, p, radius):
        self.balls.setdefault(self.key(p), []).append((p, radius))


def scatter(columns, kinds, seed, tilt):
    draw = random.Random(seed)
    grid = Grid(2.0 * max(radius for _, _, radius in kinds))
    poses = {name: [] for name, _, _ in kinds}
    # The largest first: they find room hardest.
    for name, count, radius in sorted(kinds, key=lambda kind: -kind[2]):
        tries = 0
        while len(poses[name]) < count:
            tries += 1
            if tries > 10000 * count:
                raise SystemExit(f"no room for {count} of {name}: {len(poses[name])} placed")
            x, z, width, low, high = columns[int(draw.random() * len(columns))]
            r = (width - radius) * math.sqrt(draw.random())
            angle = 2.0 * math.pi * draw.random()
            y = low + radius + (high - low - 2.0 * radius) * draw.random()
            p = (x + r * math.cos(angle), y, z + r * math.sin(angle))
            if grid.is_free(p, radius):
                grid.add(p, radius)
                poses[name].append((p, orientation(draw, tilt)))
    return poses


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--column", action="append", required=True,
                        help="x,z,radius,low,high of an upright cylinder; may be given again")
    parser.add_argument("--kind", action="append", required=True, help="NAME:COUNT:RADIUS")
    parser.add_argument("--tilt", type=float)
    parser.add_argument("--output", required=True, help="beginning of the files' names")
    options = parser.parse_args()
    columns = [tuple(float(c) for c in text.split(",")) for text in options.column]
    kinds = [(n, int(c), float(r)) for n, c, r in (text.split(":") for text in options.kind)]
    for name, poses in scatter(columns, kinds, options.seed, options.tilt).items():
        radius = next(r for n, _, r in kinds if n == name)
        with open(f"{options.output}_{name}.poses", "w", encoding="ascii") as file:
            file.write(f"# x y z qw qx qy qz of {len(poses)} bodies, each in a ball of {radius:g} that "
                       f"no other enters;\n# made by tools/scatter_poses.py --seed {options.seed}.\n")
            for p, q in poses:
                file.write(" ".join(f"{c:.9g}" for c in (*p, *q)) + "\n")


if __name__ == "__main__":
    main()
