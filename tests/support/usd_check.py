#!/usr/bin/env python3
"""Reads a USD file with OpenUSD itself and compares it with what it should hold.

usage: usd_check.py FILE EXPECTED.json

EXPECTED holds `times` and, for every body, `name`, `path` (its prim, or null when an instancer has
it) and `poses`: for every time [x, y, z, qw, qx, qy, qz] in world axes. `textures`, if there, holds
the `path` of a mesh and its `uvs`. Exit code 0 and one line
with the worst relative error when everything agrees; otherwise 1 and what does not.
"""
import json
import sys

import numpy as np
from pxr import Usd, UsdGeom, UsdShade, UsdValidation

# Of prims, which are double precision, and of instances, which the schema has in single.
TOLERANCE, INSTANCE_TOLERANCE = 1e-9, 1e-5


def expected_matrix(pose):
    """4x4 for row vectors, as USD has it."""
    x, y, z, qw, qx, qy, qz = pose
    rotation = np.array([
        [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qw * qz), 2 * (qx * qz + qw * qy)],
        [2 * (qx * qy + qw * qz), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qw * qx)],
        [2 * (qx * qz - qw * qy), 2 * (qy * qz + qw * qx), 1 - 2 * (qx * qx + qy * qy)]])
    matrix = np.eye(4)
    matrix[:3, :3] = rotation.T
    matrix[3, :3] = (x, y, z)
    return matrix


def relative_error(matrix, expected):
    place = np.abs(matrix[3] - expected[3]).max() / max(1.0, np.abs(expected[3]).max())
    return max(place, np.abs(matrix[:3] - expected[:3]).max())


def find_complaints(stage):
    """What OpenUSD's own validators say: composition, metadata, shading, geometry, physics."""
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 20
    return [f"{error.GetName()}: {error.GetMessage()}"
            for error in UsdValidation.ValidationContext(validators).Validate(stage)]


def check_textures(stage, expected):
    """The flattened texture coordinates of a mesh: [u, v] of every corner."""
    prim = stage.GetPrimAtPath(expected["path"])
    primvar = UsdGeom.PrimvarsAPI(prim).GetPrimvar("st") if prim else None
    if not primvar or not primvar.HasValue():
        return f"{expected['path']}: no texture coordinates"
    if primvar.GetInterpolation() != "faceVarying" or primvar.GetTypeName() != "texCoord2f[]":
        return f"{expected['path']}: {primvar.GetInterpolation()} {primvar.GetTypeName()}"
    found = np.array(primvar.ComputeFlattened())
    same = found.shape == np.shape(expected["uvs"]) and np.array_equal(found, expected["uvs"])
    return "" if same else f"{expected['path']}: other texture coordinates"


def instanced(stage, time):
    """Matrices of instanced bodies by name."""
    found = {}
    for prim in stage.Traverse():
        instancer = UsdGeom.PointInstancer(prim)
        if not instancer:
            continue
        names = UsdGeom.PrimvarsAPI(prim).GetPrimvar("bodyName").Get()
        world = np.array(instancer.ComputeLocalToWorldTransform(time))
        local = instancer.ComputeInstanceTransformsAtTime(
            time, time, UsdGeom.PointInstancer.ExcludeProtoXform)
        assert len(local) == len(names) == instancer.GetInstanceCount()
        found.update({name: np.array(matrix) @ world for name, matrix in zip(names, local)})
    return found


def main():
    path, expected = sys.argv[1], json.load(open(sys.argv[2]))
    stage = Usd.Stage.Open(path)
    complaints = find_complaints(stage)
    if "textures" in expected:
        complaints += filter(None, [check_textures(stage, expected["textures"])])
    worst, count = 0.0, 0
    for index, number in enumerate(expected["times"]):
        time = Usd.TimeCode(number)
        cache, instances = UsdGeom.XformCache(time), instanced(stage, time)
        for body in expected["bodies"]:
            name = body["name"]
            if body["path"] is None:
                matrix = instances.get(name)
            else:
                prim = stage.GetPrimAtPath(body["path"])
                matrix = np.array(cache.GetLocalToWorldTransform(prim)) if prim else None
            if matrix is None:
                complaints.append(f"no body {name}")
                continue
            error = relative_error(matrix, expected_matrix(body["poses"][index]))
            if not error <= (INSTANCE_TOLERANCE if body["path"] is None else TOLERANCE):
                complaints.append(f"{name} at {number}: off by {error:g}")
            worst, count = max(worst, error), count + 1
            if body["path"] is None:
                continue
            material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
            bound = material.GetPath().name if material else ""
            if bound != body["material"]:
                complaints.append(f"{name}: material is \"{bound}\"")
    print("\n".join(complaints[:20]) if complaints
          else f"{count} transforms, worst relative error {worst:g}")
    return 1 if complaints or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
