"""Compares pictures of peris with those of Mitsuba 3: mean and RMSE against the errors that both state (Z-tests).

    python3 tests/peers/mitsuba_check.py [--peris target/release/peris] [--samples 256] [--write]

Needs the packages mitsuba and numpy. Each renderer makes several pictures with different seeds; the errors of the mean are
taken from how they differ. --write renews the values that a test keeps (tests/peers/mitsuba.json).
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import mitsuba as mi
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
RUNS = 8


def columns(path):
    """A table of the program: wavelengths, and the columns beside them."""
    rows = [line.split() for line in open(path) if line.strip() and not line.startswith("#")]
    return np.array([[float(word) for word in row] for row in rows[1:]]).T


def copper():
    wavelength, n, k = columns(os.path.join(HERE, "../../host/data/color/copper.txt"))[:3]
    text = lambda values: ", ".join(f"{value}" for value in values)
    return {name: {"type": "irregular", "wavelengths": text(wavelength), "values": text(values)}
            for name, values in (("eta", n), ("k", k))}


def rgb(*value):
    return {"type": "rgb", "value": list(value)}


def diffuse(*value):
    return {"type": "diffuse", "reflectance": rgb(*value)}


def sensor(origin, fov, width, height):
    transform = mi.ScalarTransform4f().look_at(origin=origin, target=[0, 0, 0], up=[0, 1, 0])
    film = {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"},
            "pixel_format": "rgb", "component_format": "float32"}
    return {"type": "perspective", "fov": fov, "fov_axis": "smaller", "to_world": transform, "film": film,
            "sampler": {"type": "independent"}}


def cube(size, place, bsdf, turn=0.0):
    t = mi.ScalarTransform4f().translate(place).rotate([0, 1, 0], turn).scale([s / 2 for s in size])
    return {"type": "cube", "to_world": t, "bsdf": bsdf}


def box(everything):
    white, red, green = diffuse(0.75, 0.75, 0.75), diffuse(0.63, 0.06, 0.05), diffuse(0.14, 0.45, 0.09)
    lamp = mi.ScalarTransform4f().translate([0, 0.98, 0]).rotate([1, 0, 0], 90).scale([0.25, 0.25, 1])
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 51 if everything else 2, "rr_depth": 20},
        "sensor": sensor([0, 0, 4.2], 36, 64, 64),
        "floor": cube([2, 0.1, 2], [0, -1.05, 0], white), "ceiling": cube([2, 0.1, 2], [0, 1.05, 0], white),
        "back": cube([2, 2, 0.1], [0, 0, -1.05], white), "left": cube([0.1, 2, 2], [-1.05, 0, 0], red),
        "right": cube([0.1, 2, 2], [1.05, 0, 0], green),
        "low": cube([0.6, 0.6, 0.6], [0.35, -0.7, 0.3], white, 18),
        "tall": cube([0.6, 1.2, 0.6], [-0.35, -0.4, -0.3], white, -18),
        "lamp": {"type": "rectangle", "to_world": lamp, "bsdf": diffuse(0, 0, 0),
                 "emitter": {"type": "area", "radiance": rgb(15, 15, 15)}},
    }


def spheres(bsdf, grey=False):
    def rgb(*color):
        # Where spectra are carried, all light is D65: other colors become spectra in many ways.
        return {"type": "rgb", "value": [color[1]] * 3 if grey else list(color)}

    def panel(size, place, *color):
        return dict(cube(size, place, diffuse(0, 0, 0)), emitter={"type": "area", "radiance": rgb(*color)})
    return {
        "type": "scene", "integrator": {"type": "path", "max_depth": 21, "rr_depth": 30},
        "sensor": sensor([0, 1, 6], 32, 64, 64),
        "ball": {"type": "sphere", "radius": 1.0, "bsdf": bsdf},
        "left": panel([0.8, 3, 0.1], [-1.2, 0.2, -2], 2, 0.5, 0.2),
        "middle": panel([0.8, 3, 0.1], [0.1, 0.2, -2], 0.3, 1.5, 0.4),
        "right": panel([0.8, 3, 0.1], [1.4, 0.2, -2], 0.2, 0.4, 2),
        "behind": panel([3, 0.5, 0.1], [0, 1.5, 9], 3, 3, 2),
        "sky": {"type": "constant", "radiance": rgb(0.2, 0.25, 0.3)},
    }


def planes():
    up, back = mi.ScalarTransform4f().rotate([1, 0, 0], -90).scale(2), mi.ScalarTransform4f().translate([0, 1, -2]).scale(2)
    lamp = mi.ScalarTransform4f().translate([0, 3, 0]).rotate([1, 0, 0], 90).scale([0.5, 0.5, 1])
    tiles = {"type": "checkerboard", "color0": rgb(0.8, 0.75, 0.6), "color1": rgb(0.1, 0.15, 0.3),
             "to_uv": mi.ScalarTransform4f().scale([4, 4, 1])}
    picture = {"type": "bitmap", "filename": os.path.join(HERE, "planes.png"),
               "to_uv": mi.ScalarTransform4f().scale([2, -2, 1])}
    return {
        "type": "scene", "integrator": {"type": "path", "max_depth": 2},
        "sensor": sensor([0, 1.5, 6], 36, 64, 64),
        "floor": {"type": "rectangle", "to_world": up, "bsdf": {"type": "diffuse", "reflectance": tiles}},
        "wall": {"type": "rectangle", "to_world": back, "bsdf": {"type": "diffuse", "reflectance": picture}},
        "lamp": {"type": "rectangle", "to_world": lamp, "bsdf": diffuse(0, 0, 0),
                 "emitter": {"type": "area", "radiance": rgb(15, 15, 15)}},
    }


def lamps():
    def shining(shape, bsdf, *color):
        return dict(shape, bsdf={"type": "twosided", "bsdf": bsdf}, emitter={"type": "area", "radiance": rgb(*color)})
    corner, across, up = np.array([0.2, -0.95, -0.3]), np.array([1.2, 0, -0.5]), np.array([0, 1.6, 0])
    front = np.cross(across, up)
    frame = np.eye(4)
    frame[:3] = np.column_stack([across / 2, up / 2, front / np.linalg.norm(front), corner + (across + up) / 2])
    floor = mi.ScalarTransform4f().translate([0, -1, 0]).rotate([1, 0, 0], -90).scale(4)
    disc = mi.ScalarTransform4f().translate([0.3, 2.6, 1]).rotate([1, 0, 0], 90).scale([0.9, 0.9, 1])
    mirror = {"type": "conductor", "material": "none", "specular_reflectance": rgb(0.8, 0.8, 0.8)}
    return {
        "type": "scene", "integrator": {"type": "path", "max_depth": 31, "rr_depth": 40},
        "sensor": sensor([0, 0.8, 5.5], 36, 64, 64),
        "floor": {"type": "rectangle", "to_world": floor, "bsdf": diffuse(0.5, 0.5, 0.5)},
        "ball": {"type": "sphere", "center": [-0.75, -0.3, 0], "radius": 0.7, "bsdf": diffuse(0.8, 0.8, 0.8),
                 "emitter": {"type": "area", "radiance": rgb(0.4, 0.3, 0.2)}},
        "mirror": shining({"type": "rectangle", "to_world": mi.ScalarTransform4f(frame)}, mirror, 0.1, 0.12, 0.2),
        "disc": shining({"type": "disk", "to_world": disc}, diffuse(0.6, 0.6, 0.6), 4, 4, 4),
    }


# Name, script, what it is told, variant of Mitsuba, and its scene.
CASES = [
    ("direct light in a box", "box.rhai", {}, "scalar_rgb", lambda: box(False)),
    ("all light in a box", "box.rhai", {"all": "true"}, "scalar_rgb", lambda: box(True)),
    ("glass sphere", "spheres.rhai", {}, "scalar_rgb", lambda: spheres({"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0})),
    ("copper sphere, spectral", "spheres.rhai", {"which": "copper"}, "scalar_spectral",
     lambda: spheres(dict(copper(), type="conductor"), True)),
    ("rough copper sphere, spectral", "spheres.rhai", {"which": "rough copper"}, "scalar_spectral",
     lambda: spheres(dict(copper(), type="roughconductor", distribution="beckmann", alpha=0.3), True)),
    ("textured planes", "planes.rhai", {}, "scalar_rgb", planes),
    ("lamps that reflect", "lamps.rhai", {}, "scalar_rgb", lamps),
]


def peris(program, script, told, samples, seed):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "a.exr")
        told = dict(told, count=str(samples), number=str(seed))
        words = [word for name, value in told.items() for word in ("-D", f"{name}={value}")]
        subprocess.run([program, "render", os.path.join(HERE, script), "-o", path, "--json", *words],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return np.array(mi.Bitmap(path).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))


def statistics(pictures):
    stack = np.array(pictures, dtype=float)
    return stack.mean(axis=0), stack.var(axis=0, ddof=1) / len(stack)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--peris", default=os.path.join(HERE, "../../target/release/peris"))
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--only", default="", help="cases whose names have this in them")
    arguments = parser.parse_args()
    failed, kept = False, {}
    # Mitsuba numbers the parts of a picture from its seed on: seeds far apart have none in common.
    for name, script, told, variant, scene in (case for case in CASES if arguments.only in case[0]):
        mi.set_variant(variant)
        loaded = mi.load_dict(scene())
        theirs, their_error = statistics(
            [np.array(mi.render(loaded, spp=arguments.samples, seed=1000 * (seed + 1))) for seed in range(RUNS)])
        ours, our_error = statistics(
            [peris(arguments.peris, script, told, arguments.samples, seed) for seed in range(1, RUNS + 1)])
        apart = ours - theirs
        # The mean, against the error of the mean; and the squared difference, against the variances of all pixels.
        z_mean = apart.mean() / np.sqrt((our_error + their_error).sum()) * apart.size
        ratio = (apart ** 2).sum() / (our_error + their_error).sum()
        good = abs(z_mean) < 4 and ratio < 1.25
        failed |= not good
        print(f"{name}: means {ours.mean():.6f} and {theirs.mean():.6f} (Z {z_mean:+.2f}); RMSE "
              f"{np.sqrt((apart ** 2).mean()):.2e}, {np.sqrt(ratio):.3f} times what chance explains: "
              f"{'agrees' if good else 'DIFFERS'}")
        blocks = theirs.reshape(8, theirs.shape[0] // 8, 8, theirs.shape[1] // 8, 3).mean(axis=(1, 3))
        errors = np.sqrt(their_error.reshape(8, theirs.shape[0] // 8, 8, theirs.shape[1] // 8, 3).sum(axis=(1, 3)))
        errors /= theirs.shape[0] // 8 * (theirs.shape[1] // 8)
        kept[name] = {"script": script, "told": told, "blocks": np.round(blocks, 6).tolist(),
                      "errors": np.round(errors, 7).tolist()}
    if arguments.write:
        note = f"Mitsuba {mi.__version__}, {RUNS} pictures of {arguments.samples} samples: means of 8 x 8 blocks, standard errors"
        json.dump({"source": note, "cases": kept}, open(os.path.join(HERE, "mitsuba.json"), "w"))
    sys.exit(failed)


if __name__ == "__main__":
    main()
