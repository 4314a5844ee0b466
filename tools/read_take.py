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
    for path in sorted(pathlib.Path(take).glob("frames/*.scree")):
        frame, blocks = read_frame(path)
        for i, offset in enumerate(blocks.get("sub.offset", np.empty((0, 1)))[:, 0]):
            rows = slice(i * len(blocks["asset.position"]), (i + 1) * len(blocks["asset.position"]))
            yield frame - 1 + offset, blocks["sub.position"][rows], blocks["sub.orientation"][rows]
        yield frame, blocks["asset.position"], blocks["asset.orientation"]


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
