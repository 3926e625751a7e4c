/* Solids whose particles are nearer to each other than the water's: in pictures and surfaces they are as
   large as they are. */
#define _GNU_SOURCE 1
#include "calls.h"
#include "tobiuo/drawing.h"
#include "tobiuo/run.h"
#include "stripes_rig.h"
#include "surface_rig.h"
#include "world/world.h"
#include <stdio.h>
#include <unistd.h>

enum { SIDE = 400 };
#define WATER 0.02
#define FINE 0.008
#define BALL 0.1                 /* m, radius of the solid */
static const double middle[3] = { 0.75, 0.2, 0.2 };

/* Water, and beside it a red ball, in 2-D a disc. */
static tobi_world *make_world(int dimension, double fine)
{
    tobi_world_def w = tobi_default_world_def();
    tobi_mlsmpm_def m = tobi_default_mlsmpm_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_fill_def water = tobi_default_fill_def(), ball = tobi_default_fill_def();
    tobi_world *world;
    w.dimension = dimension, w.spacing = WATER, w.threads = 1;
    w.domain_max[0] = 1;
    for (int a = 1; a < 3; a++) w.domain_max[a] = 0.4;
    solid.name = "ball", solid.youngs_modulus = 1e5;
    solid.color[0] = 230, solid.color[1] = solid.color[2] = 10;
    m.spacing = fine;
    for (int a = 0; a < dimension; a++) water.box_max[a] = a == 0 ? 0.6 : 0.2, ball.centre[a] = middle[a];
    ball.radius = BALL;
    OK(tobi_world_create(&w, NULL, &world, &err));
    OK(tobi_world_use_solids(world, &m, &err));
    OK(tobi_world_add_fluid(world, &fluid, &water, 1, &err));
    OK(tobi_world_add_solid(world, &solid, &ball, 1, &err));
    return world;
}

/* What the particles of the solid fill. */
static double own_volume(const tobi_world *w)
{
    const tobi_system *s = &w->system[1];
    return (double)s->particles.count*pow(s->smoothing.spacing, w->sim.def.dimension);
}

static void expect_near(double value, double wanted, double share)
{
    if (!(fabs(value - wanted) <= share*fabs(wanted)))
        fail_msg("%.6g instead of %.6g, which is off by %.3g %%", value, wanted, 100*(value/wanted - 1));
}

/* Pixels of the red solid, of 1/scale m each. Looks come from a world that has not begun, as for results. */
static double see_solid(int dimension, double fine, int look, int threads, uint8_t rgb[SIDE][SIDE][3],
                        double *volume)
{
    const tobi_view_def view = tobi_default_output_def().view;
    tobi_looks looks;
    tobi_drawing *d;
    tobi_world *w = make_world(dimension, fine);
    OK(tobi_world_looks(w, &looks, &err));
    OK(tobi_world_start(w, &err));
    *volume = own_volume(w);
    tobi_moment m = { .count = tobi_world_count(w, TOBI_FLUID) };
    m.fields = calloc(1, sizeof *m.fields);
    m.positions = calloc((size_t)m.count, sizeof *m.positions);
    add_field(w, &m, "material", 1);
    OK(tobi_world_read(w, TOBI_FLUID, "position", &m.positions[0][0], m.count, &err));
    OK(tobi_drawing_make(&looks, &m, &view, &d, &err));
    tobi_picture *p = tobi_drawing_picture(d);
    p->width = p->height = SIDE;
    p->threads = threads;
    p->title = p->label = NULL;
    p->look = look;
    if (dimension == 3) {
        p->has_camera = 1, p->field_of_view = 2;
        for (int a = 0; a < 3; a++) p->eye[a] = p->target[a] = middle[a];
        p->eye[1] -= 20;
    }
    OK(tobi_picture_draw(p, &rgb[0][0][0], &err));
    int pixels = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) pixels += rgb[y][x][0] > 2*rgb[y][x][1] && rgb[y][x][0] > 60;
    tobi_drawing_free(d);
    tobi_looks_free(&looks);
    tobi_moment_free(&m);
    tobi_world_destroy(w);
    return pixels;
}

static void pictures_are_as_large(void **state)
{
    (void)state;
    static uint8_t one[SIDE][SIDE][3], two[SIDE][SIDE][3];
    const double flat = 0.92*SIDE, deep = SIDE/(2*20*tan(3.14159265358979/180)), pi = 3.14159265358979;
    double volume;
    for (int fine = 0; fine < 2; fine++) {
        /* an eighth of a spacing too large, so that what is stretched keeps together */
        const double spacing = fine ? FINE : 0, share = fine ? 0.025 : 0.075;
        double pixels = see_solid(2, spacing, 0, 1, one, &volume);
        expect_near(pixels/(flat*flat), volume, share);
        pixels = see_solid(3, spacing, 0, 1, one, &volume);      /* along y: the largest circle */
        expect_near(pixels/(deep*deep), pi*BALL*BALL, share);
    }
    /* discs fill the gaps between them up to 1.45 radii */
    expect_near(see_solid(2, FINE, TOBI_LOOK_PARTICLES, 1, one, &volume)/(flat*flat),
                pi*pow(BALL + 0.225*FINE, 2), 0.03);
    see_solid(3, FINE, 0, 1, one, &volume);
    see_solid(3, FINE, 0, 2, two, &volume);
    assert_memory_equal(one, two, sizeof one);
}

/* Numbers of an array of an ASCII file; how many. */
static int64_t read_array(const char *text, const char *name, double *out, int64_t room)
{
    char mark[80], *end;
    int64_t n = 0;
    snprintf(mark, sizeof mark, "Name=\"%s\"", name);
    const char *at = strstr(text, mark);
    assert_non_null(at);
    for (at = strchr(at, '>') + 1; n < room; at = end) {
        out[n] = strtod(at, &end);
        if (end == at) break;
        n++;
    }
    return n;
}

/* The volume inside the surface of a group. */
static double read_volume(const char *path, int group)
{
    enum { ROOM = 1 << 20 };
    static double place[ROOM], corner[ROOM], of[ROOM];
    static char text[1 << 24];
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    read_array(text, "Points", place, ROOM);
    read_array(text, "group", of, ROOM);
    const int64_t n = read_array(text, "connectivity", corner, ROOM);
    double sum = 0;
    for (int64_t k = 0; k < n; k += 3) {
        if ((int)of[(int64_t)corner[k]] != group) continue;
        const double *a = &place[3*(int64_t)corner[k]], *b = &place[3*(int64_t)corner[k + 1]];
        const double *c = &place[3*(int64_t)corner[k + 2]];
        sum += (a[0]*(b[1]*c[2] - b[2]*c[1]) + a[1]*(b[2]*c[0] - b[0]*c[2]) + a[2]*(b[0]*c[1] - b[1]*c[0]))/6;
    }
    return sum;
}

static void surfaces_are_as_large(void **state)
{
    (void)state;
    char dir[] = "/tmp/tobiuo_spacings_XXXXXX", path[80], command[80];
    tobi_output_def output = tobi_default_output_def();
    tobi_run *run;
    assert_non_null(mkdtemp(dir));
    output.interval = 1;
    output.surface = 1, output.compression = TOBI_ASCII;
    tobi_world *w = make_world(3, FINE);
    OK(tobi_run_create(w, &output, dir, 1, NULL, &run, &err));
    const double solid = own_volume(w), water = (double)w->system[0].particles.count*WATER*WATER*WATER;
    tobi_run_free(run);
    tobi_world_destroy(w);
    snprintf(path, sizeof path, "%s/surface/surface_000000.vtp", dir);
    expect_near(read_volume(path, 0), water, 0.02);
    expect_near(read_volume(path, 2), solid, 0.01);      /* the first piece, behind two materials */
    snprintf(command, sizeof command, "rm -r %s", dir);
    assert_int_equal(system(command), 0);
}

/* Two balls of different spacing: closed, each of its volume, the same bits for any number of threads, and
   of each the bits that it has alone. */
static void each_spacing_is_a_pass(void **state)
{
    (void)state;
    const double corner[2][3] = { { 0, 0, 0 }, { 0.3, 0, 0 } }, spacing[2] = { 0.01, 0.02 };
    const int side[2][3] = { { 20, 20, 20 }, { 10, 10, 10 } };
    rig_points p[2];
    int64_t n = 0;
    for (int k = 0; k < 2; k++) p[k] = rig_box(side[k], corner[k], spacing[k], 0.1), n += p[k].count;
    double (*position)[3] = malloc((size_t)n*sizeof *position), *own = malloc((size_t)n*sizeof *own);
    for (int64_t i = 0; i < n; i++) {
        const int k = i >= p[0].count;
        memcpy(position[i], p[k].position[k ? i - p[0].count : i], 24);
        own[i] = spacing[k];
    }
    tobi_surface_field field = { "place", 3, position[0] };
    tobi_surface_def d = tobi_default_surface();
    tobi_surface *all, *again, *one;
    d.particle_count = n, d.positions = (const double (*)[3])position;
    d.spacing = 0.02, d.spacings = own, d.threads = 1;
    d.fields = &field, d.field_count = 1;
    OK(tobi_surface_make(&d, &all, &err));
    assert_true(rig_is_closed(all));
    assert_int_equal(rig_parts(all), 2);
    expect_near(rig_volume(all), 2*0.008, 0.02);
    d.threads = 2;
    OK(tobi_surface_make(&d, &again, &err));
    assert_int_equal(again->vertex_count, all->vertex_count);
    assert_memory_equal(again->vertices, all->vertices, 24*(size_t)all->vertex_count);
    assert_memory_equal(again->triangles, all->triangles, 12*(size_t)all->triangle_count);
    d.particle_count = p[0].count, d.spacings = NULL, d.spacing = 0.01;
    OK(tobi_surface_make(&d, &one, &err));
    assert_memory_equal(one->vertices, all->vertices, 24*(size_t)one->vertex_count);
    assert_memory_equal(one->fields[0], all->fields[0], 12*(size_t)one->vertex_count);
    tobi_surface_free(all), tobi_surface_free(again), tobi_surface_free(one);

    d.particle_count = n, d.spacings = own;
    own[5] = 0;
    REFUSED(tobi_surface_make(&d, &all, &err), TOBI_INVALID, "surface: particle 5 has a spacing of 0 m");
    for (int i = 0; i < 40; i++) own[i] = 0.01 + 1e-4*(i%17);
    REFUSED(tobi_surface_make(&d, &all, &err), TOBI_INVALID, "surface: particles of more than 16 different");
    tobi_picture q = tobi_default_picture();
    uint8_t pixel[16*16*3];
    q.width = q.height = 16, q.radius = 0.02, q.radii = own;
    for (int a = 0; a < 3; a++) q.box_max[a] = 1;
    q.particle_count = n, q.positions = (const double (*)[3])position;
    own[3] = 0.03;
    REFUSED(tobi_picture_draw(&q, pixel, &err), TOBI_INVALID,
            "picture: particle 3 has a radius of 0.03 m, must be greater than 0 and at most that of the "
            "picture, 0.02 m");
    free(position), free(own), free(p[0].position), free(p[1].position);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_as_large),
        cmocka_unit_test(surfaces_are_as_large),
        cmocka_unit_test(each_spacing_is_a_pass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
