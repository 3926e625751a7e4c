/* A box of jittered particles, bound to a view as the DFSPH method binds it, and to an oracle. */
#pragma once
#include "core/cells.h"
#include "sph/state.h"
#include "core/smoothing.h"
#include "sph/kernels.h"
#include "kernel/sph_oracle.h"

typedef struct rig_case {
    int dimension, shape;
    double support;
    int periodic[3];
    int closed;           /* 1: full of fluid, no free surface      */
    int fluids;           /* 1 or 2                                 */
    double jitter;        /* in spacings                            */
    double origin;        /* world coordinate of the lower corner   */
    int along;            /* 1: with eq. (7c); 2: with (7b), for every third particle */
} rig_case;

typedef struct rig {
    tobi_exec exec;
    tobi_box box;
    tobi_smoothing_constants c;
    tobi_particles p;
    tobi_cells cells;
    sph_view view;
    oracle o;
    float coarse[64];     /* values at the nodes of a preconditioner's grid */
} rig;

static uint64_t rig_state;
/* Uniform in -1..1, the same on every machine. */
static double rig_random(void)
{
    rig_state = rig_state*6364136223846793005u + 1442695040888963407u;
    return (double)(rig_state >> 11)/4503599627370496.0 - 1;
}

static void rig_fill(rig *g, const rig_case *k, const int n[3])
{
    double d = g->c.spacing;
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++) {
                int64_t i = g->p.count++;
                double at[3] = {x, y, z}, *q = &g->p.position[i].x;
                for (int a = 0; a < 3; a++)
                    q[a] = a < k->dimension ? (at[a] + 0.5 + k->jitter*rig_random())*d : 0;
                for (int a = 0; a < k->dimension; a++) (&g->p.velocity[i].x)[a] = (float)rig_random();
                sph_fields_of(&g->p)->wetness[i] = (float)(0.5 + 0.5*rig_random());
                sph_fields_of(&g->p)->pressure[i] = (float)(1000*rig_random() + 500);
                for (int a = 0; a < k->dimension; a++) {
                    (&sph_fields_of(&g->p)->viscous_velocity[i].x)[a] = (float)rig_random();
                    (&sph_fields_of(&g->p)->viscous_expected[i].x)[a] = (float)rig_random();
                    (&sph_fields_of(&g->p)->viscous_direction[i].x)[a] = (float)rig_random();
                }
                g->p.id[i] = i;
                g->p.fluid[i] = (uint8_t)(k->fluids > 1 && x%3 == 0);
            }
}

static void rig_bind(rig *g, const rig_case *k, const double rho[2], const double nu[2])
{
    sph_view *v = &g->view;
    tobi_particles *p = &g->p;
    const sph_fields *f = sph_fields_of(p);
    v->count = p->count;
    v->position = p->position; v->record = g->cells.record; v->velocity = p->velocity; v->accel = f->accel;
    v->wall = f->wall; v->density = f->density; v->diagonal = f->diagonal; v->precondition = f->precondition;
    v->mean_pressure = f->mean; v->surface_depth = f->surface_depth;
    v->wetness = f->wetness; v->damped = f->damped;
    v->residual = f->residual; v->product = f->product; v->delta = f->delta; v->surface = f->surface;
    v->pressure = f->pressure; v->fluid = p->fluid;
    v->list = g->cells.list; v->list_far = g->cells.list_far;
    v->list_start = g->cells.list_start; v->list_groups = g->cells.list_groups;
    for (int a = 0; a < 3; a++) v->from_fixed[a] = g->box.from_fixed[a];
    v->h = (float)g->c.h; v->inverse_h = (float)(1/g->c.h); v->shape = k->shape;
    v->weight = (float)g->c.weight; v->slope = (float)g->c.slope;
    v->wall_share = (float)g->c.wall_share; v->wall_lattice = (float)g->c.wall_lattice;
    v->moment_lattice = (float)g->c.moment_lattice;
    v->inverse_rate = (float)(1/g->c.rate); v->spacing = (float)g->c.spacing; v->volume = (float)g->c.volume;
    v->dimension = k->dimension;
    v->surface_limit = (k->dimension == 3 ? 0.87f : 0.80f)*(float)k->dimension;
    v->table = &g->c.plane;
    v->plane_count = 0;
    for (int a = 0; a < k->dimension; a++) {
        v->gravity[a] = (float)(a + 1 == k->dimension ? -9.81 : 1.5);
        v->removed_gravity[a] = (float)(0.5 - a);
        if (k->periodic[a]) continue;
        v->plane[v->plane_count++] = (tobi_plane){a, 1, 0, a != 1, {0.3f, -0.2f, 0.1f}};
        v->plane[v->plane_count++] = (tobi_plane){a, -1, g->box.size[a], 0, {0}};
    }
    for (int f = 0; f < 2; f++) {
        v->inverse_density[f] = (float)(1/rho[f]);
        v->kinematic[f] = (float)nu[f];
    }
    v->dt = 1e-3f; v->inverse_dt = 1000; v->speed_cap = 1.2f;
    v->smooth = 0.02f; v->filter = 1e-6f; v->alpha = 0.3f; v->beta = 0.4f; v->mean = 0.2f;
    v->open_limit = v->surface_limit;
    v->sheet_limit = 0.6f*(float)k->dimension; v->surface_gradient = (float)(0.5/g->c.h);
    v->isolated = (k->dimension == 3) == (k->support < 2.3) ? 5 : 1.8f;   /* some are below */
    v->core = (float)(0.9*g->c.spacing); v->push = 0.25f; v->background = 30;
    v->stiffness = 2e4f; v->exponent = 7; v->damping = 40; v->relaxation = 0.05f;
    v->recovery = 30; v->recovery_pressure = 700;
    v->stretch = k->along ? f->stretch : NULL;
    v->shear = f->shear;
    v->near_body = f->near_body; v->last_link = f->last_link; v->full = v->exact = v->blind = k->along == 1;
    v->target_divergence = f->target_divergence; v->moment = f->moment; v->roughness = f->roughness;
    v->normal = f->normal; v->capillary = f->capillary;
    v->tension[0] = 0.07f; v->tension[1] = 0.03f; v->contact_cosine = 0.5f;
    v->band_depth = (float)(0.6*g->c.spacing);
}

static void rig_bind_viscosity(rig *g, const double rho[2], const double nu[2])
{
    const sph_fields *f = sph_fields_of(&g->p);
    g->view.dynamic = (float)(rho[0]*nu[0]);
    g->view.viscous = (sph_viscous_fields){f->viscous_velocity, f->viscous_expected, f->viscous_residual,
                                         f->viscous_direction, f->viscous_product, f->viscous_inverse,
                                         f->viscous_turning, f->viscous_lack, f->viscous_fit,
                                         f->viscous_fit_shear, f->viscous_spread, f->viscous_slant,
                                         f->viscous_velocity, 1, f->apparent};
    for (int k = 0; k < 2; k++) {
        const double yield = 0.1 + 0.3*k, index = k == 0 ? 0.6 : 1, creep = 2, turbulent = 0.3 - 0.2*k;
        g->view.yield_stress[k] = (float)yield; g->view.flow_index[k] = (float)index;
        g->view.creep_rate[k] = (float)creep;
        g->view.creep_viscosity[k] = (float)(nu[k]*rho[k]*pow(creep, index - 1));
        g->view.eddy[k] = (float)(rho[k]*pow(turbulent*g->c.spacing, 2));
        g->o.smagorinsky[k] = turbulent;
        g->o.yield_stress[k] = yield; g->o.flow_index[k] = index; g->o.creep_rate[k] = creep;
    }
}

/* Still water that begins under the first layers and has sunk by a spacing since. */
static void rig_bind_still(rig *g, const rig_case *k)
{
    sph_view *v = &g->view;
    double g2 = 0, h = g->c.h;
    tobi_reference w = {.level = k->dimension*0.01, .cover = 0.3*h, .ramp = 1.2*h, .rest = 0.1*h};
    for (int a = 0; a < k->dimension; a++) g2 += k->periodic[a] ? 0 : (double)v->gravity[a]*v->gravity[a];
    for (int a = 0; a < k->dimension; a++) {
        if (k->periodic[a]) continue;
        w.down[a] = v->gravity[a]/sqrt(g2);
        w.corner[a] = w.down[a] > 0 ? 0 : g->box.size[a];
    }
    if (k->fluids == 1 && g2 > 0) w.push = sqrt(g2)/v->inverse_density[0];
    v->reference = v->reference_before = w;
    v->reference_before.level -= g->c.spacing;
    g->o.reference = v->reference;
    g->o.reference_before = v->reference_before;
}

/* A grid of 4 nodes along each axis: 3 cells, or 4 where the last meets the first. */
static void rig_bind_grid(rig *g, const rig_case *k)
{
    sph_view *v = &g->view;
    for (int a = 0; a < 3; a++) {
        v->coarse.n[a] = a < k->dimension ? 4 : 1;
        v->coarse.per_metre[a] = (k->periodic[a] ? 4 : 3)/(g->box.size[a]*(1 + 1e-9));
    }
    for (int c = 0; c < 64; c++) g->coarse[c] = (float)(100*rig_random());
    v->coarse.value = g->coarse;
    v->coarse.dimension = k->dimension;
    g->o.coarse = g->coarse;
    memcpy(g->o.cells_per_metre, v->coarse.per_metre, sizeof v->coarse.per_metre);
}

static void rig_bind_oracle(rig *g, const rig_case *k, const double rho[2], const double nu[2])
{
    const sph_view *v = &g->view;
    const tobi_particles *p = &g->p;
    const sph_fields *f = sph_fields_of(p);
    oracle *o = &g->o;
    o->count = (int)p->count; o->dimension = k->dimension; o->shape = k->shape;
    o->d = g->c.spacing; o->h = g->c.h;
    o->fluid = p->fluid;
    o->along = k->along;
    o->last_link = k->along == 2 ? f->last_link : NULL;
    o->plane_count = v->plane_count;
    memcpy(o->plane, v->plane, sizeof o->plane);
    for (int a = 0; a < 3; a++) {
        o->box[a] = g->box.size[a];
        o->periodic[a] = g->box.periodic[a];
        o->gravity[a] = v->gravity[a];
        o->removed_gravity[a] = v->removed_gravity[a];
    }
    for (int f = 0; f < 2; f++) {
        o->rho0[f] = rho[f]; o->nu[f] = nu[f];
    }
    o->dt = v->dt; o->alpha = v->alpha; o->beta = v->beta; o->mean = v->mean;
    o->smooth = v->smooth; o->filter = v->filter; o->surface_limit = v->surface_limit;
    o->sheet_limit = v->sheet_limit; o->surface_gradient = v->surface_gradient;
    o->core = v->core; o->isolated = v->isolated; o->push = v->push; o->background = v->background;
    o->speed_cap = v->speed_cap;
    o->stiffness = v->stiffness; o->exponent = v->exponent; o->damping = v->damping;
    o->recovery = v->recovery; o->recovery_pressure = v->recovery_pressure;
    o->relaxation = v->relaxation;
    o->tension[0] = v->tension[0]; o->tension[1] = v->tension[1];
    o->contact = acos(v->contact_cosine); o->band_depth = v->band_depth;
    oracle_normalise(o);
}

/* Walls stand for a body that every third particle sees. */
static void rig_hide_walls(rig *g)
{
    tobi_particles *p = &g->p;
    const sph_fields *f = sph_fields_of(p);
    for (int64_t i = 0; i < p->count; i++) f->last_link[i] = p->id[i]%3 == 0 ? 0 : -1;
    for (int64_t i = 0; i < p->count; i++) {
        f->near_body[i] = f->last_link[i] >= 0;
        int32_t unpacked[TOBI_LIST_LIMIT];
        int count;
        const int32_t *list = tobi_cells_neighbors(&g->cells, i, &count, unpacked);
        for (int n = 0; n < count; n++) f->near_body[i] |= f->last_link[list[n]] >= 0;
    }
}

/* 0 = ok. 3-D: 9 x 8 x 8 particles, 2-D: 26 x 24; one support radius of air above if not closed. */
static int rig_create(rig *g, const rig_case *k, int threads, tobi_error *err)
{
    static const int size3[3] = {9, 8, 8}, size2[3] = {26, 24, 1};
    const int *n = k->dimension == 3 ? size3 : size2;
    const double rho[2] = {1000, 800}, nu[2] = {2e-3, 5e-6};   /* kg/m3, m2/s: both of (14), (14b) */
    static tobi_field field[64];
    static tobi_field_list list = { .field = field, .size = sizeof(sph_fields) };
    double d = 0.01, lower[3], upper[3];
    memset(g, 0, sizeof *g);
    rig_state = 1234567;
    if (tobi_exec_init(&g->exec, threads, err)) return 1;
    tobi_smoothing_init(&g->c, k->shape, k->dimension, d, k->support);
    for (int a = 0; a < 3; a++) {
        lower[a] = k->origin;
        upper[a] = k->origin + d*(n[a] + (!k->closed && a + 1 == k->dimension ? 3 : 0));
    }
    tobi_box_init(&g->box, k->dimension, lower, upper, k->periodic, g->c.h);
    int64_t count = (int64_t)n[0]*n[1]*n[2];
    const unsigned all = SPH_NEED_TENSION | SPH_NEED_WETTED | SPH_NEED_PHASES | SPH_NEED_IMPLICIT |
                         SPH_NEED_APPARENT | SPH_NEED_SCALARS;
    list.count = sph_field_list.count;
    for (int f = 0; f < list.count; f++) {
        field[f] = sph_field_list.field[f];
        if (field[f].life != TOBI_STATE) field[f].life = TOBI_SCRATCH;       /* all at once */
    }
    if (tobi_particles_create(&g->p, &list, all, count, err)) return 1;
    if (tobi_cells_create(&g->cells, &g->box, g->c.h, &g->p, &g->exec, err)) return 1;
    if (tobi_exec_reserve(&g->exec, count, err)) return 1;
    rig_fill(g, k, n);
    tobi_cells_sort(&g->cells, &g->box, &g->p, sph_fields_of(&g->p)->pressure, &g->exec);
    if (tobi_cells_list(&g->cells, &g->box, g->c.h, &g->p, &g->exec, err)) return 1;
    if (k->along == 2) rig_hide_walls(g);
    rig_bind(g, k, rho, nu);
    rig_bind_viscosity(g, rho, nu);
    rig_bind_oracle(g, k, rho, nu);
    rig_bind_still(g, k);
    rig_bind_grid(g, k);
    return 0;
}

static void rig_free(rig *g)
{
    tobi_cells_free(&g->cells);
    tobi_particles_free(&g->p);
    tobi_exec_free(&g->exec);
}

/* Copies the particles' values out to rows and back; exact both ways. */
static void rig_get(const rig *g, row *s)
{
    const tobi_particles *p = &g->p;
    const sph_fields *f = sph_fields_of(p);
    for (int64_t i = 0; i < p->count; i++) {
        for (int a = 0; a < 3; a++) {
            s[i][POS + a] = (&p->position[i].x)[a];
            s[i][VEL + a] = (&p->velocity[i].x)[a];
            s[i][ACC + a] = (&f->accel[i].x)[a];
            s[i][VISCOUS + a] = (&f->viscous_velocity[i].x)[a];
            s[i][VISCOUS_EXPECTED + a] = (&f->viscous_expected[i].x)[a];
            s[i][VISCOUS_RESIDUAL + a] = (&f->viscous_residual[i].x)[a];
            s[i][VISCOUS_DIRECTION + a] = (&f->viscous_direction[i].x)[a];
            s[i][VISCOUS_PRODUCT + a] = (&f->viscous_product[i].x)[a];
            s[i][VISCOUS_INVERSE + a] = (&f->viscous_inverse[i].x)[a];
        }
        for (int a = 0; a < 4; a++) s[i][WALL + a] = (&f->wall[i].x)[a];
        for (int a = 0; a < 4; a++) s[i][TURNING + a] = (&f->viscous_turning[i].x)[a];
        for (int a = 0; a < 4; a++) s[i][LACK + a] = (&f->viscous_lack[i].x)[a];
        for (int a = 0; a < 4; a++) s[i][SPREAD + a] = (&f->viscous_spread[i].x)[a];
        for (int a = 0; a < 4; a++) s[i][SLANT + a] = (&f->viscous_slant[i].x)[a];
        for (int a = 0; a < 4; a++) s[i][FIT + a] = (&f->viscous_fit[i].x)[a];
        for (int a = 0; a < 2; a++) s[i][FIT + 4 + a] = (&f->viscous_fit_shear[i].x)[a];
        for (int a = 0; a < 4; a++) s[i][NORMAL + a] = (&f->normal[i].x)[a];
        for (int a = 0; a < 4; a++) s[i][TENSOR + a] = (&f->stretch[i].x)[a];
        for (int a = 0; a < 3; a++) s[i][TENSOR + 4 + a] = (&f->shear[i].x)[a];
        s[i][APPARENT] = f->apparent[i].x; s[i][SHEAR_RATE] = f->apparent[i].y;
        s[i][BAND] = f->accel[i].w; s[i][CAPILLARY] = f->capillary[i];
        s[i][PAYLOAD] = g->cells.record[i].w;
        s[i][RHO] = f->density[i]; s[i][DIAG] = f->diagonal[i]; s[i][PRE] = f->precondition[i];
        s[i][RES] = f->residual[i]; s[i][PROD] = f->product[i]; s[i][DELTA] = f->delta[i];
        s[i][PRES] = f->pressure[i]; s[i][SURF] = f->surface[i];
        s[i][WET] = f->wetness[i]; s[i][MEAN] = f->mean[i]; s[i][DROP] = f->surface_depth[i];
        s[i][MIDWAY] = f->target_divergence[i]; s[i][DAMPED] = f->damped[i];
        for (int a = 0; a < 3; a++) s[i][MOMENT + a] = (&f->moment[i].x)[a];
        for (int a = 0; a < 3; a++) s[i][ROUGH + a] = (&f->roughness[i].x)[a];
    }
}

static void rig_set(rig *g, const row *s)
{
    tobi_particles *p = &g->p;
    const sph_fields *f = sph_fields_of(p);
    for (int64_t i = 0; i < p->count; i++) {
        for (int a = 0; a < 3; a++) {
            (&p->position[i].x)[a] = s[i][POS + a];
            (&p->velocity[i].x)[a] = (float)s[i][VEL + a];
            (&f->accel[i].x)[a] = (float)s[i][ACC + a];
            (&f->viscous_velocity[i].x)[a] = (float)s[i][VISCOUS + a];
            (&f->viscous_expected[i].x)[a] = (float)s[i][VISCOUS_EXPECTED + a];
            (&f->viscous_residual[i].x)[a] = (float)s[i][VISCOUS_RESIDUAL + a];
            (&f->viscous_direction[i].x)[a] = (float)s[i][VISCOUS_DIRECTION + a];
            (&f->viscous_product[i].x)[a] = (float)s[i][VISCOUS_PRODUCT + a];
            (&f->viscous_inverse[i].x)[a] = (float)s[i][VISCOUS_INVERSE + a];
        }
        f->wetness[i] = (float)s[i][WET]; f->mean[i] = (float)s[i][MEAN];
        f->surface_depth[i] = (float)s[i][DROP];
        f->target_divergence[i] = (float)s[i][MIDWAY]; f->damped[i] = (float)s[i][DAMPED];
        for (int a = 0; a < 3; a++) (&f->moment[i].x)[a] = (float)s[i][MOMENT + a];
        for (int a = 0; a < 3; a++) (&f->roughness[i].x)[a] = (float)s[i][ROUGH + a];
        for (int a = 0; a < 4; a++) (&f->wall[i].x)[a] = (float)s[i][WALL + a];
        for (int a = 0; a < 4; a++) (&f->viscous_turning[i].x)[a] = (float)s[i][TURNING + a];
        for (int a = 0; a < 4; a++) (&f->viscous_lack[i].x)[a] = (float)s[i][LACK + a];
        for (int a = 0; a < 4; a++) (&f->viscous_spread[i].x)[a] = (float)s[i][SPREAD + a];
        for (int a = 0; a < 4; a++) (&f->viscous_slant[i].x)[a] = (float)s[i][SLANT + a];
        for (int a = 0; a < 4; a++) (&f->viscous_fit[i].x)[a] = (float)s[i][FIT + a];
        for (int a = 0; a < 2; a++) (&f->viscous_fit_shear[i].x)[a] = (float)s[i][FIT + 4 + a];
        for (int a = 0; a < 4; a++) (&f->normal[i].x)[a] = (float)s[i][NORMAL + a];
        for (int a = 0; a < 4; a++) (&f->stretch[i].x)[a] = (float)s[i][TENSOR + a];
        for (int a = 0; a < 3; a++) (&f->shear[i].x)[a] = (float)s[i][TENSOR + 4 + a];
        f->apparent[i] = (tobi_float4){ (float)s[i][APPARENT], (float)s[i][SHEAR_RATE], 0, 0 };
        f->accel[i].w = (float)s[i][BAND]; f->capillary[i] = (float)s[i][CAPILLARY];
        g->cells.record[i].w = (float)s[i][PAYLOAD];
        f->density[i] = (float)s[i][RHO]; f->diagonal[i] = (float)s[i][DIAG];
        f->precondition[i] = (float)s[i][PRE]; f->residual[i] = (float)s[i][RES];
        f->product[i] = (float)s[i][PROD]; f->delta[i] = (float)s[i][DELTA];
        f->pressure[i] = (float)s[i][PRES]; f->surface[i] = (uint8_t)s[i][SURF];
    }
}
