/* A few bodies and a clock, without a world: what a method that has no particles would do. */
#pragma once
#include "rigid/dynamics.h"
#include "geom/vec3.h"
#include "tobiuo/tobiuo.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

typedef struct rig {
    tobi_body *bodies;
    int count;
    tobi_box box;
    tobi_rigid_world world;
    tobi_constraints joints;
    tobi_dynamics_state *state;
    double time;
    char notes[4000];
} rig;

static inline void rig_open(rig *g, double size, const double gravity[3])
{
    static const int periodic[3];
    double lower[3] = { 0, 0, 0 }, upper[3] = { size, size, size };
    memset(g, 0, sizeof *g);
    tobi_box_init(&g->box, 3, lower, upper, periodic, 0.1*size);
    g->world.dimension = 3;
    g->world.threads = 1;
    for (int a = 0; a < 3; a++) {
        g->world.gravity[a] = gravity[a];
        g->world.size[a] = size;
        g->world.wall[a] = 3;
    }
    g->world.constraints = &g->joints;
}

static inline tobi_body_def rig_def(void)
{
    tobi_body_def def = tobi_default_body_def();
    def.dynamics = TOBI_FREE;
    def.spacing = 1;
    return def;
}

/* A body; names are b0, b1, ... */
static inline tobi_body *rig_add(rig *g, const tobi_body_def *def)
{
    tobi_body_def named = *def;
    tobi_error err = { 0 };
    char name[16];
    snprintf(name, sizeof name, "b%d", g->count);
    named.name = name;
    g->bodies = realloc(g->bodies, (size_t)(g->count + 1)*sizeof *g->bodies);
    if (tobi_body_create(&g->bodies[g->count], &named, &g->box, 0.5, &err) != TOBI_OK)
        fail_msg("%s", err.text);
    return &g->bodies[g->count++];
}

/* A box of three sides around a middle. */
static inline tobi_body *rig_box(rig *g, tobi_body_def def, const double side[3], const double middle[3])
{
    for (int a = 0; a < 3; a++) {
        def.box_min[a] = -0.5*side[a];
        def.box_max[a] = 0.5*side[a];
        def.translation[a] = middle[a];
    }
    return rig_add(g, &def);
}

static inline tobi_body *rig_ball(rig *g, tobi_body_def def, double radius, const double middle[3])
{
    def.mesh = TOBI_SOURCE_DIR "/test/meshes/sphere.obj";
    for (int a = 0; a < 3; a++) {
        def.scale[a] = 2*radius;
        def.translation[a] = middle[a];
    }
    return rig_add(g, &def);
}

static inline void rig_start(rig *g)
{
    tobi_error err = { 0 };
    if (tobi_constraints_start(&g->joints, g->bodies, g->world.dimension, &err) != TOBI_OK)
        fail_msg("%s", err.text);
    if (tobi_rigid_start(g->bodies, g->count, &g->world, g->notes, sizeof g->notes, &g->state, &err) !=
        TOBI_OK)
        fail_msg("%s", err.text);
}

static inline void rig_step(rig *g, double dt)
{
    tobi_error err = { 0 };
    double speed = 0;
    tobi_status status = TOBI_OK;
    for (int k = 0; k < g->count && status == TOBI_OK; k++)
        status = tobi_body_predict(&g->bodies[k], g->time, dt, &speed, &err);
    if (status == TOBI_OK) status = tobi_constraints_close(&g->joints, g->bodies, g->time, dt, &err);
    for (int k = 0; k < g->count && status == TOBI_OK; k++)
        status = tobi_body_advance(&g->bodies[k], g->time + dt, dt, &err);
    g->time += dt;
    if (status == TOBI_OK) status = tobi_rigid_step(g->state, g->time, dt, &err);
    if (status != TOBI_OK) fail_msg("%s", err.text);
}

/* As a world does: steps no longer than the bodies allow. */
static inline void rig_advance(rig *g, double time)
{
    for (double left = time; left > 1e-12;) {
        double parts = ceil(left/tobi_rigid_step_limit(g->state) - 1e-9), dt = left/parts;
        rig_step(g, dt);
        left -= dt;
    }
}

static inline double rig_energy(const rig *g)
{
    double sum = 0;
    for (int k = 0; k < g->count; k++)
        if (g->bodies[k].rigid.kind != TOBI_PRESCRIBED) sum += tobi_rigid_kinetic_energy(&g->bodies[k].rigid);
    return sum;
}

static inline void rig_close(rig *g)
{
    tobi_rigid_free(g->state);
    tobi_constraints_free(&g->joints);
    for (int k = 0; k < g->count; k++) tobi_body_free(&g->bodies[k]);
    free(g->bodies);
}
