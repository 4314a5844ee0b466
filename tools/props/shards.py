"""A box broken into the cells of a Voronoi diagram: convex shards that fill it without gaps."""
import math


def shards(size, seeds):
    """For each seed (x, y, z) its cell in the box from the origin to `size`, a mesh (points, faces)."""
    for seed in seeds:
        # A cell is all that is nearer to its own seed; sixty neighbours are more than bound any.
        cell = box(size)
        for other in sorted(seeds, key=lambda s: math.dist(s, seed))[1:61]:
            normal = [o - s for o, s in zip(other, seed)]
            middle = [0.5 * (o + s) for o, s in zip(other, seed)]
            cell = clipped(cell, normal, dot(normal, middle))
        yield triangulated(cell)


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def box(size):
    """Six rectangles."""
    faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for end in (0.0, size[axis]):
            face = []
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = [0.0, 0.0, 0.0]
                corner[axis], corner[u], corner[v] = end, a * size[u], b * size[v]
                face.append(tuple(corner))
            faces.append(face)
    return faces


def clipped(faces, normal, limit):
    """The part of a convex polyhedron, given as polygons, in which normal · x ≤ limit."""
    kept, cut = [], []
    for face in faces:
        polygon = []
        for a, b in zip(face, face[1:] + face[:1]):
            above, below = dot(normal, a) - limit, dot(normal, b) - limit
            if above <= 0.0:
                polygon.append(a)
            if above * below < 0.0:
                share = above / (above - below)
                polygon.append(tuple(p + share * (q - p) for p, q in zip(a, b)))
                cut.append(polygon[-1])
        if len(polygon) >= 3:
            kept.append(polygon)
    if len(cut) >= 3:
        kept.append(around(cut, normal))
    return kept


def around(points, normal):
    """Points of a plane in the order in which they go around their middle."""
    middle = [sum(c) / len(points) for c in zip(*points)]
    u = [p - m for p, m in zip(points[0], middle)]
    v = cross(normal, u)

    def angle(point):
        arm = [p - m for p, m in zip(point, middle)]
        return math.atan2(dot(arm, v) / math.sqrt(dot(v, v)), dot(arm, u) / math.sqrt(dot(u, u)))

    return sorted(points, key=angle)


def triangulated(polygons):
    """A mesh of convex polygons; points nearer than a hundredth of a millimetre are one."""
    number_of, points, faces = {}, [], []
    middle = [sum(c) / sum(map(len, polygons)) for c in zip(*(p for face in polygons for p in face))]
    for polygon in polygons:
        corners = []
        for point in polygon:
            key = tuple(round(c, 5) + 0.0 for c in point)
            if key not in number_of:
                number_of[key] = len(points)
                points.append(key)
            if number_of[key] not in corners:
                corners.append(number_of[key])
        if len(corners) < 3:
            continue
        a, b, c = (points[i] for i in corners[:3])
        n = cross([q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)])
        if dot(n, [p - m for p, m in zip(a, middle)]) < 0.0:
            corners.reverse()
        faces += [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]
    return points, faces
