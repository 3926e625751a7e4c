/* The material point method in the form of Hu et al. 2018 (MLS-MPM): one explicit step. Particles carry the
   state; velocities go to a grid, feel stress, gravity and walls there, and come back. Theory, with equation
   numbers: docs/theory/mlsmpm.md. */
#include "mpm/mlsmpm.h"
#include "base/error.h"
#include "mpm/damage.h"
#include "mpm/energy.h"
#include "mpm/liquid.h"
#include "mpm/fields.h"
#include "mpm/material.h"
#include "mpm/nodes.h"
#include "mpm/state.h"
#include "mpm/contact/sides.h"
#include "mpm/cut/cuts.h"
#include "mpm/particle_fields.h"
#include "tobiuo/types.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ALL_SIDES(dimension) ((1 << 2*(dimension)) - 1)

enum { SORT_AGE = 40 };                /* steps after which the order within blocks has gone stale */

static void choose_smoothing(const void *def, int driven, int *shape, double *support)
{
    (void)def;
    (void)driven;
    *shape = TOBI_KERNEL_WENDLAND_C2;
    *support = 2;
}

static void add_fixed_planes(const tobi_system *s, mpm_view *v)
{
    static const int kinds[] = { [TOBI_PLANE_SEPARATE] = TOBI_WALL_SEPARATE,
                                 [TOBI_PLANE_SLIP] = TOBI_WALL_SLIP,
                                 [TOBI_PLANE_NO_SLIP] = TOBI_WALL_NO_SLIP };
    _Static_assert(6 + TOBI_PLANE_LIMIT <= MPM_PLANES, "six sides and all planes of a scene");
    for (int k = 0; k < s->sim->plane_count; k++) {
        const tobi_fixed_plane *f = &s->sim->plane[k];
        mpm_plane *p = &v->plane[v->plane_count++];
        *p = (mpm_plane){ .offset = f->offset, .kind = kinds[f->kind], .friction = (float)f->friction };
        memcpy(p->normal, f->normal, sizeof p->normal);
    }
}

static void add_planes(const tobi_system *s, int keep, mpm_view *v)
{
    const tobi_world_def *def = &s->sim->def;
    v->plane_count = v->held = 0;
    for (int a = 0; a < s->box.dimension; a++)
        for (int side = 0; side < 2; side++) {
            const int kind = side ? def->wall_max[a] : def->wall_min[a], bit = 1 << (2*a + side);
            if (kind == TOBI_WALL_OPEN || kind == TOBI_WALL_PERIODIC) continue;     /* nobody gets there */
            if (keep) v->held |= bit;
            if (!(v->obeyed & bit)) continue;
            mpm_plane *p = &v->plane[v->plane_count++];
            const double *velocity = side ? def->wall_velocity_max[a] : def->wall_velocity_min[a];
            memset(p, 0, sizeof *p);
            p->normal[a] = side ? -1 : 1;
            p->offset = side ? -s->box.size[a] : 0;
            p->kind = kind;
            p->limited = v->limited & bit ? 1 + a : 0;
            p->friction = (float)def->friction;
            for (int k = 0; k < 3; k++) p->velocity[k] = (float)velocity[k];
        }
    add_fixed_planes(s, v);
}

static void bind_gravity(const tobi_system *s, mpm_view *v)
{
    for (int a = 0; a < 3; a++) v->gravity[a] = a < s->box.dimension ? (float)s->sim->def.gravity[a] : 0;
}

static void bind_particles(const tobi_system *s, mlsmpm *m)
{
    const tobi_particles *p = &s->particles;
    const mpm_fields *f = mpm_fields_of(p);
    mpm_view *v = &m->view;
    v->position = p->position;
    v->velocity = p->velocity;
    v->strain = f->strain;
    v->affine = f->affine;
    v->solid = p->fluid;
    v->cuts = f->cuts;
    m->blades = f->cuts != NULL || m->view.apart;
    v->material = m->material;
    v->cell = (float)m->cell;
    v->inverse_cell = 1/m->cell;
    v->affine_momentum = m->def.transfer == TOBI_APIC;
    v->bent = mpm_takes_spline(s, m->def.gradient);
    v->flip = m->def.transfer == TOBI_FLIP ? (float)m->def.flip : 1;
    v->own = m->def.transfer == TOBI_FLIP;
    memcpy(v->size, s->box.size, sizeof v->size);
    bind_gravity(s, v);
    add_planes(s, m->def.leaving == TOBI_KEEP, v);
}

static tobi_status check_size(const tobi_system *s, const mlsmpm *m, tobi_error *err)
{
    for (int a = 0; a < s->box.dimension; a++)
        if (s->box.size[a] > 1e8*m->cell)
            return tobi_fail(err, TOBI_UNSUPPORTED, "the domain has %g cells along %c, allowed are 1e8",
                             s->box.size[a]/m->cell, "xyz"[a]);
    return TOBI_OK;
}

/* Node arrays: XPIC has one more than FLIP, measuring needs what FLIP has. */
static int count_layers(const tobi_mlsmpm_def *d)
{
    return d->transfer == TOBI_APIC ? 1 + d->measure_transfer : 1 + d->transfer;
}

static tobi_status create(tobi_system *s, tobi_error *err)
{
    mlsmpm *m = s->state = calloc(1, sizeof *m);
    if (!m) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for the method");
    m->def = *(const tobi_mlsmpm_def *)s->def;
    m->cell = m->def.cell*s->smoothing.spacing;
    m->kernels = mpm_kernels_for(s->sim->exec.isa, s->box.dimension);
    m->memory.age = -1;
    m->viscous_dt = m->liquid_sound = INFINITY;
    tobi_status status = check_size(s, m, err);
    if (status == TOBI_OK)
        status = mpm_grid_create(&m->grid, s->box.dimension, count_layers(&m->def), &s->sim->exec, err);
    if (status != TOBI_OK) {
        free(m);
        s->state = NULL;
        return status;
    }
    m->touch.cell_mass = INFINITY;
    for (int k = 0; k < s->solid_count; k++) {
        const tobi_solid_def *d = &s->solids[k].def;
        double sound;
        m->touch.cell_mass = fmin(m->touch.cell_mass, d->density*pow(m->cell, s->box.dimension));
        m->material[k] = mpm_material_describe(d, &sound);
        mpm_damage_describe(d, m->cell, &m->material[k]);
        m->damping[k] = d->damping;
        m->view.damped |= d->damping > 0;
        m->material[k].group = d->bonded ? 0 : k + 1;
        m->view.apart |= !d->bonded;
        m->sound = fmax(m->sound, sound);
        if (d->model == TOBI_LIQUID) m->liquid_sound = fmin(m->liquid_sound, sound);
        m->viscous_dt = fmin(m->viscous_dt, mpm_material_viscous_dt(d, m->cell));
    }
    bind_particles(s, m);
    m->touch.clamp = &m->clamp;
    m->clamp.longest = mpm_material_dt(s, &m->def, m->sound, 0);
    m->touch.cut = m->blades ? &m->cut : NULL;
    m->touch.kernels = mpm_pack_kernels_for(s->sim->exec.isa);
    return TOBI_OK;
}

static double choose_dt(tobi_system *s)
{
    const mlsmpm *m = s->state;
    const double speed = fmax(m->memory.speed, s->sim->body_speed);
    double dt = mpm_material_dt(s, &m->def, fmax(m->sound, m->memory.squeezed), speed);
    dt = fmin(fmin(dt, m->viscous_dt), 0.1);
    if (s->sim->def.time_step_max > 0) dt = fmin(dt, s->sim->def.time_step_max);
    if (s->sim->def.time_step > 0) dt = s->sim->def.time_step/ceil(s->sim->def.time_step/dt*(1 - 1e-9));
    return dt;
}

static double limit_dt(const tobi_system *s, int solid, double speed)
{
    const tobi_mlsmpm_def *def = s->def;
    const tobi_solid_def *d = &s->solids[solid].def;
    double sound;
    mpm_material_describe(d, &sound);
    return fmin(mpm_material_dt(s, def, sound, speed),
                mpm_material_viscous_dt(d, def->cell*s->smoothing.spacing));
}

static tobi_status accept_solid(const tobi_system *s, int solid, char note[TOBI_NOTE], tobi_error *err)
{
    const tobi_solid *d = &s->solids[solid];
    const double cell = ((const tobi_mlsmpm_def *)s->def)->cell*s->smoothing.spacing;
    const char *key;
    tobi_error why = { 0 };
    tobi_status status = mpm_damage_check(&d->def, cell, &key, note, &why);
    return status ? tobi_fail(err, status, "solid '%s': %s %s", d->name, key, why.text) : TOBI_OK;
}

static int is_stale(const mlsmpm *m)
{
    return m->memory.age < 0 || m->memory.age >= SORT_AGE || m->memory.drift > 0.95*m->cell;
}

static tobi_status find_cuts(tobi_system *s, mlsmpm *m, int stale, tobi_error *err)
{
    if (stale || m->memory.moved > MPM_SOLID_CONTACT_STALE*m->cell) {
        mpm_cut_mark(s, &m->view, &m->memory.cuts);
        m->touch.contacts.marked = 1;
        TOBI_TRY(mpm_cut_find(&m->cut, s, &m->grid, &m->view, err));
        m->memory.moved = 0;
    } else if (m->cut.rows) {
        TOBI_TRY(mpm_cut_restore(&m->cut, s, &m->grid, &m->view, err));
    }
    free(m->cut.rows);
    m->cut.rows = NULL;
    m->view.sides = m->cut.tile;
    memcpy(m->view.hidden, m->cut.hidden, sizeof m->view.hidden);
    return TOBI_OK;
}

/* Whether a node of the patch may lie at a side or behind a plane. */
static int meets_planes(const tobi_system *s, const mlsmpm *m, const mpm_patch *p)
{
    int meets = 0;
    for (int a = 0; a < s->box.dimension; a++)
        meets |= p->corner[a] <= 0 || (p->corner[a] + 3)*m->cell >= s->box.size[a]*(1 - 1e-12);
    for (int k = 0; k < s->sim->plane_count; k++) {
        double lowest[3] = { 0, 0, 0 };
        for (int a = 0; a < s->box.dimension; a++)
            lowest[a] = (p->corner[a] + (s->sim->plane[k].normal[a] < 0 ? 3 : 0))*m->cell;
        meets |= tobi_plane_height(&s->sim->plane[k], lowest) < 1e-5*m->cell;
    }
    return meets;
}

/* Blocks are good as long as no particle can leave its tile, one cell around its block. */
static tobi_status sort_particles(tobi_system *s, mlsmpm *m, double *clock, tobi_error *err)
{
    const int stale = is_stale(m);
    if (stale) {
        TOBI_TRY(mpm_grid_sort(&m->grid, &s->particles, m->view.inverse_cell, &s->sim->exec, err));
        m->memory.age = m->memory.drift = 0;
    } else if (!m->built) {
        TOBI_TRY(mpm_grid_restore(&m->grid, &s->particles, &s->sim->exec, err));
    }
    m->fresh = stale || !m->built;
    if (m->fresh) {
        mpm_sides_find(s, &m->view, m->touched);
        add_planes(s, m->def.leaving == TOBI_KEEP, &m->view);
        for (int64_t k = 0; k < m->grid.patch_count; k++)
            m->grid.patch[k].planes = meets_planes(s, m, &m->grid.patch[k]);
    }
    if (m->blades) {
        const tobi_status status = find_cuts(s, m, stale, err);
        if (status != TOBI_OK) m->memory.age = SORT_AGE;  /* there may be no room left for the blocks */
        TOBI_TRY(status);
    }
    m->built = 1;
    mpm_grid_bind(&m->grid, &m->view);
    if (m->def.transfer == TOBI_APIC) m->view.old = NULL;
    mpm_sides_mark(s, &m->grid, &m->view);
    tobi_stage_end(&s->sim->stages, "sort", clock);
    return TOBI_OK;
}

/* What gravity adds to a velocity is rounded to its last place, in free fall by the same error for all
   particles in every step. A shift of up to half a place, another in each step and without a sum that grows,
   lets it average out, m/s. */
static double dither(const tobi_system *s, double speed)
{
    int exponent;
    const double golden = 0.6180339887498949, turn = golden*(double)s->step;
    frexp(speed, &exponent);
    return ldexp(turn - floor(turn) - 0.5, exponent - 24);
}

static void use_dt(const tobi_system *s, mlsmpm *m)
{
    const double shift = dither(s, m->memory.speed);
    for (int a = 0; a < s->box.dimension; a++) {
        const double g = s->sim->def.gravity[a] + s->sim->acceleration.uniform[a];
        m->view.fall[a] = (float)(g != 0 ? g*s->dt + shift : 0);
    }
    m->view.dt = (float)s->dt;
    m->view.strain_dt = (float)m->memory.strain_dt;
    for (int k = 0; k < s->solid_count; k++) m->material[k].keep = (float)exp(-m->damping[k]*s->dt);
}

static void particles_to_grid(tobi_system *s, mlsmpm *m, double *clock)
{
    double t[TOBI_TOTALS];
    tobi_launch_each(&s->sim->exec, m->kernels->scatter, &m->view, m->grid.block_count, t);
    m->memory.damping += t[0];
    tobi_stage_end(&s->sim->stages, "to grid", clock);
}

/* XPIC(m) lets the particles keep sum over k of (-1)^(k+1) (m over k) (S S+)^k v, eq. (16). */
static void filter_velocity(tobi_system *s, mlsmpm *m)
{
    double share = m->def.xpic_order;
    if (m->def.transfer != TOBI_XPIC) return;
    for (int k = 2; k <= m->def.xpic_order; k++) {
        share *= -(m->def.xpic_order - k + 1.0)/k;
        m->view.order = (float)share;
        tobi_launch_each(&s->sim->exec, m->kernels->filter, &m->view, m->grid.block_count, NULL);
        tobi_launch_each(&s->sim->exec, m->kernels->filter_nodes, &m->view, mpm_count_patches(m), NULL);
    }
    if (m->def.measure_transfer)           /* the filter has used the tiles that mpm_energy_add_nodes reads */
        tobi_launch_each(&s->sim->exec, m->kernels->scatter_unstressed, &m->view, m->grid.block_count, NULL);
}

static void solve_grid(tobi_system *s, mlsmpm *m, double *clock)
{
    double t[TOBI_TOTALS];
    m->view.order = (float)m->def.xpic_order;
    tobi_launch_each(&s->sim->exec, m->kernels->collect, &m->view, mpm_count_patches(m), t);
    filter_velocity(s, m);
    if (m->blades) mpm_cut_begin(&m->cut, &s->sim->exec, &m->grid, s->dt);
    for (int a = 0; a < 3; a++) s->info.wall_force[a] = t[a]/s->dt;
    m->memory.sides += t[3];
    tobi_stage_end(&s->sim->stages, "grid", clock);
}

static void grid_to_particles(tobi_system *s, mlsmpm *m, double *clock)
{
    double t[TOBI_TOTALS];
    tobi_launch_each(&s->sim->exec, m->kernels->gather, &m->view, m->grid.block_count, t);
    s->info.contacts += (int64_t)t[0];
    s->info.put_back += (int64_t)t[0];
    s->info.speed_max = m->memory.speed = sqrt(t[6]);
    m->memory.drift += t[7];
    m->memory.moved += t[7] + s->sim->body_speed*s->dt;
    m->memory.strain_dt = s->dt;
    tobi_stage_end(&s->sim->stages, "to particles", clock);
}

static tobi_status touch_bodies(tobi_system *s, mlsmpm *m, double *clock, tobi_error *err)
{
    double g = 0;
    for (int a = 0; a < s->box.dimension; a++) g += s->sim->def.gravity[a]*s->sim->def.gravity[a];
    double way = (m->memory.speed + s->sim->body_speed + sqrt(g)*s->dt)*s->dt;
    const tobi_contact_step contact = {
        .dt = s->dt, .before = m->memory.strain_dt, .whole = s->sim->dt, .system = s->number,
        .radius = 0.5*s->smoothing.spacing, .reach = m->cell,
        .margin = fmin(2*way, m->cell), .rest_speed = 4*sqrt(g)*s->dt, .dimension = s->box.dimension,
        .solids = s->solids };
    TOBI_TRY(mpm_touch_bodies(&m->touch, s, &m->grid, &m->view, &contact, m->fresh ? 0 : m->memory.drift,
                              err));
    m->memory.drift += m->touch.far;
    m->memory.fracture += m->touch.work.fracture;
    m->memory.friction += m->touch.work.friction;
    m->memory.body_work += m->touch.work.bodies;
    tobi_stage_end(&s->sim->stages, "contact", clock);
    return TOBI_OK;
}

/* How fast sound is where a liquid is squeezed, for the next step. What moves slower than 0.3 of the speed of
   sound does not squeeze it that much, so that unstressed liquids do not pay for the look. */
static void measure_squeeze(tobi_system *s, mlsmpm *m)
{
    const double speed = fmax(m->memory.speed, s->sim->body_speed);
    if (speed < 0.3*m->liquid_sound && m->memory.squeezed <= m->sound) return;
    const mpm_view v = mpm_output_view(m);
    m->memory.squeezed = mpm_material_squeezed_sound(s, &v);
}

static int is_beyond(const tobi_system *s, const tobi_double3 *x)
{
    int beyond = 0;
    for (int a = 0; a < s->box.dimension; a++)
        beyond |= (&x->x)[a] < 0 || (&x->x)[a] > s->box.size[a];
    return beyond;
}

/* Takes out the particles beyond the domain, before a sort; the others stay in their order. They take their
   energy with them. */
static void remove_leavers(tobi_system *s, mlsmpm *m)
{
    tobi_particles *p = &s->particles;
    const mpm_view v = mpm_output_view(m);
    int64_t kept = 0;
    for (int64_t i = 0; i < p->count; i++) {
        if (is_beyond(s, &p->position[i])) {
            mpm_energy_drop(m, &v, i);
            continue;
        }
        if (kept < i) tobi_particles_copy(p, i, kept);
        kept++;
    }
    s->info.particles_lost += p->count - kept;
    s->info.fluid_particles = p->count = kept;
}

static tobi_status begin(tobi_system *s, tobi_error *err)
{
    mlsmpm *m = s->state;
    double clock = tobi_clock();
    use_dt(s, m);
    if (s->particles.count > 0 && m->memory.age < 0) mpm_energy_start(s, m);
    mpm_liquid_kick(s);
    if (m->view.held != ALL_SIDES(s->box.dimension) && is_stale(m)) remove_leavers(s, m);
    if (s->particles.count == 0) return TOBI_OK;
    TOBI_TRY(sort_particles(s, m, &clock, err));
    m->reach = mpm_liquid_reach(s);
    return TOBI_OK;
}

static tobi_status solve(tobi_system *s, tobi_error *err)
{
    mlsmpm *m = s->state;
    double clock = tobi_clock();
    s->info.density_converged = s->info.divergence_converged = 1;
    if (s->particles.count == 0) return TOBI_OK;
    particles_to_grid(s, m, &clock);
    mpm_energy_add_transfer(s, m);
    solve_grid(s, m, &clock);
    TOBI_TRY(mpm_clamp_hold(&m->clamp, s, &m->grid, &m->view, m->fresh, err));
    m->memory.body_work += m->clamp.work;
    TOBI_TRY(touch_bodies(s, m, &clock, err));
    if (m->blades) m->memory.friction += mpm_cut_finish(&m->cut, &s->sim->exec, &m->grid, s->dt);
    mpm_energy_add_nodes(s, m);
    return TOBI_OK;
}

static void move(tobi_system *s)
{
    mlsmpm *m = s->state;
    double clock = tobi_clock();
    if (s->particles.count == 0) return;
    grid_to_particles(s, m, &clock);
    m->memory.body_work += mpm_liquid_reach(s) - m->reach;
    mpm_energy_add_flow(s, m);
    measure_squeeze(s, m);
    tobi_contact_shift(&m->touch.contacts, &s->particles);
    m->memory.age++;
}

/* The latest cut that a particle remembers, with the sign of its side. */
static double latest_cut(const tobi_particles *p, int64_t i)
{
    const tobi_columns *cuts = mpm_fields_of(p)->cuts;
    double cut = 0;
    for (int k = 0; cuts && k < TOBI_CUTS_EACH && cuts[i].c[k].w != 0; k++) cut = cuts[i].c[k].w;
    return cut;
}

/* 0 at the surface of the start, 1 below it, 2 at a cut: within a spacing, so that each side has a layer. */
static double find_part(const tobi_system *s, int64_t i)
{
    const mpm_fields *f = mpm_fields_of(&s->particles);
    for (int k = 0; f->cuts && k < TOBI_CUTS_EACH && f->cuts[i].c[k].w != 0; k++) {
        const tobi_float4 *way = &f->cuts[i].c[k];
        const double square = (double)way->x*way->x + (double)way->y*way->y + (double)way->z*way->z;
        if (square < s->smoothing.spacing*s->smoothing.spacing) return 2;
    }
    return f->rest[i].w > 0 ? 1 : 0;
}

static void read_field(const tobi_system *s, const char *field, int64_t i, double *out)
{
    const mpm_view v = mpm_output_view(s->state);
    const tobi_particles *p = &s->particles;
    if (!strcmp(field, "material")) {
        out[0] = p->fluid[i];
        return;
    }
    if (!strcmp(field, "rest_position")) {
        const float *rest = &mpm_fields_of(p)->rest[i].x;
        for (int a = 0; a < 3; a++) out[a] = (double)rest[a] + s->box.lower[a];
        return;
    }
    if (!strcmp(field, "cut_side")) {
        out[0] = latest_cut(p, i);
        return;
    }
    if (!strcmp(field, "part")) {
        out[0] = find_part(s, i);
        return;
    }
    mpm_read_field(&v, s->solids[p->fluid[i]].def.density, field, i, out);
}

static tobi_status find_nodes(const tobi_system *s, tobi_grid *grid, tobi_error *err)
{
    const mpm_view v = mpm_output_view(s->state);
    return mpm_nodes_find(&v, s->particles.count, s->box.dimension, grid, err);
}

static int list_memory(tobi_system *s, double **values)
{
    mpm_memory *memory = &((mlsmpm *)s->state)->memory;
    *values = &memory->speed;
    return (int)(sizeof *memory/sizeof memory->speed);
}

static tobi_status keep_rows(const tobi_system *s, double **rows, int64_t *count, tobi_error *err)
{
    const mlsmpm *m = s->state;
    return mpm_cut_keep(&m->cut, rows, count, err);
}

/* After a load the blocks are built anew. */
static void restore_rows(tobi_system *s, double *rows, int64_t count)
{
    mlsmpm *m = s->state;
    free(m->cut.rows);
    m->cut.rows = rows;
    m->cut.row_count = count;
    m->built = 0;
}

/* The work of the change is no loss of the solids' energy. */
static void follow_gravity(tobi_system *s, int loaded)
{
    mlsmpm *m = s->state;
    const int begun = !loaded && m->memory.age >= 0;
    const double before = begun ? mpm_energy_find(s, m) : 0;
    bind_gravity(s, &m->view);
    if (begun) m->memory.start_energy += mpm_energy_find(s, m) - before;
}

/* The next step sorts all anew. */
static void bind_inserted(tobi_system *s)
{
    mlsmpm *m = s->state;
    bind_particles(s, m);
    m->memory.age = SORT_AGE;
}

static void account(const tobi_system *s, tobi_account *a)
{
    const mlsmpm *m = s->state;
    tobi_account_add(a, "grid of solids", mpm_grid_bytes(&m->grid));
}

static void free_state(void *state)
{
    mlsmpm *m = state;
    if (!m) return;
    mpm_grid_free(&m->grid);
    mpm_touch_free(&m->touch);
    mpm_clamp_free(&m->clamp);
    mpm_cut_free(&m->cut);
    tobi_array_free(m->size);
    free(m);
}

const tobi_method tobi_mlsmpm = {
    .name = "mlsmpm",
    .doc = "The material point method (MLS-MPM) for elastic and plastic solids, liquids, snow and sand.",
    .params = &tobi_mlsmpm_table,
    .solids = 1,
    .fields = &mpm_field_list,
    .outputs = mpm_outputs,
    .needs = mpm_needs,
    .place = mpm_place,
    .mass = mpm_mass,
    .planes = 1,
    .smoothing = choose_smoothing,
    .create = create,
    .max_dt = choose_dt,
    .begin = begin,
    .solve = solve,
    .move = move,
    .read = read_field,
    .accept = accept_solid,
    .stable_dt = limit_dt,
    .points = mpm_liquid_points,
    .nodes = find_nodes,
    .measure = mpm_energy_report,
    .memory = list_memory,
    .keep = keep_rows,
    .restore = restore_rows,
    .inserted = bind_inserted,
    .follow_gravity = follow_gravity,
    .account = account,
    .free = free_state,
};
