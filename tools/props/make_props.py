#!/usr/bin/env python3
"""Meshes and start poses of the shots that need more than the shapes of the shot language.

    tools/props/make_props.py shots

writes shots/meshes/*.obj and shots/poses/*.poses: crockery, a chain, the stones of an arch and of a viaduct, gears
and their bucket, a bolt and its nut, the letters of a word, a house of cards, an hourglass, a spiral of dominoes, a
truck, a hillside and a broken wall. Lengths are in the unit of the shot that uses them. Every mesh
but the mug and the hillside is one closed surface; a mug's handle is pushed into its wall, as
modellers do, and the shot has it wrapped.
"""
import math
import os
import random
import sys

from forms import (arc, ball, cells, extruded, joined, lofted, moved, plate_with_bore, revolved, ring_about_y,
                   rounded, stroke, swept, thread, write_obj, write_objects)
from shards import box, clipped, shards, triangulated


def vessel(curve, thickness):
    """Profile of a dish whose outside is its inside, lowered: such dishes nest."""
    inside = list(curve)
    outside = [(r, y - thickness) for r, y in inside]
    return outside + inside[::-1]


def crockery():  # cm
    plate = [(0.0, 0.0), (3.5, 0.0), (7.0, 0.0), (8.0, 0.25), (9.0, 0.8), (10.5, 1.35), (12.0, 1.7)]
    yield "plate", revolved(vessel(plate, 0.6), 40), "A dinner plate, 24 across [cm]"
    bowl = [(0.0, 0.0), (1.5, 0.0), (3.0, 0.0), (4.2, 0.7), (5.3, 1.7), (6.2, 2.7), (7.0, 3.8),
            (7.7, 4.8)]
    yield "bowl", revolved(vessel(bowl, 0.8), 32), "A bowl, 15 across [cm]"
    wall = [(0.0, 0.0), (3.0, 0.0), (3.8, 0.4), (4.0, 1.0), (4.0, 5.0), (4.0, 9.0), (3.4, 9.0),
            (3.4, 5.0), (3.4, 1.2), (3.0, 0.8), (0.0, 0.8)]
    handle = [(3.65, 7.2), (4.8, 7.3), (5.9, 6.9), (6.5, 6.0), (6.6, 4.9), (6.3, 3.7), (5.5, 2.7),
              (4.6, 2.2), (3.65, 2.0)]
    mug = joined(revolved(wall, 28), swept(handle, 0.45, 8, is_closed=False))
    yield "mug", mug, "A mug; the handle ends inside the wall [cm]"


def chain():  # cm
    bend, straight = 1.4, 2.6
    path = arc((0.5 * straight, 0.0), bend, -90, 90, 8) + arc((-0.5 * straight, 0.0), bend, 90, 270, 8)
    yield "link", swept(path, 0.6, 8), "A link of chain, 6.6 long along x [cm]"


def wedge_of_ring(inner, outer, angle, depth, steps):
    """A stone of an arch about +z, straight above the origin."""
    lower = arc((0.0, 0.0), inner, 90.0 - 0.5 * angle, 90.0 + 0.5 * angle, steps)
    upper = arc((0.0, 0.0), outer, 90.0 + 0.5 * angle, 90.0 - 0.5 * angle, steps)
    return extruded(lower[::-1] + upper[::-1], depth)


STONES, STONE_ANGLE = 15, 12.0


def arch():  # m
    yield ("voussoir", wedge_of_ring(2.0, 2.62, STONE_ANGLE, 1.3, 2),
           "One of fifteen stones of an arch of 2 inside, about its own axis [m]")
    yield ("keystone", wedge_of_ring(1.93, 2.85, STONE_ANGLE, 1.42, 2),
           "The stone at the top of the arch, a little proud of it [m]")
    cable, length, radius = 0.05, 5.0, 0.34
    neck = math.degrees(math.asin(cable / radius))
    bob = [(radius * math.cos(math.radians(a)), radius * math.sin(math.radians(a)) - length)
           for a in [-90 + (180 - neck) * i / 14 for i in range(1, 15)]]
    rope = [(cable, -length * (1 - i / 8)) for i in range(1, 9)]
    profile = [(0.0, -length - radius), *bob, *rope, (0.0, 0.0)]
    yield "wrecking_ball", revolved(profile, 20), "A ball of 0.68 on a cable, from where it hangs [m]"


VIADUCT = {"bays": 6, "bay": 3.6, "pier": 0.45, "height": 4.4, "crown": 0.22, "stones": 17, "depth": 1.2}


def pieces(stone):
    """A stone of the viaduct is laid in so many, so that joints in its depth are bonded."""
    return 2 + stone % 2


def viaduct():  # m
    """The stones of one arch from its crown to the right. They are cut from a block above the
    springing, as wide as a bay and up to the deck: below first, for the rays meet in its foot."""
    v = VIADUCT
    inner = 0.5 * (v["bay"] - v["pier"])
    step = math.pi / v["stones"]
    for i in range(v["stones"] // 2 + 1):
        depth = v["depth"] / pieces(i)
        low, high, middle = (i - 0.5) * step, (i + 0.5) * step, i * step
        stone = box((v["bay"], inner + v["crown"], depth))
        for across, up, limit in ((-math.sin(middle), -math.cos(middle), -inner * math.cos(0.5 * step)),
                                  (-math.cos(low), math.sin(low), 0.0),
                                  (round(math.cos(high), 12), -math.sin(high), 0.0)):
            stone = clipped(stone, (across, up, 0.0), limit + 0.5 * v["bay"] * across)
        yield (f"viaduct_{i}", moved(triangulated(stone), (-0.5 * v["bay"], 0.0, -0.5 * depth)),
               "A stone of a viaduct about +z, its arch springing from y = 0 [m]")


def gear(teeth, outer, depth, bore):
    root = outer - 2.2 * outer / teeth
    outline = []
    for i in range(teeth):
        for share, radius in ((0.0, root), (0.27, root), (0.4, outer), (0.6, outer), (0.73, root)):
            a = 2.0 * math.pi * (i + share) / teeth
            if share:
                outline.append((radius * math.cos(a), radius * math.sin(a)))
    return plate_with_bore(outline, bore, depth)


def gears():  # m
    yield "gear_large", gear(16, 0.42, 0.16, 0.13), "A gear of 16 teeth, axis z [m]"
    yield "gear_small", gear(10, 0.28, 0.2, 0.08), "A gear of 10 teeth, axis z [m]"
    bucket = [(0.0, 0.0), (0.7, 0.0), (1.25, 0.0), (1.32, 0.5), (1.4, 1.0), (1.47, 1.5), (1.55, 2.0),
              (1.62, 2.0), (1.62, 2.12), (1.45, 2.12), (1.36, 1.5), (1.28, 1.0), (1.2, 0.5),
              (1.14, 0.12), (0.6, 0.12), (0.0, 0.12)]
    yield "bucket", revolved(bucket, 48), "A bucket 2.12 high, open above [m]"
    half, arm = 0.07, 0.98
    cross = [(half, -half), (arm, -half), (arm, half), (half, half), (half, arm), (-half, arm),
             (-half, half), (-arm, half), (-arm, -half), (-half, -half), (-half, -arm), (half, -arm)]
    blade, faces = extruded(cross, 0.45)
    # From the plane of x and y to that of x and z.
    yield "stirrer", ([(x, z, y) for x, y, z in blade], faces), "Four blades about +y [m]"


def hexagon(apothem, points):
    """Radii of a hexagon."""
    turns = [360.0 * i / points % 60.0 - 30.0 for i in range(points)]
    return [apothem / math.cos(math.radians(turn)) for turn in turns]


def bolts(pitch=2.5, core=5.0, depth=0.8, play=0.12, flat=9.0, turn=60, rows=10):  # cm
    """A bolt that stands on its head, and its nut; corners bevelled as a lathe does."""
    outline = hexagon(flat, turn)
    edge = 0.96 * flat

    def head(bottom, top):
        """The corners cut off by a cone, as on a lathe."""
        cut = [(r - edge) * math.tan(math.radians(30.0)) for r in outline]
        return [ring_about_y(bottom, [edge] * turn), ring_about_y([bottom + c for c in cut], outline),
                ring_about_y([top - c for c in cut], outline), ring_about_y(top, [edge] * turn)]

    def wall(length, radius_of):
        """Threaded, by radius_of(height of the thread, place along it)."""
        for j in range(round(length / pitch * rows) + 1):
            y = pitch * j / rows
            yield y, [radius_of(thread(j / rows - i / turn), y) for i in range(turn)]

    foot, length = 6.0, 40.0
    fades = 1.5 * pitch  # towards the end, which is bevelled besides

    def shank(crest, y):
        return core + min(1.0, (length - y) / fades) * depth * crest - 0.8 * max(0.0, 1.0 - (length - y) / 2.0)

    rings = [ring_about_y(foot + y, radii) for y, radii in wall(length, shank)]
    yield "bolt", lofted(head(0.0, foot) + rings, is_closed=False), "A bolt, 46 high, on its head [cm]"

    height = 2.0 * pitch

    def bore(crest, y):
        mouth = 1.2 * depth * max(0.0, 1.0 - min(y, height - y) / (0.5 * pitch))
        return core + play + max(depth * crest, mouth)

    inside = [ring_about_y(y, radii) for y, radii in wall(height, bore)]
    yield "nut", lofted(head(0.0, height) + inside[::-1], is_closed=True), "Its nut, with a play of 1.2 mm [cm]"


PEN = 0.24


def letters():  # 1 high
    h = 0.5 * PEN
    s = [(0.8, 1 - h), (h, 1 - h), (h, 0.5), (0.8 - h, 0.5), (0.8 - h, h), (0.0, h)]
    c = [(0.8, 1 - h), (h, 1 - h), (h, h), (0.8, h)]
    r = [(0.0, 0.0), (0.24, 0.0), (0.24, 0.34), (0.30, 0.34), (0.52, 0.0), (0.8, 0.0), (0.575, 0.36),
         *arc((0.54, 0.61), 0.26, -60, 0, 3), *arc((0.54, 0.74), 0.26, 0, 90, 4), (0.0, 1.0), (0.0, 0.0)]
    hole = [(0.24, 0.57), (0.24, 0.77), (0.5, 0.77), (0.56, 0.72), (0.56, 0.62), (0.5, 0.57)]
    # Into the hole and back along one edge, from the crook of the leg.
    at = r.index((0.24, 0.34))
    r = r[:at + 1] + hole + [hole[0], r[at]] + r[at + 1:-1]
    e = [(0.0, 0.0), (0.8, 0.0), (0.8, 0.24), (0.24, 0.24), (0.24, 0.39), (0.7, 0.39), (0.7, 0.61),
         (0.24, 0.61), (0.24, 0.76), (0.8, 0.76), (0.8, 1.0), (0.0, 1.0)]
    outlines = {"s": stroke(rounded(s, 0.18), PEN), "c": stroke(rounded(c, 0.18), PEN), "r": r, "e": e}
    for name, outline in outlines.items():
        centred = [(x - 0.4, y - 0.5) for x, y in outline]
        yield "letter_" + name, extruded(centred, 0.42), f"The letter {name.upper()}, 1 high"


def hourglass():  # m
    inner = [(0.27, 0.0), (0.28, 0.12), (0.33, 0.26), (0.44, 0.44), (0.6, 0.66), (0.78, 0.92),
             (0.86, 1.2), (0.84, 1.48), (0.7, 1.72)]
    half = [(r, -y) for r, y in inner[:0:-1]] + inner
    outer = [(r + 0.11, y) for r, y in half]
    profile = ([(0.0, -1.84)] + [(0.6, -1.84)] + outer + [(0.6, 1.84), (0.0, 1.84), (0.0, 1.76)]
               + half[::-1] + [(0.0, -1.76)])
    # Two caverns would be two solids within one: the profile is closed along the axis.
    yield "hourglass", revolved(profile, 40), "Both bulbs of an hourglass, closed at the ends [m]"
    yield ("hourglass_cut", revolved(profile, 20, 180.0, 180.0),
           "The half of the hourglass behind z = 0, as it is drawn [m]")
    disc = revolved([(0.0, 0.0), (1.15, 0.0), (1.15, 0.14), (0.0, 0.14)], 48)
    rod = revolved([(0.0, -1.849), (0.07, -1.849), (0.07, 1.849), (0.0, 1.849)], 16)
    frame = joined(moved(disc, (0.0, 1.85, 0.0)), moved(disc, (0.0, -1.99, 0.0)),
                   *(moved(rod, (x, 0.0, z)) for x, z in ((-1.03, -0.2), (1.03, -0.2), (0.0, -1.05))))
    yield "hourglass_frame", frame, "Two discs and three rods, a millimetre between them [m]"
    draw = random.Random(5)
    for number in range(3):
        yield (f"pebble_{number}", pebble(draw, (0.105, 0.075, 0.09)),
               "A pebble, about 0.2 long [m]")


def pebble(draw, radii, roughness=0.12):
    """A ball pressed into an ellipsoid, with some flats worn into it."""
    points, faces = ball(2)
    flats = []
    for _ in range(9):
        axis = [draw.gauss(0.0, 1.0) for _ in range(3)]
        length = math.hypot(*axis)
        flats.append(([c / length for c in axis], 1.0 - roughness * draw.uniform(0.3, 1.6)))
    worn = []
    for point in points:
        reach = 1.0
        for axis, limit in flats:
            along = sum(a * p for a, p in zip(axis, point))
            if along * reach > limit:
                reach = limit / along
        worn.append(tuple(reach * c * r for c, r in zip(point, radii)))
    return worn, faces


def truck():  # m
    # An arch about the front wheel, whose middle lies below the cab.
    cab = [(0.0, 0.0), *arc((0.65, -0.18), 0.62, 160, 20, 10), (1.75, 0.0), (1.75, 0.95), (1.55, 1.1),
           (1.2, 1.95), (0.0, 1.95)]
    yield "truck_cab", extruded(cab, 2.1), "A driver's cab that looks towards +x [m]"
    tire, track = 0.52, 1.05
    rim = [(0.16, 0.47), (0.16, 0.53), (0.3, 0.53), (0.34, 0.6), (0.46, 0.6), (tire, 0.55),
           (tire, 0.25), (0.46, 0.2), (0.12, 0.2)]
    side = [(r, y + track - 0.6) for r, y in rim]
    profile = [(0.0, -side[0][1])] + [(r, -y) for r, y in side] + side[::-1] + [(0.0, side[0][1])]
    yield "truck_axle", revolved(profile, 32), "Two wheels on an axle along y [m]"
    # From the hinge at the rear: floor, two sides and the wall behind the cab.
    bed = cells(([-0.3, 0.6, 1.5, 2.4, 3.3, 3.9, 4.0], [0.0, 0.12, 0.6, 1.1],
                 [-1.15, -1.03, -0.35, 0.35, 1.03, 1.15]),
                lambda i, j, k: j == 0 or k in (0, 4) or i == 5)
    yield "truck_bed", bed, "The bed of a tipper, its hinge at the origin, open behind [m]"
    draw = random.Random(11)
    for number in range(3):
        yield (f"rock_{number}", pebble(draw, (0.2, 0.15, 0.17), 0.3), "A rock, about 0.4 long [m]")


def hillside(width=32.0, length=48.0, cell=0.64):  # m
    """A gully that comes down along +z and fans out, as an open sheet."""
    def height(x, z):
        steep = min(max((z - 4.0) / 29.0, 0.0), 1.0)
        course = 2.2 * math.sin(0.17 * z)
        side = 1.7 * (x - course) / (2.8 + 9.0 * steep)
        rims = 0.2 * max(z - 42.0, 0.0) ** 2 + 0.8 * max(2.0 - z, 0.0) ** 2
        bumps = (0.3 * math.sin(1.3 * x + 0.5 * z) * math.sin(0.9 * z - 0.4 * x) +
                 0.12 * math.sin(2.9 * x) * math.sin(2.3 * z + 1.0))
        return 1.0 + 21.0 * (1.0 - steep) ** 1.4 + 2.2 * (math.hypot(1.0, side) - 1.0) + rims + bumps

    columns, rows = round(width / cell), round(length / cell)
    points, faces = [], []
    for j in range(rows + 1):
        for i in range(columns + 1):
            x, z = cell * i - 0.5 * width, cell * j
            points.append((round(x, 2), round(height(x, z), 3), round(z, 2)))
    for j in range(rows):
        for i in range(columns):
            p = i + j * (columns + 1)
            q = p + columns + 1
            faces += [(p, q, p + 1), (p + 1, q, q + 1)]
    yield "hillside", (points, faces), "A gully of 32 by 48 that comes down along +z, an open sheet [m]"


def pose(position, quaternion=(1.0, 0.0, 0.0, 0.0)):
    return tuple(position) + tuple(quaternion)


def about(axis, degrees):
    half = math.radians(0.5 * degrees)
    return (math.cos(half),) + tuple(math.sin(half) * c for c in axis)


def after(q, p):
    """The rotation p, then q."""
    a, b, c, d = q
    e, f, g, h = p
    return (a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e)


def arch_poses():
    middle = STONES // 2
    yield "voussoirs", [pose((0.0, 1.5, 0.0), about((0, 0, 1), STONE_ANGLE * (middle - i)))
                        for i in range(STONES) if i != middle]


def bolt_poses(apart=29.0, pitch=2.5, foot=6.0):
    """Seven bolts, and three nuts high on each of them, turned as far as its thread is there."""
    places = [(0.0, 0.0)] + [(apart * math.cos(math.radians(60 * k + 10)), apart * math.sin(math.radians(60 * k + 10)))
                             for k in range(6)]
    yield "bolts", [pose((x, 0.0, z)) for x, z in places]
    nuts = []
    for k, (x, z) in enumerate(places):
        for n in range(3):
            climbed = 4.0 + 11.0 * n + 0.9 * k
            nuts.append(pose((x, foot + climbed, z), about((0.0, 1.0, 0.0), 360.0 * climbed / pitch)))
    yield "nuts", nuts


def viaduct_poses():
    v = VIADUCT
    for i in range(v["stones"] // 2 + 1):
        poses = []
        for bay in range(v["bays"]):
            for piece in range(pieces(i)):
                place = ((bay - 0.5 * (v["bays"] - 1)) * v["bay"], v["height"],
                         ((piece + 0.5) / pieces(i) - 0.5) * v["depth"])
                poses.append(pose(place))
                if i > 0:
                    poses.append(pose(place, about((0, 1, 0), 180.0)))
        yield f"viaduct_{i}", poses


def chain_poses():
    """Straight, side by side above the bar; every other link is turned by a quarter."""
    for number, (z, links, ahead) in enumerate(((-14.0, 33, 0), (-2.0, 37, -4), (10.0, 33, 3),
                                                (20.0, 29, 8))):
        poses = [pose(((i - links // 2 + ahead) * 4.15, 67.5, z),
                      after(about((1, 0, 0), 90.0 * (i % 2)), (1.0, 0.0, 0.0, 0.0)))
                 for i in range(links)]
        yield f"chain_{number}", poses


def mail_poses(columns=16, rows=54, apart=(2.5, 0.7), tilt=35.0):
    """A square of rings of radius 1, each through the four beside it: rows lean one way and the
    other, half a column aside. Those along the hem are of another metal."""
    kinds = {"steel": [], "brass": []}
    for row in range(rows):
        odd = row % 2
        for column in range(columns - odd):
            place = ((column - 0.5 * (columns - 1 - odd)) * apart[0], 14.0,
                     (row - 0.5 * (rows - 1)) * apart[1])
            isHem = column in (0, columns - 1 - odd) or row in (0, 1, rows - 2, rows - 1)
            kinds["brass" if isHem else "steel"].append(
                pose(place, about((1, 0, 0), tilt if odd else -tilt)))
    for kind, poses in kinds.items():
        yield "mail_" + kind, poses


def card_poses(length=8.8, thickness=0.12, lean=29.0, storeys=4):
    """Pairs of leaning cards [thickness, length, width] and the cards that lie across them."""
    s, c = math.sin(math.radians(lean)), math.cos(math.radians(lean))
    out = 0.5 * (thickness * c + length * s)  # from the ridge to a card's centre
    height = length * c + thickness * s
    pitch = max(length, 4.0 * out) + 0.02
    leaning, lying = [], []
    for storey in range(storeys):
        y = storey * (height + thickness)
        count = storeys - storey
        for i in range(count):
            x = (i - 0.5 * (count - 1)) * pitch
            leaning += [pose((x - out, y + 0.5 * height, 0.0), about((0, 0, 1), -lean)),
                        pose((x + out, y + 0.5 * height, 0.0), about((0, 0, 1), lean))]
            if i + 1 < count:
                lying.append(pose((x + 0.5 * pitch, y + height + 0.5 * thickness, 0.0),
                                  about((0, 0, 1), 90.0)))
    yield "cards_leaning", leaning
    yield "cards_lying", lying


def domino_poses(count=210, spacing=2.1, outer=26.0, between=4.4, colours=7):
    """A spiral inward, with even steps along it; one file a colour."""
    files = [[] for _ in range(colours)]
    angle = 0.0
    for i in range(count):
        radius = outer - between * angle / (2.0 * math.pi)
        # The domino's thin side, x, looks along the way.
        heading = math.degrees(-angle) - 90.0
        place = (radius * math.cos(angle), 2.4, radius * math.sin(angle))
        files[i * colours // count].append(pose(place, about((0, 1, 0), heading)))
        angle += spacing / radius
    for number, poses in enumerate(files):
        yield f"spiral_{number}", poses


def letter_poses(rows=5):
    """A wall of the word, rows on rows, every second one a little aside."""
    places = {"s": [], "c": [], "r": [], "e": []}
    for row in range(rows):
        for column, name in enumerate("scree"):
            x = (column - 2) * 0.86 + 0.02 * (-1) ** row
            places[name].append(pose((x, row + 0.5, 0.0)))
    for name, poses in places.items():
        yield "letters_" + name, poses


def block_poses():
    """Round walls of blocks on the turntable, laid like bricks; a block is 0.3 long along x."""
    for ring, (radius, count, layers) in enumerate(((0.45, 7, 7), (0.85, 14, 4), (1.25, 21, 2))):
        poses = []
        for layer in range(layers):
            for i in range(count):
                a = 360.0 * (i + 0.5 * (layer % 2)) / count + 7.0 * ring
                x, z = radius * math.sin(math.radians(a)), radius * math.cos(math.radians(a))
                poses.append(pose((x, 0.7 + 0.08 + 0.16 * layer, z), about((0, 1, 0), a)))
        yield f"turntable_{ring}", poses


def chimney_poses(bricks=24, layers=45, size=(0.25, 0.1, 0.12), gap=0.0005):
    """Rings of bricks, each half a brick on from the one below; size is length, height, thickness.
    Every ninth ring is of pale ones."""
    inner = 0.5 * (size[0] + gap) / math.tan(math.pi / bricks)
    radius = inner + 0.5 * size[2]
    kinds = {"red": [], "pale": []}
    for layer in range(layers):
        for i in range(bricks):
            a = 2.0 * math.pi * (i + 0.5 * (layer % 2)) / bricks
            place = (radius * math.sin(a), (layer + 0.5) * size[1], radius * math.cos(a))
            kinds["pale" if layer % 9 == 8 else "red"].append(
                pose(place, about((0, 1, 0), math.degrees(a))))
    for kind, poses in kinds.items():
        yield "chimney_" + kind, poses


def wall(size=(4.0, 2.5, 0.3), count=200):
    """Its foot in the middle of the ground."""
    draw = random.Random(7)
    seeds = [tuple(draw.uniform(0.0, s) for s in size) for _ in range(count)]
    for i, mesh in enumerate(shards(size, seeds)):
        yield f"shard_{i:03}", moved(mesh, (-0.5 * size[0], 0.0, -0.5 * size[2]))


def write_poses(path, poses):
    with open(path, "w", encoding="ascii") as file:
        file.write("# x y z qw qx qy qz. Made by tools/props/make_props.py.\n")
        for one in poses:
            file.write(" ".join(f"{round(c, 9) + 0.0:.9g}" for c in one) + "\n")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    shots = sys.argv[1]
    for make in (crockery, chain, arch, viaduct, gears, bolts, letters, hourglass, truck, hillside):
        for name, mesh, words in make():
            write_obj(os.path.join(shots, "meshes", name + ".obj"), mesh, words)
    write_objects(os.path.join(shots, "meshes", "wall.obj"), wall(),
                  "A wall of 4 by 2.5 by 0.3, broken into two hundred shards [m]")
    for make in (arch_poses, bolt_poses, viaduct_poses, chain_poses, mail_poses, card_poses, domino_poses,
                 letter_poses, block_poses, chimney_poses):
        for name, poses in make():
            write_poses(os.path.join(shots, "poses", name + ".poses"), poses)


if __name__ == "__main__":
    main()
