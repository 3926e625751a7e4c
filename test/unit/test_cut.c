/* Cuts that stay: a blade thinner than a cell parts a block at every place in the grid, no particle lands
   on the wrong side, and what is cut is pulled apart without force once the blade has left. In plane strain;
   with the argument 3d, and perhaps a thickness in mm, only this, in space, and test/physics/thin_blade
   judges. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "calls.h"
#include "mpm/particle_fields.h"
#include "base/param.h"
#include "world/world.h"

#define CELL (0.6/128)
#define SPACING (CELL/2)
enum { ACROSS = 26, DEEP = 12, MOST = ACROSS*ACROSS*DEEP };
static int dimension = 2, count = ACROSS*ACROSS;                /* of the block that is cut: particles */
static const double LEFT = 0.12, TOP = 0.07, LOW = 3e-4, DOWN = 2, UP = 4;

/* A blade with a wedge of 8 mm, its edge at the origin, along z. */
static void write_blade(const char *path, double thickness)
{
    const double half = 0.5*thickness;
    const double p[5][2] = {{0, 0}, {half, 8e-3}, {half, 0.1}, {-half, 0.1}, {-half, 8e-3}};
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    for (int z = 0; z < 2; z++)
        for (int i = 0; i < 5; i++) fprintf(f, "v %.9g %.9g %g\n", p[i][0], p[i][1], z - 0.5);
    for (int i = 0; i < 5; i++) {
        int j = (i + 1)%5;
        fprintf(f, "f %d %d %d\nf %d %d %d\n", i + 1, j + 1, j + 6, i + 1, j + 6, i + 6);
    }
    for (int i = 1; i < 4; i++) fprintf(f, "f 1 %d %d\nf 6 %d %d\n", i + 2, i + 1, i + 6, i + 7);
    fclose(f);
}

/* Down through the block, and out again faster. */
static tobi_status move(void *user, double t, int64_t points, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    const double bottom = (TOP - LOW)/DOWN;
    double y = t < bottom ? TOP - DOWN*t : fmin(LOW + UP*(t - bottom), TOP + 0.01);
    (void)user;
    (void)err;
    for (int64_t i = 0; i < points; i++) {
        memcpy(out[i], rest[i], sizeof out[i]);
        out[i][1] += y;
    }
    return TOBI_OK;
}

static tobi_world *make_world(const char *mesh, double x, int threads, int transfer)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_body_def blade = tobi_default_body_def();
    tobi_mlsmpm_def method;
    tobi_param_defaults(tobi_method_table("mlsmpm"), &method);
    tobi_world *world;
    w.method = "mlsmpm";
    w.dimension = dimension;
    for (int a = 0; a < dimension; a++) w.domain_max[a] = 0.3;
    w.gravity[2] = 0;
    w.spacing = SPACING;
    w.threads = threads;
    w.friction = 0;
    for (int a = 0; a < dimension; a++) w.wall_min[a] = w.wall_max[a] = TOBI_WALL_SEPARATE;
    method.transfer = transfer;
    solid.density = 800;
    solid.youngs_modulus = 3e6;
    solid.poissons_ratio = 0.3;
    fill.box_min[0] = LEFT;
    fill.box_max[0] = LEFT + ACROSS*SPACING;
    fill.box_max[1] = ACROSS*SPACING;
    blade.name = "knife";
    blade.mesh = mesh;
    blade.translation[0] = x;
    if (dimension == 3) {
        fill.box_min[2] = LEFT;
        fill.box_max[2] = LEFT + DEEP*SPACING;
        blade.scale[2] = 0.1;
        blade.translation[2] = LEFT + 0.5*DEEP*SPACING;
    }
    blade.blade = 1;
    blade.edge_resistance = 250;
    blade.friction_coefficient = 0.3;
    blade.motion = move;
    blade.motion_rigid = 1;
    OK(tobi_world_create(&w, &method, &world, &err));
    OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    OK(tobi_world_add_body(world, &blade, &err));
    OK(tobi_world_start(world, &err));
    assert_int_equal(tobi_world_count(world, TOBI_FLUID), count);
    return world;
}

static void read_field(tobi_world *world, const char *field, double *out, int components)
{
    OK(tobi_world_read(world, TOBI_FLUID, field, out, count, &err));
    for (int i = 0; i < count*components; i++) assert_true(isfinite(out[i]));
}

/* Number of particles that lie on another side of the blade than they remember. */
static int count_wrong(tobi_world *world, double x)
{
    static double place[MOST][3], side[MOST];
    int same = 0, cut = 0;
    read_field(world, "position", place[0], 3);
    read_field(world, "cut_side", side, 1);
    for (int i = 0; i < count; i++) {
        cut += side[i] != 0;
        same += side[i] != 0 && (place[i][0] > x) == (side[i] > 0);
    }
    assert_true(cut > 4*count/ACROSS);
    return same < cut - same ? same : cut - same;      /* the signs of the sides are the blade's choice */
}

/* Which half a particle is of: 0 left, 1 right. */
static void find_halves(tobi_world *world, int half[MOST])
{
    static double piece[MOST], rest[MOST][3];
    int right = 0;
    read_field(world, "piece", piece, 1);
    read_field(world, "rest_position", rest[0], 3);
    for (int i = 0; i < count; i++) right += rest[i][0] > LEFT + 25*SPACING ? piece[i] > 0 ? 1 : -1 : 0;
    for (int i = 0; i < count; i++) half[i] = (piece[i] > 0) == (right > 0);
}

static void set_speed(tobi_world *world, const int half[MOST], double speed)
{
    static double u[MOST][3];
    for (int i = 0; i < count; i++) u[i][0] = half[i] ? speed : -speed;
    OK(tobi_world_write(world, "velocity", u[0], count, &err));
}

static double speed_of(tobi_world *world, const int half[MOST], int which)
{
    static double u[MOST][3];
    double sum = 0;
    int members = 0;
    read_field(world, "velocity", u[0], 3);
    for (int i = 0; i < count; i++)
        if (half[i] == which) { sum += u[i][0]; members++; }
    return sum/members;
}

/* The particles of one half that remember the cut, among which those of its face are. */
static int list_face(tobi_world *world, const int half[MOST], int which, int face[MOST])
{
    static double side[MOST];
    int found = 0;
    read_field(world, "cut_side", side, 1);
    for (int i = 0; i < count; i++)
        if (half[i] == which && side[i] != 0) face[found++] = i;
    return found;
}

/* m, between the faces where they are nearest: particles of both fill a spacing. */
static double find_gap(tobi_world *world, const int half[MOST])
{
    static double place[MOST][3];
    static int left[MOST], right[MOST];
    const int lefts = list_face(world, half, 0, left), rights = list_face(world, half, 1, right);
    double least = 1;
    read_field(world, "position", place[0], 3);
    for (int i = 0; i < lefts; i++)
        for (int k = 0; k < rights; k++) {
            const double *p = place[left[i]], *q = place[right[k]];
            const double d[3] = { p[0] - q[0], p[1] - q[1], p[2] - q[2] };
            least = fmin(least, d[0]*d[0] + d[1]*d[1] + d[2]*d[2]);
        }
    return sqrt(least) - SPACING;
}

static void wait(tobi_world *world, double seconds)
{
    OK(tobi_world_advance(world, tobi_world_time(world) + seconds, NULL, &err));
}

/* Brings the halves together until they all but touch, and pulls: returns the share of the speed that one has
   lost after 2 ms; below 0, what still rings pushed them on. */
static double pull(tobi_world *world, const int half[MOST])
{
    const double speed = 0.2;
    for (int k = 0; k < 500 && find_gap(world, half) > 3e-4; k++) {
        set_speed(world, half, -speed);
        wait(world, 2.5e-4);
    }
    assert_true(find_gap(world, half) < 3e-4);
    set_speed(world, half, speed);
    wait(world, 2e-3);
    return fmax(1 - speed_of(world, half, 1)/speed, 1 + speed_of(world, half, 0)/speed);
}

/* m, by how much particles of the two faces are nearer than a spacing across the cut, of those opposite to
   each other. Where the cut passes near a column the face has steps: neighbours of one column lie along the
   cut and may have been pressed together. */
static double find_overlap(tobi_world *world, const int half[MOST])
{
    static double place[MOST][3], rest[MOST][3];
    static int left[MOST], right[MOST];
    const int lefts = list_face(world, half, 0, left), rights = list_face(world, half, 1, right);
    double most = 0;
    read_field(world, "position", place[0], 3);
    read_field(world, "rest_position", rest[0], 3);
    for (int i = 0; i < lefts; i++)
        for (int k = 0; k < rights; k++) {
            const double *p = place[left[i]], *q = place[right[k]];
            if (fabs(p[1] - q[1]) < 0.5*SPACING && fabs(p[2] - q[2]) < 0.5*SPACING &&
                fabs(rest[left[i]][0] - rest[right[k]][0]) > 0.5*SPACING)
                most = fmax(most, SPACING - fabs(p[0] - q[0]));
        }
    return most;
}

/* Lets the halves run into each other: they push each other back. Returns how far they overlapped, m. */
static double collide(tobi_world *world, const int half[MOST])
{
    double most = 0;
    set_speed(world, half, -0.5);
    for (int k = 0; k < 400 && speed_of(world, half, 1) - speed_of(world, half, 0) < 0.1; k++) {
        wait(world, 2.5e-4);
        most = fmax(most, find_overlap(world, half));
    }
    assert_true(speed_of(world, half, 1) > 0);
    assert_true(speed_of(world, half, 0) < 0);
    return most;
}

static void cut_once(double thickness, double offset, int transfer)
{
    static int half[MOST];
    char path[] = "/tmp/tobiuo_blade_XXXXXX.obj";
    const double x = LEFT + 12.8*SPACING + offset*CELL, bottom = (TOP - LOW)/DOWN;
    close(mkstemps(path, 4));
    write_blade(path, thickness);
    tobi_world *world = make_world(path, x, 1, transfer);
    unlink(path);
    OK(tobi_world_advance(world, bottom, NULL, &err));
    const int wrong = count_wrong(world, x);
    OK(tobi_world_advance(world, bottom + (TOP + 0.01 - LOW)/UP, NULL, &err));
    find_halves(world, half);
    /* With transfers that keep more motion the halves tumble, and meet with other faces than those cut. */
    const double lost = pull(world, half), overlap = transfer == TOBI_APIC ? collide(world, half) : 0;
    const tobi_pieces *pieces;
    OK(tobi_world_pieces(world, &pieces, &err));
    printf("blade %.0f mm, %.2f cells into the grid: %d pieces, %d fragments, "
           "%d on the wrong side, %.1e of the speed lost in pulling, overlap %.2f mm in colliding\n",
           thickness*1e3, offset, (int)pieces->count, (int)pieces->fragments, wrong, lost, overlap*1e3);
    const int count_now = (int)pieces->count, fragments = (int)pieces->fragments;
    tobi_world_destroy(world);
    if (dimension == 3) return;                 /* the case judges */
    assert_int_equal(count_now, 2);
    assert_int_equal(fragments, 0);
    assert_int_equal(wrong, 0);
    assert_true(lost < 1e-5);
    assert_true(overlap < 0.25*SPACING);
}

static void every_blade_at_every_place(void **state)
{
    (void)state;
    for (int t = 1; t <= 4; t += SANITIZED ? 3 : 1)
        for (int o = 0; o < 4; o += SANITIZED ? 2 : 1) cut_once(1e-3*t, 0.25*o, TOBI_APIC);
}

static int thickness_in_space;           /* mm, 0: all */

static void blades_in_space(void **state)
{
    (void)state;
    dimension = 3;
    count = MOST;
    for (int t = 1; t <= 4; t++)
        for (int o = 0; o < 4 && (!thickness_in_space || t == thickness_in_space); o++)
            cut_once(1e-3*t, 0.25*o, TOBI_APIC);
}

static void other_transfers(void **state)
{
    (void)state;
    cut_once(3e-3, 0.25, TOBI_FLIP);
    cut_once(3e-3, 0.25, TOBI_XPIC);
}

/* --- a cut block against its halves alone ---------------------------------------------------------- */

enum { SIDE = 8, HALF_MOST = SIDE*SIDE*SIDE };

/* Halves of a block of SIDE particles along each axis, cut at the plane x = 0: both (which < 0), or one. A
   blade that stands far off makes the particles remember cuts. */
static tobi_world *make_halves(int dimension, int transfer, int which)
{
    char path[] = "/tmp/tobiuo_blade_XXXXXX.obj";
    tobi_world_def w = tobi_default_world_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def fill[2] = { tobi_default_fill_def(), tobi_default_fill_def() };
    tobi_body_def blade = tobi_default_body_def();
    tobi_mlsmpm_def method;
    tobi_world *world;
    tobi_param_defaults(tobi_method_table("mlsmpm"), &method);
    method.transfer = transfer;
    w.method = "mlsmpm";
    w.dimension = dimension;
    w.spacing = 0.01;
    w.time_step = 1e-4;
    w.threads = 2;
    for (int a = 0; a < 3; a++) {
        w.gravity[a] = 0;
        w.domain_min[a] = -0.4;
        w.domain_max[a] = 0.4;
        for (int h = 0; h < 2; h++) {
            fill[h].box_min[a] = a ? 0 : h ? 0 : -0.5*SIDE*w.spacing;
            fill[h].box_max[a] = a ? SIDE*w.spacing : fill[h].box_min[0] + 0.5*SIDE*w.spacing;
        }
    }
    solid.youngs_modulus = 1e5;
    solid.poissons_ratio = 0.3;
    close(mkstemps(path, 4));
    write_blade(path, 1e-3);
    blade.name = "far";
    blade.mesh = path;
    blade.blade = 1;
    blade.translation[0] = 0.35;
    if (dimension == 3) blade.scale[2] = 0.1;
    OK(tobi_world_create(&w, &method, &world, &err));
    OK(tobi_world_add_solid(world, &solid, which < 0 ? fill : &fill[which], which < 0 ? 2 : 1, &err));
    OK(tobi_world_add_body(world, &blade, &err));
    OK(tobi_world_start(world, &err));
    unlink(path);
    return world;
}

/* Cuts the block, and gives the halves turning, stretching motions that part them. */
static void set_off(tobi_world *world)
{
    static double u[HALF_MOST][3];
    tobi_particles *p = &world->system[0].particles;
    const mpm_fields *f = mpm_fields_of(p);
    for (int64_t i = 0; i < p->count; i++) {
        const double x = f->rest[i].x - 0.4, y = f->rest[i].y - 0.4, z = f->rest[i].z - 0.4;
        const double s = x > 0 ? 1 : -1;
        f->cuts[i].c[0] = (tobi_float4){ (float)x, 0, 0, (float)s };
        double *to = u[world->system[0].particles.id[i]];
        to[0] = s*(0.5 + 8*fabs(x)) + 3*y;
        to[1] = s*4*x - 6*y + 0.2*s;
        to[2] = world->system[0].box.dimension == 3 ? 5*z - 4*y : 0;
    }
    OK(tobi_world_write(world, "velocity", u[0], p->count, &err));
}

static void read_positions(tobi_world *world, double (*out)[3])
{
    OK(tobi_world_read(world, TOBI_FLUID, "position", out[0], world->system[0].particles.count, &err));
}

/* Largest difference of positions, m, after the halves have moved by about 2 mm. */
static double compare_halves(int dimension, int transfer)
{
    static double both[HALF_MOST][3], alone[HALF_MOST][3];
    tobi_world *block = make_halves(dimension, transfer, -1);
    double worst = 0;
    set_off(block);
    OK(tobi_world_advance(block, 4e-3, NULL, &err));
    read_positions(block, both);
    int64_t at = 0;
    for (int h = 0; h < 2; h++) {
        tobi_world *half = make_halves(dimension, transfer, h);
        set_off(half);
        OK(tobi_world_advance(half, 4e-3, NULL, &err));
        read_positions(half, alone);
        for (int64_t i = 0; i < half->system[0].particles.count; i++, at++)
            for (int a = 0; a < 3; a++) worst = fmax(worst, fabs(both[at][a] - alone[i][a]));
        tobi_world_destroy(half);
    }
    assert_int_equal(at, block->system[0].particles.count);
    tobi_world_destroy(block);
    return worst;
}

static void halves_move_as_if_alone(void **state)
{
    (void)state;
    const int transfers[] = { TOBI_APIC, TOBI_FLIP, TOBI_XPIC };
    for (int dimension = 2; dimension <= 3; dimension++)
        for (int k = 0; k < 3; k++) {
            double worst = compare_halves(dimension, transfers[k]);
            printf("%d-D, transfer %d: positions differ by %.1e m\n", dimension, transfers[k], worst);
            assert_true(worst < 1e-8);
        }
}

/* A world before the cut, made with so many threads. */
static tobi_world *make_uncut(int threads)
{
    char path[] = "/tmp/tobiuo_blade_XXXXXX.obj";
    close(mkstemps(path, 4));
    write_blade(path, 3e-3);
    tobi_world *world = make_world(path, LEFT + 13*SPACING, threads, TOBI_APIC);
    unlink(path);
    return world;
}

/* A world that writes checkpoints, one that does not, with other threads, and one made anew that goes on from
   the last of them. The steps between find no new cut at some and one at others. */
static void same_bits(void **state)
{
    (void)state;
    char path[] = "/tmp/tobiuo_cut_XXXXXX";
    close(mkstemp(path));
    tobi_world *one = make_uncut(1), *four = make_uncut(4), *later = make_uncut(1);
    OK(tobi_world_advance(one, 0.015, NULL, &err));
    OK(tobi_world_advance(four, 0.015, NULL, &err));
    assert_true(one->sim.bodies[0].rigid.cut == 1);
    for (int step = 0; step < 40; step++) {
        if (step%7 == 0) OK(tobi_world_save(one, path, &err));
        OK(tobi_world_step(one, 0, NULL, &err));
        OK(tobi_world_step(four, 0, NULL, &err));
    }
    OK(tobi_world_load(later, path, &err));
    OK(tobi_world_save(later, path, &err));            /* handed on without a step */
    OK(tobi_world_load(later, path, &err));
    assert_true(later->sim.bodies[0].rigid.cut == 1);
    OK(tobi_world_advance(one, 0.03, NULL, &err));
    OK(tobi_world_advance(four, 0.03, NULL, &err));
    OK(tobi_world_advance(later, 0.03, NULL, &err));
    assert_true(tobi_world_hash(one) == tobi_world_hash(four));
    assert_true(tobi_world_hash(one) == tobi_world_hash(later));
    assert_memory_equal(mpm_fields_of(&one->system[0].particles)->cuts,
                        mpm_fields_of(&later->system[0].particles)->cuts,
                        (size_t)count*sizeof(tobi_columns));
    tobi_error why = { 0 };
    double *nowhere = calloc(TOBI_RESTORED_ROW, sizeof *nowhere);
    assert_non_null(nowhere);
    nowhere[0] = 1e9;
    OK(tobi_world_load(later, path, &err));
    later->system[0].method->restore(&later->system[0], nowhere, 1);
    assert_int_equal(tobi_world_step(later, 0, NULL, &why), TOBI_DAMAGED);
    assert_non_null(strstr(why.text, "the checkpoint remembers a cut at node 1e+09"));
    assert_int_equal(one->sim.bodies[0].piece_count, 1);
    one->sim.bodies[0].edge_share[0][1] = NAN;
    OK(tobi_world_save(one, path, &err));
    assert_int_equal(tobi_world_load(later, path, &why), TOBI_DAMAGED);
    assert_non_null(strstr(why.text, "the checkpoint's state of the edge of '"));
    unlink(path);
    tobi_world_destroy(one);
    tobi_world_destroy(four);
    tobi_world_destroy(later);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_blade_at_every_place),
        cmocka_unit_test(other_transfers),
        cmocka_unit_test(halves_move_as_if_alone),
        cmocka_unit_test(same_bits),
    };
    if (argc < 2 || strcmp(argv[1], "3d") != 0) return cmocka_run_group_tests(tests, NULL, NULL);
    const struct CMUnitTest in_space[] = { cmocka_unit_test(blades_in_space) };
    thickness_in_space = argc > 2 ? atoi(argv[2]) : 0;
    return cmocka_run_group_tests(in_space, NULL, NULL);
}
