/* What every method does to its particles. */
#include "core/system.h"
#include "core/opening.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

void tobi_account_add(tobi_account *a, const char *name, int64_t bytes)
{
    int k = 0;
    while (k < a->count && strcmp(a->name[k], name) != 0) k++;
    if (bytes == 0 || k == TOBI_ACCOUNT_LIMIT) return;
    if (k == a->count) a->name[a->count++] = name, a->bytes[k] = 0;
    a->bytes[k] += bytes;
}

int tobi_system_memory(tobi_system *s, double **values)
{
    if (s->method->memory) return s->method->memory(s, values);
    *values = &s->info.speed_max;
    return 1;
}

/* totals: kinetic, potential, momentum x y z, mass. Potential against the box's lower corner. */
static void measure_range(const void *view, int64_t begin, int64_t end, double *t)
{
    const tobi_system *s = view;
    for (int64_t i = begin; i < end; i++) {
        double m = s->method->mass ? s->method->mass(s, i)
                                   : s->smoothing.volume*s->fluid[s->particles.fluid[i]].density;
        tobi_float4 v = s->particles.velocity[i];
        const double *x = &s->particles.position[i].x;
        t[0] += 0.5*m*((double)v.x*v.x + (double)v.y*v.y + (double)v.z*v.z);
        for (int a = 0; a < s->box.dimension; a++) t[1] -= m*s->sim->def.gravity[a]*x[a];
        t[2] += m*v.x; t[3] += m*v.y; t[4] += m*v.z;
        t[5] += m;
    }
}

void tobi_system_measure(tobi_system *s)
{
    double t[TOBI_TOTALS], g2 = 0;
    tobi_launch(&s->sim->exec, TOBI_HOST(measure_range, 6, 0), s, 0, s->particles.count, t);
    for (int a = 0; a < s->box.dimension; a++) g2 += s->sim->def.gravity[a]*s->sim->def.gravity[a];
    s->info.kinetic_energy = t[0];
    s->info.potential_energy = t[1];
    for (int a = 0; a < 3; a++) s->info.momentum[a] = t[2 + a];
    s->info.mass_held = t[5];
    s->info.weight = t[5]*sqrt(g2);
}

tobi_status tobi_system_room(tobi_system *s, int64_t rows, tobi_error *err)
{
    if (rows <= s->particles.capacity) return TOBI_OK;
    TOBI_TRY(tobi_particles_room(&s->particles, rows, err));
    TOBI_TRY(tobi_exec_reserve(&s->sim->exec, s->particles.capacity, err));    /* more rows fill it later */
    if (s->method->inserted) s->method->inserted(s);
    return s->method->solids ? TOBI_OK : tobi_cells_grow(&s->cells, &s->particles, err);
}

tobi_status tobi_system_insert(tobi_system *s, int64_t count, int64_t *first, tobi_error *err)
{
    tobi_particles *p = &s->particles;
    tobi_simulation *w = s->sim;
    TOBI_TRY(tobi_system_room(s, p->count + count, err));
    p->next_id = w->next_id - s->first_id;
    TOBI_TRY(tobi_particles_insert(p, count, first, err));
    w->next_id += count;
    s->info.fluid_particles = p->count;
    if (s->method->inserted) s->method->inserted(s);
    return TOBI_OK;
}

void tobi_system_densities(const tobi_system *s, double *least, double *most)
{
    *least = INFINITY;
    *most = 0;
    for (int f = 0; f < s->fluid_count; f++) {
        *least = fmin(*least, s->fluid[f].density);
        *most = fmax(*most, s->fluid[f].density);
    }
}

double tobi_system_density_ratio(const tobi_system *s)
{
    double least, most;
    tobi_system_densities(s, &least, &most);
    return most > 0 ? most/least : 1;
}

int tobi_system_is_mixed(const tobi_system *s)
{
    for (int a = 1; a < s->fluid_count; a++) {
        const tobi_fluid *f = &s->fluid[a];
        if (f->density != s->fluid[0].density || f->viscosity != s->fluid[0].viscosity) return 1;
        for (int b = 0; b < a; b++)
            if (f->interface_tension[b] > 0) return 1;
    }
    return 0;
}

double tobi_system_capillary(const tobi_system *s)
{
    double most = 0;
    for (int f = 0; f < s->fluid_count; f++) {
        const tobi_fluid *fluid = &s->fluid[f];
        most = fmax(most, fluid->tension/(fluid->density*s->smoothing.spacing));
        for (int b = 0; b < s->fluid_count; b++)
            most = fmax(most, fluid->interface_tension[b]/(fluid->density*s->smoothing.spacing));
    }
    return most;
}

/* Largest pressure that an outlet gives over the density, m2/s2: by it liquid comes in. */
static double opening_head(const tobi_system *s)
{
    const double *gravity = s->sim->def.gravity;
    double most = 0, size = 0, floor = 0;
    for (int a = 0; a < s->box.dimension; a++) {
        const double lower = s->box.lower[a];
        size += gravity[a]*gravity[a];
        floor += fmax(gravity[a]*lower, gravity[a]*(lower + s->box.size[a]));
    }
    for (int k = 0; k < s->sim->opening_count; k++) {
        const tobi_opening *o = &s->sim->openings[k];
        if (o->gives == TOBI_GIVES_PRESSURE) most = fmax(most, o->pressure/s->fluid[0].density);
        if (o->gives == TOBI_GIVES_LEVEL) most = fmax(most, sqrt(size)*o->level + floor);
    }
    return most;
}

/* All of a flow as a jet one spacing wide: out of a place of two it contracts to 0.61 of it (Kirchhoff 1869),
   and goes in one row. At most TOBI_NARROWEST times as fast as the fastest that feeds it. */
static double narrow_speed(const tobi_system *s, double flow, double fastest)
{
    return fmin(flow/pow(s->smoothing.spacing, s->box.dimension - 1), TOBI_NARROWEST*fastest);
}

static double inlet_speed(const tobi_system *s)
{
    const int dimension = s->box.dimension;
    double flow = 0, fastest = 0;
    for (int k = 0; k < s->sim->opening_count; k++) {
        const tobi_opening *o = &s->sim->openings[k];
        if (o->outlet) continue;
        flow += o->speed*tobi_opening_area(o, dimension);
        fastest = fmax(fastest, o->speed);
    }
    return narrow_speed(s, flow, fastest);
}

/* The flow that a body's wet points push, m3/s; *fastest is raised to their speed. */
static double pushed_flow(const tobi_body *b, double *fastest)
{
    double flow = 0;
    for (int64_t k = 0; k < b->point_count; k++) {
        const double speed = b->wet[k] ? vec3_dot(b->normal[k], b->point_velocity[k]) : 0;
        if (!(speed > 0)) continue;
        flow += b->area[k]*speed;
        *fastest = fmax(*fastest, speed);
    }
    return flow;
}

/* A free jet is no faster than the pressure on what pushes it explains: the work of a rigid body is its flow
   times that pressure. */
double tobi_system_pushed_speed(const tobi_system *s)
{
    double least, most, flow = 0, fastest = 0, head = 0;
    for (int k = 0; k < s->sim->body_count; k++) {
        const tobi_body *b = &s->sim->bodies[k];
        const tobi_body_info *i = &b->info;
        if (b->rigid.kind != TOBI_PRESCRIBED || !b->motion) continue;
        const double own = pushed_flow(b, &fastest);
        const double work = vec3_dot(i->pressure_force, i->velocity)
            + vec3_dot(i->pressure_torque, i->angular_velocity);
        if (own > 0) head = fmax(head, b->deforms ? INFINITY : -work/own);
        flow += own;
    }
    if (!(flow > 0)) return 0;
    tobi_system_densities(s, &least, &most);
    return fmin(narrow_speed(s, flow, fastest), sqrt(2*head/least));
}

/* Spacings in a step: what moves less is at rest but for rounding, though nothing drives it. Beside bodies
   that move by forces it is no runaway: motors, springs and programs move them within the step, and their
   speed is known at its end. */
static const double STILL = 1e-6, STILL_BESIDE_BODIES = 0.1;

/* m2/s2 */
static double fall_head(const tobi_system *s)
{
    double fall = opening_head(s);
    for (int a = 0; a < s->box.dimension; a++) fall += tobi_simulation_pull(s->sim, a)*s->box.size[a];
    return fall;
}

double tobi_system_fall_speed(const tobi_system *s) { return sqrt(2*fall_head(s)); }

double tobi_system_speed_scale(const tobi_system *s)
{
    const double fall = fall_head(s);
    const double brought = fmax(2*s->start_speed, fmax(inlet_speed(s), s->pushed_speed));
    const double scale = sqrt(2*fall + 8*tobi_system_capillary(s)) + s->sim->body_speed + brought;
    const int driven = tobi_body_any_free(s->sim->bodies, s->sim->body_count);
    const double still = driven ? STILL_BESIDE_BODIES : STILL;
    return s->dt > 0 ? fmax(scale, still*s->smoothing.spacing/s->dt) : scale;
}
