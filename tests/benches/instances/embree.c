/* Rays per second of Embree 4 through instances, for the benchmark of instances.
 *
 * Arguments: a file of numbers, and 1 for an array of instances or 0 for one geometry each. The file holds, as doubles, the
 * numbers of vertices, triangles, instances and sets; for each set the number of rays and whether any hit is enough; the
 * vertices; the triangles; for each instance the four columns of its map; for each ray origin, direction and farthest
 * parameter. Prints the processor seconds of building and the bytes an instance takes, then a line a set: millions of
 * rays a second (median of five passes), hits, and the sum of the parameters at these.
 *
 * What is declared here of the library is its interface, version 4, for single rays. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct Device *Device;
typedef struct Scene *Scene;
typedef struct Geometry *Geometry;

enum { TRIANGLES = 0, INSTANCE = 121, INSTANCES = 122 };
enum { INDEX = 0, VERTEX = 1, TRANSFORM = 23 };
enum { UINT3 = 0x5003, FLOAT3 = 0x9003, AFFINE = 0x9234 };
enum { ROBUST = 4, HIGH = 2 };

struct Ray {
    float origin[3], near, direction[3], time, far;
    unsigned mask, id, flags;
};
struct Hit {
    float normal[3], u, v;
    unsigned primitive, geometry, instance, in_array;
};
struct RayHit {
    _Alignas(16) struct Ray ray;
    struct Hit hit;
};

Device rtcNewDevice(const char *);
Scene rtcNewScene(Device);
void rtcSetSceneFlags(Scene, int);
void rtcSetSceneBuildQuality(Scene, int);
void rtcCommitScene(Scene);
Geometry rtcNewGeometry(Device, int);
void *rtcSetNewGeometryBuffer(Geometry, int, unsigned, int, size_t, size_t);
void rtcSetGeometryInstancedScene(Geometry, Scene);
void rtcSetGeometryTransform(Geometry, unsigned, int, const void *);
void rtcCommitGeometry(Geometry);
unsigned rtcAttachGeometry(Scene, Geometry);
void rtcReleaseGeometry(Geometry);
int rtcGetDeviceError(Device);
void rtcIntersect1(Scene, struct RayHit *, void *);
void rtcOccluded1(Scene, struct Ray *, void *);

static double seconds(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return time.tv_sec + 1e-9 * time.tv_nsec;
}

static double resident(void) {
    char line[256];
    double kilobytes = 0;
    FILE *status = fopen("/proc/self/status", "r");
    while (status && fgets(line, sizeof line, status))
        if (!strncmp(line, "VmRSS:", 6)) kilobytes = atof(line + 6);
    if (status) fclose(status);
    return 1024 * kilobytes;
}

static double *numbers(FILE *file, size_t count) {
    double *all = malloc(8 * (count ? count : 1));
    if (!all || fread(all, 8, count, file) != count) {
        fprintf(stderr, "the file is too short\n");
        exit(1);
    }
    return all;
}

static int rising(const void *one, const void *other) {
    double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

static Scene scene(Device device) {
    Scene made = rtcNewScene(device);
    rtcSetSceneFlags(made, ROBUST);
    rtcSetSceneBuildQuality(made, HIGH);
    return made;
}

int main(int count, char **arguments) {
    FILE *file = count == 3 ? fopen(arguments[1], "rb") : NULL;
    if (!file) return 2;
    double *counts = numbers(file, 4);
    size_t vertices = counts[0], triangles = counts[1], instances = counts[2], sets = counts[3];
    double *kinds = numbers(file, 2 * sets), *points = numbers(file, 3 * vertices), *corners = numbers(file, 3 * triangles);
    double *maps = numbers(file, 12 * instances);
    Device device = rtcNewDevice("threads=1");
    Scene prototype = scene(device);
    Geometry mesh = rtcNewGeometry(device, TRIANGLES);
    float *vertex = rtcSetNewGeometryBuffer(mesh, VERTEX, 0, FLOAT3, 12, vertices);
    for (size_t i = 0; i < 3 * vertices; i++) vertex[i] = points[i];
    unsigned *index = rtcSetNewGeometryBuffer(mesh, INDEX, 0, UINT3, 12, triangles);
    for (size_t i = 0; i < 3 * triangles; i++) index[i] = corners[i];
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(prototype, mesh);
    rtcCommitScene(prototype);
    double before = resident(), begun = seconds();
    Scene all = scene(device);
    if (arguments[2][0] == '1') {
        Geometry array = rtcNewGeometry(device, INSTANCES);
        rtcSetGeometryInstancedScene(array, prototype);
        float *map = rtcSetNewGeometryBuffer(array, TRANSFORM, 0, AFFINE, 48, instances);
        for (size_t i = 0; i < 12 * instances; i++) map[i] = maps[i];
        rtcCommitGeometry(array);
        rtcAttachGeometry(all, array);
    } else {
        for (size_t i = 0; i < instances; i++) {
            float map[12];
            for (int k = 0; k < 12; k++) map[k] = maps[12 * i + k];
            Geometry one = rtcNewGeometry(device, INSTANCE);
            rtcSetGeometryInstancedScene(one, prototype);
            rtcSetGeometryTransform(one, 0, AFFINE, map);
            rtcCommitGeometry(one);
            rtcAttachGeometry(all, one);
            rtcReleaseGeometry(one);
        }
    }
    rtcCommitScene(all);
    if (rtcGetDeviceError(device)) return 3;
    printf("%.6f %.1f\n", seconds() - begun, (resident() - before) / instances);
    for (size_t set = 0; set < sets; set++) {
        size_t rays = kinds[2 * set], hits = 0;
        double *ray = numbers(file, 7 * rays), passes[5], sum = 0;
        for (int pass = 0; pass < 5; pass++) {
            hits = 0, sum = 0, begun = seconds();
            for (size_t i = 0; i < rays; i++) {
                double *from = ray + 7 * i;
                struct RayHit query = {{{from[0], from[1], from[2]}, 0, {from[3], from[4], from[5]}, 0, from[6], -1, 0, 0},
                                       {{0, 0, 0}, 0, 0, -1, -1, -1, -1}};
                if (kinds[2 * set + 1]) {
                    rtcOccluded1(all, &query.ray, NULL);
                    hits += query.ray.far < 0;
                } else {
                    rtcIntersect1(all, &query, NULL);
                    if (query.hit.geometry != (unsigned)-1) hits++, sum += query.ray.far;
                }
            }
            passes[pass] = seconds() - begun;
        }
        qsort(passes, 5, sizeof *passes, rising);
        printf("%.6f %zu %.9g\n", rays / passes[2] / 1e6, hits, sum);
        free(ray);
    }
    return 0;
}
