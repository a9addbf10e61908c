"""Compares the Cornell box by radiosity with Mitsuba's path tracer: means of 16 x 16 regions of the picture.

    python3 tests/peers/radiosity_check.py [--peris target/release/peris] [--minutes 10] [--write] [--kept]

Needs the packages mitsuba and numpy. Mitsuba works for so many minutes; `--write` keeps its regions in radiosity.json, where
tests/tests/peers.rs looks for them, and `--kept` takes those that are there. Regions are as far off as their mean over the bands
is, as a part of theirs, or of a fifth of the mean of the picture where that is more. Those at the lamp, which outshines all
else, do not count.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

from mitsuba_check import HERE, diffuse, rgb

SIDE, REGIONS = 128, 16
KEPT = os.path.join(HERE, "radiosity.json")
WHITE, RED, GREEN = (0.725, 0.71, 0.68), (0.63, 0.065, 0.05), (0.14, 0.45, 0.091)
# Corners in x and z, from where to where in y, and reflectance; as in host/scenes/cornell.rhai.
BLOCKS = [
    ([[0, 0], [5.528, 0], [5.496, 5.592], [0, 5.592]], -0.1, 0, WHITE),
    ([[0, 0], [5.56, 0], [5.56, 5.592], [0, 5.592]], 5.488, 5.588, WHITE),
    ([[0, 5.592], [5.56, 5.592], [5.56, 5.692], [0, 5.692]], 0, 5.488, WHITE),
    ([[-0.1, 0], [0, 0], [0, 5.592], [-0.1, 5.592]], 0, 5.488, GREEN),
    ([[5.528, 0], [5.628, 0], [5.596, 5.592], [5.496, 5.592]], 0, 5.488, RED),
    ([[1.3, 0.65], [0.82, 2.25], [2.4, 2.72], [2.9, 1.14]], 0, 1.65, WHITE),
    ([[4.23, 2.47], [2.65, 2.96], [3.14, 4.56], [4.72, 4.06]], 0, 3.3, WHITE),
]


def block(folder, number, corners, low, high, reflectance):
    """A prism as a file of triangles, their normals outwards."""
    area = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, corners[1:] + corners[:1]))
    # Seen from above, x to the right and z down: counter-clockwise where the area is negative.
    corners = corners if area < 0 else corners[::-1]
    path = os.path.join(folder, f"block{number}.obj")
    with open(path, "w") as file:
        for y in (low, high):
            file.writelines(f"v {x} {y} {z}\n" for x, z in corners)
        file.write("f 5 6 7\nf 5 7 8\nf 3 2 1\nf 4 3 1\n")
        for i in range(4):
            j = (i + 1) % 4
            file.write(f"f {i + 1} {j + 1} {j + 5}\nf {i + 1} {j + 5} {i + 5}\n")
    return {"type": "obj", "filename": path, "face_normals": True, "bsdf": diffuse(*reflectance)}


def scene(folder):
    eye = mi.ScalarTransform4f().look_at(origin=[2.78, 2.73, -8], target=[2.78, 2.73, 0], up=[0, 1, 0])
    film = {"type": "hdrfilm", "width": SIDE, "height": SIDE, "rfilter": {"type": "box"}, "pixel_format": "rgb",
            "component_format": "float32"}
    lamp = mi.ScalarTransform4f().translate([2.78, 5.4875, 2.795]).rotate([1, 0, 0], 90).scale([0.65, 0.525, 1])
    blocks = {f"block{number}": block(folder, number, *what) for number, what in enumerate(BLOCKS)}
    return mi.load_dict({
        "type": "scene", "integrator": {"type": "path", "max_depth": -1, "rr_depth": 20},
        "sensor": {"type": "perspective", "fov": 39.3, "to_world": eye, "film": film},
        "lamp": {"type": "rectangle", "to_world": lamp, "bsdf": diffuse(0, 0, 0),
                 "emitter": {"type": "area", "radiance": rgb(17, 12, 4)}},
        **blocks,
    })


def regions(picture):
    step = picture.shape[0] // REGIONS
    return picture.reshape(REGIONS, step, REGIONS, step, 3).mean(axis=(1, 3))


def beside_the_lamp(theirs):
    """Which regions count: no lamp is in them, above, below or beside them."""
    lamp = np.pad(theirs.mean(axis=2) >= 1, 1)
    return ~(lamp[1:-1, 1:-1] | lamp[2:, 1:-1] | lamp[:-2, 1:-1] | lamp[1:-1, 2:] | lamp[1:-1, :-2])


def reference(minutes):
    """Means of regions, and their standard errors."""
    with tempfile.TemporaryDirectory() as folder:
        loaded = scene(folder)
        start, made = time.time(), []
        while time.time() < start + 60 * minutes or len(made) < 4:
            # Seeds number the parts of a picture: far apart, none is made twice.
            made.append(regions(np.array(mi.render(loaded, spp=16, seed=100003 * (len(made) + 1)), dtype=float)))
    stack = np.array(made)
    return stack.mean(axis=0), stack.std(axis=0, ddof=1) / np.sqrt(len(made)), 16 * len(made)


def peris(program, *words):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "a.exr")
        told = [program, "render", "cornell", "-o", path, "--width", str(SIDE), "--height", str(SIDE), *words]
        subprocess.run(told, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        picture = mi.Bitmap(path).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
        return regions(np.array(picture, dtype=float))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--peris", default=os.path.join(HERE, "../../target/release/peris"))
    parser.add_argument("--minutes", type=float, default=10, help="how long to work on a reference")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--kept", action="store_true", help="take the reference that was kept")
    parser.add_argument("--map", action="store_true", help="print how far off each region is, in percent")
    arguments = parser.parse_args()
    if arguments.kept:
        kept = json.load(open(KEPT))
        theirs, errors = np.array(kept["regions"]), np.array(kept["errors"])
    else:
        theirs, errors, samples = reference(arguments.minutes)
        if arguments.write:
            note = f"Mitsuba {mi.__version__}, {SIDE} x {SIDE} pixels of {samples} samples: means of {REGIONS} x {REGIONS} regions, standard errors"
            json.dump({"source": note, "regions": np.round(theirs, 6).tolist(), "errors": np.round(errors, 7).tolist()},
                      open(KEPT, "w"))
    least = theirs.mean() / 5
    print(f"mean {theirs.mean():.6f}; regions of the reference are uncertain by "
          f"{(errors.mean(axis=2) / np.maximum(theirs.mean(axis=2), least)).max():.2%} at the most")
    failed = False
    for name, words in (("radiosity", ["--renderer", "radiosity"]), ("ray tracing with radiosity", ["--samples", "64"])):
        ours = peris(arguments.peris, *words)
        off = (ours - theirs).mean(axis=2) / np.maximum(theirs.mean(axis=2), least)
        counts = beside_the_lamp(theirs)
        mean = ours[counts].mean() / theirs[counts].mean() - 1
        good = abs(mean) < 0.01 and np.abs(off[counts]).max() < 0.03
        failed |= not good
        print(f"{name}: mean {mean:+.2%}, regions {np.sqrt((off[counts] ** 2).mean()):.2%} rms, "
              f"{np.abs(off[counts]).max():.2%} at the most: {'agrees' if good else 'DIFFERS'}")
        if arguments.map:
            print(np.array2string(np.round(100 * off, 1), max_line_width=200))
    sys.exit(failed)


if __name__ == "__main__":
    main()
