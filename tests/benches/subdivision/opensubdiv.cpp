// Seconds of OpenSubdiv for a mesh from a file, for the benchmark of subdivision.
//
// Arguments: the file of doubles (the numbers of vertices and triangles, the vertices, the triangles as doubles), the
// number of levels. Prints one line a scheme: its name, the best processor seconds of five runs for the topology and for
// the positions, and how many vertices and faces there are at the last level.

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <vector>

using namespace OpenSubdiv;

struct Point {
    double x[3];
    void Clear(void* = nullptr) { x[0] = x[1] = x[2] = 0; }
    void AddWithWeight(Point const& p, double w) {
        for (int k = 0; k < 3; ++k) x[k] += w * p.x[k];
    }
};

static double seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + t.tv_nsec * 1e-9;
}

int main(int, char** arguments) {
    FILE* file = fopen(arguments[1], "rb");
    if (!file) return 1;
    double counts[2];
    if (fread(counts, sizeof(double), 2, file) != 2) return 1;
    size_t vertices = size_t(counts[0]), triangles = size_t(counts[1]);
    std::vector<Point> points(vertices);
    std::vector<double> corners(3 * triangles);
    if (fread(points.data(), sizeof(Point), vertices, file) != vertices) return 1;
    if (fread(corners.data(), sizeof(double), corners.size(), file) != corners.size()) return 1;
    std::vector<int> indices(corners.begin(), corners.end()), sizes(triangles, 3);
    int levels = atoi(arguments[2]);
    for (auto scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
        double best[2] = {1e9, 1e9};
        int size[2] = {0, 0};
        for (int run = 0; run < 5; ++run) {
            double start = seconds();
            Far::TopologyDescriptor descriptor;
            descriptor.numVertices = int(vertices);
            descriptor.numFaces = int(triangles);
            descriptor.numVertsPerFace = sizes.data();
            descriptor.vertIndicesPerFace = indices.data();
            typedef Far::TopologyRefinerFactory<Far::TopologyDescriptor> Factory;
            std::unique_ptr<Far::TopologyRefiner> refiner(
                Factory::Create(descriptor, Factory::Options(scheme, Sdc::Options())));
            refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(levels));
            double middle = seconds();
            Far::PrimvarRefinerReal<double> primvars(*refiner);
            std::vector<Point> from = points, to;
            for (int level = 1; level <= levels; ++level) {
                to.resize(refiner->GetLevel(level).GetNumVertices());
                primvars.Interpolate(level, from, to);
                std::swap(from, to);
            }
            double end = seconds();
            best[0] = std::min(best[0], middle - start);
            best[1] = std::min(best[1], end - middle);
            size[0] = refiner->GetLevel(levels).GetNumVertices();
            size[1] = refiner->GetLevel(levels).GetNumFaces();
        }
        printf("%s %g %g %d %d\n", scheme == Sdc::SCHEME_LOOP ? "Loop" : "Catmull-Clark", best[0], best[1], size[0], size[1]);
    }
}
