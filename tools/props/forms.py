"""Closed triangle surfaces by revolving, sweeping, extruding and joining cells, written as OBJ.

A mesh is a pair (points, faces): points [(x, y, z)], faces [(i, j, k)] counted from 0 and wound
anticlockwise seen from outside. Every form here is closed when what it is given does not cross
itself, so that the solver takes it as a solid without repair.
"""
import math


def turned_outward(mesh):
    """The mesh with its faces wound so that it encloses a volume above 0."""
    points, faces = mesh
    volume = 0.0
    for i, j, k in faces:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = points[i], points[j], points[k]
        volume += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return mesh if volume > 0.0 else (points, [(i, k, j) for i, j, k in faces])


def write_obj(path, mesh, words):
    write_objects(path, [(None, mesh)], words)


def write_objects(path, named, words, maker="make_props.py", decimals=6, digits=6):
    """Several meshes (name, mesh) in one file, each an object of its own. With enough digits,
    neighbours that share a place get the same."""
    start = 1
    with open(path, "w", encoding="ascii") as file:
        file.write(f"# {words}. Made by tools/props/{maker}.\n")
        for name, mesh in named:
            points, faces = turned_outward(mesh)
            if name:
                file.write(f"o {name}\n")
            for point in points:
                file.write("v " + " ".join(f"{round(c, decimals) + 0.0:.{digits}g}" for c in point) + "\n")
            for face in faces:
                file.write("f " + " ".join(str(i + start) for i in face) + "\n")
            start += len(points)


def lofted(rings, is_closed):
    """A skin over rings of equally many points, each above the one before and wound to +z seen from
    -y; from the last back to the first if it is closed, and otherwise with both ends filled."""
    turn = len(rings[0])
    points = [p for ring in rings for p in ring]
    rows = [range(turn * j, turn * (j + 1)) for j in range(len(rings))]
    faces = []
    for low, high in zip(rows, rows[1:] + rows[:1] if is_closed else rows[1:]):
        for i in range(turn):
            j = (i + 1) % turn
            faces += [(low[i], low[j], high[j]), (low[i], high[j], high[i])]
    if not is_closed:
        bottom, top = len(points), len(points) + 1
        points += [(0.0, rings[0][0][1], 0.0), (0.0, rings[-1][0][1], 0.0)]
        for i in range(turn):
            j = (i + 1) % turn
            faces += [(rows[0][j], rows[0][i], bottom), (rows[-1][i], rows[-1][j], top)]
    return points, faces


def ring_about_y(heights, radii):
    """Points as far from the y axis as the radii say, equal angles apart; at one height or as many."""
    turn = len(radii)
    heights = heights if isinstance(heights, list) else [heights] * turn
    steps = [2.0 * math.pi * i / turn for i in range(turn)]
    return [(r * math.cos(a), y, -r * math.sin(a)) for r, y, a in zip(radii, heights, steps)]


def thread(phase):
    """Height of a thread, 0 ... 1. Round as that of a light bulb: the facets of a sharp one would
    take all the play where crests fall between the points."""
    return 0.5 - 0.5 * math.cos(2.0 * math.pi * phase)


def joined(*meshes):
    """All meshes as one, each a part of its own."""
    points, faces = [], []
    for part, triangles in meshes:
        start = len(points)
        points += part
        faces += [tuple(i + start for i in face) for face in triangles]
    return points, faces


def moved(mesh, by):
    points, faces = mesh
    return [tuple(c + b for c, b in zip(point, by)) for point in points], faces


def arc(centre, radius, first, last, steps):
    """Points (x, y) of a circle from angle `first` to `last` [degrees], both ends among them."""
    angles = (math.radians(first + (last - first) * i / steps) for i in range(steps + 1))
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def rounded(path, radius, steps=5):
    """An open polyline with its corners rounded, of right angles by arcs of this radius."""
    result = [path[0]]
    for before, corner, after in zip(path, path[1:], path[2:]):
        for i in range(steps + 1):
            # A quadratic curve from one straight to the next: near enough to an arc.
            t = i / steps
            ends = []
            for end in (before, after):
                length = math.dist(end, corner)
                ends.append([c + (e - c) * radius / length for c, e in zip(corner, end)])
            result.append(tuple((1 - t) ** 2 * a + 2 * t * (1 - t) * c + t * t * b
                                for a, c, b in zip(ends[0], corner, ends[1])))
    return result + [path[-1]]


def stroke(path, width):
    """The outline of a pen of this width along an open path in the plane."""
    left, right = [], []
    for i, (x, y) in enumerate(path):
        ways = []
        for a, b in ((i - 1, i), (i, i + 1)):
            if a >= 0 and b < len(path):
                length = math.dist(path[a], path[b])
                ways.append([(q - p) / length for p, q in zip(path[a], path[b])])
        dx, dy = (sum(c) / len(ways) for c in zip(*ways))
        # Where the way bends, the mean of two unit vectors is short by the cosine of half the bend.
        scale = 0.5 * width / (dx * dx + dy * dy)
        left.append((x - dy * scale, y + dx * scale))
        right.append((x + dy * scale, y - dx * scale))
    return right + left[::-1]


def cross(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def ears(loop, points):
    """Triangles that fill an anticlockwise loop of indices into `points` (x, y), by clipping ears.

    A hole is given by a loop that goes to it and back along the same edge."""
    loop, faces = list(loop), []

    def is_ear(n):
        i, j, k = loop[n - 1], loop[n], loop[(n + 1) % len(loop)]
        a, b, c = points[i], points[j], points[k]
        if cross(a, b, c) <= 1e-12:
            return False
        for m in set(loop) - {i, j, k}:
            p = points[m]
            if min(cross(a, b, p), cross(b, c, p), cross(c, a, p)) > -1e-12:
                return False
        return True

    while len(loop) > 3:
        # The fattest ear first keeps splinters away.
        found = [n for n in range(len(loop)) if is_ear(n)]
        if not found:
            raise ValueError("the outline crosses itself")
        best = min(found, key=lambda n: math.dist(points[loop[n - 1]],
                                                  points[loop[(n + 1) % len(loop)]]))
        faces.append((loop[best - 1], loop[best], loop[(best + 1) % len(loop)]))
        del loop[best]
    return faces + [tuple(loop)]


def extruded(outline, depth):
    """A prism over an anticlockwise outline in x and y, from z = -depth / 2 to depth / 2.

    Points that occur twice are the two ways along a bridge to a hole."""
    flat = list(dict.fromkeys(outline))
    loop = [flat.index(p) for p in outline]
    edges = set(zip(loop, loop[1:] + loop[:1]))
    count = len(flat)
    points = [(x, y, z) for z in (-0.5 * depth, 0.5 * depth) for x, y in flat]
    lid = ears(loop, flat)
    faces = [(i, k, j) for i, j, k in lid] + [tuple(i + count for i in face) for face in lid]
    for i, j in sorted(edges):
        if (j, i) not in edges:
            faces += [(i, j, j + count), (i, j + count, i + count)]
    return points, faces


def plate_with_bore(outline, bore, depth):
    """An extruded outline around the origin with a round hole; a hole point under every point."""
    inner = []
    for x, y in outline:
        length = math.hypot(x, y)
        inner.append((x / length * bore, y / length * bore))
    n = len(outline)
    points = [(x, y, z) for z in (-0.5 * depth, 0.5 * depth) for x, y in outline + inner]
    faces = []
    for i in range(n):
        j = (i + 1) % n
        quads = [(i, j, j + 2 * n, i + 2 * n), (n + j, n + i, 3 * n + i, 3 * n + j),
                 (j, i, n + i, n + j), (2 * n + i, 2 * n + j, 3 * n + j, 3 * n + i)]
        for a, b, c, d in quads:
            faces += [(a, b, c), (a, c, d)]
    return points, faces


def revolved(profile, sectors, degrees=360.0, first=0.0):
    """A solid of revolution about +y. The profile (r, y) goes from the axis to the axis, or is
    closed around. Less than a full turn is closed by two flat ends."""
    is_full = degrees >= 360.0
    steps = sectors if is_full else sectors + 1
    is_ring = all(r > 0.0 for r, _ in profile)
    rows, points = [], []
    for r, y in profile:
        if r == 0.0:
            rows.append([len(points)] * steps)
            points.append((0.0, y, 0.0))
            continue
        rows.append(range(len(points), len(points) + steps))
        for i in range(steps):
            a = math.radians(first + degrees * i / sectors)
            points.append((r * math.cos(a), y, r * math.sin(a)))
    faces = []
    for low, high in zip(rows, rows[1:] + (rows[:1] if is_ring else [])):
        for i in range(sectors):
            j = (i + 1) % steps
            for face in ((low[i], high[i], high[j]), (low[i], high[j], low[j])):
                if len(set(face)) == 3:
                    faces.append(face)
    if not is_full:
        area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(profile, profile[1:] + profile[:1]))
        order = range(len(profile)) if area > 0.0 else range(len(profile))[::-1]
        for end, sign in ((0, -1), (steps - 1, 1)):
            for i, j, k in ears(order, profile):
                a, b, c = rows[i][end], rows[j][end], rows[k][end]
                # The walls run with the profile at one end and against it at the other.
                faces.append((a, b, c)[::sign if area > 0.0 else -sign])
    return points, faces


def swept(path, radius, sides, is_closed=True):
    """A round tube along a path in the plane z = 0."""
    n = len(path)
    points, faces = [], []
    for i, (x, y) in enumerate(path):
        before, after = path[i - 1], path[(i + 1) % n]
        if not is_closed:
            before, after = path[max(i - 1, 0)], path[min(i + 1, n - 1)]
        dx, dy = after[0] - before[0], after[1] - before[1]
        length = math.hypot(dx, dy)
        for k in range(sides):
            a = 2.0 * math.pi * k / sides
            out, up = radius * math.cos(a), radius * math.sin(a)
            points.append((x + dy / length * out, y - dx / length * out, up))
    for i in range(n if is_closed else n - 1):
        for k in range(sides):
            a, b = i * sides + k, i * sides + (k + 1) % sides
            c, d = ((i + 1) % n) * sides + k, ((i + 1) % n) * sides + (k + 1) % sides
            faces += [(a, c, d), (a, d, b)]
    if not is_closed:
        for k in range(1, sides - 1):
            faces += [(0, k, k + 1), ((n - 1) * sides, (n - 1) * sides + k + 1, (n - 1) * sides + k)]
    return points, faces


def cells(planes, is_solid):
    """The surface of those boxes between the planes (x, y, z lists) that is_solid(i, j, k) keeps."""
    points, faces = {}, []

    def corner(*index):
        return points.setdefault(index, len(points))

    sizes = [len(axis) - 1 for axis in planes]
    for cell in ((i, j, k) for i in range(sizes[0]) for j in range(sizes[1]) for k in range(sizes[2])):
        if not is_solid(*cell):
            continue
        for axis in range(3):
            for side in (0, 1):
                beside = list(cell)
                beside[axis] += 2 * side - 1
                if all(0 <= b < s for b, s in zip(beside, sizes)) and is_solid(*beside):
                    continue
                u, v = (axis + 1) % 3, (axis + 2) % 3
                quad = []
                for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    at = list(cell)
                    at[axis] += side
                    at[u] += du
                    at[v] += dv
                    quad.append(corner(*at))
                a, b, c, d = quad if side else quad[::-1]
                faces += [(a, b, c), (a, c, d)]
    return [tuple(plane[i] for plane, i in zip(planes, index)) for index in points], faces


def ball(subdivisions):
    """Points of a unit sphere, an icosahedron divided so many times."""
    g = (1.0 + math.sqrt(5.0)) / 2.0
    points = [(0, 1, g), (0, -1, g), (0, 1, -g), (0, -1, -g), (1, g, 0), (-1, g, 0), (1, -g, 0),
              (-1, -g, 0), (g, 0, 1), (-g, 0, 1), (g, 0, -1), (-g, 0, -1)]
    faces = [(i, j, k) for i in range(12) for j in range(i + 1, 12) for k in range(j + 1, 12)
             if all(math.dist(points[a], points[b]) < 2.1 for a, b in ((i, j), (j, k), (k, i)))]
    faces = [f if dot_of_face(points, f) > 0.0 else f[::-1] for f in faces]
    for _ in range(subdivisions):
        middles, finer = {}, []
        for i, j, k in faces:
            m = []
            for a, b in ((i, j), (j, k), (k, i)):
                key = (min(a, b), max(a, b))
                if key not in middles:
                    middles[key] = len(points)
                    points.append(tuple(0.5 * (p + q) for p, q in zip(points[a], points[b])))
                m.append(middles[key])
            finer += [(i, m[0], m[2]), (j, m[1], m[0]), (k, m[2], m[1]), tuple(m)]
        faces = finer
    return [tuple(c / math.hypot(*p) for c in p) for p in points], faces


def dot_of_face(points, face):
    """Above 0 when the face is seen from outside by someone who is away from the origin."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (points[i] for i in face)
    return ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
