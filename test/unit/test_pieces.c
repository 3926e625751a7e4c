/* Pieces of solids: against all pairs, with cuts, torn and touching again, the same for any number of
   threads, and in the files of a run. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "solid_rig.h"
#include "mpm/particle_fields.h"
#include "mpm/cut/cuts.h"
#include "tobiuo/run.h"
#include "world/world.h"

#define D 0.1

/* A block of nx x ny x nz particles, its lower corner at (1, 1, 1). */
static tobi_world *make_world(int dimension, int model, const int n[3], int threads)
{
    solid_setup s = solid_default(dimension, D, 8);
    s.world.threads = threads;
    s.solid.model = model;
    for (int a = 0; a < dimension; a++) {
        s.fill.box_min[a] = 1;
        s.fill.box_max[a] = 1 + n[a]*D;
    }
    tobi_world *world = solid_world(&s);
    OK(tobi_world_start(world, &err));
    return world;
}

/* Room for cuts, as scenes with blades have it; the world frees it. */
static void remember_cuts(tobi_world *world)
{
    tobi_particles *p = &world->system[0].particles;
    mpm_fields *f = mpm_fields_of(p);
    p->needs |= MPM_NEED_BLADES;
    f->cuts = calloc((size_t)p->capacity + 16, sizeof *f->cuts);
    assert_non_null(f->cuts);
}

static const tobi_pieces *find(tobi_world *world)
{
    const tobi_pieces *pieces;
    world->fresh = 0;                   /* the tests move particles behind its back */
    OK(tobi_world_pieces(world, &pieces, &err));
    double mass = 0, volume = 0;
    int64_t particles = 0;
    for (int64_t k = 0; k < pieces->count + pieces->fragments; k++) {
        const tobi_piece *a = &pieces->piece[k];
        mass += a->mass;
        volume += a->volume;
        particles += a->particles;
        assert_int_equal(a->fragment, k >= pieces->count);
        assert_int_equal(a->fragment, a->particles < (world->system[0].box.dimension == 3 ? 8 : 4));
        if (k > 0 && a->fragment == a[-1].fragment)
            assert_true(a->mass < a[-1].mass || (a->mass == a[-1].mass && a->first_id > a[-1].first_id));
    }
    assert_true(mass == pieces->mass && volume == pieces->volume);      /* exactly */
    assert_true(particles <= world->system[0].particles.count);
    return pieces;
}

static void a_block_is_one_piece(void **state)
{
    (void)state;
    tobi_world *world = make_world(3, TOBI_NEO_HOOKEAN, (int[]){ 6, 5, 4 }, 2);
    const tobi_pieces *p = find(world);
    assert_true(p->count == 1 && p->fragments == 0 && p->piece[0].particles == 120);
    assert_true(fabs(p->mass - 120) < 1e-4 && fabs(p->volume - 0.12) < 1e-7);
    assert_true(fabs(p->piece[0].centre[0] - 1.3) < 1e-6 && fabs(p->piece[0].centre[2] - 1.2) < 1e-6);
    double *cut = solid_read(world, "cut_side", 1);
    for (int i = 0; i < 120; i++) assert_true(cut[i] == 0);
    free(cut);
    /* Squeezed by half: the volume is that of now. */
    for (int i = 0; i < 120; i++) {
        mpm_fields_of(&world->system[0].particles)->strain[i].c[1].y = -0.5f;
        world->system[0].particles.position[i].y *= 0.5;
    }
    p = find(world);
    assert_true(p->count == 1 && fabs(p->volume - 0.06) < 1e-7 && fabs(p->piece[0].centre[1] - 0.625) < 1e-6);
    tobi_world_destroy(world);
}

/* A plane at x = `at` parts what lies within three spacings of it; the pieces still touch. */
static void cut_at(tobi_world *world, double at, int number)
{
    tobi_particles *p = &world->system[0].particles;
    const mpm_fields *f = mpm_fields_of(p);
    for (int64_t i = 0; i < p->count; i++) {
        int k = 0;
        double x = p->position[i].x - at;
        while (k < TOBI_CUTS_EACH && f->cuts[i].c[k].w != 0) k++;
        if (fabs(x) < 3*D && k < TOBI_CUTS_EACH)
            f->cuts[i].c[k] = (tobi_float4){ 1, 0, 0, (float)(x > 0 ? number : -number) };
    }
}

static void cuts_part(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        const int n[3] = { 20, 6, dimension == 3 ? 6 : 1 }, layer = 6*n[2];
        tobi_world *world = make_world(dimension, TOBI_NEO_HOOKEAN, n, 1);
        remember_cuts(world);
        cut_at(world, 1.5, 1);
        const tobi_pieces *p = find(world);
        assert_true(p->count == 2 && p->fragments == 0);
        assert_true(p->piece[0].particles == 15*layer && p->piece[1].particles == 5*layer);
        assert_true(fabs(p->piece[0].mass - 3*p->piece[1].mass) < 1e-6*p->mass);
        cut_at(world, 2, 2);             /* equal ones: the smaller id first, which is that at the left */
        cut_at(world, 2.5, 3);
        p = find(world);
        assert_true(p->count == 4);
        for (int k = 0; k < 4; k++) assert_true(fabs(p->piece[k].centre[0] - (1.25 + 0.5*k)) < 1e-6);
        double *piece = solid_read(world, "piece", 1), *side = solid_read(world, "cut_side", 1);
        double *x = solid_read(world, "position", 3);
        for (int64_t i = 0; i < world->system[0].particles.count; i++) {
            assert_true(piece[i] == floor((x[3*i] - 1)/0.5));
            double latest = x[3*i] > 2.5 - 3*D ? (x[3*i] > 2.5 ? 3 : -3) : 0;
            if (latest != 0 && x[3*i] < 2.5 + 3*D) assert_true(side[i] == latest);
        }
        free(piece);
        free(side);
        free(x);
        tobi_world_destroy(world);
    }
}

/* A crumb of three particles is debris: neither counted as a piece nor hidden. */
static void crumbs_are_told_apart(void **state)
{
    (void)state;
    tobi_world *world = make_world(3, TOBI_NEO_HOOKEAN, (int[]){ 8, 8, 8 }, 1);
    tobi_particles *p = &world->system[0].particles;
    const mpm_fields *f = mpm_fields_of(p);
    remember_cuts(world);
    double whole = find(world)->mass;
    for (int64_t i = 0; i < p->count; i++)
        f->cuts[i].c[0] = (tobi_float4){ 0, 0, 1, p->id[i] < 3 ? -7 : 7 };
    const tobi_pieces *found = find(world);
    assert_true(found->count == 1 && found->fragments == 1 && found->piece[1].particles == 3);
    assert_true(found->piece[1].first_id == 0 && found->mass == whole);
    double *piece = solid_read(world, "piece", 1);
    for (int i = 0; i < 512; i++) assert_true(piece[i] == (i < 3));
    free(piece);
    tobi_world_destroy(world);
}

/* The right half goes 3 spacings away, or on top of the left one. */
static void shift(tobi_world *world, double dx, double dy)
{
    tobi_particles *p = &world->system[0].particles;
    const mpm_fields *f = mpm_fields_of(p);
    for (int64_t i = 0; i < p->count; i++)
        if (f->rest[i].x > 1.4f) {
            p->position[i].x += dx;
            p->position[i].y += dy;
        }
}

static void tearing_and_touching(void **state)
{
    (void)state;
    static const int models[] = { TOBI_NEO_HOOKEAN, TOBI_SAND };
    for (int k = 0; k < 2; k++) {
        tobi_world *world = make_world(3, models[k], (int[]){ 8, 4, 4 }, 2);
        shift(world, 0.4*D, 0);
        assert_int_equal(find(world)->count, 1);
        shift(world, 2.6*D, 0);
        assert_int_equal(find(world)->count, 2);
        shift(world, -7*D, 4*D);                                  /* upon the other, skin on skin */
        assert_int_equal(find(world)->count, 2 - (k == 1));       /* sand is one heap, rubber stays two */
        tobi_world_destroy(world);
    }
    /* Stretched to twice its length it is whole, if its deformation says so. */
    tobi_world *world = make_world(3, TOBI_COROTATED, (int[]){ 8, 4, 4 }, 2);
    tobi_particles *p = &world->system[0].particles;
    const mpm_fields *f = mpm_fields_of(p);
    for (int64_t i = 0; i < p->count; i++) p->position[i].x = 2*p->position[i].x;
    assert_int_equal(find(world)->count, 8);
    for (int64_t i = 0; i < p->count; i++) f->strain[i].c[0].x = 1;
    assert_int_equal(find(world)->count, 1);
    assert_true(fabs(find(world)->volume - 2*0.128) < 1e-6);
    tobi_world_destroy(world);
}

static void solids_stay_apart_and_liquids_have_none(void **state)
{
    (void)state;
    tobi_world *world = make_world(3, TOBI_LIQUID, (int[]){ 4, 4, 4 }, 1);
    assert_true(find(world)->count == 0 && find(world)->fragments == 0 && find(world)->mass == 0);
    double *piece = solid_read(world, "piece", 1);
    for (int i = 0; i < 64; i++) assert_true(piece[i] == -1);
    free(piece);
    tobi_world_destroy(world);

    solid_setup s = solid_default(3, D, 4);
    OK(tobi_world_create(&s.world, NULL, &world, &err));
    for (int k = 0; k < 3; k++) {        /* side by side: the second solid is the heaviest */
        s.solid.name = (const char *[]){ "a", "b", "c" }[k];
        s.solid.density = k == 1 ? 2000 : 1000;
        s.solid.model = k == 2 ? TOBI_STATIONARY : TOBI_NEO_HOOKEAN;
        s.fill.box_min[0] = k;
        s.fill.box_max[0] = k + 1;
        s.fill.box_max[1] = s.fill.box_max[2] = 1;
        OK(tobi_world_add_solid(world, &s.solid, &s.fill, 1, &err));
    }
    const tobi_pieces *p = find(world);
    assert_true(p->count == 3 && p->piece[0].solid == 1 && p->piece[1].solid == 0 && p->piece[2].solid == 2);
    tobi_world_destroy(world);
}

/* --- against all pairs ------------------------------------------------------------------------------ */

static double draw(uint64_t *seed)
{
    *seed = *seed*6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11)/9007199254740992.0;
}

/* Marks what hangs together with particle i, in the order of links. */
static void flood(const tobi_particles *p, int64_t i, int number, int *of, int64_t *stack)
{
    const mpm_fields *f = mpm_fields_of(p);
    int64_t top = 0;
    stack[top++] = i;
    of[i] = number;
    while (top) {
        int64_t a = stack[--top];
        for (int64_t b = 0; b < p->count; b++) {
            double x = p->position[a].x - p->position[b].x, y = p->position[a].y - p->position[b].y,
                   z = p->position[a].z - p->position[b].z;
            if (of[b] >= 0 || !(sqrt(x*x + y*y + z*z) <= 1.5*D)) continue;
            if (f->cuts[a].c[0].w != 0 && f->cuts[a].c[0].w == -f->cuts[b].c[0].w) continue;
            of[b] = number;
            stack[top++] = b;
        }
    }
}

/* Sand thrown into a box in clumps; `far` throws some of it so far that cells do not fit a table. */
static void check_cloud(int dimension, double size, double far, int threads)
{
    tobi_world *world = make_world(dimension, TOBI_SAND, (int[]){ 15, 15, dimension == 3 ? 10 : 1 }, threads);
    tobi_particles *p = &world->system[0].particles;
    const mpm_fields *f = mpm_fields_of(p);
    uint64_t seed = 7;
    remember_cuts(world);
    for (int64_t i = 0; i < p->count; i++) {
        double *x = &p->position[i].x, scale = i%50 == 0 ? far : size;
        for (int a = 0; a < dimension; a++) x[a] = scale*draw(&seed);
        f->cuts[i].c[0].w = i%3 ? 0 : x[0] > 0.5*size ? 1 : -1;
    }
    if (far > 1e6) p->position[17].x = NAN;
    const tobi_pieces *found = find(world);
    double *piece = solid_read(world, "piece", 1);
    int *of = malloc((size_t)p->count*sizeof *of), number = 0;
    int64_t *stack = malloc((size_t)p->count*sizeof *stack);
    for (int64_t i = 0; i < p->count; i++) of[i] = -1;
    for (int64_t i = 0; i < p->count; i++)
        if (of[i] < 0) flood(p, i, number++, of, stack);
    assert_int_equal(number, found->count + found->fragments);
    assert_true(number > 5);
    for (int64_t i = 0; i < p->count; i++)
        for (int64_t j = 0; j < p->count; j += 37)
            assert_int_equal(of[i] == of[j], piece[p->id[i]] == piece[p->id[j]]);
    free(of);
    free(stack);
    free(piece);
    tobi_world_destroy(world);
}

static void pieces_are_those_of_all_pairs(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 4; threads += 3) {
        check_cloud(3, 2.2, 2.2, threads);
        check_cloud(3, 2.2, 1e5, threads);
        check_cloud(3, 2.2, 1e30, threads);
        check_cloud(2, 2, 2, threads);
        check_cloud(2, 2, 1e12, threads);
    }
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    tobi_world *one = make_world(3, TOBI_NEO_HOOKEAN, (int[]){ 40, 12, 12 }, 1);
    tobi_world *four = make_world(3, TOBI_NEO_HOOKEAN, (int[]){ 40, 12, 12 }, 4);
    tobi_world *both[] = { one, four };
    for (int k = 0; k < 2; k++) {
        remember_cuts(both[k]);
        for (int cut = 1; cut < 8; cut++) cut_at(both[k], 1 + 0.5*cut, cut);
        solid_step(both[k], 30);
    }
    const tobi_pieces *a = find(one), *b = find(four);
    assert_true(a->count == 8 && a->count == b->count && a->fragments == b->fragments);
    assert_memory_equal(a->piece, b->piece, (size_t)a->count*sizeof *a->piece);
    assert_true(a->mass == b->mass && a->volume == b->volume);
    double *x = solid_read(one, "piece", 1), *y = solid_read(four, "piece", 1);
    assert_memory_equal(x, y, 40*12*12*sizeof *x);
    free(x);
    free(y);
    tobi_world_destroy(one);
    tobi_world_destroy(four);
}

/* --- files ------------------------------------------------------------------------------------------ */

/* Slices of nine particles; the last is in crumbs of three and six. */
static void slice_up(tobi_world *world)
{
    tobi_particles *p = &world->system[0].particles;
    const mpm_fields *f = mpm_fields_of(p);
    for (int64_t i = 0; i < p->count; i++) {
        int slice = (int)((p->position[i].x - 1)/D);
        f->cuts[i].c[0].w = (float)(slice + 1);
        f->cuts[i].c[1].w = -(float)(slice + 2);
        if (slice == 69) f->cuts[i].c[2].w = f->rest[i].y > 1.2f ? 1000 : -1000;
    }
    world->fresh = 0;
}

static double number_of(const json_t *json, const char *object, const char *key)
{
    const json_t *value = json_object_get(object ? json_object_get(json, object) : json, key);
    if (!json_is_number(value)) fail_msg("summary.json lacks %s %s", object ? object : "", key);
    return json_number_value(value);
}

static void check_summary(const char *folder)
{
    char path[100];
    snprintf(path, sizeof path, "%s/summary.json", folder);
    json_t *json = json_load_file(path, 0, NULL), *list = json_object_get(json, "piece_list");
    assert_true(number_of(json, NULL, "pieces") == 69 && json_array_size(list) == 64);
    assert_true(number_of(json, "piece_rest", "count") == 5);
    assert_true(number_of(json, "piece_rest", "particles") == 45);
    assert_true(number_of(json, "fragments", "count") == 2);
    assert_true(number_of(json, "fragments", "particles") == 9);
    double mass = number_of(json, "piece_rest", "mass") + number_of(json, "fragments", "mass");
    for (size_t k = 0; k < 64; k++) {
        const json_t *piece = json_array_get(list, k);
        mass += number_of(piece, NULL, "mass");
        assert_true(number_of(piece, NULL, "particles") == 9);
        assert_true(fabs(number_of(piece, NULL, "volume") - 0.009) < 1e-8);
        assert_string_equal(json_string_value(json_object_get(piece, "solid")), "solid");
        const json_t *x = json_array_get(json_object_get(piece, "centre"), 0);
        assert_true(fabs(json_number_value(x) - (1.05 + (double)k*D)) < 1e-6);
    }
    assert_true(fabs(mass - 630) < 1e-4 && fabs(number_of(json, NULL, "piece_mass") - mass) < 1e-8);
    json_decref(json);
}

/* The last two columns of history.csv. */
static void check_history(const char *folder)
{
    char path[100], line[4096];
    static const char *const ends[] = { ",pieces,fragments\n", ",1,0\n", ",69,2\n" };
    snprintf(path, sizeof path, "%s/history.csv", folder);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    for (int k = 0; k < 3; k++) {
        assert_non_null(fgets(line, sizeof line, file));
        assert_string_equal(line + strlen(line) - strlen(ends[k]), ends[k]);
    }
    fclose(file);
}

static void files_tell(void **state)
{
    (void)state;
    char folder[] = "/tmp/tobiuo_pieces_XXXXXX", command[100];
    assert_non_null(mkdtemp(folder));
    tobi_world *world = make_world(3, TOBI_NEO_HOOKEAN, (int[]){ 70, 3, 3 }, 1);
    tobi_output_def output = tobi_default_output_def();
    tobi_run *run;
    output.fields = "piece,cut_side";
    OK(tobi_run_create(world, &output, folder, 1, NULL, &run, &err));
    remember_cuts(world);
    slice_up(world);
    OK(tobi_run_output(run, &err));
    OK(tobi_run_finish(run, "complete", &err));
    check_summary(folder);
    check_history(folder);
    tobi_run_free(run);
    tobi_world_destroy(world);
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

/* --- pictures --------------------------------------------------------------------------------------- */

static tobi_world *color_world(const tobi_fill_def *fill, const double core[3], int threads)
{
    solid_setup s = solid_default(3, D, 3);
    s.fill = *fill;
    s.world.threads = threads;
    for (int a = 0; a < 3; a++) {
        s.world.domain_min[a] = -1;
        s.solid.color[a] = a == 0 ? 200 : 30;
    }
    memcpy(s.solid.core_color, core, sizeof s.solid.core_color);
    tobi_world *world = solid_world(&s);
    OK(tobi_world_start(world, &err));
    return world;
}

static const double cream[3] = { 250, 240, 200 }, red[3] = { 200, 30, 30 }, none[3] = { -1, -1, -1 };

static int count_core(tobi_world *world)
{
    int count = 0;
    const tobi_particles *p = &world->system[0].particles;
    const mpm_fields *f = mpm_fields_of(p);
    for (int64_t i = 0; i < p->count; i++) count += f->rest[i].w == 1;
    return count;
}

static void the_core_is_below_the_skin(void **state)
{
    (void)state;
    tobi_fill_def fill = tobi_default_fill_def();
    for (int a = 0; a < 3; a++) fill.box_max[a] = 1;
    tobi_world *world = color_world(&fill, cream, 2), *plain = color_world(&fill, none, 2);
    assert_true(world->system[0].particles.count == 1000);
    assert_true(count_core(world) == 216 && count_core(plain) == 0);
    for (int64_t i = 0; i < 1000; i++) {
        const tobi_float4 *x = &mpm_fields_of(&world->system[0].particles)->rest[i];
        int core = 1;
        for (int a = 0; a < 3; a++) core &= (&x->x)[a] > 1.175f && (&x->x)[a] < 1.825f;
        assert_int_equal(x->w == 1, core);
    }
    /* It survives steps and a restart. */
    solid_step(world, 50);
    solid_copy(world, plain);
    assert_true(count_core(world) == 216 && count_core(plain) == 216);
    tobi_world_destroy(world);
    tobi_world_destroy(plain);

    fill.radius = 0.6;                  /* the core of a ball: 4/3 pi 0.425^3/D^3 particles */
    world = color_world(&fill, cream, 1);
    assert_true(abs(count_core(world) - 321) < 20);
    tobi_world_destroy(world);

    char cube[] = "/tmp/tobiuo_cube_XXXXXX.stl";       /* a mesh: the same as the box */
    int file = mkstemps(cube, 4);
    static const int corner[12][3] = { {0,3,1}, {0,2,3}, {4,5,7}, {4,7,6}, {0,1,5}, {0,5,4},
                                       {2,7,3}, {2,6,7}, {0,6,2}, {0,4,6}, {1,3,7}, {1,7,5} };
    FILE *stl = fdopen(file, "w");
    fprintf(stl, "solid cube\n");
    for (int t = 0; t < 12; t++) {
        fprintf(stl, "facet normal 0 0 0\nouter loop\n");
        for (int c = 0; c < 3; c++)
            fprintf(stl, "vertex %d %d %d\n", corner[t][c] & 1, corner[t][c] >> 1 & 1, corner[t][c] >> 2);
        fprintf(stl, "endloop\nendfacet\n");
    }
    fprintf(stl, "endsolid cube\n");
    fclose(stl);
    fill.radius = 0;
    fill.mesh = cube;
    world = color_world(&fill, cream, 1);
    assert_true(world->system[0].particles.count == 1000 && count_core(world) == 216);
    tobi_world_destroy(world);
    unlink(cube);
}

/* The picture of a block; with `gap` its halves have been parted. The caller frees. */
static char *picture(const double core[3], double gap, size_t *size)
{
    char folder[] = "/tmp/tobiuo_core_XXXXXX", path[100], *bytes = malloc(1 << 22);
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_output_def output = tobi_default_output_def();
    tobi_run *run;
    for (int a = 0; a < 3; a++) fill.box_max[a] = 1;
    tobi_world *world = color_world(&fill, core, 1);
    for (int64_t i = 0; i < 1000; i++)
        if (mpm_fields_of(&world->system[0].particles)->rest[i].x > 1.5f)
            world->system[0].particles.position[i].x += gap;
    assert_non_null(mkdtemp(folder));
    output.frames = 1;
    OK(tobi_run_create(world, &output, folder, 1, NULL, &run, &err));
    snprintf(path, sizeof path, "%s/frames/frame_000000.png", folder);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    *size = fread(bytes, 1, 1 << 22, file);
    fclose(file);
    tobi_run_free(run);
    tobi_world_destroy(world);
    snprintf(path, sizeof path, "rm -r %s", folder);
    assert_int_equal(system(path), 0);
    return bytes;
}

static void a_cut_shows_the_core(void **state)
{
    (void)state;
    size_t size[4];
    char *whole = picture(cream, 0, &size[0]), *skin = picture(none, 0, &size[1]);
    char *parted = picture(cream, 1, &size[2]), *plain = picture(red, 1, &size[3]);
    assert_true(size[0] == size[1] && memcmp(whole, skin, size[0]) == 0);      /* nothing shines through */
    assert_true(size[2] != size[3] || memcmp(parted, plain, size[2]) != 0);
    free(whole);
    free(skin);
    free(parted);
    free(plain);
}

static void other_methods_have_no_pieces(void **state)
{
    (void)state;
    tobi_world_def w = tobi_default_world_def();
    tobi_world *world;
    const tobi_pieces *pieces;
    w.spacing = D;
    for (int a = 0; a < 3; a++) w.domain_max[a] = 1;
    OK(tobi_world_create(&w, NULL, &world, &err));
    REFUSED(tobi_world_pieces(world, &pieces, &err), TOBI_UNSUPPORTED, "dfsph has no solids, so no pieces");
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_is_one_piece),
        cmocka_unit_test(cuts_part),
        cmocka_unit_test(crumbs_are_told_apart),
        cmocka_unit_test(tearing_and_touching),
        cmocka_unit_test(solids_stay_apart_and_liquids_have_none),
        cmocka_unit_test(pieces_are_those_of_all_pairs),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(files_tell),
        cmocka_unit_test(the_core_is_below_the_skin),
        cmocka_unit_test(a_cut_shows_the_core),
        cmocka_unit_test(other_methods_have_no_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
