"""Opens exports in Blender (PyPI's bpy) and compares them with the take, which read_take.py reads
without any of our program's code. Prints what it measured; exit code 1 when a claim does not hold.

    blender_check.py poses EXPORT TAKE       matrices, at whole frames and between
    blender_check.py births EXPORT TAKE      nobody is seen before its birth, all move after it
    blender_check.py shading EXPORT          flat boxes, round tori, names of materials
    blender_check.py camera EXPORT TAKE      field of view and line of sight of the first camera
    blender_check.py textures TAKE ASSET.obj EXPORT...   texture coordinates of every corner
    blender_check.py write FILE.abc EXPECTED.json   Blender's own Alembic file, and what is in it
    blender_check.py blur EXPORT TAKE BODY   sweep of a body that spins about z, in Cycles
"""
import json
import math
import os
import pathlib
import sys
import tempfile

import bpy
import numpy as np
from mathutils import Matrix, Vector

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
import blender_open  # noqa: E402
from read_take import read_motion  # noqa: E402

TOLERANCE = 1e-5  # relative; Blender computes in single precision (6e-8)


def open_export(export):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    blender_open.import_export(pathlib.Path(export))


def read_info(take):
    return json.loads((pathlib.Path(take) / "take.json").read_text())


Z_UP_FROM_Y_UP = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]], float)


def expected_turns(export, info):
    """What Blender puts before and behind a body's matrix. Its USD importer turns the stage; its
    Alembic importer takes every file for y-up and turns the frames of the meshes as well."""
    before = Z_UP_FROM_Y_UP if info["up"] == "+y" else np.eye(4)
    return before, Z_UP_FROM_Y_UP.T if export.endswith(".abc") else np.eye(4)


def matrix_of(position, wxyz):
    w, x, y, z = wxyz
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, 3] = position
    return matrix


def set_time(time):
    frame = math.floor(time + 1e-9)
    bpy.context.scene.frame_set(frame, subframe=max(0.0, time - frame))
    return bpy.context.evaluated_depsgraph_get()


def check_poses(export, take):
    info = read_info(take)
    open_export(export)
    names = [body["name"] for body in info["bodies"]]
    missing = [name for name in names if name not in bpy.data.objects]
    if missing:
        return f"missing: {missing}"
    if bpy.context.scene.render.fps != info["fps"]:
        bpy.context.scene.render.fps = round(info["fps"])  # the .abc importer leaves it alone
    before, behind = expected_turns(export, info)
    worst, compared, between = 0.0, 0, 0
    for time, positions, orientations in read_motion(take):
        graph = set_time(time)
        for name, position, orientation in zip(names, positions, orientations):
            expected = before @ matrix_of(position, orientation) @ behind
            found = np.array(bpy.data.objects[name].evaluated_get(graph).matrix_world)
            scale = max(1.0, np.abs(expected).max())
            worst = max(worst, np.abs(found - expected).max() / scale)
            compared += 1
            between += time != round(time)
    print(f"compared {compared} matrices, {between} of them between frames; worst {worst:.2e}")
    shapes = check_points(take, info, behind)
    if shapes:
        return shapes
    if worst > TOLERANCE:
        return f"a matrix is off by {worst:.2e} of its size"
    return "" if compared else "nothing was compared"


def check_births(export, take):
    """At whole frames. EXPORT may be the take itself."""
    info = read_info(take)
    if pathlib.Path(export).is_dir():
        blender_open.open_scene(blender_open.parse_options([export]))
    else:
        open_export(export)
        bpy.context.scene.render.fps = round(info["fps"])
    births = blender_open.births_of(pathlib.Path(take), info)
    late = [number for number, birth in births.items() if birth is None or birth > info["frames"][0]]
    if not late:
        return "the shot has nobody who comes late"
    turn = Z_UP_FROM_Y_UP if info["up"] == "+y" else np.eye(4)
    for time, positions, _ in read_motion(take):
        if time != round(time):
            continue  # between frames somebody who is about to come may be there already
        graph = set_time(time)
        for number, body in enumerate(info["bodies"]):
            thing = bpy.data.objects.get(body["name"])  # of USD what is hidden is not read at all
            is_seen = thing is not None
            if is_seen:
                thing = thing.evaluated_get(graph)
                place = np.array(thing.matrix_world)
                is_seen = np.abs(place[:3, :3]).max() > 1e-6 and not thing.hide_render
            birth = births.get(number, info["frames"][0]) if body.get("visible", True) else None
            if is_seen != (birth is not None and time >= birth):
                return f"{body['name']}, born at {birth}, is seen at {time}: {is_seen}"
            wanted = turn[:3, :3] @ positions[number]
            if is_seen and np.abs(place[:3, 3] - wanted).max() > TOLERANCE * max(1, np.abs(wanted).max()):
                return f"{body['name']} is at {place[:3, 3]} at {time}, not at {wanted}"
    print(f"{len(late)} bodies come late, and are seen from then on")
    return ""


def mesh_of(name):
    """The mesh of a body, which may be an instance of a collection."""
    body = bpy.data.objects[name]
    if body.instance_collection:
        return next(o.data for o in body.instance_collection.all_objects if o.type == "MESH")
    return body.data


def check_points(take, info, behind):
    """The artist's points in the frame that the matrices are of."""
    for body in info["bodies"]:
        if "plane" in body:
            continue
        points, triangles, _ = blender_open.read_ply(pathlib.Path(take) / "shapes" / f"{body['shape']}.ply")
        mesh = mesh_of(body["name"])
        found = np.array([v.co for v in mesh.vertices])
        expected = points @ np.linalg.inv(behind)[:3, :3].T
        if found.shape != expected.shape or np.abs(found - expected).max() > TOLERANCE * np.abs(expected).max():
            return f"{body['name']} has other points than its shape"
        corners = {tuple(sorted(p.vertices)) for p in mesh.polygons}
        if corners != {tuple(sorted(t)) for t in triangles.tolist()}:
            return f"{body['name']} has other triangles than its shape"
    return ""


def corner_normals(mesh):
    values = np.empty(3 * len(mesh.loops), np.float32)
    mesh.corner_normals.foreach_get("vector", values)
    return values.reshape(-1, 3)


def check_shading(export):
    """Objects called box… must be flat, objects called ring… smooth."""
    open_export(export)
    meshes = {o.name: o for o in bpy.data.objects if o.type == "MESH"}
    for name, body in meshes.items():
        mesh = body.data
        if [m.name.split(".")[0] for m in mesh.materials if m] != ["paint"]:
            return f"{name} has the materials {[m and m.name for m in mesh.materials]}"
        normals = corner_normals(mesh)
        faces = np.array([p.normal for p in mesh.polygons for _ in p.loop_indices])
        bend = np.degrees(np.arccos(np.clip(np.sum(normals * faces, axis=1), -1, 1))).max()
        print(f"{name}: normals leave their faces by {bend:.2f} degrees at most")
        if name.startswith("box") and bend > 0.1:
            return f"{name} is not flat"
        if name.startswith("ring") and not 5 < bend < 40:
            return f"{name} is not smooth"
    return "" if len(meshes) == 2 else f"expected a box and a ring, found {sorted(meshes)}"


def read_asset(path):
    """Points, and for every polygon the (point, u, v) of its corners, of a simple OBJ file."""
    points, uvs, polygons = [], [], []
    for line in pathlib.Path(path).read_text().splitlines():
        key, *words = line.split()
        if key == "v":
            points.append([float(w) for w in words])
        elif key == "vt":
            uvs.append([float(w) for w in words])
        elif key == "f":
            corners = [w.split("/") for w in words]
            polygons.append([(int(p) - 1, *uvs[int(t) - 1]) for p, t in corners])
    return np.array(points), polygons


def import_any(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if path.endswith(".glb"):
        bpy.ops.import_scene.gltf(filepath=path)
    elif path.endswith(".obj"):
        bpy.ops.wm.obj_import(filepath=path)
    else:
        blender_open.import_export(pathlib.Path(path), instancing=False)
    bpy.context.scene.frame_set(1001)


def check_textures(take, asset, *exports):
    """Every corner of every triangle must lie, in the world, on a point of the asset and show what
    that corner of the asset's polygon shows. The asset's polygons are planar and have no texture
    coordinates in common, so that no seam can be closed and no corner mistaken for another."""
    points, polygons = read_asset(asset)
    _, position, orientation = next(iter(read_motion(take)))
    place = Z_UP_FROM_Y_UP @ matrix_of(position[0], orientation[0])
    world = points @ place[:3, :3].T + place[:3, 3]
    wanted = {(round(u, 5), round(v, 5)): world[p] for polygon in polygons for p, u, v in polygon}
    takes = {"the take itself": None, **{pathlib.Path(e).name: e for e in exports}}
    for name, path in takes.items():
        if path:
            import_any(path)
        else:
            blender_open.open_scene(blender_open.parse_options([str(take)]))
        meshes = [o for o in bpy.data.objects if o.type == "MESH"]
        if len(meshes) != 1 or len(meshes[0].data.uv_layers) != 1:
            return f"{name}: {[(m.name, len(m.data.uv_layers)) for m in meshes]}"
        mesh, matrix = meshes[0].data, np.array(meshes[0].matrix_world)
        seen = set()
        for loop, uv in zip(mesh.loops, mesh.uv_layers[0].uv):
            key = (round(uv.vector.x, 5), round(uv.vector.y, 5))
            if key not in wanted:
                return f"{name}: no corner of the asset shows {key}"
            found = matrix[:3, :3] @ np.array(mesh.vertices[loop.vertex_index].co) + matrix[:3, 3]
            if np.abs(found - wanted[key]).max() > TOLERANCE * np.abs(world).max():
                return f"{name}: {key} is seen at {found}, not at {wanted[key]}"
            seen.add(key)
        print(f"{name}: {len(mesh.loops)} corners show what they should")
        if len(seen) != len(wanted) or len(mesh.polygons) != 2 * len(polygons):
            return f"{name}: {len(seen)} of {len(wanted)} corners in {len(mesh.polygons)} faces"
    return ""


def write_alembic(path, expected):
    """Two crates that share a mesh, one of them stretched and carried by what moves, and a drum
    with lids of seven corners. Tells where their points are at every frame, with y up."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = 24, 1001, 1004
    carrier = bpy.data.objects.new("carrier", None)
    bpy.context.collection.objects.link(carrier)
    bpy.ops.mesh.primitive_cube_add(size=1, calc_uvs=True, location=(1, 0, 0.5))
    crate = bpy.context.object
    crate.name, crate.parent, crate.scale = "crate", carrier, (1.5, 1, 0.75)
    twin = bpy.data.objects.new("twin", crate.data)
    twin.location = (-3, 2, 1)
    bpy.context.collection.objects.link(twin)
    bpy.ops.mesh.primitive_cylinder_add(vertices=7, radius=0.5, depth=2, location=(0, -4, 1))
    bpy.context.object.name = "drum"
    for frame in (1001, 1004):
        carrier.location = (0.25 * (frame - 1001), 1, 0)
        carrier.rotation_euler = (0, 0.1 * (frame - 1001), 0.2 * (frame - 1001))
        carrier.keyframe_insert("location", frame=frame)
        carrier.keyframe_insert("rotation_euler", frame=frame)
    bpy.ops.wm.alembic_export(filepath=path, start=1001, end=1004, as_background_job=False)

    found = {}
    for name in ("crate", "twin", "drum"):
        found[name] = []
        for frame in range(1001, 1005):
            body = bpy.data.objects[name].evaluated_get(set_time(frame))
            world = [body.matrix_world @ v.co for v in body.data.vertices]
            found[name].append([[x, z, -y] for x, y, z in world])
    pathlib.Path(expected).write_text(json.dumps(found))
    return ""


def check_camera(export, take):
    info = read_info(take)
    if pathlib.Path(export).is_dir():
        blender_open.open_scene(blender_open.parse_options([export]))
    else:
        open_export(export)
    wanted = info["cameras"][0]
    cameras = [o for o in bpy.data.objects if o.type == "CAMERA"]
    if not cameras:
        return "no camera"
    scene, camera = bpy.context.scene, cameras[0]
    scene.render.resolution_x, scene.render.resolution_y = info["picture_size"]
    problem = check_lens(scene, camera, wanted)
    for time, eye, target in camera_times(wanted, info["frames"][0]):
        problem = problem or check_view(camera, time, blender_open.to_blender(eye, info),
                                        blender_open.to_blender(target, info))
    return problem


def camera_times(wanted, first):
    """Time, eye and target at the first frame, or at the keys and between them (linear ones)."""
    if "keys" not in wanted:
        return [(first, wanted["eye"], wanted["target"])]
    times = []
    for a, b in zip(wanted["keys"], wanted["keys"][1:]):
        for share in (0.0, 0.5, 1.0):
            mixed = lambda name: [(1 - share) * p + share * q for p, q in zip(a[name], b[name])]
            times.append(((1 - share) * a["frame"] + share * b["frame"], mixed("eye"), mixed("target")))
    return times


def check_lens(scene, camera, wanted):
    set_time(scene.frame_start)

    # The frame of the picture, one unit in front of the lens.
    corners = camera.data.view_frame(scene=scene)
    height = max(c.y for c in corners) - min(c.y for c in corners)
    fov = math.degrees(2 * math.atan(0.5 * height / abs(corners[0].z)))
    print(f"field of view {fov:.5f} degrees")
    return "" if abs(fov - wanted["fov"]) < 1e-3 else f"the field of view is {fov}, not {wanted['fov']}"


def check_view(camera, time, eye, target):
    place = camera.evaluated_get(set_time(time)).matrix_world
    sight = place.to_quaternion() @ Vector((0, 0, -1))
    upward = (place.to_quaternion() @ Vector((0, 1, 0))).z
    print(f"time {time}: eye off by {(place.translation - eye).length:.2e}")
    if (place.translation - eye).length > TOLERANCE * eye.length:
        return f"time {time}: the eye is at {place.translation}, not at {eye}"
    if sight.angle(target - eye) > 1e-4:
        return f"time {time}: it looks elsewhere"
    return "" if upward > 0 else "it is upside down"


def render_alpha(scene):
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = folder + "/blur.png"
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        width, height = image.size
        pixels = np.array(image.pixels[:]).reshape(height, width, 4)
        bpy.data.images.remove(image)
    return pixels[..., 3]


def covered_degrees(alpha, radius):
    """How much of the circle of `radius` (1 is half the picture) has been passed, of 180°: the
    body is alike after half a turn."""
    size = len(alpha)
    angles = np.radians(np.arange(0, 360, 0.5))
    x = ((1 + radius * np.cos(angles)) * size / 2).astype(int)
    y = ((1 + radius * np.sin(angles)) * size / 2).astype(int)
    return 0.5 * 0.5 * np.count_nonzero(alpha[y, x] > 0.005)


def is_part_of(thing, name):
    """The object itself or, as from USD, a mesh below it."""
    return thing is not None and (thing.name == name or is_part_of(thing.parent, name))


def check_blur(export, take, name):
    """The body is looked at along its axis: over an open shutter it must cover the angle that it
    turns by in that time, and without motion blur only its own width."""
    info = read_info(take)
    options = blender_open.parse_options([export, "--size", "160x160", "--samples", "128", "--no-denoise"])
    options.take = pathlib.Path(take)
    scene = blender_open.open_scene(options)
    for other in list(bpy.data.objects):
        if other.type == "MESH" and not is_part_of(other, name):
            bpy.data.objects.remove(other)
    frame = (info["frames"][0] + info["frames"][1]) // 2
    graph = set_time(frame)
    middle = bpy.data.objects[name].evaluated_get(graph).matrix_world.translation.copy()
    camera = bpy.data.objects.new("front", bpy.data.cameras.new("front"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2.6
    camera.location = middle + Vector((0, -10, 0))
    camera.rotation_euler = (math.pi / 2, 0, 0)
    bpy.context.collection.objects.link(camera)
    scene.camera = camera
    scene.render.film_transparent = True
    scene.render.image_settings.color_mode = "RGBA"

    number = [body["name"] for body in info["bodies"]].index(name)
    turns = {t: Matrix(matrix_of((0, 0, 0), q[number]).tolist()) for t, _, q in read_motion(take)}
    opened = turns[frame - 0.25].to_quaternion()
    closed = turns[frame + 0.25].to_quaternion()
    expected = math.degrees(opened.rotation_difference(closed).angle)

    covered = {}
    for shutter in (0.0, 0.5):
        scene.render.use_motion_blur = shutter > 0
        scene.render.motion_blur_shutter = max(shutter, 0.01)
        covered[shutter] = covered_degrees(render_alpha(scene), radius=0.6)
    swept = covered[0.5] - covered[0.0]
    print(f"turns {expected:.1f} degrees while the shutter is open, sweeps {swept:.1f}")
    # Pixels are 1.2° wide at that radius, and the ends are seen for an instant only.
    return "" if abs(swept - expected) < 4 else "the blur is not the turn"


if __name__ == "__main__":
    checks = {
        "poses": check_poses,
        "births": check_births,
        "shading": check_shading,
        "camera": check_camera,
        "textures": check_textures,
        "write": write_alembic,
        "blur": check_blur,
    }
    problem = checks[sys.argv[1]](*sys.argv[2:])
    if problem:
        print("WRONG:", problem)
    # bpy 4.2 crashes while it is torn down after an import of glTF; all has been said by then.
    sys.stdout.flush()
    os._exit(1 if problem else 0)
