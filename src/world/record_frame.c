/* The picture of an output: water coloured by speed, bodies by number, seen so that the box fits. */
#include "io/frame.h"
#include "world/record.h"
#include "world/world.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float body_colors[][3] = {
    { 0.93f, 0.62f, 0.28f }, { 0.80f, 0.33f, 0.36f }, { 0.55f, 0.70f, 0.35f }, { 0.62f, 0.50f, 0.74f },
};
enum { COLOR_COUNT = sizeof body_colors / sizeof *body_colors };

typedef struct drawing {
    double *positions, *velocities;    /* n x 3        */
    float *speeds;                     /* n            */
    tobi_frame_mesh *meshes;
} drawing;

static void free_drawing(drawing *d)
{
    free(d->positions);
    free(d->velocities);
    free(d->speeds);
    free(d->meshes);
}

static tobi_status read_fluid(tobi_run *run, int64_t n, drawing *d, tobi_error *err)
{
    d->positions = malloc((size_t)n * 3 * sizeof *d->positions + 1);
    d->velocities = malloc((size_t)n * 3 * sizeof *d->velocities + 1);
    d->speeds = malloc((size_t)n * sizeof *d->speeds + 1);
    if (!d->positions || !d->velocities || !d->speeds)
        return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    TOBI_TRY(tobi_world_read(run->world, TOBI_FLUID, "position", d->positions, 3 * n, err));
    TOBI_TRY(tobi_world_read(run->world, TOBI_FLUID, "velocity", d->velocities, 3 * n, err));
    for (int64_t i = 0; i < n; i++) {
        const double *v = d->velocities + 3 * i;
        d->speeds[i] = (float)sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    }
    return TOBI_OK;
}

static tobi_status read_meshes(tobi_run *run, int count, drawing *d, tobi_error *err)
{
    d->meshes = calloc((size_t)count + 1, sizeof *d->meshes);
    if (!d->meshes) return tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    for (int b = 0; b < count; b++) {
        tobi_frame_mesh *m = &d->meshes[b];
        TOBI_TRY(tobi_world_surface(run->world, b, &m->vertex_count, &m->vertices, &m->triangle_count,
                                    &m->triangles));
        memcpy(m->color, body_colors[b % COLOR_COUNT], sizeof m->color);
    }
    return TOBI_OK;
}

/* Half the speed of a fall through the domain: the same colours in every picture of a run. */
static double color_speed(const tobi_world_def *def)
{
    double work = 0.0;
    for (int a = 0; a < def->dimension; a++)
        work += fabs(def->gravity[a]) * (def->domain_max[a] - def->domain_min[a]);
    return 0.5 * sqrt(2.0 * work);
}

static tobi_status draw(tobi_run *run, const char *path, drawing *d, tobi_error *err)
{
    const tobi_world_def *def = &run->world->sim.def;
    char title[64];
    tobi_frame frame = tobi_default_frame();
    frame.dimension = def->dimension;
    for (int a = 0; a < 3; a++) {
        frame.box_min[a] = def->domain_min[a];
        frame.box_max[a] = def->domain_max[a];
        frame.up[a] = -def->gravity[a];
    }
    frame.particle_count = tobi_world_count(run->world, TOBI_FLUID);
    frame.mesh_count = tobi_world_body_count(run->world);
    TOBI_TRY(read_fluid(run, frame.particle_count, d, err));
    TOBI_TRY(read_meshes(run, frame.mesh_count, d, err));
    frame.positions = (const double (*)[3])d->positions;
    frame.values = d->speeds;
    frame.radius = 0.5 * def->spacing;
    frame.value_max = color_speed(def);
    frame.meshes = d->meshes;
    snprintf(title, sizeof title, "t = %.4f s", tobi_world_time(run->world));
    frame.title = title;
    frame.label = "speed [m/s]";
    return tobi_frame_write(path, &frame, err);
}

tobi_status tobi_record_frame(tobi_run *run, tobi_error *err)
{
    drawing d = { 0 };
    char *path = tobi_record_path(run->dir, "frames/frame_%06lld.png", (long long)run->outputs);
    tobi_status status = path ? draw(run, path, &d, err)
                              : tobi_fail(err, TOBI_NO_MEMORY, "picture: out of memory");
    free_drawing(&d);
    free(path);
    return status;
}
