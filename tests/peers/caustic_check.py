"""Compares caustics of peris with Mitsuba's particle tracer: the light that a glass ball gathers on a plane.

    python3 tests/peers/caustic_check.py [--peris target/release/peris] [--reference FILE] [--minutes 20]

Needs the packages mitsuba and numpy. The reference is made once, in so many minutes, and kept in FILE; what is there is used
as it is. Only pixels beside the ball count: the particle tracer does not find what is seen through glass. The relative MSE is
the mean of (a - b)^2 / (b^2 + 0.01), as `peris diff` has it, less what chance does to the reference; seconds are those of a
processor, start of the program and scene included.
"""
import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

from mitsuba_check import HERE, diffuse, rgb
from mitsuba_time import lamp

SCENE = os.path.join(HERE, "../../host/scenes/caustic.rhai")
SIDE = 256
FROM, AT, FIELD = np.array([1.5, 5, 6]), np.array([-0.4, 0.5, 0]), 38
CENTER, RADIUS = np.array([0, 1.2, 0]), 1.0
POWER, LAMP = 400, 0.2
# Ways of light, samples of each pixel, and points of the lamp that each of them looks at.
SETTINGS = [(50_000, 1, 8), (80_000, 1, 8), (200_000, 4, 4), (200_000, 16, 1), (800_000, 16, 1), (200_000, 64, 1)]
# Of Mitsuba, for each pixel.
PARTICLES = [4, 16, 64]


def scene():
    eye = mi.ScalarTransform4f().look_at(origin=FROM, target=AT, up=[0, 1, 0])
    film = {"type": "hdrfilm", "width": SIDE, "height": SIDE, "rfilter": {"type": "box"}, "pixel_format": "rgb"}
    return mi.load_dict({
        "type": "scene", "integrator": {"type": "ptracer", "max_depth": -1},
        "sensor": {"type": "perspective", "fov": FIELD, "fov_axis": "smaller", "to_world": eye, "film": film,
                   "sampler": {"type": "independent"}},
        "plane": {"type": "cube", "to_world": mi.ScalarTransform4f().translate([0, -0.1, 0]).scale([6, 0.1, 6]),
                  "bsdf": diffuse(0.7, 0.7, 0.7)},
        "ball": {"type": "sphere", "center": CENTER, "radius": RADIUS,
                 "bsdf": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}},
        "lamp": lamp([2.5 - LAMP / 2, 6, -LAMP / 2], [LAMP, 0, 0], [0, 0, LAMP], POWER / (np.pi * LAMP * LAMP)),
    })


def particles(loaded, count, seed):
    start = time.process_time()
    picture = np.array(mi.render(loaded, spp=count, seed=seed), dtype=float).mean(axis=2)
    return picture, time.process_time() - start


def reference(path, loaded, minutes):
    """Mean of many pictures, and the variance of the mean."""
    if path and os.path.exists(path):
        kept = np.load(path)
        return kept["mean"], kept["variance"]
    start, pictures, total, squares = time.time(), 0, np.zeros((SIDE, SIDE)), np.zeros((SIDE, SIDE))
    while time.time() < start + 60 * minutes or pictures < 2:
        pictures += 1
        # Seeds number the parts of a picture: far apart, none is made twice.
        picture, _ = particles(loaded, 64, 100003 * pictures)
        total, squares = total + picture, squares + picture ** 2
    mean = total / pictures
    variance = np.maximum(squares / pictures - mean ** 2, 0) / (pictures - 1)
    if path:
        with open(path, "wb") as file:
            np.savez(file, mean=mean, variance=variance)
    return mean, variance


def beside_the_ball():
    """Which pixels show the plane, clear of the ball and of the plane's edges."""
    forward = (AT - FROM) / np.linalg.norm(AT - FROM)
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    at = ((np.arange(SIDE) + 0.5) / SIDE * 2 - 1) * np.tan(np.radians(FIELD / 2))
    way = forward + right * at[None, :, None] - up * at[:, None, None]
    way /= np.linalg.norm(way, axis=2, keepdims=True)
    offset = CENTER - FROM
    distance = np.sqrt(np.maximum(offset @ offset - (way @ offset) ** 2, 0))
    with np.errstate(divide="ignore"):
        hit = FROM + way * (-FROM[1] / way[:, :, 1])[:, :, None]
    on_plane = (way[:, :, 1] < 0) & (np.abs(hit[:, :, [0, 2]]).max(axis=2) < 5.8)
    return on_plane & (distance > 1.03 * RADIUS)


def peris(program, photons, samples, points, everything):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "a.exr")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([program, "render", SCENE, "-o", path, "--renderer", "two-way", "--samples", str(samples),
                        "--width", str(SIDE), "--height", str(SIDE), "-D", f"photons={photons}", "-D", f"points={points}",
                        "-D", f"interreflection={'true' if everything else 'false'}"],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        picture = np.array(mi.Bitmap(path).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False), dtype=float)
        return picture.mean(axis=2), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--peris", default=os.path.join(HERE, "../../target/release/peris"))
    parser.add_argument("--reference", help="a file to keep the reference in")
    parser.add_argument("--minutes", type=float, default=20, help="how long to work on a reference")
    arguments = parser.parse_args()
    loaded, counts = scene(), beside_the_ball()
    mean, variance = reference(arguments.reference, loaded, arguments.minutes)
    weight = 1 / (mean ** 2 + 0.01)
    noise = (variance * weight)[counts].mean()
    print(f"{counts.sum()} pixels; chance in the reference: {noise:.2e}")
    print(f"{'':34} {'relative MSE':>12} {'mean ratio':>11} {'seconds':>8}")
    errors = []

    def tell(name, made):
        picture, seconds = made
        error = ((picture - mean) ** 2 * weight)[counts].mean() - noise
        ratio = picture[counts].mean() / mean[counts].mean()
        print(f"{name:34} {error:12.2e} {ratio:11.4f} {seconds:8.2f}", flush=True)
        errors.append((error, ratio))

    for everything in (True, False):
        for photons, samples, points in SETTINGS:
            name = f"{photons} ways, {samples} x {points} samples" + ("" if everything else ", one bounce")
            tell(name, peris(arguments.peris, photons, samples, points, everything))
    best = len(SETTINGS) - 1
    for count in PARTICLES:
        tell(f"Mitsuba, {count} particles a pixel", particles(loaded, count, 7_000_003 * count))
    error, ratio = errors[best]
    sys.exit(not (error < 0.01 and abs(ratio - 1) < 0.02))


if __name__ == "__main__":
    main()
