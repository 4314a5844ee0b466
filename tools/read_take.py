#!/usr/bin/env python3
"""Reads a take with NumPy alone: read_take.py takes/seesaw/frames/frame.001001.scree

The layout is explained in io/TAKE_FORMAT.md. The checksum at the end is not verified here.
"""
import json
import pathlib
import struct
import sys

import numpy as np

HEADER = struct.Struct("<8sIIqQQQ")  # magic, version, blocks, frame, bodies, shot hash, bytes
ENTRY = struct.Struct("<24s8sQQQ8x")  # name, NumPy type, rows, columns, offset


def read_frame(path):
    """Frame number and a dictionary of arrays: name -> rows x columns."""
    data = pathlib.Path(path).read_bytes()
    magic, version, block_count, frame, _, _, byte_count = HEADER.unpack_from(data)
    if magic != b"SCREEFRM" or version != 1 or byte_count != len(data):
        raise ValueError(f"{path}: not a whole Scree frame of version 1")
    blocks = {}
    for i in range(block_count):
        name, dtype, rows, columns, offset = ENTRY.unpack_from(data, 64 + 64 * i)
        values = np.frombuffer(data, dtype.rstrip(b"\0").decode(), rows * columns, offset)
        blocks[name.rstrip(b"\0").decode()] = values.reshape(rows, columns)
    return frame, blocks


def read_motion(take):
    """All samples in order of time, those between frames included: frame (with its fraction),
    positions, orientations w x y z."""
    def number(path):  # names sort otherwise below zero
        return int(path.stem.split(".")[-1])

    for path in sorted(pathlib.Path(take).glob("frames/*.scree"), key=number):
        frame, blocks = read_frame(path)
        for i, offset in enumerate(blocks.get("sub.offset", np.empty((0, 1)))[:, 0]):
            rows = slice(i * len(blocks["asset.position"]), (i + 1) * len(blocks["asset.position"]))
            yield frame - 1 + offset, blocks["sub.position"][rows], blocks["sub.orientation"][rows]
        yield frame, blocks["asset.position"], blocks["asset.orientation"]


def _slope_at(frames, values, key):
    """As in core/picture/camera_motion.cpp: at rest at both ends and at a turn, else the weighted
    harmonic mean of the slopes on both sides."""
    slope = np.zeros(values.shape[1])
    if key in (0, len(frames) - 1):
        return slope
    h0, h1 = frames[key] - frames[key - 1], frames[key + 1] - frames[key]
    before, after = (values[key] - values[key - 1]) / h0, (values[key + 1] - values[key]) / h1
    passes = before * after > 0
    w0, w1 = 2 * h1 + h0, h1 + 2 * h0
    slope[passes] = (w0 + w1) / (w0 / before[passes] + w1 / after[passes])
    return slope


def camera_at(camera, frame, up_axis):
    """Eye, target, up and vertical angle of view of a camera of take.json at a moment [frames]."""
    scene_up = [0, 1, 0] if up_axis == "+y" else [0, 0, 1]
    row = lambda key: [*key["eye"], *key["target"], *key.get("up", scene_up), key["fov"]]
    now = np.array(row(camera), float)
    if "keys" in camera:
        frames = np.array([key["frame"] for key in camera["keys"]], float)
        values = np.array([row(key) for key in camera["keys"]], float)
        inside = min(max(frame, frames[0]), frames[-1])
        k = int(np.clip(np.searchsorted(frames, inside, "right") - 1, 0, max(len(frames) - 2, 0)))
        now = values[k]
        if len(frames) > 1:
            h = frames[k + 1] - frames[k]
            s = (inside - frames[k]) / h
            way = values[k + 1] - values[k]
            if camera["interpolate"] == "linear":
                now = now + s * way
            else:
                slopes = _slope_at(frames, values, k), _slope_at(frames, values, k + 1)
                bend = h * s * (1 - s) * ((1 - s) * slopes[0] - s * slopes[1])
                now = now + s * s * (3 - 2 * s) * way + bend
    elif "orbit" in camera:
        orbit = camera["orbit"]
        first, last = orbit["frames"]
        share = min(max((frame - first) / (last - first), 0.0), 1.0) if last > first else 0.0
        angle = np.radians(orbit["start"] + share * orbit["degrees"])
        right, front = orbit["radius"] * np.sin(angle), orbit["radius"] * np.cos(angle)
        height = orbit["height"]
        around = [right, height, front] if up_axis == "+y" else [right, -front, height]
        now[:6] = [*(np.array(orbit["centre"]) + around), *orbit["centre"]]
    return now[:3], now[3:6], now[6:9], now[9]


def forces(blocks):
    """Mean force [N] that each contact put on its first body in the step that ended at the frame."""
    return blocks["contact.impulse"] / blocks["step.dt"][0, 0]


if __name__ == "__main__":
    frame, blocks = read_frame(sys.argv[1])
    take = json.loads((pathlib.Path(sys.argv[1]).parents[1] / "take.json").read_text())
    print(f"frame {frame} of {take['name']}")
    for body, place, turn in zip(take["bodies"], blocks["asset.position"], blocks["asset.orientation"]):
        print(f"{body['name']:24} position {place}  orientation w x y z {turn}")
    if "step.dt" in blocks:
        for (a, b), force in zip(blocks["contact.bodies"], forces(blocks)):
            print(f"{take['bodies'][b]['name']} on {take['bodies'][a]['name']}: force {force} N")
