/* tobiuo bench frame and bench surface: the processor time of a picture, and of a surface. The water is made
   here, not computed: a pool with waves, a body in it and spray above it, so that the case starts at once and
   is the same everywhere. Drawback: a real flow has another share of spray. */
#define _GNU_SOURCE
#include "bench.h"
#include "tobiuo/picture.h"
#include "tobiuo/surface.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { RINGS = 40, SECTORS = 80, BALL_VERTICES = (RINGS + 1)*SECTORS, BALL_TRIANGLES = 2*RINGS*SECTORS };

typedef struct cloud {
    double (*position)[3];
    float *speed;
    int64_t count;
    double spacing;                    /* m */
    double vertex[BALL_VERTICES][3];
    int32_t triangle[BALL_TRIANGLES][3];
} cloud;

static const double pool[3] = { 2, 1, 1 };       /* m */

/* From 0 to 1, of a number: no random generator of a library, so that the cloud is the same everywhere. */
static double scatter(uint64_t n)
{
    n = (n + 1)*0x9e3779b97f4a7c15ull;
    n = (n ^ n >> 29)*0xbf58476d1ce4e5b9ull;
    return (double)(n >> 11)/9007199254740992.0;
}

static double surface_height(double x, double y)
{
    return 0.32 + 0.10*sin(4*x) + 0.03*cos(9*y + 2*x) + 0.18*exp(-40*((x - 1.2)*(x - 1.2)
                                                                      + (y - 0.5)*(y - 0.5)));
}

static void add(cloud *c, double x, double y, double z, double speed)
{
    const double jitter = 0.3*c->spacing;
    const uint64_t n = (uint64_t)c->count;
    c->position[n][0] = x + jitter*(scatter(3*n) - 0.5);
    c->position[n][1] = y + jitter*(scatter(3*n + 1) - 0.5);
    c->position[n][2] = z + jitter*(scatter(3*n + 2) - 0.5);
    c->speed[n] = (float)speed;
    c->count++;
}

/* Particles below the surface from the floor on, one for each spacing; 2 in 100 are spray. */
static void fill_pool(cloud *c, int64_t count)
{
    const double d = c->spacing;
    c->count = 0;
    for (int k = 0; k*d < pool[2]; k++)
        for (int j = 0; (j + 0.5)*d < pool[1]; j++)
            for (int i = 0; (i + 0.5)*d < pool[0] && c->count < count*98/100; i++) {
                const double x = (i + 0.5)*d, y = (j + 0.5)*d, z = (k + 0.5)*d;
                if (z < surface_height(x, y)) add(c, x, y, z, z + 0.2*x);
            }
    while (c->count < count) {
        const uint64_t n = (uint64_t)c->count;
        const double x = pool[0]*scatter(7*n), y = pool[1]*scatter(7*n + 1);
        add(c, x, y, surface_height(x, y) + 0.4*scatter(7*n + 2)*scatter(7*n + 3), 1.5);
    }
}

static void make_ball(cloud *c)
{
    const double pi = 3.14159265358979323846, radius = 0.14, middle[3] = { 0.7, 0.4, 0.38 };
    for (int i = 0; i <= RINGS; i++)
        for (int j = 0; j < SECTORS; j++) {
            const double a = pi*i/RINGS, b = 2*pi*j/SECTORS;
            const double n[3] = { sin(a)*cos(b), sin(a)*sin(b), cos(a) };
            for (int k = 0; k < 3; k++) c->vertex[i*SECTORS + j][k] = middle[k] + radius*n[k];
        }
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < SECTORS; j++) {
            const int a = i*SECTORS + j, b = i*SECTORS + (j + 1)%SECTORS, t = 2*(i*SECTORS + j);
            const int32_t two[2][3] = { { a, a + SECTORS, b }, { b, a + SECTORS, b + SECTORS } };
            for (int k = 0; k < 6; k++) c->triangle[t + k/3][k%3] = two[k/3][k%3];
        }
}

/* Seconds of processor time of the process. */
static double processor_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9*(double)now.tv_nsec;
}

/* Draws the cloud several times; the quickest counts, since other programs only make it slower. */
static int draw_often(tobi_picture *p, const char *path, int times, double *best, double stage[])
{
    tobi_error err = { 0 };
    double spent[TOBI_PICTURE_STAGES];
    *best = INFINITY;
    for (int k = 0; k < times; k++) {
        p->stage_seconds = spent;
        const double begun = processor_clock();
        const tobi_status status = tobi_picture_write(path, p, &err);
        const double seconds = processor_clock() - begun;
        p->stage_seconds = NULL;
        if (status != TOBI_OK) return complain("%s", err.text);
        if (seconds >= *best) continue;
        *best = seconds;
        for (int s = 0; s < TOBI_PICTURE_STAGES; s++) stage[s] = spent[s];
    }
    return 0;
}

static int make_cloud(cloud *c, int64_t count)
{
    c->spacing = cbrt(pool[0]*pool[1]*0.33/(double)count);
    c->position = malloc((size_t)count*sizeof *c->position);
    c->speed = malloc((size_t)count*sizeof *c->speed);
    if (!c->position || !c->speed) return complain("out of memory");
    fill_pool(c, count);
    return 0;
}

static void free_cloud(cloud *c)
{
    if (c) free(c->position), free(c->speed);
    free(c);
}

static int measure(const bench_options *o, cloud *c, int64_t count, const char *path)
{
    double best, stage[TOBI_PICTURE_STAGES];
    tobi_picture p = tobi_default_picture();
    const tobi_picture_mesh ball = { .vertex_count = BALL_VERTICES,
                                     .vertices = (const double (*)[3])c->vertex,
                                     .triangle_count = BALL_TRIANGLES,
                                     .triangles = (const int32_t (*)[3])c->triangle,
                                     .color = { 0.93f, 0.62f, 0.28f } };
    if (make_cloud(c, count) != 0) return EXIT_ERROR;
    for (int k = 0; k < 3; k++) p.box_max[k] = pool[k];
    p.particle_count = c->count;
    p.positions = (const double (*)[3])c->position;
    p.radius = 0.5*c->spacing;
    p.title = "t = 0.0000 s";
    p.meshes = &ball;
    p.mesh_count = 1;
    p.threads = o->threads > 0 ? o->threads : 1;
    const int failed = draw_often(&p, path, o->steps ? o->steps : 5, &best, stage);
    if (failed) return failed;
    printf("%lld particles, %d x %d pixels, %d thread%s\n", (long long)c->count, p.width, p.height, p.threads,
           p.threads > 1 ? "s" : "");
    for (int s = 0; s < TOBI_PICTURE_STAGES; s++)
        printf("  %-22s %8.1f ms of processor time\n", tobi_picture_stage_name(s), 1e3*stage[s]);
    printf("  %-22s %8.1f\n\n", "whole picture", 1e3*best);
    return 0;
}

int bench_frame(const bench_options *o)
{
    static const int64_t counts[] = { 68000, 500000 };
    char path[] = P_tmpdir "/tobiuo-frame-XXXXXX";
    cloud *c = calloc(1, sizeof *c);
    const int file = mkstemp(path);
    int failed = 0;
    if (file >= 0) close(file);
    if (!c || file < 0) failed = complain("bench: no memory or no temporary file %s", path);
    if (!failed) make_ball(c);
    for (int k = 0; k < 2 && !failed; k++) {
        failed = measure(o, c, counts[k], path);
        free(c->position);
        free(c->speed);
        c->position = NULL;
        c->speed = NULL;
    }
    if (file >= 0) unlink(path);
    free_cloud(c);
    return failed;
}

/* The quickest of some surfaces of the cloud, with one field. */
static int measure_surface(const bench_options *o, const cloud *c, double cell)
{
    const tobi_surface_field field = { "place", 3, &c->position[0][0] };
    tobi_surface_def d = tobi_default_surface();
    tobi_surface *s;
    tobi_error err = { 0 };
    double best = INFINITY;
    int64_t triangles = 0;
    d.particle_count = c->count;
    d.positions = (const double (*)[3])c->position;
    d.spacing = c->spacing;
    d.cell = cell;
    d.fields = &field;
    d.field_count = 1;
    d.threads = o->threads > 0 ? o->threads : 1;
    for (int a = 0; a < 3; a++) d.box_max[a] = pool[a], d.flat_min[a] = d.flat_max[a] = 1;
    for (int k = 0; k < (o->steps ? o->steps : 5); k++) {
        const double begun = processor_clock();
        if (tobi_surface_make(&d, &s, &err) != TOBI_OK) return complain("%s", err.text);
        best = fmin(best, processor_clock() - begun);
        triangles = s->triangle_count;
        tobi_surface_free(s);
    }
    printf("%lld particles, cell %.2f d, %lld triangles: %.0f ms of processor time, %.2f million particles "
           "per second and core\n", (long long)c->count, cell, (long long)triangles, 1e3*best,
           1e-6*(double)c->count/best);
    return 0;
}

int bench_surface(const bench_options *o)
{
    static const double cells[] = { 0.75, 0.5 };
    cloud *c = calloc(1, sizeof *c);
    int failed = c ? make_cloud(c, 500000) : complain("out of memory");
    for (int k = 0; k < 2 && !failed; k++) failed = measure_surface(o, c, cells[k]);
    free_cloud(c);
    return failed;
}
