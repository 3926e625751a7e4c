/* Free flight: particles that only fall, slowed by the air. The smallest method there is, kept to show what a
   method needs, and as a test that it needs no more: this folder and a line in a list of methods. */
#include "base/param_rows.h"
#include "core/system.h"
#include <math.h>

typedef struct free_flight_def { double drag; } free_flight_def;

static const tobi_param rows[] = {
    { .key = "drag", REAL, AT(free_flight_def, drag), RANGE(0, 1000), .unit = "1/s",
      .doc = "Rate at which the air slows a particle." },
    { 0 }
};
static const tobi_param_table table = {
    "free_flight", "Particles that fall.", sizeof(free_flight_def), rows };

#define FIELDS(X) X(float, TOBI_F32, 1, path, TOBI_STATE, 0, "m", "way flown since the start")
typedef struct fields { FIELDS(TOBI_FIELD_POINTER) } fields;
#define ROW(...) TOBI_FIELD_ROW(fields, __VA_ARGS__)
static const tobi_field field[] = { FIELDS(ROW) };
static const tobi_field_list list = { field, 1, sizeof(fields) };
static const tobi_output outputs[] = { { "path", 1, "m", 0 }, { NULL, 0, NULL, 0 } };

static double max_dt(tobi_system *s)
{
    return s->sim->def.cfl*s->smoothing.spacing/fmax(s->info.speed_max, 1);
}

/* From (x, v) to those of the same parabola a step later, then the drag: totals[6] the largest speed. */
static void fly(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_system *s = view;
    const double dt = s->dt, keep = exp(-((const free_flight_def *)s->def)->drag*dt);
    for (int64_t i = begin; i < end; i++) {
        double *x = &s->particles.position[i].x, way = 0, speed = 0;
        float *v = &s->particles.velocity[i].x;
        for (int a = 0; a < s->box.dimension; a++) {
            const double g = s->sim->def.gravity[a], step = dt*(v[a] + 0.5*g*dt);
            x[a] += step;
            v[a] = (float)(keep*(v[a] + g*dt));
            way += step*step;
            speed += (double)v[a]*v[a];
        }
        ((const fields *)s->particles.own)->path[i] += (float)sqrt(way);
        totals[6] = fmax(totals[6], sqrt(speed));
    }
}

static void move(tobi_system *s)
{
    double t[TOBI_TOTALS];
    tobi_launch(&s->sim->exec, TOBI_HOST(fly, 0, 1), s, 0, s->particles.count, t);
    s->info.speed_max = t[6];
}

const tobi_method tobi_free_flight = {
    .name = "free_flight", .doc = "Particles that only fall.", .params = &table, .fields = &list,
    .outputs = outputs, .max_dt = max_dt, .move = move,
};
