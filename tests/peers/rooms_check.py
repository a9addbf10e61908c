"""Compares rooms by radiosity with Mitsuba's light tracer: the mean of the picture, means of 8 x 6 parts of it, and pixels.

    python3 tests/peers/rooms_check.py [--peris target/release/peris] [--rooms "sky 0.6"] [--write]

Needs the packages mitsuba, numpy and OpenEXR, and LLVM's library for Mitsuba. Mitsuba's numbers have 24 bits, and its rays
start so far off surfaces that it shows in windows of 0.05: its rooms are enlarged about the window. `--write` lets Mitsuba
work, some minutes a room, and keeps its values in rooms.json and rooms.exr, where tests/tests/peers.rs looks for them. In
the second, pictures of all rooms are one below the other, in the order of the first: red is the mean of a pixel, green the
mean over it and those beside it of its standard error. A pixel is off by more than 5 % of what is there and three standard
errors. Each room is made of rectangles here; of the sky only what fills the outer rim of the window is there, which is all
that comes in. Pixels in which the window, the lamp or what is next to them is in sight do not count.
"""
import argparse
import json
import os
import subprocess
import tempfile

import mitsuba as mi
import numpy as np
import OpenEXR

mi.set_variant("llvm_ad_rgb")

HERE = os.path.dirname(os.path.abspath(__file__))
KEPT = os.path.join(HERE, "rooms.json")
PIXELS = os.path.join(HERE, "rooms.exr")
COLUMNS, ROWS, PARTS = 64, 48, (6, 8)
PASSES = 16
# Single pixels of these are uncertain.
PASSES_OF = {"lamp 0.2": 64, "spot 0.2": 64}
# Of the light of a lamp or a spot, less comes to the window; of a small window, less comes to the room.
SAMPLES = {"sky": 1024, "sun": 1024, "pane": 1024, "lantern": 1024, "lamp": 4096, "spot": 4096}
SAMPLES |= {"sky 0.05": 4096, "sun 0.05": 4096}
# Light by a small window is found by few samples.
OUR_SAMPLES = {"0.05": 16384}
MOST_SAMPLES = 4096
# A pixel may be off by this part of what is there.
OFF = 0.05
# A pixel with so many times the median shows a lamp or the sky.
BRIGHT = 20
ROOMS = [f"{kind} {width}" for kind in ("sky", "sun", "lamp", "spot") for width in ("0.05", "0.2", "0.6", "2")]
ROOMS += ["pane 0.6", "lantern 0"]
T = mi.ScalarTransform4f
# Mitsuba's rays start some 1e-4 (1 + distance from the origin) off surfaces, in units of length.
ENLARGED, ORIGIN = 1000, np.array([2.1, 0, 0])


def grey(value):
    return {"type": "rgb", "value": [value] * 3}


def paint(reflectance):
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": grey(reflectance)}}


def rectangle(corner, across, up, **more):
    corner, across, up = (np.array(vector, float) for vector in (corner, across, up))
    normal = np.cross(across, up)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1] = across / 2, up / 2
    matrix[:3, 2] = normal / np.linalg.norm(normal)
    matrix[:3, 3] = corner + across / 2 + up / 2
    return {"type": "rectangle", "to_world": T(matrix.tolist()), **more}


def emitter(kind, radiance):
    return {"bsdf": paint(0), "emitter": {"type": kind, "radiance": grey(radiance)}}


def with_hole(middle, axis, half, hole, bsdf):
    """Four rectangles: a square sheet at a middle, across an axis, with half sides and a square hole."""
    across, up = {0: (2, 1), 1: (0, 2), 2: (0, 1)}[axis]
    h, (a, b) = hole / 2, half

    def part(from_across, from_up, to_across, to_up):
        corner, one, other = np.array(middle, float), np.zeros(3), np.zeros(3)
        corner[across] += from_across
        corner[up] += from_up
        one[across], other[up] = to_across - from_across, to_up - from_up
        return rectangle(corner, one, other, bsdf=bsdf)

    return [part(-a, -b, a, -h), part(-a, h, a, b), part(-a, -h, -h, h), part(h, -h, a, h)]


def tunnel(middle, axis, length, side, bsdf):
    """The four walls of a square tunnel along an axis."""
    one, other = [i for i in range(3) if i != axis]
    walls = []
    for fixed, free in ((one, other), (other, one)):
        for sign in (-1, 1):
            corner, along, wide = np.array(middle, float), np.zeros(3), np.zeros(3)
            corner[axis] -= length / 2
            corner[fixed] += sign * side / 2
            corner[free] -= side / 2
            along[axis], wide[free] = length, side
            walls.append(rectangle(corner, along, wide, bsdf=bsdf))
    return walls


def window_light(kind, w):
    """What shines through the window, and what is in it."""
    rim = ([2.2, -w / 2, -w / 2], [0, 0, w], [0, w, 0])
    if kind in ("sky", "pane"):
        glass = {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0}
        pane = [rectangle([2.1, -w / 2, -w / 2], [0, 0, w], [0, w, 0], bsdf=glass)] if kind == "pane" else []
        return [rectangle(*rim, **emitter("area", 1))] + pane
    if kind == "lamp":
        return [rectangle([3.2, -0.3, -0.5], [0, 0, 1], [0, 1, 0], **emitter("area", 100))]
    if kind == "spot":
        turned = T().look_at(origin=[4, 0.5, 0.6], target=[2, 0, 0], up=[0, 1, 0])
        return [{"type": "spot", "intensity": grey(100), "cutoff_angle": 40.0, "beam_width": 39.9, "to_world": turned}]
    # The sun: a rectangle across its direction that sends as much along its normal, and covers the window.
    towards = np.array([-1, -0.35, 0.2])
    towards /= np.linalg.norm(towards)
    across = np.cross([0, 1, 0], towards)
    across *= 1.6 * w / np.linalg.norm(across)
    up = np.cross(towards, across)
    corner = np.array([2.2, 0, 0]) - 2 * towards - (across + up) / 2
    return [rectangle(corner, across, up, **emitter("directionalarea", 100))]


def scene(name):
    kind, width = name.split()
    w, grey_wall = float(width), paint(0.5)
    walls = [rectangle([-2, -1.25, -3.5], [0, 0, 7], [0, 2.5, 0], bsdf=grey_wall)]
    for y in (-1.25, 1.25):
        walls.append(rectangle([-2, y, -3.5], [4, 0, 0], [0, 0, 7], bsdf=grey_wall))
    for z in (-3.5, 3.5):
        walls.append(rectangle([-2, -1.25, z], [4, 0, 0], [0, 2.5, 0], bsdf=grey_wall))
    if kind == "lantern":
        walls.append(rectangle([2, -1.25, -3.5], [0, 0, 7], [0, 2.5, 0], bsdf=grey_wall))
        middle = np.array([0.6, 0, -0.5])
        for side in (-1, 1):
            for axis in (0, 2):
                for far in (0.23, 0.25):
                    at = middle.copy()
                    at[axis] += side * far
                    walls += with_hole(at, axis, (far, far), 0.3, grey_wall)
                at = middle.copy()
                at[axis] += side * 0.24
                walls += tunnel(at, axis, 0.02, 0.3, grey_wall)
            for far in (0.23, 0.25):
                corner = middle + [-far, side * far, -far]
                walls.append(rectangle(corner, [2 * far, 0, 0], [0, 0, 2 * far], bsdf=grey_wall))
        walls.append({"type": "sphere", "center": middle.tolist(), "radius": 0.05, **emitter("area", 100)})
    else:
        walls += with_hole([2, 0, 0], 0, (3.5, 1.25), w, grey_wall) + with_hole([2.2, 0, 0], 0, (3.7, 1.45), w, paint(0))
        walls += tunnel([2.1, 0, 0], 0, 0.2, w, grey_wall) + window_light(kind, w)
    camera = T().look_at(origin=[-1.8, 0, 3.3], target=[0.5, -0.3, 0], up=[0, 1, 0])
    film = {"type": "hdrfilm", "width": COLUMNS, "height": ROWS, "rfilter": {"type": "box"}, "pixel_format": "rgb",
            "component_format": "float32"}
    sensor = {"type": "perspective", "fov": 80, "fov_axis": "y", "to_world": camera, "film": film}
    integrator = {"type": "ptracer", "max_depth": 31, "rr_depth": 100}
    shapes = {f"shape{number}": shape for number, shape in enumerate(walls)}
    return mi.load_dict(enlarged({"type": "scene", "integrator": integrator, "sensor": sensor, **shapes}))


def enlarged(made):
    """A scene whose light is the same in its pictures, larger, and with its window at the origin."""
    grown = {}
    for key, value in made.items():
        if isinstance(value, dict):
            value = enlarged(value)
        elif key == "to_world":
            matrix = np.array(value.matrix, float)
            matrix[:3, 3] = ENLARGED * (matrix[:3, 3] - ORIGIN)
            if made["type"] == "rectangle":
                matrix[:3, :3] *= ENLARGED
            value = T(matrix.tolist())
        elif key == "center":
            value = (ENLARGED * (np.array(value) - ORIGIN)).tolist()
        elif key == "radius":
            value = ENLARGED * value
        grown[key] = value
    if made.get("type") == "spot":
        grown["intensity"] = grey(made["intensity"]["value"][0] * ENLARGED**2)
    return grown


def parts(picture):
    rows, columns = PARTS
    blocks = picture.reshape(picture.shape[:-2] + (rows, ROWS // rows, columns, COLUMNS // columns))
    return blocks.sum(axis=(-3, -1))


def bright(passes):
    """The pixels in which a lamp or the sky is in sight, and those next to them."""
    mean = passes.mean(axis=0)
    shows = np.pad(mean > BRIGHT * np.median(mean), 1)
    near = [shows[1 + i:1 + i + ROWS, 1 + j:1 + j + COLUMNS] for i in (-1, 0, 1) for j in (-1, 0, 1)]
    return np.flatnonzero(np.any(near, axis=0)).tolist()


def values(passes, left_out):
    """What is kept of the pictures of all passes: sums over parts, with their standard errors, and the pixels left out."""
    passes = passes.copy()
    passes.reshape(len(passes), -1)[:, left_out] = 0
    error = lambda of: of.std(axis=0, ddof=1) / len(passes) ** 0.5
    whole = passes.sum(axis=(1, 2))
    short = lambda array: [[float(f"{value:.5g}") for value in row] for row in array]
    return {
        "left_out": left_out,
        "whole": float(f"{whole.mean():.6g}"),
        "error": float(f"{error(whole):.3g}"),
        "parts": short(parts(passes).mean(axis=0)),
        "errors": short(error(parts(passes))),
    }


def around(picture):
    """The mean over each pixel and those beside it; those that are left out are no numbers."""
    rows, columns = picture.shape
    near = lambda i, j: picture[max(0, i - 1):i + 2, max(0, j - 1):j + 2]
    with np.errstate(all="ignore"):
        return np.array([[np.nanmean(near(i, j)) for j in range(columns)] for i in range(rows)])


def counted(picture, left_out):
    picture = picture.astype(float)
    picture.reshape(-1)[left_out] = np.nan
    return picture


def pixels(passes, left_out):
    """Means and standard errors. The error of one pixel is taken over its neighbourhood: chance makes its own too small just
    where it makes the pixel too dark."""
    square = counted(passes.var(axis=0, ddof=1) / len(passes), left_out)
    return np.stack([passes.mean(axis=0), np.nan_to_num(np.sqrt(around(square)))], axis=-1)


def kept_pixels(rooms, new):
    """Pictures of all rooms, of which some are new."""
    old = {}
    if os.path.exists(PIXELS):
        known = OpenEXR.File(PIXELS).channels()["RGB"].pixels
        names = sorted(json.load(open(KEPT))["rooms"])
        old = {name: known[ROWS * i:ROWS * (i + 1), :, :2] for i, name in enumerate(names)}
    return np.concatenate([new.get(name, old.get(name, np.zeros((ROWS, COLUMNS, 2)))) for name in sorted(rooms)])


def write_pixels(values):
    values = np.concatenate([values, np.zeros_like(values[:, :, :1])], axis=-1).astype(np.float32)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": values}).write(PIXELS + ".new.exr")
    os.replace(PIXELS + ".new.exr", PIXELS)


def ours(peris, name, folder):

    kind, width = name.split()
    path = os.path.join(folder, "room.exr")
    words = ["-D", f"kind={kind}", "-D", f"width={float(width) or 0.6}", "--samples", str(OUR_SAMPLES.get(width, MOST_SAMPLES)), "-o", path]
    subprocess.run([peris, "render", os.path.join(HERE, "rooms.rhai"), *words], check=True, capture_output=True)
    channels = OpenEXR.File(path).channels()
    return next(iter(channels.values())).pixels[:, :, 1].astype(float)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peris", default="target/release/peris")
    parser.add_argument("--rooms", nargs="*", default=ROOMS)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    kept = json.load(open(KEPT)) if os.path.exists(KEPT) else {"rooms": {}}
    kept["source"] = f"Mitsuba {mi.__version__}, ptracer: sums over 8 x 6 parts of {COLUMNS} x {ROWS} pixels, standard errors"
    if options.write:
        for name in options.rooms:
            made = scene(name)
            kind, width = name.split()
            samples = SAMPLES.get(name, SAMPLES[kind])
            seeds = range(PASSES_OF.get(name, PASSES))
            passes = np.array([np.array(mi.render(made, spp=samples, seed=seed))[:, :, 1] for seed in seeds])
            # A window is where the sky is seen in it.
            left_out = bright(passes) if kind in ("sky", "lantern") else kept["rooms"][f"sky {width}"]["left_out"]
            kept["rooms"][name] = values(passes, left_out)
            write_pixels(kept_pixels(kept["rooms"], {name: pixels(passes, left_out)}))
            with open(KEPT + ".new", "w") as file:
                rooms = ",\n".join(f"{json.dumps(room)}: {json.dumps(of)}" for room, of in sorted(kept["rooms"].items()))
                file.write(f'{{"source": {json.dumps(kept["source"])}, "rooms": {{\n{rooms}\n}}}}\n')
            os.replace(KEPT + ".new", KEPT)
            print(f"{name}: kept, uncertain by {kept['rooms'][name]['error'] / kept['rooms'][name]['whole']:.2%}", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in options.rooms:
            room = kept["rooms"][name]
            picture = ours(options.peris, name, folder)
            row = ROWS * sorted(kept["rooms"]).index(name)
            theirs, error = np.moveaxis(OpenEXR.File(PIXELS).channels()["RGB"].pixels[row:row + ROWS, :, :2], -1, 0)
            theirs = counted(theirs, room["left_out"])
            off = np.abs(picture - theirs) > OFF * around(theirs) + 3 * error
            print(f"{name}: {np.count_nonzero(off)} pixels are off: {np.argwhere(off).tolist()[:8]}", flush=True)
            picture.reshape(-1)[room["left_out"]] = 0
            known = np.array(room["parts"])
            off = (parts(picture) / np.where(known > 0, known, 1) - 1)[known > 0]
            print(f"{name}: mean {picture.sum() / room['whole'] - 1:+.2%}, uncertain by {room['error'] / room['whole']:.2%}; "
                  f"parts {off.min():+.1%} to {off.max():+.1%}, rms {np.sqrt((off ** 2).mean()):.2%}", flush=True)


if __name__ == "__main__":
    main()
