/* Spray, foam and bubbles: motions that are known exactly, water that makes none, sums against all pairs in
   double, the same bits for any number of threads, mistakes in words. */
#define _GNU_SOURCE 1
#include "calls.h"
#include "tobiuo/picture.h"
#include "tobiuo/results.h"
#include "view/foam/foam.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define D 0.01
enum { SIDE = 12, N = SIDE*SIDE*SIDE };

/* Water on a lattice within the domain, whose box is as large or, with room, larger. */
typedef struct rig { double x[N][3], v[N][3]; int64_t id[N]; tobi_foam_water water; } rig;

static rig *make_rig(const double u[3])
{
    rig *r = calloc(1, sizeof *r);
    for (int i = 0; i < N; i++) {
        const int at[3] = { i%SIDE, i/SIDE%SIDE, i/SIDE/SIDE };
        for (int a = 0; a < 3; a++) r->x[i][a] = D*(at[a] + 0.5), r->v[i][a] = u[a];
        r->id[i] = 3*i + 1;
    }
    r->water = (tobi_foam_water){ .count = N, .positions = (const double (*)[3])r->x,
                                  .velocities = (const double (*)[3])r->v, .ids = r->id };
    return r;
}

static tobi_foam_def make_def(double room)
{
    tobi_foam_def d = tobi_default_foam();
    d.spacing = D, d.threads = 1;
    for (int a = 0; a < 3; a++) d.box_min[a] = -room, d.box_max[a] = SIDE*D + room;
    return d;
}

static void flow(rig *r, double dt)
{
    r->water.time += dt;
    for (int i = 0; i < N; i++)
        for (int a = 0; a < 3; a++) r->x[i][a] += dt*r->v[i][a];
}

static void follow(tobi_foam *f, rig *r, double dt, int outputs)
{
    OK(tobi_foam_advance(f, &r->water, &err));
    for (int k = 0; k < outputs; k++) {
        flow(r, dt);
        OK(tobi_foam_advance(f, &r->water, &err));
    }
}

static void test_spray_flies(void **state)
{
    (void)state;
    rig *r = make_rig((double[3]){ 0, 0, 0 });
    const tobi_foam_def d = make_def(1);
    const double x[3] = { -0.5, 0.02, 0.3 }, v[3] = { 0.7, -0.3, 1.1 };
    tobi_foam *f;
    tobi_foam_particles p;
    OK(tobi_foam_create(&d, &f, &err));
    OK(tobi_foam_add(f, x, v, 10, &err));
    follow(f, r, 0.03, 5);
    OK(tobi_foam_read(f, &p, &err));
    assert_int_equal(p.count, 1);
    assert_int_equal(p.kind[0], TOBI_SPRAY);
    for (int a = 0; a < 3; a++) {
        const double t = 0.15, exact = x[a] + v[a]*t + 0.5*d.gravity[a]*t*t;
        if (fabs(p.positions[0][a] - exact) > 1e-12) fail_msg("%.17g is not %.17g", p.positions[0][a], exact);
    }
    assert_true(fabs((double)p.age[0] - 0.15) < 1e-6 && fabs((double)p.life[0] - 9.85) < 1e-5);
    tobi_foam_free(f);
    free(r);
}

/* Beyond a side it is gone. */
static void test_spray_leaves(void **state)
{
    (void)state;
    rig *r = make_rig((double[3]){ 0, 0, 0 });
    const tobi_foam_def d = make_def(0.1);
    tobi_foam *f;
    tobi_foam_particles p;
    OK(tobi_foam_create(&d, &f, &err));
    OK(tobi_foam_add(f, (double[3]){ 0.2, 0, 0.1 }, (double[3]){ 5, 0, 0 }, 10, &err));
    follow(f, r, 0.02, 1);
    OK(tobi_foam_read(f, &p, &err));
    assert_int_equal(p.count, 0);
    tobi_foam_free(f);
    free(r);
}

/* Foam on water that moves as one moves with it; until its life ends. */
static void test_foam_moves_along(void **state)
{
    (void)state;
    const double u[3] = { 0.3, -0.2, 0.05 }, x[3] = { 0.06, 0.06, SIDE*D };
    rig *r = make_rig(u);
    const tobi_foam_def d = make_def(1);
    tobi_foam *f;
    tobi_foam_particles p;
    OK(tobi_foam_create(&d, &f, &err));
    OK(tobi_foam_add(f, x, (double[3]){ 0, 0, 0 }, 1, &err));
    OK(tobi_foam_add(f, x, (double[3]){ 0, 0, 0 }, 0.05, &err));
    follow(f, r, 0.05, 6);
    OK(tobi_foam_read(f, &p, &err));
    assert_int_equal(p.count, 1);
    assert_int_equal(p.kind[0], TOBI_FOAM);
    for (int a = 0; a < 3; a++)
        if (fabs(p.positions[0][a] - x[a] - 0.3*u[a]) > 1e-6) fail_msg("%g", p.positions[0][a] - x[a]);
    tobi_foam_free(f);
    free(r);
}

/* A bubble rises at 0.25 m/s, until it is foam at the surface. It does not dissolve. */
static void test_bubbles_rise(void **state)
{
    (void)state;
    rig *r = make_rig((double[3]){ 0, 0, 0 });
    tobi_foam_def d = make_def(0);
    d.box_max[2] = 1;
    tobi_foam *f;
    tobi_foam_particles p;
    OK(tobi_foam_create(&d, &f, &err));
    OK(tobi_foam_add(f, (double[3]){ 0.06, 0.06, 0.02 }, (double[3]){ 0, 0, 0 }, 0.3, &err));
    follow(f, r, 0.01, 20);
    OK(tobi_foam_read(f, &p, &err));
    const double t = 0.2, relax = 0.25/(2*9.81), exact = 0.02 + 0.25*(t - relax*(1 - exp(-t/relax)));
    assert_int_equal(p.kind[0], TOBI_BUBBLE);
    if (fabs(p.positions[0][2] - exact) > 1e-6) fail_msg("at %g, not %g", p.positions[0][2], exact);
    assert_true((double)p.life[0] > 0.299);
    follow(f, (flow(r, 0.01), r), 0.01, 25);
    OK(tobi_foam_read(f, &p, &err));
    assert_int_equal(p.kind[0], TOBI_FOAM);
    assert_true(p.positions[0][2] > 0.1 && p.positions[0][2] < 0.125);
    tobi_foam_free(f);
    free(r);
}

/* Water at rest, and water whose energy is below the limit, its corners ahead: none is made. */
static void test_even_water_makes_none(void **state)
{
    (void)state;
    const double speed[] = { 0, 0.2, 0.7 };
    for (int k = 0; k < 3; k++) {
        rig *r = make_rig((double[3]){ speed[k], 0, 0 });
        tobi_foam_def d = make_def(0);
        d.box_min[0] = -1, d.box_max[0] = 2, d.box_max[2] = 1;
        tobi_foam *f;
        tobi_foam_particles p;
        OK(tobi_foam_create(&d, &f, &err));
        follow(f, r, 0.02, 5);
        OK(tobi_foam_read(f, &p, &err));
        assert_int_equal(p.count, 0);
        tobi_foam_free(f);
        free(r);
    }
}

/* Two blocks that run into each other at 3 m/s. */
static rig *make_crash(void)
{
    rig *r = make_rig((double[3]){ 0, 0, 0 });
    for (int i = 0; i < N; i++) {
        r->v[i][0] = i%SIDE < SIDE/2 ? 1.5 : -1.5;
        r->v[i][2] = 0.3*(double)(i%7);
    }
    return r;
}

static tobi_foam_particles crash(int threads, double amount, int64_t most, tobi_foam **f)
{
    rig *r = make_crash();
    tobi_foam_def d = make_def(0.2);
    tobi_foam_particles p;
    d.threads = threads, d.amount = amount, d.most = most;
    OK(tobi_foam_create(&d, f, &err));
    follow(*f, r, 0.01, 4);
    OK(tobi_foam_read(*f, &p, &err));
    free(r);
    return p;
}

static void test_same_bits(void **state)
{
    (void)state;
    tobi_foam *f[3];
    const tobi_foam_particles a = crash(1, 0.5, 100000, &f[0]), b = crash(2, 0.5, 100000, &f[1]);
    assert_true(a.count > 500);
    assert_int_equal(a.count, b.count);
    const size_t n = (size_t)a.count;
    assert_memory_equal(a.positions, b.positions, n*sizeof *a.positions);
    assert_memory_equal(a.velocities, b.velocities, n*sizeof *a.velocities);
    assert_memory_equal(a.kind, b.kind, n);
    assert_memory_equal(a.life, b.life, n*sizeof *a.life);
    assert_memory_equal(a.ids, b.ids, n*sizeof *a.ids);
    /* twice the amount are twice as many */
    const tobi_foam_particles c = crash(1, 1, 100000, &f[2]);
    assert_true(fabs((double)c.count/(double)a.count - 2) < 0.2);
    for (int k = 0; k < 3; k++) tobi_foam_free(f[k]);
}

/* No more than there is room for, and the rest is counted. */
static void test_room(void **state)
{
    (void)state;
    tobi_foam *f;
    const tobi_foam_particles p = crash(1, 0.5, 300, &f);
    assert_true(p.count > 250 && p.count <= 300);
    assert_true(p.left_out > 100);
    tobi_foam_free(f);
}

/* Fullness, normal and velocity differences against all pairs in double; no walls. */
static void test_sums(void **state)
{
    (void)state;
    rig *r = make_crash();
    const tobi_foam_def d = make_def(0.2);
    tobi_foam *f;
    for (int i = 0; i < N; i++)
        for (int a = 0; a < 3; a++) r->x[i][a] += 0.004*(foam_chance(i, a, 0) - 0.5);
    OK(tobi_foam_create(&d, &f, &err));
    OK(tobi_foam_advance(f, &r->water, &err));
    for (int i = 0; i < N; i += 7) {
        double weight = 1, closing = 0, away[3] = { 0, 0, 0 };
        for (int j = 0; j < N; j++) {
            double distance = 0, speed = 0, dot = 0;
            for (int a = 0; a < 3; a++) {
                const double x = r->x[i][a] - r->x[j][a], v = r->v[i][a] - r->v[j][a];
                distance += x*x, speed += v*v, dot += x*v;
            }
            distance = sqrt(distance);
            if (j == i || distance >= 2*D) continue;
            const double w = 1 - distance/(2*D);
            weight += w, closing += w*(sqrt(speed) - dot/distance);
            for (int a = 0; a < 3; a++) away[a] += w*(r->x[i][a] - r->x[j][a])/distance;
        }
        const double length = sqrt(away[0]*away[0] + away[1]*away[1] + away[2]*away[2]);
        assert_true(fabs((double)f->normal[i][3]*(double)f->full - weight) < 1e-3);
        assert_true(fabs((double)f->before.spread[i] - closing/(2*(weight - 1))) < 1e-3);
        for (int a = 0; a < 3 && length > 0.1; a++)
            assert_true(fabs((double)f->normal[i][a] - away[a]/length) < 1e-3);
    }
    tobi_foam_free(f);
    free(r);
}

/* A particle that goes and one that comes, as through an outlet and an inlet. */
static void test_ids_change(void **state)
{
    (void)state;
    rig *r = make_crash();
    const tobi_foam_def d = make_def(0.2);
    tobi_foam *f;
    OK(tobi_foam_create(&d, &f, &err));
    OK(tobi_foam_advance(f, &r->water, &err));
    flow(r, 0.01);
    memmove(r->x, r->x + 1, (N - 1)*sizeof *r->x);
    memmove(r->v, r->v + 1, (N - 1)*sizeof *r->v);
    memmove(r->id, r->id + 1, (N - 1)*sizeof *r->id);
    r->id[N - 1] = 3*N + 100;
    OK(tobi_foam_advance(f, &r->water, &err));
    assert_int_equal(f->after.partner[0], -1);
    assert_int_equal(f->after.partner[1], 0);
    assert_int_equal(f->after.partner[N - 1], N - 2);
    tobi_foam_free(f);
    free(r);
}

/* Water that runs along a body closes it off: no surface there, and what comes into the body is gone. */
static void test_bodies(void **state)
{
    (void)state;
    double (*body)[3] = calloc(N, sizeof *body);
    tobi_foam *f[2];
    tobi_foam_particles p;
    rig *r = make_crash();
    for (int k = 0; k < 2; k++) {
        const tobi_foam_def d = make_def(0.2);
        for (int i = 0; i < N; i++)
            for (int a = 0; a < 3; a++) body[i][a] = r->x[i][a] + (a == 2 ? SIDE*D : 0);
        r->water.solid_count = k ? N : 0, r->water.solids = (const double (*)[3])body;
        OK(tobi_foam_create(&d, &f[k], &err));
        OK(tobi_foam_advance(f[k], &r->water, &err));
    }
    const int top = N - SIDE*SIDE/2 - SIDE/2;      /* in the middle of the upper side */
    assert_true(f[0]->normal[top][3] < FOAM_SURFACE && f[0]->normal[top][2] > 0.9f);
    assert_true(f[1]->normal[top][3] > 0.99f);
    assert_true(fabsf(f[0]->before.spread[top] - f[1]->before.spread[top]) < 1e-6f);
    OK(tobi_foam_add(f[1], (double[3]){ 0.06, 0.06, 1.5*SIDE*D }, (double[3]){ 0, 0, 0 }, 1, &err));
    flow(r, 1e-4);
    OK(tobi_foam_advance(f[1], &r->water, &err));
    OK(tobi_foam_read(f[1], &p, &err));
    for (int64_t k = 0; k < p.count; k++) assert_true(p.ids[k] != 0);
    r->water.time = 1, r->water.solids = NULL;
    REFUSED(tobi_foam_advance(f[1], &r->water, &err), TOBI_INVALID, "points of bodies without positions");
    tobi_foam_free(f[0]), tobi_foam_free(f[1]);
    free(r), free(body);
}

/* More water than exec has sums for at first. */
static void test_much_water(void **state)
{
    (void)state;
    enum { MUCH = 150000 };
    double (*x)[3] = calloc(MUCH, sizeof *x), (*v)[3] = calloc(MUCH, sizeof *v);
    tobi_foam_def d = make_def(0);
    tobi_foam *f;
    for (int i = 0; i < MUCH; i++) x[i][0] = i%400*D, x[i][1] = i/400*D;
    d.dimension = 2, d.gravity[1] = -9.81, d.box_max[0] = d.box_max[1] = 4;
    const tobi_foam_water water = { .count = MUCH, .positions = (const double (*)[3])x,
                                    .velocities = (const double (*)[3])v };
    OK(tobi_foam_create(&d, &f, &err));
    assert_true(f->exec.partial_blocks*TOBI_TOTALS < MUCH/4096);
    OK(tobi_foam_advance(f, &water, &err));
    assert_true(f->exec.partial_blocks*TOBI_TOTALS >= MUCH/4096 + 1);
    tobi_foam_free(f);
    free(x), free(v);
}

static void test_flat_world(void **state)
{
    (void)state;
    rig *r = make_crash();
    tobi_foam_def d = make_def(0.2);
    tobi_foam *f;
    tobi_foam_particles p;
    d.dimension = 2, d.gravity[1] = -9.81, d.gravity[2] = 0, d.amount = 3;
    for (int i = 0; i < N; i++) r->v[i][1] = r->v[i][2];
    r->water.count = SIDE*SIDE;
    OK(tobi_foam_create(&d, &f, &err));
    follow(f, r, 0.01, 4);
    OK(tobi_foam_read(f, &p, &err));
    assert_true(p.count > 50);
    for (int64_t k = 0; k < p.count; k++) assert_true(p.positions[k][2] == 0 && p.velocities[k][2] == 0);
    tobi_foam_free(f);
    free(r);
}

enum { WIDE = 64 };

/* A plate across the view of a box, foam at this x in front of it or behind; the brightness in the middle. */
static int draw_point(double x, int count)
{
    static const double corner[][3] = { { 0.5, -1, -1 }, { 0.5, 2, -1 }, { 0.5, 2, 2 }, { 0.5, -1, 2 } };
    static const int32_t face[][3] = { { 0, 2, 1 }, { 0, 3, 2 } };
    static uint8_t rgb[WIDE*WIDE*3];
    const tobi_picture_mesh plate = { .vertex_count = 4, .vertices = corner, .triangle_count = 2,
                                      .triangles = face, .color = { 0.2f, 0.1f, 0.1f } };
    tobi_picture p = tobi_default_picture();
    double foam[40][3];
    uint8_t kind[40] = { 0 };
    for (int k = 0; k < 40; k++) foam[k][0] = x, foam[k][1] = 0.5, foam[k][2] = 0.5;
    p.width = p.height = WIDE, p.threads = 1, p.radius = 0.1;
    for (int a = 0; a < 3; a++) p.box_max[a] = 1;
    p.has_camera = 1, p.eye[0] = -3, p.eye[1] = p.eye[2] = 0.5, p.target[0] = 1;
    p.target[1] = p.target[2] = 0.5;
    p.meshes = &plate, p.mesh_count = 1;
    p.foam = (const double (*)[3])foam, p.foam_kind = kind, p.foam_count = count;
    OK(tobi_picture_draw(&p, rgb, &err));
    return rgb[3*(WIDE*WIDE/2 + WIDE/2)];
}

/* White before a dark plate, hidden behind it. */
static void test_picture(void **state)
{
    (void)state;
    const int bare = draw_point(0.2, 0), before = draw_point(0.2, 40), behind = draw_point(0.8, 40);
    if (before < bare + 60) fail_msg("%d before a plate of %d", before, bare);
    assert_int_equal(behind, bare);
    tobi_picture p = tobi_default_picture();
    uint8_t rgb[3];
    for (int a = 0; a < 3; a++) p.box_max[a] = 1;
    p.foam_count = 1;
    REFUSED(tobi_picture_draw(&p, rgb, &err), TOBI_INVALID, "1 points of foam cannot be drawn");
}

/* What is written for an output is read back; another file is refused. */
static void test_files(void **state)
{
    (void)state;
    char dir[] = "foam.XXXXXX", path[64];
    tobi_foam *f;
    tobi_results *results;
    tobi_moment m = { 0 };
    const tobi_foam_particles p = crash(1, 0.2, 100000, &f);
    assert_non_null(mkdtemp(dir));
    snprintf(path, sizeof path, "%s/all.pvd", dir);
    FILE *file = fopen(path, "w");
    fputs("<DataSet timestep=\"0\" name=\"fluid\" file=\"fluid.vtu\"/>\n", file);
    fclose(file);
    OK(tobi_results_open(dir, &results, &err));
    OK(tobi_results_read_foam(results, 0, &m, &err));
    assert_int_equal(m.foam_count, 0);
    snprintf(path, sizeof path, "%s/foam", dir);
    assert_int_equal(mkdir(path, 0777), 0);
    snprintf(path, sizeof path, "%s/foam/foam_000000.vtp", dir);
    OK(tobi_foam_write(path, &p, &err));
    OK(tobi_results_read_foam(results, 0, &m, &err));
    assert_int_equal(m.foam_count, p.count);
    assert_memory_equal(m.foam, p.positions, (size_t)p.count*sizeof *m.foam);
    assert_memory_equal(m.foam_kind, p.kind, (size_t)p.count);
    file = fopen(path, "w");
    fputs("<VTKFile><PolyData><Piece NumberOfPoints=\"1\"><Points>"
          "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" "
          "format=\"ascii\">1 2 3</DataArray></Points></Piece>", file);
    fclose(file);
    REFUSED(tobi_results_read_foam(results, 0, &m, &err), TOBI_DAMAGED, "is no file of foam");
    tobi_moment_free(&m);
    tobi_results_free(results);
    tobi_foam_free(f);
    unlink(path);
    snprintf(path, sizeof path, "%s/foam", dir);
    rmdir(path);
    snprintf(path, sizeof path, "%s/all.pvd", dir);
    unlink(path);
    rmdir(dir);
}

static void test_mistakes(void **state)
{
    (void)state;
    tobi_foam *f;
    tobi_foam_def d = make_def(0);
#define BAD_DEF(CHANGE, TEXT) \
    do { \
        tobi_foam_def bad = d; \
        CHANGE; \
        REFUSED(tobi_foam_create(&bad, &f, &err), TOBI_INVALID, TEXT); \
        assert_null(f); \
    } while (0)
    BAD_DEF(bad.dimension = 1, "foam: dimension 1, allowed are 2 and 3");
    BAD_DEF(bad.spacing = 0, "foam: a spacing of 0 m, must be greater than 0");
    BAD_DEF(bad.amount = 1001, "foam: 1001 times the usual amount, allowed is above 0 to 1000");
    BAD_DEF(bad.lifetime = -1, "foam: a lifetime of -1 s, must be 0 or greater");
    BAD_DEF(bad.most = 0, "foam: at most 0 particles, allowed are 1 to 1073741824");
    BAD_DEF(bad.box_max[1] = -1, "foam: the box is empty along y");
    BAD_DEF(bad.gravity[2] = (double)NAN, "foam: gravity is no number along z");
    rig *r = make_rig((double[3]){ 0, 0, 0 });
    d.most = 1;
    OK(tobi_foam_create(&d, &f, &err));
    OK(tobi_foam_add(f, r->x[0], r->v[0], 1, &err));
    REFUSED(tobi_foam_add(f, r->x[0], r->v[0], 1, &err), TOBI_INVALID, "foam: there are 1 diffuse particles");
    OK(tobi_foam_advance(f, &r->water, &err));
    REFUSED(tobi_foam_advance(f, &r->water, &err), TOBI_INVALID,
          "foam: an output at 0 s after one at 0 s; times must rise");
    r->water.time = 1;
    r->water.velocities = NULL;
    REFUSED(tobi_foam_advance(f, &r->water, &err), TOBI_INVALID,
          "particles without positions or velocities cannot be followed");
    r->water.velocities = (const double (*)[3])r->v;
    r->id[5] = 1;
    REFUSED(tobi_foam_advance(f, &r->water, &err), TOBI_INVALID,
            "foam: the ids of the particles at 1 s do not");
    tobi_foam_free(f);
    tobi_foam_free(NULL);
    free(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spray_flies), cmocka_unit_test(test_spray_leaves),
        cmocka_unit_test(test_foam_moves_along), cmocka_unit_test(test_bubbles_rise),
        cmocka_unit_test(test_even_water_makes_none), cmocka_unit_test(test_same_bits),
        cmocka_unit_test(test_room), cmocka_unit_test(test_sums), cmocka_unit_test(test_ids_change),
        cmocka_unit_test(test_flat_world), cmocka_unit_test(test_picture), cmocka_unit_test(test_bodies),
        cmocka_unit_test(test_much_water),
        cmocka_unit_test(test_files), cmocka_unit_test(test_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
