/* The terms of isph per particle, for output: computed when they are asked for, at the present positions, as
   the next step begins. Drawback: forces are computed once more for each; bodies that move by forces count
   with the velocities they have. */
#include "base/language.h"
#include "sph/isph/fields.h"
#include "sph/boundary/boundary.h"
#include "sph/fields.h"
#include "sph/isph/bodies.h"
#include "sph/viscosity.h"
#include <math.h>
#include <string.h>

const tobi_output isph_outputs[] = {
    { TR("acceleration"), 3, "m/s2", 1 }, { TR("vorticity"), 3, "1/s", 1 },
    { TR("surface"), 1, "1", 0 }, { TR("apparent_viscosity"), 1, "Pa s", 1 },
    { TR("material"), 1, "1", 0 }, { TR("temperature"), 1, "degC", 0 },
    { TR("concentration"), 1, "1", 0 }, { TR("viscous_acceleration"), 3, "m/s2", 1 },
    { TR("pressure_acceleration"), 3, "m/s2", 1 }, { TR("divergence"), 1, "1/s", 1 },
    { TR("predicted_divergence"), 1, "1/s", 1 }, { TR("pressure_source"), 1, "Pa/m2", 1 },
    { TR("predicted_density"), 1, "kg/m3", 1 }, { TR("surface_gate"), 1, "1", 1 },
    { TR("surface_normal"), 3, "1", 1 }, { NULL, 0, NULL, 0 }
};

static int is(const char *a, const char *b) { return strcmp(a, b) == 0; }

int isph_fields_know(const char *field)
{
    for (const tobi_output *o = isph_outputs; o->name; o++)
        if (is(o->name, field))
            return o->derived && !is(field, "acceleration") && !is(field, "vorticity") &&
                   !is(field, "apparent_viscosity");
    return 0;
}

static void launch(tobi_system *s, isph_solver *m, tobi_kernel k)
{
    tobi_launch(&s->sim->exec, k, &m->view, 0, s->particles.count, NULL);
}

/* Viscosity and friction of a step dt, s, into the velocities; `saved_velocity` has those before. */
static void add_viscosity(tobi_system *s, isph_solver *m, const sph_view *shared, double dt)
{
    sph_view v = *shared;
    const double step = s->dt;
    const int corrected = m->def->viscosity_form != TOBI_VISCOSITY_PLAIN;
    v.dt = (float)dt;
    v.filter = 0;
    for (int a = 0; a < 3; a++) v.gravity[a] = 0;
    v.acceleration.acts = 0;
    v.scalar.lift.acts = 0;
    s->dt = m->view.dt = dt;
    if (corrected) launch(s, m, m->kernel->isph_viscosity);
    sph_viscosity_begin(s, &v, m->kernel);
    tobi_launch(&s->sim->exec, m->kernel->sph_laplacian, &v, 0, s->particles.count, NULL);
    tobi_launch(&s->sim->exec, m->kernel->sph_kick, &v, 0, s->particles.count, NULL);
    if (s->sim->body_count > 0) {
        tobi_boundary_add_forces(s);
        isph_bodies_remove_hydrostatic(s);
    }
    sph_viscosity_add(s, &v, m->kernel);
    if (corrected) launch(s, m, m->kernel->isph_add_shift_velocity);
    s->dt = m->view.dt = step;
}

/* What the velocities have gained over dt, s, into accel. */
static void read_gain(tobi_system *s, const tobi_float4 *before, double dt)
{
    const tobi_float4 *u = s->particles.velocity;
    tobi_float4 *out = sph_fields_of(&s->particles)->accel;
    for (int64_t i = 0; i < s->particles.count; i++)
        for (int a = 0; a < 3; a++)
            (&out[i].x)[a] = (float)((double)((&u[i].x)[a] - (before ? (&before[i].x)[a] : 0))/dt);
}

static void read_pressure(tobi_system *s, isph_solver *m)
{
    tobi_particles *p = &s->particles;
    for (int64_t i = 0; i < p->count; i++) {
        s->cells.record[i].w = m->view.pressure[i];
        p->velocity[i] = (tobi_float4){0, 0, 0, 0};
    }
    launch(s, m, m->kernel->isph_projection);
    read_gain(s, NULL, m->view.dt);
}

static void read_viscosity(tobi_system *s, isph_solver *m, const sph_view *shared, const tobi_float4 *kept)
{
    add_viscosity(s, m, shared, 1);
    read_gain(s, kept, 1);
}

/* The velocities that the pressure equation gets, their divergence, and the source: 0 before there is a step,
   by which it is divided. */
static void predict(tobi_system *s, isph_solver *m, const sph_view *shared, int source)
{
    tobi_float4 *out = sph_fields_of(&s->particles)->accel;
    add_viscosity(s, m, shared, m->view.dt);
    launch(s, m, m->kernel->isph_gravity);
    m->view.gravity_dt = (float)m->view.dt;
    launch(s, m, m->kernel->isph_divergence);
    if (source && m->view.dt > 0) launch(s, m, m->kernel->isph_rows);
    m->view.gravity_dt = 0;
    for (int64_t i = 0; source && i < s->particles.count; i++)
        out[i].x = m->view.dt > 0 ? (float)m->view.source[i] : 0;
}

static void read_geometry(tobi_system *s, const isph_view *v, int normal)
{
    tobi_float4 *out = sph_fields_of(&s->particles)->accel;
    for (int64_t i = 0; i < s->particles.count; i++) {
        const tobi_float4 c = v->concentration_gradient[i];
        const float size = sqrtf(c.x*c.x + c.y*c.y + c.z*c.z) + 1e-20f;
        out[i] = (tobi_float4){v->gate[i], 0, 0, 0};
        if (normal) out[i] = (tobi_float4){-c.x/size, -c.y/size, -c.z/size, 0};
    }
}

/* accel has the predicted divergence. */
static void read_density(tobi_system *s, const isph_view *v)
{
    tobi_float4 *out = sph_fields_of(&s->particles)->accel;
    for (int64_t i = 0; i < s->particles.count; i++)
        out[i].x = (float)(v->density*(1 + v->volume_sum*(v->concentration[i] - 1.0) -
                                       v->volume_change*v->dt*out[i].x));
}

void isph_fields_derive(isph_solver *m, tobi_system *s, const sph_view *shared, const char *field)
{
    tobi_particles *p = &s->particles;
    tobi_float4 *kept = sph_fields_of(p)->saved_velocity;
    const size_t bytes = (size_t)p->count*sizeof *kept;
    memcpy(kept, p->velocity, bytes);
    if (is(field, "surface_gate") || is(field, "surface_normal"))
        read_geometry(s, &m->view, is(field, "surface_normal"));
    else if (is(field, "divergence")) launch(s, m, m->kernel->isph_divergence);
    else if (is(field, "pressure_source")) predict(s, m, shared, 1);
    else if (is(field, "viscous_acceleration")) read_viscosity(s, m, shared, kept);
    else if (is(field, "pressure_acceleration")) read_pressure(s, m);
    else predict(s, m, shared, 0);
    if (is(field, "predicted_density")) read_density(s, &m->view);
    memcpy(p->velocity, kept, bytes);
}

void isph_fields_read(const tobi_system *s, const char *field, int64_t i, double *out)
{
    const tobi_float4 *a = &sph_fields_of(&s->particles)->accel[i];
    out[0] = a->x;
    for (const tobi_output *o = isph_outputs; o->name; o++)
        if (is(o->name, field) && o->components == 3) {
            out[1] = a->y;
            out[2] = a->z;
        }
}
