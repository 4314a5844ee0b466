#!/usr/bin/env python3
"""Opens a take or an export of it in Blender, ready to render with Cycles.

    blender -P tools/blender_open.py -- takes/rings_100
    blender -b -P tools/blender_open.py -- rings.abc --take takes/rings_100 --render out.####.png
    python3 tools/blender_open.py rings.usda --render last.png --frames 1240    (PyPI's bpy)

It sets frame range, camera, light, materials and motion blur. Colours are in the take: they are
found when the export stands in <take>/exports, or with --take. Written for Blender 4.2.
"""
import argparse
import json
import math
import pathlib
import re
import sys

import bpy
import numpy as np
from mathutils import Matrix, Vector

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from read_take import camera_at, read_frame, read_motion  # noqa: E402

CREASE = math.radians(40)  # as in the exports: sharper edges are meant to be seen
PLANE_GROWTH = 60  # a plane is infinite: this keeps its edge behind the horizon


# ---- what there is to open --------------------------------------------------------------------


def find_take(source, given):
    """The take's folder and take.json, or nothing when the export stands alone."""
    for folder in [given] if given else [source, source.parent.parent]:
        if folder and (folder / "take.json").is_file():
            return folder, json.loads((folder / "take.json").read_text())
    if given:
        sys.exit(f"Error: {given} is no take: it has no take.json")
    return None, None


def import_export(source, instancing=True):
    """Lets Blender's own importers read an .abc or a .usda."""
    if not source.is_file():
        sys.exit(f"Error: {source}: no such file")
    if source.suffix == ".abc":
        bpy.ops.wm.alembic_import(filepath=str(source), as_background_job=False)
    elif source.suffix in (".usda", ".usd", ".usdc"):
        bpy.ops.wm.usd_import(filepath=str(source), support_scene_instancing=instancing)
    else:
        sys.exit(f"Error: {source}: expected a take, .abc or .usda")


def unfold_instances(info):
    """The USD importer makes collection instances of bodies, which keep their names but lose their
    materials. Each becomes a mesh below its body that shares the shape's data."""
    materials = {body["name"]: body["material"] for body in info["bodies"]}
    for body in [o for o in bpy.data.objects if o.instance_collection and o.name in materials]:
        for part in [o for o in body.instance_collection.all_objects if o.type == "MESH"]:
            mesh = bpy.data.objects.new(body.name + "Shape", part.data)
            mesh.parent = body
            bpy.context.collection.objects.link(mesh)
            if not mesh.data.materials:
                mesh.data.materials.append(None)
            name = materials[body.name]
            mesh.material_slots[0].link = "OBJECT"
            mesh.material_slots[0].material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
        body.instance_type, body.instance_collection = "NONE", None


# ---- a take without an export ------------------------------------------------------------------


def read_ply(path):
    """Points, triangles and texture coordinates (u, v of each corner, or none) of a mesh in a
    take."""
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    counts = [int(n) for n in re.findall(rb"element \w+ (\d+)", head)]
    points = np.frombuffer(body, "<f8", 3 * counts[0]).reshape(-1, 3)
    fields = [("count", "u1"), ("corners", "<i4", 3)]
    if b" texcoord\n" in head:
        fields += [("uv_count", "u1"), ("uvs", "<f4", (3, 2))]
    faces = np.frombuffer(body, np.dtype(fields), counts[1], points.nbytes)
    return points, faces["corners"], faces["uvs"] if "uvs" in faces.dtype.names else None


def make_mesh(name, points, triangles, uvs=None):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.tolist(), [], triangles.tolist())
    if uvs is not None:
        mesh.uv_layers.new(name="uv").uv.foreach_set("vector", uvs.ravel())
    mesh.polygons.foreach_set("use_smooth", [True] * len(triangles))
    mesh.set_sharp_from_angle(angle=CREASE)
    return mesh


def plane_mesh(name, half):
    corners = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]]) * half
    return make_mesh(name, corners, np.array([[0, 1, 2], [0, 2, 3]]))


def key_motion(body, times, positions, orientations):
    """Linear keys at every sample; neighbouring quaternions on the same side."""
    flips = np.sum(orientations[1:] * orientations[:-1], axis=1) < 0
    signs = np.cumprod(np.concatenate([[1], np.where(flips, -1, 1)]))
    action = bpy.data.actions.new(body.name)
    body.animation_data_create().action = action
    for path, values in [
        ("location", positions),
        ("rotation_quaternion", orientations * signs[:, None]),
    ]:
        for index, column in enumerate(values.T):
            curve = action.fcurves.new(path, index=index)
            curve.keyframe_points.add(len(times))
            keys = np.stack([times, column], axis=1).ravel()
            curve.keyframe_points.foreach_set("co", keys)
            curve.keyframe_points.foreach_set("interpolation", [1] * len(times))  # linear


def hide_until(body, birth, first):
    """Not to be seen before its birth, the number of a frame, or never without one."""
    action = body.animation_data_create().action or bpy.data.actions.new(body.name)
    body.animation_data.action = action
    for path in ("hide_render", "hide_viewport"):
        curve = action.fcurves.new(path)
        for frame, value in [(first, 1.0)] + ([(birth, 0.0)] if birth is not None else []):
            curve.keyframe_points.insert(frame, value).interpolation = "CONSTANT"


def births_of(folder, info):
    """Frames of birth, None for who never came; nothing where all are there from the start."""
    last = max(folder.glob("frames/*.scree"), key=lambda path: int(path.stem.split(".")[-1]))
    born_at = read_frame(last)[1].get("body.born_at")
    if born_at is None:
        return {}
    first = info["frames"][0]
    return {
        number: first + int(born) if born >= 0 else None
        for number, born in enumerate(born_at[:, 0])
        if born != 0
    }


def build_take(folder, info):
    samples = list(read_motion(folder))
    if not samples:
        sys.exit(f"Error: {folder} has no frames")
    times = np.array([time for time, _, _ in samples], dtype=float)
    positions = np.array([places for _, places, _ in samples])
    orientations = np.array([turns for _, _, turns in samples])

    # Blender's up is z: a y-up shot stands below an empty that is turned.
    root = bpy.data.objects.new(info["name"], None)
    if info["up"] == "+y":
        root.matrix_world = Matrix.Rotation(math.pi / 2, 4, "X")
    bpy.context.collection.objects.link(root)

    shapes = {
        shape["name"]: read_ply(folder / "shapes" / (shape["name"] + ".ply"))
        for shape in info["shapes"]
    }
    reach = np.abs(positions).max() + 1.0
    meshes, births = {}, births_of(folder, info)
    for number, entry in enumerate(info["bodies"]):
        key = entry.get("shape", entry.get("plane")), entry["material"]
        if key not in meshes:
            meshes[key] = (
                plane_mesh(key[0], reach) if "plane" in entry else make_mesh(key[0], *shapes[key[0]])
            )
            material = bpy.data.materials.get(key[1]) or bpy.data.materials.new(key[1])
            meshes[key].materials.append(material)
        body = bpy.data.objects.new(entry["name"], meshes[key])
        body.parent = root
        body.rotation_mode = "QUATERNION"
        body.location = positions[0, number]
        body.rotation_quaternion = orientations[0, number]
        bpy.context.collection.objects.link(body)
        if entry["motion"] != "static":
            key_motion(body, times, positions[:, number], orientations[:, number])
        if not entry.get("visible", True):
            body.hide_render = body.hide_viewport = True
        elif number in births:
            hide_until(body, births[number], info["frames"][0])


# ---- range, camera, light, materials ------------------------------------------------------------


def set_range(scene, info):
    first, last = info["frames"]
    scene.frame_start, scene.frame_end = first, last
    scene.render.fps = round(info["fps"])
    scene.render.fps_base = scene.render.fps / info["fps"]
    scene.unit_settings.scale_length = info["metres_per_unit"]


def to_blender(point, info):
    x, y, z = point
    return Vector((x, y, z)) if info["up"] == "+z" else Vector((x, -z, y))


def is_plane(thing, info):
    """Whether the object, or the body it is below, is one of the shot's planes."""
    planes = {body["name"] for body in info["bodies"] if "plane" in body} if info else set()
    return thing.name in planes or (thing.parent is not None and thing.parent.name in planes)


def box_of_bodies(info):
    """Corners of all that is not a plane, at the present frame."""
    graph = bpy.context.evaluated_depsgraph_get()
    corners = []
    for body in bpy.data.objects:
        if body.type != "MESH" or is_plane(body, info):
            continue
        place = body.evaluated_get(graph).matrix_world
        corners += [place @ Vector(corner) for corner in body.bound_box]
    points = np.array(corners) if corners else np.array([[-1, -1, -1], [1, 1, 1]])
    return Vector(points.min(axis=0)), Vector(points.max(axis=0))


def look_at(camera, eye, target, up=Vector((0, 0, 1))):
    backward = (eye - target).normalized()
    right = up.cross(backward)
    if right.length < 1e-9:
        right = backward.orthogonal()
    right.normalize()
    axes = Matrix((right, backward.cross(right), backward)).transposed()
    camera.matrix_world = Matrix.Translation(eye) @ axes.to_4x4()


def key_camera(camera, known, info):
    """A key a frame: takes hold rules, not samples, and Blender's curves are others."""
    moves = "keys" in known or "orbit" in known
    camera.rotation_mode = "QUATERNION"
    first, last = info["frames"]
    before = None
    for frame in range(first, (last if moves else first) + 1):
        eye, target, up, fov = camera_at(known, frame, info["up"])
        look_at(camera, *(to_blender(list(v), info) for v in (eye, target, up)))
        camera.data.angle_y = math.radians(fov)
        turn = camera.matrix_world.to_quaternion()
        if before is not None and before.dot(turn) < 0:
            turn.negate()
        before = turn
        camera.rotation_quaternion = turn
        if not moves:
            return
        camera.keyframe_insert("location", frame=frame)
        camera.keyframe_insert("rotation_quaternion", frame=frame)
        camera.data.keyframe_insert("lens", frame=frame)
    for holder in (camera, camera.data):
        for curve in holder.animation_data.action.fcurves:
            for key in curve.keyframe_points:
                key.interpolation = "LINEAR"


def set_camera(scene, info, name):
    """The export's own camera, or the take's, or a three-quarter view of everything."""
    found = [o for o in bpy.data.objects if o.type == "CAMERA" and (not name or o.name == name)]
    if found:
        scene.camera = found[0]
        # A shot's field of view is vertical. The .abc importer would fit the wider side, which shows
        # another part of the scene when --size has another shape than the shot's pictures.
        found[0].data.sensor_fit = "VERTICAL"
        return
    camera = bpy.data.objects.new(name or "camera", bpy.data.cameras.new(name or "camera"))
    bpy.context.collection.objects.link(camera)
    scene.camera = camera
    known = [c for c in info["cameras"] if not name or c["name"] == name] if info else []
    if name and not known:
        sys.exit(f"Error: no camera called {name}")
    camera.data.sensor_fit = "VERTICAL"
    if known:
        key_camera(camera, known[0], info)
        return
    low, high = box_of_bodies(info)
    camera.data.angle_y = math.radians(35)
    middle, radius = (low + high) / 2, (high - low).length / 2
    look_at(camera, middle + radius * 3.4 * Vector((0.58, -0.70, 0.42)).normalized(), middle)


def set_light(scene):
    """A low sun from the left and slightly from behind the bodies, and a pale sky."""
    bpy.context.view_layer.update()
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle = 5.0, math.radians(2)
    sun.data.color = (1.0, 0.93, 0.84)
    toward = scene.camera.matrix_world.to_quaternion() @ Vector((0, 0, 1))
    around = math.atan2(toward.y, toward.x) + math.radians(90)
    sun.rotation_euler = (math.radians(56), 0, around - math.radians(105))
    bpy.context.collection.objects.link(sun)

    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.60, 0.72, 0.90, 1.0)
    background.inputs["Strength"].default_value = 0.38


def set_materials(info, metals):
    looks = {look["material"]: look for look in info["looks"]} if info else {}
    for material in bpy.data.materials:
        look = looks.get(material.name.split(".")[0])
        if look is None:
            continue
        material.use_nodes = True
        shader = material.node_tree.nodes["Principled BSDF"]
        shader.inputs["Base Color"].default_value = (*look["color"], 1.0)
        shader.inputs["Roughness"].default_value = look["roughness"]
        shader.inputs["Metallic"].default_value = 1.0 if look["material"] in metals else 0.0


def grow_planes(info):
    for mesh in {o.data for o in bpy.data.objects if o.type == "MESH" and is_plane(o, info)}:
        mesh.transform(Matrix.Scale(PLANE_GROWTH, 4))


def set_cycles(scene, options):
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = options.samples
    scene.cycles.seed = 1
    scene.cycles.use_denoising = options.denoise
    scene.render.use_motion_blur = options.shutter > 0
    scene.render.motion_blur_position = "CENTER"
    scene.render.motion_blur_shutter = options.shutter
    scene.render.resolution_x, scene.render.resolution_y = options.size
    scene.render.resolution_percentage = 100
    scene.view_settings.look = "AgX - Medium High Contrast"
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.compression = 100
    for body in bpy.data.objects:
        body.cycles.motion_steps = 2  # five poses over the shutter: spinners blur in arcs


def render(scene, options):
    first, _, last = options.frames.partition("-") if options.frames else ("", "", "")
    first = int(first or scene.frame_start)
    last = int(last or (first if options.frames else scene.frame_end))
    for frame in range(first, last + 1):
        scene.frame_set(frame)
        name = re.sub("#+", lambda mark: f"{frame:0{len(mark.group())}}", options.render)
        scene.render.filepath = str(pathlib.Path(name).resolve())
        bpy.ops.render.render(write_still=True)


def parse_options(words):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("source", type=pathlib.Path, help="a take, .abc or .usda")
    parser.add_argument("--take", type=pathlib.Path, help="where colours and cameras are found")
    parser.add_argument("--camera", default="", help="by name; else the first one")
    parser.add_argument("--metal", action="append", default=[], help="material that is a metal")
    parser.add_argument("--render", help="out.####.png; nothing is rendered without it")
    parser.add_argument("--frames", default="", help="1240 or 1001-1240; else all")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--no-denoise", dest="denoise", action="store_false")
    parser.add_argument("--shutter", type=float, default=0.5, help="frames; 0 for no motion blur")
    parser.add_argument("--save", help="also save a .blend")
    options = parser.parse_args(words)
    options.size = [int(n) for n in options.size.split("x")]
    return options


def open_scene(options):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    folder, info = find_take(options.source, options.take)
    if options.source.is_dir():
        if info is None:
            sys.exit(f"Error: {options.source} is no take: it has no take.json")
        build_take(folder, info)
    else:
        # Without a take nobody can give instances their materials back, so names go instead.
        import_export(options.source, instancing=info is not None)
    if info:
        unfold_instances(info)
        set_range(scene, info)
        grow_planes(info)
    scene.frame_set(scene.frame_start)
    set_camera(scene, info, options.camera)
    set_light(scene)
    set_materials(info, set(options.metal))
    set_cycles(scene, options)
    return scene


def main():
    words = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    options = parse_options(words)
    scene = open_scene(options)
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(pathlib.Path(options.save).resolve()))
    if options.render:
        render(scene, options)


if __name__ == "__main__":
    main()
