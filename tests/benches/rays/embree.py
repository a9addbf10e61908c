"""Rays per second of Embree on a mesh and rays from a file, for the benchmark of the octree.

Arguments: the file of doubles. It holds the number of vertices, of triangles and of rays of each set (four sets), then the
vertices, the triangles (as doubles) and for each ray origin and direction. Prints the processor seconds of building, of all
threads, then one line a set: millions of rays per second of one thread (median of five passes), then the sum of
hits.
"""

import statistics
import sys
import time

import numpy
from embreex import rtcore_scene
from embreex.mesh_construction import TriangleMesh

data = numpy.fromfile(sys.argv[1], dtype=numpy.float64)
counts = data[:6].astype(int)
at = 6
vertices = data[at : at + 3 * counts[0]].reshape(-1, 3).astype(numpy.float32)
at += 3 * counts[0]
triangles = data[at : at + 3 * counts[1]].reshape(-1, 3).astype(numpy.int32)
at += 3 * counts[1]
scene = rtcore_scene.EmbreeScene()
TriangleMesh(scene, vertices[triangles])
# Builds before the first ray.
start = time.process_time()
first = numpy.array([[0, 0, 0]], dtype=numpy.float32)
scene.run(first, first + 1)
print(time.process_time() - start)
for index, count in enumerate(counts[2:]):
    rays = data[at : at + 6 * count].reshape(-1, 6).astype(numpy.float32)
    at += 6 * count
    origins = numpy.ascontiguousarray(rays[:, :3])
    directions = numpy.ascontiguousarray(rays[:, 3:])
    query = "OCCLUDED" if index == 2 else "INTERSECT"
    distances = numpy.full(count, 1.0 if index == 2 else 1e30, dtype=numpy.float32)
    seconds = []
    for _ in range(5):
        start = time.process_time()
        hits = scene.run(origins, directions, dists=distances.copy(), query=query)
        seconds.append(time.process_time() - start)
    print(count / statistics.median(seconds) / 1e6, int((numpy.asarray(hits) >= 0).sum()))
