/* The world's temperature and concentration: added by definition after fluids, bodies and inlets. Drawback:
   every liquid of a world has both, with one diffusivity. */
#include "base/error.h"
#include "base/param.h"
#include "world/names.h"
#include "world/scalars.h"
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define REFUSE(key, ...) return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, __VA_ARGS__), "%s", key)

static const char *const field_name[] = { "temperature", "concentration" };
static const char *const field_unit[] = { "degC", "1" };
static const char *const side_name[] = { "x_min", "x_max", "y_min", "y_max", "z_min", "z_max" };

/* Half the density at most: beyond it a change of weight is no small one. */
static const double MOST_CHANGE = 0.5;

static tobi_status check_world(const tobi_world *w, tobi_error *err)
{
    if (w->started) return tobi_fail(err, TOBI_INVALID, "a started world takes no more scalars");
    if (w->system[0].method->solids)
        return tobi_fail(err, TOBI_UNSUPPORTED, "%s knows no temperature and no concentration; they are for "
                         "the liquids of the SPH methods", w->system[0].method->name);
    return TOBI_OK;
}

tobi_status tobi_world_add_scalar(tobi_world *w, const tobi_scalar_def *def, tobi_error *err)
{
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(tobi_param_check(&tobi_scalar_table, def, err));
    TOBI_TRY(check_world(w, err));
    tobi_scalar *c = &w->sim.scalar[def->field];
    if (c->given) REFUSE("field", tr("%s is given already; allowed is once"), field_name[def->field]);
    if (def->thinning != 0 && !w->sim.def.implicit_viscosity)
        return tobi_at_key(err, tobi_fail(err, TOBI_UNSUPPORTED, "%s changes viscosities by %.10g, and "
                           "implicit_viscosity is false; allowed without it is 0", field_name[def->field],
                           def->thinning), "thinning");
    *c = (tobi_scalar){ 1, def->value, def->diffusivity, def->expansion, def->capacity,
                        def->turbulent_number, def->thinning };
    return TOBI_OK;
}

/* Which of the five it is: exactly one. */
static tobi_status find_kind(const tobi_world *w, const tobi_scalar_value_def *d, tobi_scalar_place *p,
                             tobi_error *err)
{
    int box = 0;
    for (int a = 0; a < 3; a++) box |= d->box_min[a] != 0 || d->box_max[a] != 0;
    if (box + (d->fluid != NULL) + (d->inlet != NULL) + (d->side != TOBI_SIDE_NONE) + (d->body != NULL) != 1)
        REFUSE("", tr("a value of %s is given at %s of box, fluid, inlet, side and body; allowed is one"),
               field_name[d->field], box || d->fluid || d->inlet || d->side || d->body ? tr("more than one")
               : tr("none"));
    p->kind = box ? TOBI_SCALAR_AT_BOX : d->fluid ? TOBI_SCALAR_AT_FLUID : d->inlet ? TOBI_SCALAR_AT_INLET
              : d->body ? TOBI_SCALAR_AT_BODY : TOBI_SCALAR_AT_SIDE;
    const int wall = p->kind == TOBI_SCALAR_AT_SIDE || p->kind == TOBI_SCALAR_AT_BODY,
              given = d->value > TOBI_NO_VALUE;
    if (!given && !wall)
        REFUSE("value",
               tr("%s has no value there; allowed are numbers, and a flux of sides and bodies alone"),
               field_name[d->field]);
    if (d->flux != 0 && (given || !wall))
        REFUSE("flux", tr("a flux of %s goes with a side or body that has no value"), field_name[d->field]);
    if (d->transfer > 0 && !(given && wall))
        REFUSE("transfer", tr("a transfer of %s goes with the value of a side or body"),
               field_name[d->field]);
    if (d->heat_capacity > 0 && !(given && wall))
        REFUSE("heat_capacity", tr("a heat capacity of %s goes with the value of a side or body"),
               field_name[d->field]);
    if (d->power != 0 && !(d->heat_capacity > 0))
        REFUSE("power", tr("a power of %s goes with a heat capacity: else nothing would change by it"),
               field_name[d->field]);
    if (!w->sim.scalar[d->field].given)
        REFUSE("field", tr("the world has no %s; scalars are to have it"), field_name[d->field]);
    return TOBI_OK;
}

static tobi_status place_box(const tobi_world *w, const tobi_scalar_value_def *d, tobi_scalar_place *p,
                             tobi_error *err)
{
    const tobi_box *box = &w->system[0].box;
    for (int a = 0; a < box->dimension; a++) {
        p->lower[a] = d->box_min[a] - box->lower[a];
        p->upper[a] = d->box_max[a] - box->lower[a];
        if (!(p->upper[a] > p->lower[a]))
            REFUSE("box.max", tr("the box of %s reaches from %g to %g m in %c: allowed are upper corners "
                   "above the lower ones"), field_name[d->field], d->box_min[a], d->box_max[a], "xyz"[a]);
    }
    return TOBI_OK;
}

static tobi_status find_side(const tobi_world *w, const tobi_scalar_value_def *d, tobi_scalar_place *p,
                             tobi_error *err)
{
    const int axis = (d->side - TOBI_X_MIN)/2, upper = (d->side - TOBI_X_MIN)%2;
    p->number = 2*axis + upper;
    if (axis >= w->system[0].box.dimension) REFUSE("side", tr("%s: a 2-D domain has no such side"),
                                                   side_name[p->number]);
    const int kind = upper ? w->sim.def.wall_max[axis] : w->sim.def.wall_min[axis];
    if (kind == TOBI_WALL_OPEN || w->system[0].box.periodic[axis])
        REFUSE("side", tr("%s is %s: allowed are walls"), side_name[p->number],
               kind == TOBI_WALL_OPEN ? "open" : "periodic");
    return TOBI_OK;
}

static int find_fluid(const tobi_world *w, const char *name)
{
    for (int f = 0; f < w->system[0].fluid_count; f++)
        if (strcmp(w->system[0].fluid[f].name, name) == 0) return f;
    return -1;
}

static int find_inlet(const tobi_world *w, const char *name)
{
    for (int k = 0; k < w->sim.opening_count; k++)
        if (!w->sim.openings[k].outlet && strcmp(w->sim.openings[k].name, name) == 0) return k;
    return -1;
}

/* The place that it names, and the default of its own name. */
static tobi_status find_place(const tobi_world *w, const tobi_scalar_value_def *d, tobi_scalar_place *p,
                              const char **name, tobi_error *err)
{
    const char *key = d->fluid ? "fluid" : d->inlet ? "inlet" : "body";
    *name = d->fluid ? d->fluid : d->inlet ? d->inlet : d->body ? d->body : "box";
    if (p->kind == TOBI_SCALAR_AT_BOX) return place_box(w, d, p, err);
    if (p->kind == TOBI_SCALAR_AT_SIDE) {
        *name = side_name[d->side - TOBI_X_MIN];
        return find_side(w, d, p, err);
    }
    p->number = d->fluid ? find_fluid(w, *name) : d->inlet ? find_inlet(w, *name)
                : tobi_world_find_body(w, *name);
    if (p->number < 0) REFUSE(key, tr("there is no %s '%s'"), key, *name);
    return TOBI_OK;
}

/* Columns of scalars.csv have names of their own, and each wall one value. */
static tobi_status check_others(const tobi_world *w, const tobi_scalar_place *p, tobi_error *err)
{
    for (int k = 0; k < w->sim.scalar_place_count; k++) {
        const tobi_scalar_place *q = &w->sim.scalar_place[k];
        if (q->field != p->field || q->kind < TOBI_SCALAR_AT_INLET || p->kind < TOBI_SCALAR_AT_INLET)
            continue;
        if (q->kind == p->kind && q->number == p->number)
            REFUSE("", tr("%s of '%s' is given already, by value %d"), field_name[p->field], p->name, k);
        if (strcmp(q->name, p->name) == 0)
            REFUSE("name", tr("value %d of %s has the name '%s' already"), k, field_name[p->field], p->name);
    }
    return TOBI_OK;
}

tobi_status tobi_world_add_scalar_value(tobi_world *w, const tobi_scalar_value_def *def, tobi_error *err)
{
    tobi_scalar_place p = { .field = 0 };
    const char *name;
    TOBI_NEED_WORLD(w);
    TOBI_NEED(def, "the definition");
    TOBI_TRY(tobi_param_check(&tobi_scalar_value_table, def, err));
    TOBI_TRY(check_world(w, err));
    if (w->sim.scalar_place_count == TOBI_SCALAR_VALUE_LIMIT)
        return tobi_fail(err, TOBI_UNSUPPORTED, "more than %d values of scalars", TOBI_SCALAR_VALUE_LIMIT);
    TOBI_TRY(find_kind(w, def, &p, err));
    TOBI_TRY(find_place(w, def, &p, &name, err));
    const tobi_scalar *c = &w->sim.scalar[def->field];
    p.field = def->field;
    p.value = def->value;
    p.wall.fixed = def->value > TOBI_NO_VALUE;
    p.wall.value = p.wall.fixed != 0 ? (float)(def->value - c->value) : 0;
    p.wall.flux = (float)(def->flux/c->capacity);
    p.wall.resistance = def->transfer > 0 ? (float)(c->capacity/def->transfer) : 0;
    p.capacity = def->heat_capacity;
    p.power = def->power;
    p.stored = p.wall.fixed != 0 ? def->value - c->value : 0;
    snprintf(p.name, sizeof p.name, "%s", def->name ? def->name : name);
    TOBI_TRY(check_others(w, &p, err));
    w->sim.scalar_place[w->sim.scalar_place_count++] = p;
    return TOBI_OK;
}

/* first: the value of one of the particles. */
typedef struct measuring {
    const tobi_system *s;
    const tobi_double2 *at;
    int field;
    double value, first;
} measuring;

static double get_value(const tobi_double2 *at, int field)
{
    return field == TOBI_TEMPERATURE ? at->x : at->y;
}

/* totals: mass, mass times the difference from `value`; how far values go [6] below, [7] above the first:
   maxima begin at 0. */
static void measure_range(const void *view, int64_t begin, int64_t end, double *t)
{
    const measuring *m = view;
    for (int64_t i = begin; i < end; i++) {
        const double mass = m->s->smoothing.volume*m->s->fluid[m->s->particles.fluid[i]].density,
                     value = get_value(&m->at[i], m->field);
        t[0] += mass;
        t[1] += mass*(value - m->value);
        t[6] = fmax(t[6], m->first - value);
        t[7] = fmax(t[7], value - m->first);
    }
}

int tobi_world_scalar(const tobi_world *w, int number, tobi_scalar_info *info)
{
    int field = 0;
    for (; w && field < TOBI_SCALAR_LIMIT; field++)
        if (w->sim.scalar[field].given && number-- == 0) break;
    if (!w || field == TOBI_SCALAR_LIMIT) return 0;
    if (!info) return 1;
    const tobi_system *s = &w->system[0];
    measuring m = { s, tobi_scalars_of(&s->particles), field, w->sim.scalar[field].value, 0 };
    double t[TOBI_TOTALS] = { 0 };
    *info = (tobi_scalar_info){ field_name[field], field_unit[field], m.value, m.value, m.value, 0 };
    if (m.at && s->particles.count > 0) m.first = get_value(m.at, field);
    if (m.at)
        tobi_launch((tobi_exec *)&w->sim.exec, TOBI_HOST(measure_range, 2, 2), &m, 0, s->particles.count, t);
    if (!(t[0] > 0)) return 1;
    info->least = m.first - t[6];
    info->most = m.first + t[7];
    info->mean += t[1]/t[0];
    info->amount = t[1]*w->sim.scalar[field].capacity;
    return 1;
}

const char *tobi_world_scalar_flow(const tobi_world *w, int number, tobi_scalar_flow *flow)
{
    for (int k = 0; w && k < w->sim.scalar_place_count; k++) {
        const tobi_scalar_place *p = &w->sim.scalar_place[k];
        if (p->kind != TOBI_SCALAR_AT_SIDE && p->kind != TOBI_SCALAR_AT_BODY) continue;
        if (number-- > 0) continue;
        const double value = p->capacity > 0 ? w->sim.scalar[p->field].value + p->stored
                                             : p->wall.fixed != 0 ? p->value : NAN;
        if (flow) *flow = (tobi_scalar_flow){ field_name[p->field], field_unit[p->field], p->flow,
                                              p->capacity > 0, value };
        return p->name;
    }
    return NULL;
}

tobi_status tobi_scalars_know(const tobi_world *w, const char *field, tobi_error *err)
{
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++)
        if (strcmp(field, field_name[k]) == 0 && !w->sim.scalar[k].given)
            return tobi_fail(err, TOBI_NOT_FOUND, "the world has no %s; scalars are to have it", field);
    return TOBI_OK;
}

tobi_double2 *tobi_scalars_of(const tobi_particles *p)
{
    const tobi_field *f;
    void *data;
    for (int k = 0; (f = tobi_particles_state(p, k, &data)); k++)
        if (strcmp(f->name, "scalars") == 0) return data;
    return NULL;
}

/* Of liquid that comes or starts there: what its inlet says, else the last that holds. */
static tobi_double2 find_value(const tobi_simulation *s, int fluid, int inlet, const double *x, int dimension)
{
    double value[TOBI_SCALAR_LIMIT];
    int by_inlet[TOBI_SCALAR_LIMIT] = { 0 };
    for (int k = 0; k < TOBI_SCALAR_LIMIT; k++) value[k] = s->scalar[k].value;
    for (int k = 0; k < s->scalar_place_count; k++) {
        const tobi_scalar_place *p = &s->scalar_place[k];
        int holds = p->kind == TOBI_SCALAR_AT_INLET ? p->number == inlet
                    : p->kind == TOBI_SCALAR_AT_FLUID ? p->number == fluid : p->kind == TOBI_SCALAR_AT_BOX;
        for (int a = 0; p->kind == TOBI_SCALAR_AT_BOX && a < dimension; a++)
            holds &= inlet < 0 && x[a] >= p->lower[a] && x[a] < p->upper[a];
        if (!holds || by_inlet[p->field]) continue;
        value[p->field] = p->value;
        by_inlet[p->field] = p->kind == TOBI_SCALAR_AT_INLET;
    }
    return (tobi_double2){ value[TOBI_TEMPERATURE], value[TOBI_CONCENTRATION] };
}

void tobi_scalars_place(tobi_system *s, int64_t i, int inlet)
{
    tobi_double2 *at = tobi_scalars_of(&s->particles);
    if (at) at[i] = find_value(s->sim, s->particles.fluid[i], inlet, &s->particles.position[i].x,
                               s->box.dimension);
}

void tobi_scalars_repeat(tobi_system *s, int64_t i, const tobi_system *other, int64_t of)
{
    tobi_double2 *at = tobi_scalars_of(&s->particles);
    if (at) at[i] = tobi_scalars_of(&other->particles)[of];
}

static int any_stores(const tobi_simulation *s)
{
    int any = 0;
    for (int k = 0; k < s->scalar_place_count; k++) any |= s->scalar_place[k].capacity > 0;
    return any;
}

tobi_status tobi_scalars_put(const tobi_world *w, tobi_store *f, tobi_error *err)
{
    double stored[TOBI_SCALAR_VALUE_LIMIT];
    if (!any_stores(&w->sim)) return TOBI_OK;
    for (int k = 0; k < w->sim.scalar_place_count; k++) stored[k] = w->sim.scalar_place[k].stored;
    return tobi_store_put(f, "scalar_walls", TOBI_F64, w->sim.scalar_place_count, 1, stored, err);
}

tobi_status tobi_scalars_get(const tobi_world *w, tobi_store *f, const char *path, double *stored,
                             tobi_error *err)
{
    const int n = w->sim.scalar_place_count;
    for (int k = 0; k < n; k++) stored[k] = w->sim.scalar_place[k].stored;
    if (!any_stores(&w->sim)) return TOBI_OK;
    TOBI_TRY(tobi_store_get(f, "scalar_walls", TOBI_F64, n, 1, stored, err));
    for (int k = 0; k < n; k++)
        if (!isfinite(stored[k]))
            return tobi_fail(err, TOBI_DAMAGED, "%s: the temperature of a wall is no number", path);
    return TOBI_OK;
}

static void start_range(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    tobi_double2 *at = tobi_scalars_of(&s->particles);
    for (int64_t i = begin; i < end; i++)
        at[i] = find_value(s->sim, s->particles.fluid[i], -1, &s->particles.position[i].x, s->box.dimension);
}

void tobi_scalars_start(tobi_system *s)
{
    if (tobi_scalars_of(&s->particles))
        tobi_loop(s->sim->exec.threads, s->particles.count, 0, start_range, s);
}

static int holds_liquid(const tobi_system *s, const tobi_scalar_place *p)
{
    for (int64_t i = 0; i < s->particles.count; i++) {
        const double *x = &s->particles.position[i].x;
        int holds = 1;
        for (int a = 0; a < s->box.dimension; a++) holds &= x[a] >= p->lower[a] && x[a] < p->upper[a];
        if (holds) return 1;
    }
    return 0;
}

/* A value that nothing takes; NULL where it acts. */
static const char *find_idle(const tobi_world *w, const tobi_scalar_place *p)
{
    const tobi_system *s = &w->system[0];
    double spread = w->sim.scalar[p->field].diffusivity;
    for (int f = 0; f < s->fluid_count; f++) spread += s->fluid[f].smagorinsky;
    if (p->kind == TOBI_SCALAR_AT_BOX && !holds_liquid(s, p))
        return tr("has no liquid in it at the start: its value does nothing\n");
    if (p->wall.fixed != 0 && p->kind >= TOBI_SCALAR_AT_SIDE && spread == 0)
        return tr("has a value, but nothing passes: the diffusivity is 0\n");
    return NULL;
}

tobi_status tobi_world_note_scalars(tobi_world *w, tobi_error *err)
{
    char text[TOBI_NOTE];
    for (int k = 0; k < w->sim.scalar_place_count; k++) {
        const tobi_scalar_place *p = &w->sim.scalar_place[k];
        const tobi_scalar *c = &w->sim.scalar[p->field];
        const double change = p->value > TOBI_NO_VALUE ? fabs(c->expansion*(p->value - c->value)) : 0;
        const char *idle = find_idle(w, p);
        if (idle) TOBI_TRY(tobi_world_add_notes(w, field_name[p->field], p->name, idle, err));
        if (change <= MOST_CHANGE) continue;
        snprintf(text, sizeof text, tr("changes the weight of the liquid by %.3g of it; its inertia stays, "
                 "which holds for small changes alone\n"), change);
        TOBI_TRY(tobi_world_add_notes(w, field_name[p->field], p->name, text, err));
    }
    return TOBI_OK;
}
