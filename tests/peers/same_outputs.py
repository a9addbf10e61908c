"""Whether two builds give the same bytes: hashes of some sixty outputs of both programs.

    python3 tests/peers/same_outputs.py target/release > before
    ... another commit, built ...
    python3 tests/peers/same_outputs.py target/release > after; diff before after

Each line is a name and the SHA-256 of a picture, a mesh, a table or a listing; lines of seconds, threads and memory are left
out of texts. It runs in the root of the repository and takes four minutes on two cores. Needs nothing but Python.
"""
import csv
import hashlib
import os
import re
import subprocess
import sys
import tempfile

# Scenes by ray tracing, from their files: two programs see the same ones. `name:key=value` sets a parameter.
RAY_TRACED = ["teapot", "primitives", "flange", "chess", "car", "crystal", "manifold", "materials", "textures", "cornell:all=true",
              "spectrum", "mirror", "vases", "corner", "motion", "room", "room:all=true", "room:view=2"]
SCAN_LINE = ["teapot", "flange", "chess", "materials", "textures", "corner", "room", "crystal"]
RADIOSITY = ["cornell", "corner"]
TWO_WAY = ["caustic", "ring", "pool", "flowers"]
TEXTS = ["plan teapot", "plan corner", "plan room", "plan afternoon", "octree chess", "intersect manifold", "continuity car",
         "functions sphere"]
STUDIES = ["render corner --width 24 --knob samples,depth,light_samples", "illumination", "tessellate teapot", "octree teapot",
           "newton manifold"]
# What differs from run to run: lines and columns of times, threads and memory, and errors of settings of renderers, which are
# tried more often where they are quick.
VARYING_LINES = re.compile(r"^.*(\bthreads?\b|\d ?(ms|µs|ns|s|[KMG]iB)\b).*$", re.M)
VARYING_COLUMNS = re.compile(r"time|second|MSE x|per s|cost|\(ns\)|\(µs\)|\(ms\)|\(s\)|^RMSE$|^chance$|^bias|^rel. MSE$", re.I)


def digest(data):
    return hashlib.sha256(data).hexdigest()


class Programs:
    def __init__(self, folder, place, scenes):
        self.folder, self.place, self.scenes = os.path.abspath(folder), place, scenes

    def run(self, program, words, text=None):
        """What a program says; its files lie in the folder."""
        done = subprocess.run([os.path.join(self.folder, program), *words], cwd=self.place, input=text, capture_output=True, timeout=600)
        return done.stdout

    def tell(self, name, data):
        print(name, digest(data), flush=True)

    def file(self, name, file):
        path = os.path.join(self.place, file)
        self.tell(name, open(path, "rb").read() if os.path.exists(path) else b"none")

    def tables(self, name, folder):
        """The tables of a folder, without columns of times; they are removed."""
        for file in sorted(os.listdir(os.path.join(self.place, folder))):
            path = os.path.join(self.place, folder, file)
            if file.endswith(".csv"):
                with open(path, newline="") as table:
                    head, *rows = csv.reader(table)
                kept = [column for column, title in enumerate(head) if not VARYING_COLUMNS.search(title)]
                self.tell(f"{name} {file}", repr([[row[column] for column in kept] for row in [head, *rows]]).encode())
            os.remove(path)

    def picture(self, scene, renderer, *more):
        name, *defined = scene.split(":")
        name = os.path.join(self.scenes, f"{name}.rhai")
        defined = [word for value in defined for word in ("-D", value)]
        file = "picture.exr"
        path = os.path.join(self.place, file)
        if os.path.exists(path):
            os.remove(path)
        self.run("peris", ["render", name, *defined, "--renderer", renderer, "--width", "80", "--samples", "2", "-o", file, *more])
        self.file(f"{renderer} {scene} {' '.join(more)}".strip(), file)


def main(folder):
    root = os.getcwd()
    with tempfile.TemporaryDirectory() as place:
        programs = Programs(folder, place, os.path.join(root, "host", "scenes"))
        for scene in RAY_TRACED:
            programs.picture(scene, "ray-tracing")
        programs.picture("corner", "ray-tracing", "--layers")
        programs.picture("corner", "ray-tracing", "--denoise")
        programs.picture("cornell", "ray-tracing")
        for scene in SCAN_LINE:
            programs.picture(scene, "scan-line")
        for scene in RADIOSITY:
            programs.picture(scene, "radiosity")
        for scene in TWO_WAY:
            programs.picture(scene, "two-way")
        for words in TEXTS:
            programs.tell(words, VARYING_LINES.sub("", programs.run("peris", words.split()).decode()).encode())
        for words in STUDIES:
            programs.run("peris", ["study", *words.split(), "-o", "study"])
            programs.tables(f"study {words}", "study")
        for scene in ["teapot", "flange", "crystal"]:
            programs.run("peris", ["tessellate", scene, "-o", "mesh.ply"])
            programs.file(f"tessellate {scene}", "mesh.ply")
            programs.run("peris", ["convert", scene, "scene.ps300"])
            programs.file(f"convert {scene}", "scene.ps300")
        emulator(programs, root)


def emulator(programs, root):
    """Pictures and listings of the emulator, of the command files that ship."""
    for folder, _, files in sorted(os.walk(os.path.join(root, "ps340"))):
        for file in sorted(files):
            if not file.endswith(".ps300"):
                continue
            path = os.path.join(folder, file)
            name = os.path.relpath(path, root)
            programs.tell(f"decode {name}", programs.run("ps340", ["decode", path]))
            programs.run("ps340", ["play", "--frames", "60", "--picture", "shown.png", "--transcript", "said.txt", path])
            programs.file(f"vectors {name}", "shown.png")
            programs.file(f"transcript {name}", "said.txt")
    programs.tell("table of functions", programs.run("ps340", ["functions"]))
    programs.tell("table of commands", programs.run("ps340", ["commands"]))
    for function in ["functions", "commands"]:
        programs.tell(f"help of {function}", programs.run("ps340", [function, "--help"]))


if __name__ == "__main__":
    main(sys.argv[1])
