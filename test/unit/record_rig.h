/* What tests of the recorder share: a folder, files in it, and a tiny tank of water with cubes. */
#pragma once
#include "tobiuo/run.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

static char folder[] = "/tmp/tobiuo_record_XXXXXX";

/* A path below the test's folder, valid until the fourth call after. */
static inline const char *at(const char *format, ...) __attribute__((format(printf, 1, 2)));
static inline const char *at(const char *format, ...)
{
    static char paths[4][512];
    static int turn;
    char *path = paths[turn++ % 4];
    int n = snprintf(path, sizeof paths[0], "%s/", folder);
    va_list args;
    va_start(args, format);
    vsnprintf(path + n, sizeof paths[0] - (size_t)n, format, args);
    va_end(args);
    return path;
}

static inline bool exists(const char *path) { return access(path, F_OK) == 0; }

static inline void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* Whole file, ended by a zero; the caller frees. */
static inline char *read_file(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    if (!file) fail_msg("%s is missing", path);
    char *text = calloc(1, 1 << 22);
    *length = fread(text, 1, (1 << 22) - 1, file);
    fclose(file);
    return text;
}

static inline void assert_same_file(const char *a, const char *b)
{
    size_t m, n;
    char *x = read_file(a, &m), *y = read_file(b, &n);
    if (m != n || memcmp(x, y, m) != 0) fail_msg("%s and %s differ", a, b);
    free(x);
    free(y);
}

static inline int count_rows(const char *path)
{
    size_t n;
    int rows = -1;      /* the header */
    char *text = read_file(path, &n);
    for (size_t k = 0; k < n; k++) rows += text[k] == '\n';
    free(text);
    return rows;
}

static inline tobi_status swing(void *user, double t, int64_t n, const double (*rest)[3],
                         double (*position)[3], tobi_error *err)
{
    (void)user;
    (void)err;
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++)
            position[i][a] = rest[i][a] + (a == 0 ? 0.01 * sin(20 * t) : 0.0);
    return TOBI_OK;
}

/* A tank of water with `bodies` cubes of the given names in it. */
static inline tobi_world *make_world(int bodies, const char *const *names)
{
    tobi_error err = { 0 };
    tobi_world *world = NULL;
    tobi_world_def w = tobi_default_world_def();
    const double low[3] = { -0.06, -0.04, 0.0 }, high[3] = { 0.06, 0.04, 0.1 },
                 g[3] = { 0, 0, -9.81 };
    memcpy(w.domain_min, low, sizeof low);
    memcpy(w.domain_max, high, sizeof high);
    memcpy(w.gravity, g, sizeof g);
    w.spacing = 0.01;
    w.threads = 1;
    if (tobi_world_create(&w, NULL, &world, &err)) fail_msg("%s", err.text);
    tobi_fluid_def water = tobi_default_fluid_def();
    water.name = "water";
    water.density = 1000;
    tobi_fill_def fill = tobi_default_fill_def();
    memcpy(fill.box_min, low, sizeof low);
    memcpy(fill.box_max, high, sizeof high);
    fill.box_max[2] = 0.06;
    if (tobi_world_add_fluid(world, &water, &fill, 1, &err)) fail_msg("%s", err.text);
    for (int k = 0; k < bodies; k++) {
        tobi_body_def body = tobi_default_body_def();
        body.name = names[k];
        body.mesh = at("cube.obj");
        body.translation[0] = -0.03 + 0.03 * k;
        body.translation[2] = 0.03;
        body.density = 1000;
        body.spacing = 0.002;
        body.motion = swing;
        body.motion_rigid = 1;
        if (tobi_world_add_body(world, &body, &err)) fail_msg("%s", err.text);
    }
    return world;
}

static inline tobi_output_def make_output(void)
{
    tobi_output_def output = tobi_default_output_def();
    output.interval = 0.004;
    return output;
}

static inline tobi_run *create(tobi_world *world, const tobi_output_def *output, const char *dir,
                        int force)
{
    tobi_run *run = NULL;
    tobi_error err = { 0 };
    if (tobi_run_create(world, output, dir, force, "{}\n", &run, &err)) fail_msg("%s", err.text);
    return run;
}

static inline void step_until(tobi_run *run, double end)
{
    tobi_error err = { 0 };
    while (!tobi_run_done(run, end))
        if (tobi_run_step(run, end, NULL, &err)) fail_msg("%s", err.text);
}

static inline void expect_failure(tobi_status expected, const char *part, const tobi_output_def *output,
                           const char *dir)
{
    tobi_world *world = make_world(0, NULL);
    tobi_run *run = NULL;
    tobi_error err = { 0 };
    assert_int_equal(tobi_run_create(world, output, dir, 0, NULL, &run, &err), expected);
    if (!strstr(err.text, part)) fail_msg("'%s' without '%s'", err.text, part);
    assert_null(run);
    tobi_world_destroy(world);
}

static inline int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder)) return -1;
    char text[600] = "";
    for (int k = 0; k < 8; k++) {
        const double h = 0.01;
        sprintf(text + strlen(text), "v %g %g %g\n", k & 1 ? h : -h, k & 2 ? h : -h,
                k & 4 ? h : -h);
    }
    strcat(text, "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    write_file(at("cube.obj"), text);
    return 0;
}

static inline int remove_folder(void **state)
{
    (void)state;
    char command[600];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}
