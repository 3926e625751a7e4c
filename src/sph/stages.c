/* What the steps of dfsph, wcsph and isph have in common, as functions of the system and a view.
   Drawback: a method must bind its view again after each sort. */
#include "sph/state.h"
#include "sph/stages.h"
#include "sph/boundary/boundary.h"
#include "sph/openings.h"
#include "sph/phases.h"
#include "sph/scalars.h"
#include "sph/viscosity.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

/* Pairs nearer than CORE spacings are pushed apart, each side by PUSH of the overlap: below the density that
   packs spheres at random, so that the core never works against a density solve. */
static const double CORE = 0.9;
static const float PUSH = 0.25f;
/* Of the mean diagonal: two particles 1.5 d apart that have no other neighbour. */
static const double ISOLATED = 0.01;
/* Fewer are worked on one after another: large bodies have parallel loops of their own. */
enum { FEW_BODIES = 8 };

static void launch(tobi_system *s, sph_view *v, tobi_kernel k, double *totals)
{
    tobi_launch(&s->sim->exec, k, v, 0, s->particles.count, totals);
}

static void bind_planes(const tobi_system *s, sph_view *v)
{
    v->plane_count = 0;
    for (int a = 0; a < s->box.dimension; a++) {
        if (s->box.periodic[a]) continue;
        const double *lower = s->sim->def.wall_velocity_min[a], *upper = s->sim->def.wall_velocity_max[a];
        v->plane[v->plane_count++] = (tobi_plane){a, 1, 0, s->sim->def.wall_min[a] == TOBI_WALL_NO_SLIP,
                                                  {(float)lower[0], (float)lower[1], (float)lower[2]}};
        v->plane[v->plane_count++] =
            (tobi_plane){a, -1, s->box.size[a], s->sim->def.wall_max[a] == TOBI_WALL_NO_SLIP,
                         {(float)upper[0], (float)upper[1], (float)upper[2]}};
    }
}

/* Mean depth of the band at a flat surface: layers at (k + 1/2) d, weighted as sph_normal weighs them. */
static double band_depth(const tobi_smoothing_constants *c)
{
    double d = c->spacing, weight = 0, sum = 0, first = 0;
    for (double s = 0.5*d; s < c->h; s += d) {
        double g = c->plane.sigma[(int)(s/c->h*TOBI_PLANE_SAMPLES)];
        if (!(first > 0)) first = g;
        weight += fmax(g/first - 0.2, 0);
        sum += s*fmax(g/first - 0.2, 0);
    }
    return sum/weight;
}

static void bind_stage(sph_view *v, const sph_fields *f)
{
    v->mean_pressure = f->mean; v->surface_depth = f->surface_depth;
    v->wetness = f->wetness; v->damped = f->damped;
    v->precondition = f->precondition; v->residual = f->residual; v->product = f->product;
    v->delta = f->delta;
    v->moment = f->moment; v->roughness = f->roughness; v->target_divergence = f->target_divergence;
    v->viscous = (sph_viscous_fields){f->viscous_velocity, f->viscous_expected, f->viscous_residual,
                                    f->viscous_direction, f->viscous_product, f->viscous_inverse,
                                    f->viscous_turning, f->viscous_lack, f->viscous_fit,
                                    f->viscous_fit_shear, f->viscous_spread, f->viscous_slant,
                                    NULL, 0, f->apparent};
}

void sph_stage(tobi_system *s, sph_view *v, int stage)
{
    tobi_particles_stage(&s->particles, stage);
    bind_stage(v, sph_fields_of(&s->particles));
}

static void bind_fluids(const tobi_system *s, sph_view *v)
{
    for (int f = 0; f < s->fluid_count; f++) {
        v->inverse_density[f] = (float)(1/s->fluid[f].density);
        v->kinematic[f] = (float)(s->fluid[f].viscosity/s->fluid[f].density);
        v->tension[f] = (float)s->fluid[f].tension;
        v->yield_stress[f] = (float)s->fluid[f].yield_stress;
        v->flow_index[f] = (float)s->fluid[f].flow_index;
        v->creep_rate[f] = (float)s->fluid[f].creep_rate;
        v->creep_viscosity[f] = (float)(s->fluid[f].viscosity*pow(s->fluid[f].creep_rate,
                                                                 s->fluid[f].flow_index - 1));
        v->eddy[f] = (float)(s->fluid[f].density*pow(s->fluid[f].smagorinsky*s->smoothing.spacing, 2));
    }
}

static void bind_smoothing(const tobi_system *s, sph_view *v, double vessel)
{
    const tobi_smoothing_constants *c = &s->smoothing;
    v->h = (float)c->h; v->inverse_h = (float)(1/c->h); v->shape = c->shape;
    v->weight = (float)c->weight; v->slope = (float)c->slope;
    v->wall_share = (float)c->wall_share; v->wall_lattice = (float)c->wall_lattice;
    v->moment_lattice = (float)c->moment_lattice;
    v->spacing = (float)c->spacing; v->volume = (float)c->volume; v->inverse_rate = (float)(1/c->rate);
    v->dimension = c->dimension;
    v->open_limit = (c->dimension == 3 ? 0.87f : 0.80f)*(float)c->dimension;
    v->surface_limit = vessel == SPH_VESSEL_FULL ? -1e30f : v->open_limit;
    v->sheet_limit = 0.6f*(float)c->dimension;
    v->surface_gradient = 0.4f*c->plane.sigma[(int)(0.5*c->spacing/c->h*TOBI_PLANE_SAMPLES)];
    v->table = &c->plane;
}

void sph_bind_view(const tobi_system *s, sph_view *v, double vessel)
{
    const tobi_particles *p = &s->particles;
    const sph_fields *f = sph_fields_of(&s->particles);
    const tobi_smoothing_constants *c = &s->smoothing;
    v->count = p->count;
    v->position = p->position; v->record = s->cells.record; v->velocity = p->velocity; v->accel = f->accel;
    v->stretch = f->stretch; v->shear = f->shear; v->near_body = f->near_body;
    v->wall = f->wall; v->normal = f->normal; v->capillary = f->capillary;
    v->density = f->density;
    v->implicit = s->sim->def.implicit_viscosity;
    v->dynamic = (float)s->fluid[0].viscosity;
    v->diagonal = f->diagonal;
    v->surface = f->surface;
    v->full = vessel == SPH_VESSEL_FULL;
    /* bodies let go act larger with (7c) beside them than with (7b), decision 28 */
    v->exact = v->full && v->stretch && !tobi_body_any_free(s->sim->bodies, s->sim->body_count) &&
               tobi_system_density_ratio(s) == 1;
    /* with it a tank lost volume in which salt water ran under fresh water */
    v->blind = v->exact && !sph_scalars_lift(s).acts;
    bind_stage(v, f);
    v->held = sph_of(s)->marked ? f->held : NULL;
    v->porous = NULL;
    v->outlet_normal = sph_of(s)->normal;
    v->last_link = s->sim->body_count > 0 ? f->last_link : NULL;
    v->fluid = p->fluid; v->list_start = s->cells.list_start; v->list_groups = s->cells.list_groups;
    v->list = s->cells.list; v->list_far = s->cells.list_far;
    memcpy(v->from_fixed, s->box.from_fixed, sizeof v->from_fixed);
    bind_smoothing(s, v, vessel);
    v->core = (float)(CORE*c->spacing);
    v->push = PUSH;
    bind_planes(s, v);
    bind_fluids(s, v);
    sph_phases_bind(s, v);
    v->band_depth = (float)band_depth(c);
    v->contact_cosine = (float)cos(s->sim->def.contact_angle*acos(-1)/180);
    v->acceleration = s->sim->acceleration;
    sph_scalars_bind(s, v);
    for (int a = 0; a < 3; a++) {
        v->gravity[a] = a < c->dimension ? (float)s->gravity[a] : 0;
        v->removed_gravity[a] = a < c->dimension ? (float)(s->sim->def.gravity[a] - s->gravity[a]) : 0;
    }
}

double sph_gravity_dt(const tobi_system *s)
{
    return 0.25*sqrt(s->smoothing.spacing/fmax(tobi_simulation_pull_size(s->sim), 1e-12));
}

double sph_viscous_dt(const tobi_system *s)
{
    double rate = 2*s->smoothing.rate + 2*s->smoothing.plane.sigma[0]/(0.25*s->smoothing.spacing);
    double dt = INFINITY;
    for (int f = 0; f < s->fluid_count; f++)
        if (s->fluid[f].viscosity > 0)
            dt = fmin(dt, 0.8*s->fluid[f].density/(s->fluid[f].viscosity*rate));
    if (sph_phases_differ(s)) dt *= s->box.dimension/(s->box.dimension + 2.0);     /* by eq. (41) */
    return dt;
}

double sph_tension_dt(const tobi_system *s)
{
    double d = s->smoothing.spacing, dt = INFINITY;
    for (int f = 0; f < s->fluid_count; f++)
        if (s->fluid[f].tension > 0)
            dt = fmin(dt, 0.4*sqrt(s->fluid[f].density*d*d*d/(2*acos(-1)*s->fluid[f].tension)));
    return fmin(dt, sph_phases_dt(s));
}

double sph_force_dt(const tobi_system *s)
{
    const double viscous = s->sim->def.implicit_viscosity ? INFINITY : sph_viscous_dt(s);
    return fmin(fmin(viscous, sph_scalars_dt(s)), sph_tension_dt(s));
}

void sph_use_dt(const tobi_system *s, sph_view *v)
{
    v->dt = (float)s->dt;
    v->inverse_dt = (float)(1/s->dt);
}

tobi_status sph_find_neighbors(tobi_system *s, double *clock, tobi_error *err)
{
    const sph_fields *f = sph_fields_of(&s->particles);
    sph_of(s)->marked = 0;
    tobi_cells_sort(&s->cells, &s->box, &s->particles, f->pressure, &s->sim->exec);
    tobi_stage_end(&s->sim->stages, "sort", clock);
    TOBI_TRY(tobi_cells_list(&s->cells, &s->box, s->smoothing.h, &s->particles, &s->sim->exec, err));
    tobi_stage_end(&s->sim->stages, "neighbours", clock);
    return TOBI_OK;
}

tobi_status sph_find_boundaries(tobi_system *s, sph_view *v, const sph_kernels *k, double *clock,
                          tobi_error *err)
{
    sph_stage(s, v, SPH_BOUNDARIES);
    launch(s, v, k->sph_walls, NULL);
    if (s->sim->body_count > 0) {
        tobi_stage_end(&s->sim->stages, "walls and bodies", clock);
        TOBI_TRY(tobi_boundary_search(s, err));
        tobi_stage_end(&s->sim->stages, "body search", clock);
        TOBI_TRY(tobi_boundary_measure(s, err));
        TOBI_TRY(tobi_boundary_cut_pairs(s, err));
        tobi_boundary_mark_near_body(s);
        tobi_boundary_add_gradients(s);
    }
    TOBI_TRY(sph_soft_find(s, err));
    sph_soft_wet_bodies(s);
    sph_soft_add_gradients(s);
    sph_stage(s, v, SPH_SEE);
    tobi_stage_end(&s->sim->stages, "walls and bodies", clock);
    return TOBI_OK;
}

/* Whether what is empty is too little for half a layer along the least side and along bodies: a lattice that
   bodies cut lacks as much. Sides that liquid leaves by are no vessel. m3, in 2-D m2. */
static int has_no_room(const tobi_system *s)
{
    const double d = s->smoothing.spacing, *size = s->box.size;
    double whole = 1, least = INFINITY, bodies = 0, area = 0;
    for (int a = 0; a < s->box.dimension; a++) {
        if (s->sim->def.wall_min[a] == TOBI_WALL_OPEN || s->sim->def.wall_max[a] == TOBI_WALL_OPEN) return 0;
        whole *= size[a];
    }
    for (int a = 0; a < s->box.dimension; a++) least = fmin(least, whole/size[a]);
    for (int k = 0; k < s->sim->body_count; k++) {
        if (s->sim->bodies[k].is_absent) continue;
        bodies += fabs(s->sim->bodies[k].rest.volume);
        area += s->sim->bodies[k].rest.area;
    }
    return whole - bodies - (double)s->particles.count*s->smoothing.volume < 0.5*d*(least + area);
}

/* Of the particles of a surface across a cube as many as the liquid: those that surely lie at one, by which a
   vessel is open; where there is hardly room for a surface it takes more of them. */
static const double SURFACE = 0.1, SURFACE_WITHOUT_ROOM = 0.5;

static tobi_status classify_vessel(tobi_system *s, sph_view *v, const sph_kernels *k, double *vessel,
                                   double *clock, tobi_error *err)
{
    double t[TOBI_TOTALS], count = sph_rows(s);
    if (*vessel != SPH_VESSEL_UNKNOWN) return TOBI_OK;
    if (sph_has_openings(s)) *vessel = SPH_VESSEL_OPEN;        /* the levels may change */
    TOBI_TRY(sph_find_boundaries(s, v, k, clock, err));
    v->pressure = sph_fields_of(&s->particles)->pressure;
    v->smooth = 0;
    launch(s, v, k->sph_density, t);
    sph_of(s)->lowest = t[7];
    const double across = s->box.dimension == 3 ? cbrt(count*count) : sqrt(count);
    const int full = t[3] < (has_no_room(s) ? SURFACE_WITHOUT_ROOM : SURFACE)*across;
    if (!sph_has_openings(s)) *vessel = full ? SPH_VESSEL_FULL : SPH_VESSEL_OPEN;
    return TOBI_OK;
}

tobi_status sph_classify_vessel(tobi_system *s, sph_view *v, const sph_kernels *k, double *vessel,
                                double *clock, tobi_error *err)
{
    TOBI_TRY(classify_vessel(s, v, k, vessel, clock, err));
    sph_of(s)->full = *vessel == SPH_VESSEL_FULL;
    return TOBI_OK;
}

double sph_measure_density(tobi_system *s, sph_view *v, const sph_kernels *k, double smooth,
                           double *clock)
{
    sph_state *state = sph_of(s);
    double t[TOBI_TOTALS], count = sph_rows(s);
    v->pressure = sph_fields_of(&s->particles)->pressure;
    v->smooth = (float)smooth;
    launch(s, v, k->sph_density, t);
    s->info.density_error_mean = t[0]/count;
    s->info.density_error_max = t[6];
    s->info.surface_share = t[1]/count;
    state->lowest = t[7];
    state->open = t[3];
    double diagonal = t[2]/count;
    v->isolated = (float)(ISOLATED*diagonal);
    tobi_stage_end(&s->sim->stages, "density", clock);
    return diagonal;
}

void sph_set_body_velocities(tobi_system *s, double *clock)
{
    for (int k = 0; k < s->sim->body_count; k++) {
        tobi_body *b = &s->sim->bodies[k];
        if (b->rigid.kind != TOBI_PRESCRIBED)
            tobi_body_set_velocity(b, b->rigid.velocity, b->rigid.angular_velocity);
        else if (b->motion) tobi_body_set_point_velocities(b);
    }
    tobi_stage_end(&s->sim->stages, "motion", clock);
}

/* Of bodies with a motion, m/s2. */
static double fastest_change(const tobi_system *s)
{
    double most = 0;
    for (int k = 0; k < s->sim->body_count; k++) {
        const tobi_body *b = &s->sim->bodies[k];
        for (int64_t i = 0; b->rigid.kind == TOBI_PRESCRIBED && b->motion && i < b->mesh.vertex_count; i++) {
            double change[3];
            vec3_sub(change, b->vertex_velocity[i], b->vertex_before[i]);
            most = fmax(most, vec3_dot(change, change));
        }
    }
    return sqrt(most)/s->sim->dt;
}

double sph_explained_head(const tobi_system *s)
{
    const double depth = s->start_head*tobi_system_density_ratio(s);
    const double body = fmax(s->sim->body_speed, s->pushed_speed);
    return 1.5*depth + body*body + fastest_change(s)*vec3_length(s->box.size)
        + 4*tobi_system_capillary(s);
}

static void apply_tension(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    double most = 0;
    for (int f = 0; f < s->fluid_count; f++) most = fmax(most, s->fluid[f].tension);
    if (!(most > 0)) return;
    launch(s, v, k->sph_normal, NULL);
    launch(s, v, k->sph_smooth_normal, NULL);
    if (s->sim->body_count > 0) tobi_boundary_turn_normals(s);
    launch(s, v, k->sph_curvature, NULL);
    launch(s, v, k->sph_tension, NULL);
}

double sph_viscous_share(const tobi_system *s, const sph_view *v, double dt)
{
    double least = v->kinematic[0];
    for (int f = 1; f < s->fluid_count; f++) least = fmin(least, v->kinematic[f]);
    return 4*least*s->smoothing.rate*dt;
}

/* Eq. (13b); nothing is left for that of (13). */
static void apply_filter(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    if (!(v->filter > 0)) return;
    launch(s, v, k->sph_filter, NULL);
    launch(s, v, k->sph_filter_compare, NULL);
    v->filter *= (float)(4*pow(s->smoothing.rate, 2)/pow(s->smoothing.shortest, 3));
    launch(s, v, k->sph_filter_kick, NULL);
    v->filter = 0;
}

static int is_viscous(const tobi_system *s, const sph_view *v)
{
    float most = 0;
    for (int f = 0; f < s->fluid_count; f++) most = fmaxf(most, v->kinematic[f]);
    return most > 0 && !v->implicit;
}

/* All but the filter (13b). */
static void kick(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    if (!v->implicit) sph_phases_rub(s, v, k);
    if (v->filter > 0 || is_viscous(s, v)) launch(s, v, k->sph_laplacian, NULL);
    launch(s, v, v->filter > 0 ? k->sph_kick : k->sph_kick_unfiltered, NULL);
    if (!v->implicit) sph_phases_kick(s, v, k);
    if (s->sim->body_count > 0) tobi_boundary_add_forces(s);
    sph_soft_add_forces(s);
    apply_tension(s, v, k);
    sph_phases_find(s, v, k);
    if (!sph_of(s)->mirrors) sph_phases_pull(s, v, k);
}

void sph_apply_forces(tobi_system *s, sph_view *v, const sph_kernels *k, double *clock)
{
    sph_stage(s, v, SPH_FORCES);
    if (v->exact) launch(s, v, k->sph_target_divergence, NULL);
    sph_viscosity_begin(s, v, k);
    if (v->blind) apply_filter(s, v, k);
    kick(s, v, k);
    sph_openings_hold(s);
    tobi_stage_end(&s->sim->stages, "forces", clock);
}

void sph_measure_forces(tobi_system *s, sph_view *v, const sph_kernels *k, double *clock)
{
    double t[TOBI_TOTALS];
    launch(s, v, k->sph_wall_force, t);
    memcpy(s->info.wall_force, t, sizeof s->info.wall_force);
    sph_viscosity_load(s);
    sph_of(s)->reference_volume = t[3]*s->smoothing.volume;
    if (s->sim->body_count > 0) tobi_boundary_load(s);
    sph_soft_load(s);
    tobi_stage_end(&s->sim->stages, "walls and bodies", clock);
}

double sph_move_particles(tobi_system *s, sph_view *v, const sph_kernels *k, double *clock)
{
    double t[TOBI_TOTALS];
    v->speed_cap = (float)fmax(3*tobi_system_speed_scale(s), s->sim->def.speed_limit);
    sph_openings_drive(s);
    sph_scalars_spread(s, v, k);
    launch(s, v, k->sph_advance, t);
    for (int a = 0; a < 3; a++) s->info.wall_force[a] += t[1 + a]/s->dt;
    s->info.contacts = (int64_t)t[0];
    s->info.speed_max = sqrt(t[7]);
    s->info.capped = (int64_t)t[4];
    tobi_stage_end(&s->sim->stages, "advance", clock);
    return sqrt(t[6]);
}

static void update_surfaces(const void *view, int64_t begin, int64_t end)
{
    tobi_body *bodies = ((const tobi_system *)view)->sim->bodies;
    for (int64_t k = begin; k < end; k++) {
        tobi_body *b = &bodies[k];
        if (!b->deforms && (b->motion || b->rigid.kind != TOBI_PRESCRIBED)) tobi_body_update_surface(b);
    }
}

void sph_finish(tobi_system *s)
{
    double clock = tobi_clock();
    const int bodies = s->sim->body_count;
    tobi_loop(bodies < FEW_BODIES ? 1 : s->sim->exec.threads, bodies, 1, update_surfaces, s);
    if (s->sim->body_count > 0) tobi_push_out(s);
    tobi_couple_finish(s);
    s->info.contacts += sph_of(s)->links.contacts;
    tobi_stage_end(&s->sim->stages, "motion", &clock);
}

static void show_pressure(const void *view, int64_t begin, int64_t end)
{
    const tobi_system *s = view;
    const float *p = sph_fields_of(&s->particles)->pressure;
    for (int64_t i = begin; i < end; i++) s->cells.record[i].w = p[i];
}

void sph_show_pressure(tobi_system *s)
{
    tobi_loop(s->sim->exec.threads, s->particles.count, 0, show_pressure, s);
}

/* The kick over one second, then taken back, and the pressure. */
static void derive_acceleration(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    tobi_particles *p = &s->particles;
    const sph_fields *f = sph_fields_of(&s->particles);
    const float dt = v->dt;
    const double step = s->dt;
    sph_stage(s, v, SPH_DERIVE);
    memcpy(f->saved_velocity, p->velocity, (size_t)p->count*sizeof *f->saved_velocity);
    s->dt = v->dt = 1;
    v->filter = 0;
    sph_viscosity_begin(s, v, k);
    kick(s, v, k);
    sph_viscosity_add(s, v, k);
    s->dt = step;
    v->dt = dt;
    for (int64_t i = 0; i < p->count; i++) {
        const tobi_float4 u = p->velocity[i], before = f->saved_velocity[i];
        p->velocity[i] = before;
        f->saved_velocity[i] = (tobi_float4){u.x - before.x, u.y - before.y, u.z - before.z, 0};
        s->cells.record[i].w = f->pressure[i];
    }
    launch(s, v, k->sph_pressure_accel, NULL);
    for (int64_t i = 0; i < p->count; i++)
        for (int a = 0; a < 3; a++) (&f->accel[i].x)[a] += (&f->saved_velocity[i].x)[a];
}

static void derive_viscosity(tobi_system *s, sph_view *v, const sph_kernels *k)
{
    sph_stage(s, v, SPH_DERIVE);
    sph_viscosity_begin(s, v, k);
}

void sph_derive(tobi_system *s, sph_view *v, const sph_kernels *k, const char *field)
{
    if (strcmp(field, "vorticity") == 0) launch(s, v, k->sph_vorticity, NULL);
    else if (strcmp(field, "apparent_viscosity") == 0) derive_viscosity(s, v, k);
    else derive_acceleration(s, v, k);
}
