/* Pictures: valid PNG, things where they belong, the same for any number of threads and far from the origin,
   nothing broken by strange input. */
#define _GNU_SOURCE 1
#include "calls.h"
#include "tobiuo/picture.h"
#include <math.h>
#include <omp.h>
#include <png.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#include <cmocka.h>

enum { SIDE = 24, N = SIDE*SIDE*SIDE, W = 320, H = 180 };

static char folder[] = "/tmp/tobi_view_picture_XXXXXX";
static char path[64];
static double position[N][3];
static float speed[N];
static const double far_away[3] = { 10000, -10000, 7000 };

static const double cube[8][3] = {
    { 0.4, 0.4, 0.1 }, { 0.6, 0.4, 0.1 }, { 0.4, 0.6, 0.1 }, { 0.6, 0.6, 0.1 },
    { 0.4, 0.4, 0.8 }, { 0.6, 0.4, 0.8 }, { 0.4, 0.6, 0.8 }, { 0.6, 0.6, 0.8 }
};
static const int32_t side[12][3] = {
    { 0, 2, 1 }, { 1, 2, 3 }, { 4, 5, 6 }, { 5, 7, 6 }, { 0, 1, 4 }, { 1, 5, 4 },
    { 2, 6, 3 }, { 3, 6, 7 }, { 0, 4, 2 }, { 2, 4, 6 }, { 1, 3, 5 }, { 3, 7, 5 }
};
static const tobi_picture_mesh red_cube = { 8, cube, 12, side, { 0.9f, 0.1f, 0.1f }, 0, 0, NULL, NULL };

/* A unit box, half full of water, cube through the surface. */
static tobi_picture make_frame(void)
{
    tobi_picture f = tobi_default_picture();
    f.width = W, f.height = H;
    for (int k = 0; k < 3; k++) f.box_max[k] = 1;
    f.positions = position, f.values = speed, f.particle_count = N;
    f.radius = 0.5/SIDE, f.value_max = 1, f.clarity = 0.6;
    f.meshes = &red_cube, f.mesh_count = 1;
    f.has_camera = 1;
    f.eye[0] = 0.5, f.eye[1] = -3, f.eye[2] = 0.7;
    for (int k = 0; k < 3; k++) f.target[k] = 0.5;
    return f;
}

static void fill(void)
{
    for (int i = 0; i < N; i++) {
        position[i][0] = (i%SIDE + 0.5)/SIDE;
        position[i][1] = (i/SIDE%SIDE + 0.5)/SIDE;
        position[i][2] = (i/SIDE/SIDE + 0.5)/SIDE*0.5;
        speed[i] = (float)(i%SIDE)/SIDE*0.3f;
    }
}

static unsigned char *read_png(int *width, int *height)
{
    png_image image = { .version = PNG_IMAGE_VERSION };
    if (!png_image_begin_read_from_file(&image, path)) fail_msg("not a PNG: %s", image.message);
    image.format = PNG_FORMAT_RGB;
    unsigned char *pixels = malloc(PNG_IMAGE_SIZE(image));
    assert_true(png_image_finish_read(&image, NULL, pixels, 0, NULL));
    *width = (int)image.width;
    *height = (int)image.height;
    return pixels;
}

static unsigned char *draw(const tobi_picture *f)
{
    tobi_error err = { 0 };
    int width, height;
    tobi_status status = tobi_picture_write(path, f, &err);
    if (status != TOBI_OK) fail_msg("%s", err.text);
    unsigned char *pixels = read_png(&width, &height);
    assert_int_equal(width, f->width);
    assert_int_equal(height, f->height);
    return pixels;
}

static const unsigned char *pixel(const unsigned char *pixels, int x, int y) { return pixels + 3*(y*W + x); }
static int redness(const unsigned char *p) { return p[0] - (p[1] + p[2])/2; }
static int blueness(const unsigned char *p) { return p[2] - p[0]; }

static double mean_difference(const unsigned char *a, const unsigned char *b)
{
    double sum = 0;
    for (int i = 0; i < 3*W*H; i++) sum += abs(a[i] - b[i]);
    return sum/(3*W*H);
}

static void things_are_where_they_belong(void **state)
{
    (void)state;
    tobi_picture f = make_frame();
    unsigned char *all = draw(&f);
    /* The camera looks level at the middle of the box: the cube's upper part is at the centre's top. */
    const unsigned char *dry = pixel(all, W/2, H/2 - 18), *wet = pixel(all, W/2, H/2 + 26);
    const unsigned char *water = pixel(all, W/2 - 40, H/2 + 26);
    assert_true(redness(dry) > 60);
    assert_true(blueness(water) > 60);
    f.particle_count = 0;
    unsigned char *drained = draw(&f);
    const unsigned char *bare = pixel(drained, W/2, H/2 + 26);
    assert_true(redness(bare) > 60);
    /* Under water the cube shows through, bluer than bare and redder than the water beside it. */
    assert_true(redness(wet) > redness(water) + 10);
    assert_true(redness(wet) < redness(bare) - 10);
    f.mesh_count = 0;
    unsigned char *empty = draw(&f);
    assert_true(abs(redness(pixel(empty, W/2, H/2 - 18))) < 20);
    f = make_frame();
    f.mesh_count = 0;
    unsigned char *water_only = draw(&f);
    assert_true(redness(pixel(water_only, W/2, H/2 - 18)) < 20);
    assert_true(blueness(pixel(water_only, W/2, H/2 + 26)) > 60);
    /* Nothing of it in the corners. */
    assert_int_equal(memcmp(pixel(all, 3, 3), pixel(empty, 3, 3), 3), 0);
    assert_int_equal(memcmp(pixel(all, W - 4, H - 4), pixel(empty, W - 4, H - 4), 3), 0);
    free(all), free(drained), free(empty), free(water_only);
}

/* A cube of glass: what is behind shows through, in the water and above it. */
static void glass_lets_light_through(void **state)
{
    (void)state;
    tobi_picture f = make_frame();
    tobi_picture_mesh m = red_cube;
    unsigned char *opaque = draw(&f);
    f.mesh_count = 0;
    unsigned char *none = draw(&f);
    m.transparency = 0.7f;
    f.meshes = &m, f.mesh_count = 1, f.threads = 1;
    unsigned char *glass = draw(&f);
    f.threads = 3;
    unsigned char *again = draw(&f);
    assert_int_equal(memcmp(glass, again, 3*W*H), 0);
    for (int k = 0; k < 2; k++) {
        const int y = H/2 + (k ? 26 : -18), red = redness(pixel(glass, W/2, y));
        assert_true(red > redness(pixel(none, W/2, y)) + 5 && red < redness(pixel(opaque, W/2, y)) - 10);
    }
    assert_int_equal(memcmp(pixel(none, 3, 3), pixel(glass, 3, 3), 3), 0);
    m.transparency = 1, f.mesh_count = 1, f.particle_count = 0;
    free(draw(&f));
    free(opaque), free(none), free(glass), free(again);
}

/* The eye looks along y at the middle of the cube. What is before a plane across that is gone, and the cut is
   filled, unless the cube is hollow. */
static void a_plane_cuts_bodies(void **state)
{
    (void)state;
    tobi_picture f = make_frame();
    tobi_picture_mesh m = red_cube;
    f.particle_count = 0, f.meshes = &m;
    unsigned char *whole = draw(&f);
    f.clip = 1, f.clip_normal[1] = -2, f.clip_point[1] = 0.5;
    unsigned char *filled = draw(&f);
    m.hollow = 1;
    unsigned char *open = draw(&f);
    f.clip_point[1] = 0.99;
    unsigned char *gone = draw(&f);
    f.clip_point[1] = 0.5, f.slice = 0.1, m.hollow = 0;
    unsigned char *slice = draw(&f);
    int more = 0, less = 0;
    for (int i = 0; i < W*H; i++) {
        const int before = redness(whole + 3*i) > 40, after = redness(filled + 3*i) > 40;
        more += after && !before, less += before && !after;
        if (redness(slice + 3*i) > 60) assert_true(before);
    }
    assert_int_equal(more, 0);            /* the back of the cube is within what its front covers */
    assert_true(less > 50);
    const unsigned char *p = pixel(filled, W/2, H/2), *q = pixel(open, W/2, H/2);
    assert_true(redness(p) > 40 && redness(pixel(slice, W/2, H/2)) > 40 && memcmp(p, q, 3) != 0);
    assert_true(redness(pixel(gone, W/2, H/2)) < 20);
    free(whole), free(filled), free(open), free(gone), free(slice);
}

static int count_different(const unsigned char *a, const unsigned char *b, int *darker)
{
    int n = 0;
    *darker = 0;
    for (int i = 0; i < 3*W*H; i += 3) {
        n += memcmp(a + i, b + i, 3) != 0;
        *darker += a[i] + a[i + 1] + a[i + 2] > b[i] + b[i + 1] + b[i + 2];
    }
    return n;
}

/* Lines of equal value are dark; a path is as red as it should be. */
static void lines_are_drawn(void **state)
{
    (void)state;
    static const double points[3][3] = { { 0.1, 0.2, 0.8 }, { 0.5, 0.2, 0.9 }, { 0.9, 0.2, 0.8 } };
    const tobi_picture_path path = { 3, points, { 1, 0, 0 } };
    int darker;
    tobi_picture f = make_frame();
    f.look = TOBI_LOOK_SURFACE, f.mesh_count = 0;
    f.value_max = 0.4;
    unsigned char *bare = draw(&f);
    f.isolines = 3;
    unsigned char *lines = draw(&f);
    const int n = count_different(bare, lines, &darker);
    print_message("%d pixels of isolines, %d darker\n", n, darker);
    assert_true(n > 100 && n < W*H/8 && darker > n*8/10);
    f.paths = &path, f.path_count = 1, f.look = TOBI_LOOK_NATURAL;
    unsigned char *red = draw(&f);
    int reds = 0;
    for (int i = 0; i < W*H; i++) reds += redness(red + 3*i) > 80;
    assert_true(reds > 100 && reds < 2000);
    free(lines), free(bare), free(red);
}

/* The left half of the block is a green solid, the right half water: only the solid hides the cube. */
static void solids_hide_what_is_behind(void **state)
{
    (void)state;
    static uint8_t opaque[N];
    static float number[N];
    static const float palette[2][3] = { { 0.1f, 0.8f, 0.1f }, { 0.1f, 0.2f, 0.9f } };
    tobi_picture f = make_frame();
    f.opaque = opaque, f.values = number, f.palette = palette, f.palette_count = 2;
    for (int i = 0; i < N; i++) {
        opaque[i] = position[i][0] < 0.5;
        number[i] = !opaque[i];
    }
    int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    unsigned char *with = draw(&f);
    omp_set_num_threads(4);
    unsigned char *again = draw(&f);
    omp_set_num_threads(threads);
    f.mesh_count = 0;
    unsigned char *without = draw(&f);
    const int y = H/2 + 26, left = W/2 - 6, right = W/2 + 6;
    const unsigned char *green = pixel(with, left, y);
    assert_true(green[1] > green[0] + 40 && green[1] > green[2] + 40);
    assert_memory_equal(green, pixel(without, left, y), 3);
    assert_true(redness(pixel(with, right, y)) > redness(pixel(without, right, y)) + 10);
    assert_memory_equal(with, again, 3*W*H);
    free(with);
    free(again);
    free(without);
}

static void threads_and_instructions_do_not_matter(void **state)
{
    (void)state;
    tobi_picture f = make_frame();
    f.threads = 1;
    unsigned char *one = draw(&f);
    for (int k = 0; k < 5; k++) {
        static const char *const isa[] = { "4", "4", "4", "3", "2" };
        static const int threads[] = { 2, 4, 3, 1, 2 };
        setenv("TOBIUO_ISA", isa[k], 1);
        f.threads = threads[k];
        unsigned char *other = draw(&f);
        assert_memory_equal(one, other, 3*W*H);
        free(other);
    }
    setenv("TOBIUO_ISA", "5", 1);
    REFUSED(tobi_picture_write(path, &f, &err), TOBI_INVALID, "TOBIUO_ISA is \"5\"");
    unsetenv("TOBIUO_ISA");
    free(one);
}

static void bytes_are_those_of_the_file(void **state)
{
    (void)state;
    static unsigned char bytes[3*W*H];
    tobi_error err = { 0 };
    tobi_picture f = make_frame();
    unsigned char *file = draw(&f);
    assert_int_equal(tobi_picture_draw(&f, bytes, &err), TOBI_OK);
    assert_memory_equal(file, bytes, 3*W*H);
    free(file);
    REFUSED(tobi_picture_draw(NULL, bytes, &err), TOBI_INVALID, "the picture is NULL");
    REFUSED(tobi_picture_draw(&f, NULL, &err), TOBI_INVALID, "the place for its pixels is NULL");
    f.width = 8;
    REFUSED(tobi_picture_draw(&f, bytes, &err), TOBI_INVALID, "picture: a picture of 8 x 180 pixels");
}

static int count_colour(const unsigned char *p, int channel)
{
    int count = 0;
    for (int i = 0; i < W*H; i++)
        count += p[3*i + channel] > p[3*i + (channel + 1)%3] + 40
            && p[3*i + channel] > p[3*i + (channel + 2)%3] + 40;
    return count;
}

/* Values from blue to red along x: the surface and the particles have both; a clip plane leaves the blue
   half, a slice a part of it. Arrows and axes change the picture. */
static void fields_have_colours(void **state)
{
    (void)state;
    static const float map[2][3] = { { 0.05f, 0.1f, 0.9f }, { 0.9f, 0.1f, 0.05f } };
    static double velocity[N][3];
    tobi_picture f = make_frame();
    f.mesh_count = 0, f.palette = map, f.palette_count = 2, f.value_max = 0.3;
    for (f.look = TOBI_LOOK_SURFACE; f.look <= TOBI_LOOK_PARTICLES; f.look++) {
        f.clip = 0, f.slice = 0;
        unsigned char *all = draw(&f);
        f.clip = 1, f.clip_point[0] = 0.45, f.clip_normal[0] = 2;
        unsigned char *half = draw(&f);
        f.slice = 0.2;
        unsigned char *slice = draw(&f);
        assert_true(count_colour(all, 0) > 300 && count_colour(all, 2) > 300);
        assert_true(count_colour(half, 0) < 30);
        assert_in_range(count_colour(half, 2), 300, count_colour(all, 2) + 200);
        assert_in_range(count_colour(slice, 2) + 10*count_colour(slice, 0), 1, count_colour(half, 2)/2);
        free(all), free(half), free(slice);
    }
    for (int i = 0; i < N; i++) velocity[i][0] = 1;
    f.look = TOBI_LOOK_PARTICLES, f.clip = 0;
    unsigned char *plain = draw(&f);
    f.velocities = (const double (*)[3])velocity;
    unsigned char *arrows = draw(&f);
    f.velocities = NULL, f.axes = 1;
    unsigned char *axes = draw(&f);
    assert_true(mean_difference(plain, arrows) > 0.5);
    assert_true(mean_difference(plain, axes) > 0.1);
    free(plain), free(arrows), free(axes);
}

static void maps_have_names(void **state)
{
    (void)state;
    int count, maps = 0;
    for (const char *name; (name = tobi_color_map_name(maps)); maps++) {
        const float (*map)[3] = tobi_color_map(name, &count);
        assert_non_null(map);
        assert_true(count >= 2);
    }
    assert_int_equal(maps, 5);
    assert_null(tobi_color_map("jet", &count));
    assert_int_equal(count, 0);
    assert_null(tobi_color_map(NULL, &count));
    assert_null(tobi_color_map_name(-1));
}

/* Where nothing is drawn the file has alpha 0, in the middle of the cube 255. */
static void background_is_transparent(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_picture f = make_frame();
    f.transparent = 1;
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_OK);
    png_image image = { .version = PNG_IMAGE_VERSION };
    assert_true(png_image_begin_read_from_file(&image, path));
    image.format = PNG_FORMAT_RGBA;
    unsigned char *p = malloc(PNG_IMAGE_SIZE(image));
    assert_true(png_image_finish_read(&image, NULL, p, 0, NULL));
    assert_int_equal(p[4*(3*W + 3) + 3], 0);
    assert_int_equal(p[4*((H/2 - 18)*W + W/2) + 3], 255);
    free(p);
    f.width = 8;
    REFUSED(tobi_picture_write(path, &f, &err), TOBI_INVALID, "8 x 180 pixels");
}

static void place_does_not_matter(void **state)
{
    (void)state;
    static double moved[N][3], moved_cube[8][3];
    tobi_picture f = make_frame();
    f.has_camera = 0;
    unsigned char *here = draw(&f);
    for (int k = 0; k < 3; k++) {
        f.box_min[k] += far_away[k], f.box_max[k] += far_away[k];
        for (int i = 0; i < N; i++) moved[i][k] = position[i][k] + far_away[k];
        for (int i = 0; i < 8; i++) moved_cube[i][k] = cube[i][k] + far_away[k];
    }
    tobi_picture_mesh m = { 8, moved_cube, 12, side, { 0.9f, 0.1f, 0.1f }, 0, 0, NULL, NULL };
    f.positions = moved, f.meshes = &m;
    unsigned char *there = draw(&f);
    double difference = mean_difference(here, there);
    print_message("mean difference at 10 km: %.4f of 255\n", difference);
    /* Lines of the floor's grid fall elsewhere; depths differ in the last bit. */
    assert_true(difference < 0.2);
    free(here), free(there);
}

static void flat_scenes_are_discs(void **state)
{
    (void)state;
    static const double disc[2][3] = { { 0.5, 0.25, 0 }, { 1.5, 0.75, 0 } };
    static const float value[2] = { 0, 1 };
    tobi_picture f = tobi_default_picture();
    f.width = W, f.height = H, f.dimension = 2;
    f.box_max[0] = 2, f.box_max[1] = 1;
    f.positions = disc, f.values = value, f.particle_count = 2, f.radius = 0.1, f.value_max = 1;
    unsigned char *p = draw(&f);
    double scale = fmin(0.92*W/2, 0.92*H);
    const unsigned char *low = pixel(p, (int)(W/2 - 0.5*scale), (int)(H/2 + 0.25*scale));
    const unsigned char *high = pixel(p, (int)(W/2 + 0.5*scale), (int)(H/2 - 0.25*scale));
    assert_true(low[0] < 10 && abs(low[1] - 41) < 3 && abs(low[2] - 107) < 3);
    assert_true(abs(high[0] - 168) < 3 && abs(high[1] - 245) < 3 && abs(high[2] - 224) < 3);
    f.title = "t = 0.125 s ?%&", f.label = "speed [m/s]";
    unsigned char *labelled = draw(&f);
    assert_true(mean_difference(p, labelled) > 0.5);
    free(p), free(labelled);
}

/* Seen from the front a vessel would hide its water: in 2-D it is an outline. */
static void flat_vessels_are_outlines(void **state)
{
    (void)state;
    tobi_picture f = make_frame();
    double box[8][3];
    for (int k = 0; k < 8; k++)
        for (int a = 0; a < 3; a++) box[k][a] = a < 2 ? cube[k][a] : k/4 - 0.5;
    tobi_picture_mesh m = red_cube;
    m.vertices = (const double (*)[3])box;
    f.dimension = 2, f.particle_count = 0, f.radius = 0.05, f.meshes = &m;
    const int left = (int)(W/2 - 0.095*0.92*H);
    for (m.hollow = 0; m.hollow < 2; m.hollow++) {
        unsigned char *p = draw(&f);
        assert_int_equal(redness(pixel(p, W/2, H/2)) > 60, !m.hollow);
        assert_true(redness(pixel(p, left, H/2)) > 60);
        free(p);
    }
}

/* Values rise to the right: lines in 2-D stand where a quarter, a half and three quarters are. */
static void flat_scenes_have_isolines(void **state)
{
    (void)state;
    static double place[800][3];
    static float value[800];
    for (int i = 0; i < 800; i++) {
        place[i][0] = 0.025 + 0.05*(i%40), place[i][1] = 0.025 + 0.05*(i/40);
        value[i] = (float)(0.5*place[i][0]);
    }
    tobi_picture f = tobi_default_picture();
    f.width = W, f.height = H, f.dimension = 2;
    f.box_max[0] = 2, f.box_max[1] = 1;
    f.positions = (const double (*)[3])place, f.values = value, f.particle_count = 800;
    f.radius = 0.025, f.value_max = 1;
    unsigned char *bare = draw(&f);
    f.isolines = 3;
    unsigned char *lines = draw(&f);
    const double scale = fmin(0.92*W/2, 0.92*H);
    int at[W] = { 0 }, far = 0;
    for (int i = 0; i < W*H; i++) at[i%W] += memcmp(bare + 3*i, lines + 3*i, 3) != 0;
    for (int x = 0; x < W; x++) {
        const double quarters = 2*((x + 0.5 - 0.5*W)/scale + 1);
        if (fabs(quarters - round(quarters)) > 0.1) far += at[x];
        if (fabs(quarters - 2)*scale < 1) assert_true(at[x] > scale/2);
    }
    assert_int_equal(far, 0);
    free(bare), free(lines);
}

/* Not finite, enormous, behind the eye, a camera inside the water, every direction of up: a picture all the
   same. */
static void strange_input_is_drawn(void **state)
{
    (void)state;
    static double wild[64][3];
    const double odd[] = { NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e30, 1e9, -1e5, 0.5 };
    for (int i = 0; i < 64; i++)
        for (int k = 0; k < 3; k++) wild[i][k] = odd[(i*7 + k*(i%5 + 1))%9];
    static float values[64];
    for (int i = 0; i < 64; i++) values[i] = (float)odd[i%9];
    tobi_picture f = make_frame();
    f.positions = wild, f.values = values, f.particle_count = 64;
    f.value_min = f.value_max = 0;
    free(draw(&f));
    double wild_cube[8][3];
    memcpy(wild_cube, cube, sizeof cube);
    wild_cube[0][0] = NAN, wild_cube[1][1] = 1e300, wild_cube[2][2] = -INFINITY, wild_cube[3][0] = 1e8;
    tobi_picture_mesh m = { 8, wild_cube, 12, side, { 2, -1, NAN }, 0, 0, NULL, NULL };
    f.meshes = &m;
    free(draw(&f));
    f = make_frame();
    f.eye[1] = 0.3, f.eye[2] = 0.25;
    free(draw(&f));
    f.eye[0] = 0.5, f.eye[1] = 0.5, f.eye[2] = 5;      /* straight down, along up */
    free(draw(&f));
    f.has_camera = 0;
    for (int k = 0; k < 6; k++) {
        f.up[0] = f.up[1] = f.up[2] = 0;
        f.up[k/2] = k%2 ? -1 : 1;
        free(draw(&f));
    }
    f.samples = 1;
    f.values = NULL;
    f.radius = 3;
    free(draw(&f));
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    tobi_error err;
    remove(path);
    tobi_picture f = make_frame();
    f.width = 8;
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "8 x 180 pixels"));
    f = make_frame(), f.samples = 9;
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_INVALID);
    f = make_frame(), f.dimension = 4;
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_INVALID);
    f = make_frame(), f.box_max[1] = 0;
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_INVALID);
    f = make_frame(), f.radius = 0;
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_INVALID);
    f = make_frame(), f.positions = NULL;
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_INVALID);
    f = make_frame(), f.field_of_view = 0;
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_INVALID);
    f = make_frame(), memcpy(f.eye, f.target, sizeof f.eye);
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_INVALID);
    f = make_frame(), f.isolines = 101;
    REFUSED(tobi_picture_write(path, &f, &err), TOBI_INVALID, "101 isolines, allowed are 0 to 100");
    f = make_frame(), f.path_count = 2;
    REFUSED(tobi_picture_write(path, &f, &err), TOBI_INVALID, "2 paths cannot be drawn");
    tobi_picture_mesh m = { 7, cube, 12, side, { 0, 0, 0 }, 0, 0, NULL, NULL };
    f = make_frame(), f.meshes = &m;
    assert_int_equal(tobi_picture_write(path, &f, &err), TOBI_INVALID);
    assert_non_null(strstr(err.text, "uses vertex 7 of 7"));
    REFUSED(tobi_picture_write(NULL, &f, &err), TOBI_INVALID, "the path is NULL");
    REFUSED(tobi_picture_write(path, NULL, &err), TOBI_INVALID, "the picture is NULL");
    f = make_frame(), f.palette = &red_cube.color, f.palette_count = 0;
    REFUSED(tobi_picture_write(path, &f, &err), TOBI_INVALID, "a palette of 0 colours, at least 1");
    f = make_frame(), f.look = 3;
    REFUSED(tobi_picture_write(path, &f, &err), TOBI_INVALID, "there is no look 3");
    f = make_frame(), f.clip = 1;
    REFUSED(tobi_picture_write(path, &f, &err), TOBI_INVALID,
            "the normal of the clip plane has no direction");
    f = make_frame(), f.meshes = NULL;
    REFUSED(tobi_picture_write(path, &f, &err), TOBI_INVALID, "1 bodies cannot be drawn");
    m.triangles = NULL, f = make_frame(), f.meshes = &m;
    REFUSED(tobi_picture_write(path, &f, &err), TOBI_INVALID, "body 0 has no vertices or no triangles");
    f = make_frame();
    assert_int_equal(tobi_picture_write("/no/such/a.png", &f, &err), TOBI_IO);
    assert_string_equal(err.text, "cannot write /no/such/a.png: No such file or directory");
    assert_int_not_equal(access(path, F_OK), 0);
}

static void full_disk_leaves_nothing(void **state)
{
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    tobi_picture f = make_frame();
    remove(path);
    for (rlim_t size = 0; size < 6000; size += 1500) {
        struct rlimit limit = { size, before.rlim_max };
        tobi_error err;
        setrlimit(RLIMIT_FSIZE, &limit);
        tobi_status status = tobi_picture_write(path, &f, &err);
        setrlimit(RLIMIT_FSIZE, &before);
        assert_int_equal(status, TOBI_IO);
        assert_non_null(strstr(err.text, "a.png: File too large"));
        assert_int_not_equal(access(path, F_OK), 0);
    }
}

static int set_up(void **state)
{
    (void)state;
    fill();
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/a.png", folder);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    remove(path);
    return rmdir(folder);     /* fails if a .part file was left */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(things_are_where_they_belong),
            cmocka_unit_test(threads_and_instructions_do_not_matter),
        cmocka_unit_test(place_does_not_matter), cmocka_unit_test(bytes_are_those_of_the_file),
        cmocka_unit_test(fields_have_colours), cmocka_unit_test(maps_have_names),
        cmocka_unit_test(background_is_transparent), cmocka_unit_test(glass_lets_light_through),
        cmocka_unit_test(a_plane_cuts_bodies), cmocka_unit_test(lines_are_drawn),
            cmocka_unit_test(flat_scenes_are_discs),
        cmocka_unit_test(flat_vessels_are_outlines), cmocka_unit_test(flat_scenes_have_isolines),
        cmocka_unit_test(strange_input_is_drawn), cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(solids_hide_what_is_behind), cmocka_unit_test(full_disk_leaves_nothing)
    };
    return cmocka_run_group_tests_name("view/picture", tests, set_up, tear_down);
}
