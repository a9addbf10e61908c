"""Times peris beside Mitsuba 3 on the same scenes and threads: how long either takes to an RMSE of 0.01.

    python3 tests/peers/mitsuba_time.py [--peris target/release/peris] [--side 256]

Needs the packages mitsuba and numpy. RMSE is that of chance: pictures of two seeds are as far apart as the square root of two of
it. Times are the least of three pictures; for peris they have making octree and materials in them, for Mitsuba they do not. The
time to 0.01 is interpolated between the two numbers of samples around it.
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

from mitsuba_check import HERE, box, copper, diffuse, rgb, sensor

GOAL = 0.01
SAMPLES = [2, 4, 9, 16, 36, 64, 144, 256, 484, 1024]


def lamp(corner, across, up, radiance):
    corner, across, up = (np.array(v, dtype=float) for v in (corner, across, up))
    normal = np.cross(across, up)
    columns = [across / 2, up / 2, normal / np.linalg.norm(normal), corner + across / 2 + up / 2]
    matrix = np.eye(4)
    matrix[:3, :] = np.array(columns).T
    return {"type": "rectangle", "to_world": mi.ScalarTransform4f(matrix), "bsdf": diffuse(0, 0, 0),
            "emitter": {"type": "area", "radiance": rgb(radiance, radiance, radiance)}}


def vase(program, folder):
    path = os.path.join(folder, "vase.ply")
    told = [program, "tessellate", os.path.join(HERE, "vase.rhai"), "-D", "alone=true", "-o", path]
    subprocess.run(told, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    ground = mi.ScalarTransform4f().rotate([1, 0, 0], -90).scale(20)
    metal = dict(copper(), type="roughconductor", distribution="beckmann", alpha=0.4)
    eye = sensor([0, 2.5, 9], 22, 64, 64)
    eye["to_world"] = mi.ScalarTransform4f().look_at(origin=[0, 2.5, 9], target=[0, 1.3, 0], up=[0, 1, 0])
    return {
        "type": "scene", "integrator": {"type": "path", "max_depth": 3, "rr_depth": 20}, "sensor": eye,
        "vase": {"type": "ply", "filename": path, "bsdf": metal},
        "ground": {"type": "rectangle", "to_world": ground, "bsdf": diffuse(0.18, 0.18, 0.18)},
        "left": lamp([-3, 5, 1], [1.5, 0, 0], [0, 1.06, 1.06], 240),
        "right": lamp([3, 3, 3], [0, 0, -1.5], [-0.75, 1.3, 0], 160),
    }


def theirs(loaded, samples, seed):
    start = time.time()
    picture = np.array(mi.render(loaded, spp=samples, seed=100000 * seed))
    return picture, time.time() - start


def ours(program, script, words, side, seed):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "a.exr")
        told = [program, "render", os.path.join(HERE, script), "-o", path, "--json", "--width", str(side), "--height", str(side),
                "-D", f"number={seed}", *words]
        report = json.loads(subprocess.run(told, check=True, capture_output=True, text=True).stdout)
        picture = np.array(mi.Bitmap(path).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
        return picture, report["render_seconds"] + report["build_seconds"]


def measured(make):
    runs = [make(seed) for seed in (1, 2, 3)]
    apart = [np.sqrt(((runs[i][0] - runs[i - 1][0]) ** 2).mean() / 2) for i in range(3)]
    return float(np.mean(apart)), min(seconds for _, seconds in runs)


def to_goal(name, steps):
    """Takes more and more samples; the time at which the error is the goal."""
    before = None
    for step, make in steps:
        error, seconds = measured(make)
        print(f"  {name}, {step}: RMSE {error:.4f}, {seconds:.2f} s", flush=True)
        if error <= GOAL:
            if before is None:
                return seconds
            part = np.log(before[0] / GOAL) / np.log(before[0] / error)
            return float(np.exp(np.log(before[1]) * (1 - part) + np.log(seconds) * part))
        before = error, seconds
    return float("nan")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--peris", default=os.path.join(HERE, "../../target/release/peris"))
    parser.add_argument("--side", type=int, default=256)
    arguments = parser.parse_args()
    program, side = arguments.peris, arguments.side
    slower = False
    with tempfile.TemporaryDirectory() as folder:
        cases = [("direct light in a box", "box.rhai", "scalar_rgb", lambda: box(False)),
                 ("copper vase, spectral", "vase.rhai", "scalar_spectral", lambda: vase(program, folder))]
        for name, script, variant, scene in cases:
            mi.set_variant(variant)
            scene = scene()
            scene["sensor"]["film"].update(width=side, height=side)
            scene["sensor"]["sampler"] = {"type": "multijitter"}
            loaded = mi.load_dict(scene)
            print(f"{name}, {side} x {side}:")
            mitsuba = to_goal("Mitsuba, scalar", [(f"{n} samples", lambda seed, n=n: theirs(loaded, n, seed)) for n in SAMPLES])
            fixed = to_goal("peris", [(f"{n} samples", lambda seed, n=n: ours(program, script, ["-D", f"count={n}"], side, seed))
                                      for n in SAMPLES])
            errors = [0.4, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01]
            aimed = to_goal("peris", [(f"--error {e}", lambda seed, e=e: ours(
                program, script, ["-D", "count=256", "--error", str(e)], side, seed)) for e in errors])
            print(f"  to an RMSE of {GOAL}: Mitsuba {mitsuba:.2f} s, peris {fixed:.2f} s ({fixed / mitsuba:.2f}), "
                  f"aimed at an error {aimed:.2f} s ({aimed / mitsuba:.2f})")
            slower |= not min(fixed, aimed) <= mitsuba
    sys.exit(slower)


if __name__ == "__main__":
    main()
