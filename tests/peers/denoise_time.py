"""Denoised pictures beside noisy ones that took as long: their errors to the eye (FLIP).

    python3 tests/peers/denoise_time.py [--peris target/release/peris] [--samples 4] [SCENE[:all] ...]

Needs the packages flip-evaluator, numpy and pillow. `SCENE:all` has all kinds of light in it (`-D all=true`). References have
many samples of another seed. Times are those of rendering and denoising, the median of five pictures. The error of a noisy picture
that takes as long is interpolated between two numbers of samples, as a power of the time; all pictures of a scene have the
exposure of the denoised one.
"""
import argparse
import json
import math
import os
import statistics
import subprocess
import tempfile

import flip_evaluator
import numpy as np
from PIL import Image

SCENES = ["teapot", "chess", "motion", "materials", "ring", "corner", "vases", "cornell", "cornell:all", "caustic", "pool",
          "textures", "flowers", "crystal", "afternoon", "room", "room:all"]
WIDTH = 320


def command(program, scene, *more):
    name, _, all_light = scene.partition(":")
    told = [program, "render", name, "--width", str(WIDTH), *map(str, more)]
    return told + (["-D", "all=true"] if all_light else [])


def picture(path):
    return np.asarray(Image.open(path).convert("RGB"), dtype=np.float32) / 255


def rendered(program, scene, samples, path, *more):
    """The median time, s, and the exposure, stops."""
    seconds = []
    for _ in range(5):
        told = command(program, scene, "--samples", samples, "--tone", "filmic", "--json", "-o", path, *more)
        report = json.loads(subprocess.run(told, check=True, capture_output=True, text=True).stdout)
        seconds.append(report["render_seconds"])
        if seconds[0] > 4:
            break
    return statistics.median(seconds), report["exposure"]


def compared(program, scene, samples, reference_samples, folder):
    path = lambda name: os.path.join(folder, name)
    seconds, exposure = rendered(program, scene, samples, path("denoised.png"), "--denoise")
    told = command(program, scene, "--samples", reference_samples, "--seed", 77, "-o", path("reference.exr"))
    subprocess.run(told, check=True, capture_output=True)
    told = [program, "convert", path("reference.exr"), path("reference.png"), "--exposure", str(exposure), "--tone", "filmic"]
    subprocess.run(told, check=True, capture_output=True)
    reference = picture(path("reference.png"))
    error = lambda name: flip_evaluator.evaluate(reference, picture(path(name)), "LDR")[1]
    denoised, noisy = error("denoised.png"), []
    for count in range(samples, 4 * samples + 1):
        time, _ = rendered(program, scene, count, path("noisy.png"))
        noisy.append((math.log(time), math.log(error("noisy.png"))))
        if time >= seconds:
            break
    as_long = noisy[-1][1]
    if len(noisy) > 1:
        (before, high), (after, low) = noisy[-2:]
        as_long = high + (low - high) * (math.log(seconds) - before) / max(after - before, 1e-9)
    return seconds, denoised, math.exp(as_long), math.exp(noisy[0][1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peris", default="target/release/peris")
    parser.add_argument("--samples", type=int, default=4)
    parser.add_argument("--reference", type=int, default=512, help="samples of the references")
    parser.add_argument("scenes", nargs="*", default=SCENES, metavar="SCENE")
    options = parser.parse_args()
    print(f"{'scene':14} {'time':>7} {'denoised':>9} {'as long':>9} {'ratio':>6} {'same samples':>13}")
    with tempfile.TemporaryDirectory() as folder:
        for scene in options.scenes:
            seconds, denoised, as_long, same = compared(options.peris, scene, options.samples, options.reference, folder)
            print(f"{scene:14} {seconds:7.3f} {denoised:9.4f} {as_long:9.4f} {denoised / as_long:6.2f} "
                  f"{denoised / same:13.2f}", flush=True)


if __name__ == "__main__":
    main()
