/* Every model and all transfers of the material point method against a double-precision loop over all
   particles and all nodes; the same bits for any instruction set and number of threads. */
#include "kernel/mpm_oracle.h"
#include "mpm/particle_fields.h"
#include "mpm/fields.h"
#include "mpm/grid.h"
#include "mpm/kernels.h"
#include "tobiuo/types.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

/* After the models: neo-Hookean and corotated solids that break. */
enum { MODELS = 9, BREAKING = 7, COUNT = 900, ORDER = 3, TRANSFERS = 3 };
static const double H = 0.05, DT = 2e-4, STRAIN_DT = 3e-4;

static uint64_t seed;
static double noise(void)
{
    seed = seed*6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11)/4503599627370496.0 - 1;
}

/* One step's worth of the method, without the method. */
typedef struct rig {
    tobi_exec exec;
    tobi_particles p;
    mpm_grid grid;
    mpm_view view;
    mpm_material material[MODELS];
    oracle_solid solid[MODELS];
    int dimension;
    const mpm_kernels *kernels;
} rig;

/* Random numbers of usual size. Sand, snow, von Mises and what breaks get strains on both sides of their
   limits. */
static void choose_solids(rig *g, int only)
{
    for (int k = 0; k < MODELS; k++) {
        const oracle_solid s = {
            .model = k < BREAKING ? k : k - BREAKING, .strength = k < BREAKING ? 0 : 3000, .last = 0.1,
            .E = 1e5*(1 + k), .nu = 0.1 + 0.05*(k%BREAKING), .bulk = 2e5, .viscosity = 3, .yield = 4e3,
            .hardening = k == TOBI_SNOW ? 8 : 2e4, .compression = 0.04, .stretch = 0.02, .cone = 0.2,
            .friction_rise = k == TOBI_SAND && (only < 0) == (g->dimension == 2) ? 0.5 : 0,
            .inertial_scale = 1e5,
            .keep = 1 - 0.01*k };
        g->solid[k] = s;
        g->material[k] = (mpm_material){
            .model = s.model, .strength = (float)s.strength, .brittleness = 10,
            .mu = (float)(s.E/(2*(1 + s.nu))),
            .lambda = (float)(s.E*s.nu/((1 + s.nu)*(1 - 2*s.nu))), .bulk = (float)s.bulk,
            .viscosity = (float)s.viscosity, .yield = (float)s.yield, .hardening = (float)s.hardening,
            .compression = (float)s.compression, .stretch = (float)s.stretch, .friction = (float)s.cone,
            .friction_rise = (float)s.friction_rise, .inertial_scale = (float)s.inertial_scale,
            .keep = (float)s.keep };
    }
}

/* only: number of a model, or -1 for all, one beside the other. strain: size of F - I. */
static void fill(rig *g, int only, double strain)
{
    const mpm_fields *f = mpm_fields_of(&g->p);
    const int dim = g->dimension;
    for (int i = 0; i < COUNT; i++) {
        tobi_particles *p = &g->p;
        double *x = &p->position[i].x;
        for (int a = 0; a < 3; a++) x[a] = a < dim ? H*(5 + 5*noise()) : 0;
        for (int a = 0; a < dim; a++) (&p->velocity[i].x)[a] = (float)(3*noise());
        p->velocity[i].w = 0;
        p->id[i] = i;
        p->fluid[i] = (uint8_t)(only >= 0 ? only : i%MODELS);
        for (int c = 0; c < 3; c++)
            for (int r = 0; r < 3; r++) {
                int plane = r < dim && c < dim, out = r == c && only != TOBI_LIQUID;
                (&f->strain[i].c[c].x)[r] = (float)(plane || out ? strain*noise() : 0);
                (&f->affine[i].c[c].x)[r] = (float)(plane ? 20*noise() : 0);
            }
        f->strain[i].c[0].w = (float)(pow(H/2, dim)*(1 + 0.3*noise()));
        f->strain[i].c[1].w = (float)(p->fluid[i] == TOBI_NEO_HOOKEAN ? 0 : 0.02*(1 + noise()));
        if (p->fluid[i] >= BREAKING) f->strain[i].c[1].w = (float)fmin(1, 0.6*(1 + noise()));
        f->strain[i].c[2].w = f->strain[i].c[0].w*1000;
    }
    g->p.count = COUNT;
}

/* Where node n of a block of nodes lies, cells. */
static void place_of(const rig *g, int64_t patch, int n, int place[3])
{
    const int three = g->dimension == 3;
    const int32_t *corner = g->grid.patch[patch].corner;
    place[0] = corner[0] + (three ? n/16 : n/4);
    place[1] = corner[1] + (three ? n/4%4 : n%4);
    place[2] = three ? corner[2] + n%4 : 0;
}

static void make(rig *g, int dim, int only, double strain, int threads, int isa, int transfer)
{
    tobi_error err;
    memset(g, 0, sizeof *g);
    seed = 77;
    g->dimension = dim;
    assert_int_equal(tobi_exec_init(&g->exec, threads, &err), TOBI_OK);
    if (isa && isa < g->exec.isa) g->exec.isa = isa;
    assert_int_equal(tobi_particles_create(&g->p, &mpm_field_list, 0, COUNT, &err), TOBI_OK);
    assert_int_equal(mpm_grid_create(&g->grid, dim, 1 + transfer, &g->exec, &err), TOBI_OK);
    g->kernels = mpm_kernels_for(g->exec.isa, dim);
    choose_solids(g, only);
    fill(g, only, strain);
    mpm_view *v = &g->view;
    *v = (mpm_view){
        .position = g->p.position, .velocity = g->p.velocity, .strain = mpm_fields_of(&g->p)->strain,
        .affine = mpm_fields_of(&g->p)->affine,
        .solid = g->p.fluid, .material = g->material, .cell = (float)H, .inverse_cell = 1/H, .dt = (float)DT,
        .strain_dt = (float)STRAIN_DT, .affine_momentum = transfer == TOBI_APIC,
        .bent = transfer != TOBI_XPIC, .flip = transfer == TOBI_FLIP ? 0.9f : 1,
        .own = transfer == TOBI_FLIP, .order = ORDER,
        .plane_count = 3,
        .gravity = {1, -2, dim == 3 ? -9.81f : 0}, .size = {1, 1, 1} };
    for (int a = 0; a < 3; a++) v->fall[a] = (float)DT*v->gravity[a];
    v->plane[0] = (mpm_plane){.normal = {1, 0, 0}, .kind = TOBI_WALL_NO_SLIP, .velocity = {0, 0.4f, 0}};
    v->plane[1] = (mpm_plane){.normal = {0, 1, 0}, .kind = TOBI_WALL_SEPARATE, .friction = 0.4f};
    v->plane[2] = (mpm_plane){.normal = {-1, 0, 0}, .offset = -9*H, .kind = TOBI_WALL_SLIP, .limited = 1};
    assert_int_equal(mpm_grid_sort(&g->grid, &g->p, 1/H, &g->exec, &err), TOBI_OK);
    mpm_grid_bind(&g->grid, v);
    for (int64_t k = 0; k < g->grid.patch_count; k++) {
        mpm_patch *patch = &g->grid.patch[k];
        patch->planes = 1;
        patch->obey[0] = 0;
        for (int n = 0; n < (dim == 3 ? MPM_NODES_3D : MPM_NODES_2D); n++) {
            int place[3];
            place_of(g, k, n, place);
            patch->obey[0] |= (uint64_t)oracle_obeys(place) << n;
        }
    }
}

static void end(rig *g)
{
    mpm_grid_free(&g->grid);
    tobi_particles_free(&g->p);
    tobi_exec_free(&g->exec);
}

static void step(rig *g, int transfer, int gather)
{
    double t[TOBI_TOTALS], share = ORDER;
    g->view.order = ORDER;
    tobi_launch_each(&g->exec, g->kernels->scatter, &g->view, g->grid.block_count, t);
    tobi_launch_each(&g->exec, g->kernels->collect, &g->view, g->grid.patch_count, t);
    for (int k = 2; k <= ORDER && transfer == TOBI_XPIC; k++) {
        share *= -(ORDER - k + 1.0)/k;
        g->view.order = (float)share;
        tobi_launch_each(&g->exec, g->kernels->filter, &g->view, g->grid.block_count, t);
        tobi_launch_each(&g->exec, g->kernels->filter_nodes, &g->view, g->grid.patch_count, t);
    }
    if (gather) tobi_launch_each(&g->exec, g->kernels->gather, &g->view, g->grid.block_count, t);
}

static oracle_grid *see(const rig *g, oracle_particle *out)
{
    oracle_grid *o = calloc(1, sizeof *o);
    assert_non_null(o);
    *o = (oracle_grid){
        .dimension = g->dimension, .affine = g->view.affine_momentum,
        .spline = g->view.bent, .sides = 3, .h = H, .dt = (float)DT };
    for (int a = 0; a < 3; a++) o->gravity[a] = g->view.gravity[a];
    o->side[0] = (oracle_side){.axis = 0, .kind = 1, .velocity = {0, 0.4f, 0}};
    o->side[1] = (oracle_side){.axis = 1, .kind = 3, .friction = 0.4f};
    o->side[2] = (oracle_side){.axis = 0, .upper = 1, .at = 9*H, .chequered = 1};
    for (int64_t i = 0; i < g->p.count; i++) {
        const tobi_columns *e = &mpm_fields_of(&g->p)->strain[i], *c = &mpm_fields_of(&g->p)->affine[i];
        out[i] = (oracle_particle){
            .volume = e->c[0].w, .state = e->c[1].w, .mass = e->c[2].w, .solid = g->p.fluid[i] };
        for (int r = 0; r < 3; r++) {
            out[i].x[r] = (&g->p.position[i].x)[r];
            out[i].v[r] = (&g->p.velocity[i].x)[r];
            for (int k = 0; k < 3; k++) {
                out[i].F[r][k] = (r == k) + (double)(&e->c[k].x)[r];
                out[i].C[r][k] = (&c->c[k].x)[r];
            }
        }
    }
    return o;
}

/* Float rounds by 6e-8; the longest chain (principal stretches, flow, stress, momentum) has some hundred
   operations, most of which do not add up: 1e-5 of what was summed; particles average over their nodes. */
static const double PART = 1e-5;

/* A place in a tile has 3e-7 cells; where a weight is w, near its end, that makes sqrt(2 w) of it. */
static double mass_tolerance(double mass, int dim)
{
    return PART*mass + 1e-6*sqrt(mass*1000*pow(H/2, dim)) + 1e-12;
}

/* NaN stays. */
static double worst_of(double worst, double error, double scale)
{
    return error/scale <= worst || isnan(worst) ? worst : error/scale;
}

static double compare_nodes(const rig *g, oracle_grid *o)
{
    const int dim = g->dimension, nodes = dim == 3 ? MPM_NODES_3D : MPM_NODES_2D;
    double worst = 0;
    long seen = 0, all = 0;
    for (int at = 0; at < ORACLE_NODES*ORACLE_NODES*ORACLE_NODES; at++) all += o->node[at].mass > 0;
    for (int64_t k = 0; k < g->grid.patch_count; k++)
        for (int n = 0; n < nodes; n++) {
            const tobi_float4 *mine = &g->view.node[k*nodes + n];
            int place[3];
            place_of(g, k, n, place);
            oracle_node *his = oracle_at(o, place);
            double mass = his ? his->mass : 0;
            if (!(mass > 0) || !(mine->w > 0)) {
                assert_true(mass < 1e-12 && mine->w < 1e-12);
                seen += mass > 0;
                continue;
            }
            seen++;
            worst = worst_of(worst, fabs(mine->w - mass), mass_tolerance(mass, dim));
            for (int a = 0; a < 3; a++)
                worst = worst_of(worst, mass*fabs((&mine->x)[a] - his->v[a]), PART*(his->bound + mass*0.1));
        }
    assert_int_equal(seen, all);
    return worst;
}

/* F after flow, and the plastic state. Damage is a quotient of differences of stresses. */
static double compare_strain(const rig *g, const oracle_particle *p)
{
    double worst = 0;
    for (int64_t i = 0; i < g->p.count; i++) {
        const tobi_columns *e = &mpm_fields_of(&g->p)->strain[i];
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                worst = worst_of(worst, fabs((r == c) + (double)(&e->c[c].x)[r] - p[i].F[r][c]), 1e-6);
        worst = worst_of(worst, fabs(e->c[1].w - p[i].state), 1e-6);
    }
    return worst;
}

static double compare_particles(const rig *g, oracle_grid *o, oracle_particle *p, int transfer)
{
    const mpm_fields *f = mpm_fields_of(&g->p);
    double worst = 0;
    for (int64_t i = 0; i < g->p.count; i++) {
        double bound;
        const oracle_particle before = p[i];
        oracle_to_particle(o, &g->solid[p[i].solid], transfer, g->view.flip, &p[i], &bound);
        double part = 0.1*PART*(bound + 1);
        for (int a = 0; a < 3; a++) {
            worst = worst_of(worst, fabs((&g->p.velocity[i].x)[a] - p[i].v[a]), part);
            worst = worst_of(worst, fabs((&g->p.position[i].x)[a] - p[i].x[a]), part*DT);
            for (int b = 0; b < 3; b++)
                worst = worst_of(worst, fabs((&f->affine[i].c[b].x)[a] - p[i].C[a][b]), 4/H*part);
        }
        if (p[i].solid != TOBI_STATIONARY) assert_true(memcmp(before.x, p[i].x, sizeof before.x) != 0);
    }
    return worst;
}

/* Each model alone and all mixed; small strains, and strains beyond the limits of the plastic models. */
static void transfers_match_the_oracle(void **state)
{
    (void)state;
    static oracle_particle p[COUNT];
    for (int dim = 2; dim <= 3; dim++)
        for (int only = -1; only < MODELS; only++)
            for (int large = 0; large < 2; large++)
                for (int transfer = 0; transfer < (only < 0 ? TRANSFERS : 1); transfer++) {
                    rig g;
                    make(&g, dim, only, large ? 0.15 : 0.003, 1, 0, transfer);
                    oracle_grid *o = see(&g, p);
                    step(&g, transfer, 0);
                    oracle_to_grid(o, g.solid, p, COUNT, g.view.strain_dt);
                    oracle_solve_grid(o);
                    if (transfer == TOBI_XPIC) oracle_filter(o, p, COUNT, ORDER);
                    double strain = compare_strain(&g, p), nodes = compare_nodes(&g, o);
                    end(&g);
                    make(&g, dim, only, large ? 0.15 : 0.003, 1, 0, transfer);
                    step(&g, transfer, 1);
                    double moved = compare_particles(&g, o, p, transfer);
                    printf("%d-D model %2d large %d transfer %d: F %.2f nodes %.2f particles %.2f\n", dim,
                            only, large, transfer, strain, nodes, moved);
                    assert_true(strain < 1 && nodes < 1 && moved < 1);
                    end(&g);
                    free(o);
                }
}

/* What is written to files, against the oracle: Cauchy stress = tau/J. */
static void shown_stress_matches_the_oracle(void **state)
{
    (void)state;
    static oracle_particle p[COUNT];
    static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    for (int dim = 2; dim <= 3; dim++) {
        rig g;
        make(&g, dim, -1, 0.1, 1, 0, TOBI_APIC);
        free(see(&g, p));
        for (int64_t i = 0; i < COUNT; i++) {
            double tau[3][3], size = 100;
            const oracle_solid *m = &g.solid[p[i].solid];
            if (m->strength > 0) {           /* damage leaves a part of what the intact solid would have */
                oracle_solid intact = *m;
                oracle_particle copy = p[i];
                intact.strength = 0;
                oracle_stress(&intact, g.view.strain_dt, &copy, tau);
                for (int k = 0; k < 9; k++) size += fabs(tau[k/3][k%3]);
            }
            mpm_sample s = mpm_sample_particle(&g.view, i);
            oracle_stress(m, g.view.strain_dt, &p[i], tau);
            double ratio = oracle_det(p[i].F);
            if (m->model == TOBI_SNOW) ratio *= 1 + p[i].state;
            if (m->model == TOBI_SAND) ratio *= exp(p[i].state);
            assert_true(fabs(s.ratio - ratio) < 1e-5);
            for (int k = 0; k < 9; k++) size += fabs(tau[k/3][k%3]);
            for (int k = 0; k < 6; k++)
                assert_true(fabs(s.stress[k]*ratio - tau[at[k][0]][at[k][1]]) < 2*PART*size);
        }
        end(&g);
    }
}

static void same_state(const rig *a, const rig *b)
{
    assert_memory_equal(a->p.position, b->p.position, COUNT*sizeof *a->p.position);
    assert_memory_equal(a->p.velocity, b->p.velocity, COUNT*sizeof *a->p.velocity);
    const mpm_fields *f = mpm_fields_of(&a->p), *g = mpm_fields_of(&b->p);
    assert_memory_equal(f->strain, g->strain, COUNT*sizeof *f->strain);
    assert_memory_equal(f->affine, g->affine, COUNT*sizeof *f->affine);
    size_t nodes = (size_t)(a->grid.patch_count*(a->dimension == 3 ? MPM_NODES_3D : MPM_NODES_2D));
    assert_memory_equal(a->view.node, b->view.node, nodes*sizeof *a->view.node);
}

/* AVX2 and AVX-512 round alike; without them a b + c rounds twice (exec/rows.h). */
static void neither_threads_nor_instruction_sets_matter(void **state)
{
    (void)state;
    static const int threads[3][4] = {{4, 2, 3}, {1, 4, 2}, {1, 4, 3}};
    for (int dim = 2; dim <= 3; dim++)
        for (int transfer = 0; transfer < TRANSFERS; transfer++)
            for (int isa = 2; isa <= 3; isa++) {
                rig first;
                make(&first, dim, -1, 0.1, 1, isa, transfer);
                for (int k = 0; k < 3; k++) step(&first, transfer, 1);
                for (int n = 0; n < 3; n++)
                    for (int more = 0; more < (isa == 3 ? 2 : 1); more++) {
                        rig g;
                        make(&g, dim, -1, 0.1, threads[more ? 2 : isa - 2][n], isa + more, transfer);
                        for (int k = 0; k < 3; k++) step(&g, transfer, 1);
                        same_state(&first, &g);
                        end(&g);
                    }
                end(&first);
            }
}

/* The oldest instruction set, which others of the tests never run. */
static void oldest_instruction_set_matches_the_oracle(void **state)
{
    (void)state;
    static oracle_particle p[COUNT];
    for (int dim = 2; dim <= 3; dim++) {
        rig g;
        make(&g, dim, -1, 0.1, 1, 2, TOBI_APIC);
        oracle_grid *o = see(&g, p);
        step(&g, TOBI_APIC, 1);
        oracle_to_grid(o, g.solid, p, COUNT, g.view.strain_dt);
        oracle_solve_grid(o);
        assert_true(compare_strain(&g, p) < 1);
        assert_true(compare_particles(&g, o, p, TOBI_APIC) < 1);
        end(&g);
        free(o);
    }
}

/* The oracle's own tools. */
static void decomposition_gives_back(void **state)
{
    (void)state;
    seed = 5;
    for (int n = 0; n < 200; n++) {
        double F[3][3], U[3][3], V[3][3], s[3], again[3][3];
        for (int k = 0; k < 9; k++) F[k/3][k%3] = (k%4 == 0) + (n < 100 ? 0.3 : 1e-4)*noise();
        oracle_svd(F, U, s, V);
        oracle_compose(U, s, V, again);
        double one[3] = {1, 1, 1}, UU[3][3], VV[3][3];
        oracle_compose(U, one, U, UU);
        oracle_compose(V, one, V, VV);
        for (int k = 0; k < 9; k++) {
            assert_true(fabs(F[k/3][k%3] - again[k/3][k%3]) < 1e-13);
            assert_true(fabs(UU[k/3][k%3] - (k%4 == 0)) < 1e-13 && fabs(VV[k/3][k%3] - (k%4 == 0)) < 1e-13);
        }
    }
}

/* Energies of the transfers, against their definitions. */
static void energies_match_sums(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        rig g;
        double came[TOBI_TOTALS], unstressed[TOBI_TOTALS], there[TOBI_TOTALS];
        double before = 0, kept = 0, nodes = 0;
        make(&g, dim, -1, 0.1, 1, 0, TOBI_XPIC);
        g.view.affine_momentum = 1;
        for (int64_t i = 0; i < g.p.count; i++) {
            double keep = g.material[g.p.fluid[i]].keep, square = 0;
            for (int a = 0; a < 3; a++) {
                square += pow((&g.p.velocity[i].x)[a], 2);
                for (int c = 0; c < 3; c++)
                    square += 0.25*H*H*pow((&mpm_fields_of(&g.p)->affine[i].c[c].x)[a], 2);
            }
            before += 0.5*mpm_fields_of(&g.p)->strain[i].c[2].w*square;
            kept += 0.5*mpm_fields_of(&g.p)->strain[i].c[2].w*square*keep*keep;
        }
        tobi_launch_each(&g.exec, g.kernels->scatter, &g.view, g.grid.block_count, NULL);
        tobi_launch_each(&g.exec, g.kernels->scatter_unstressed, &g.view, g.grid.block_count, came);
        tobi_launch_each(&g.exec, g.kernels->collect, &g.view, g.grid.patch_count, NULL);
        tobi_launch_each(&g.exec, g.kernels->energy_nodes, &g.view, g.grid.patch_count, there);
        for (int64_t n = 0; n < g.grid.patch_count*(dim == 3 ? MPM_NODES_3D : MPM_NODES_2D); n++)
            for (int a = 0; a < 3; a++) nodes += 0.5*g.view.node[n].w*pow((&g.view.node[n].x)[a], 2);
        assert_true(fabs(came[0] - before) < 1e-5*before && fabs(came[1] - kept) < 1e-5*kept);
        assert_true(fabs(there[0] - nodes) < 1e-5*nodes);
        /* a uniform flow loses but what the materials' damping makes of it */
        for (int64_t i = 0; i < g.p.count; i++) {
            g.p.velocity[i] = (tobi_float4){1, -2, dim == 3 ? 3 : 0, 0};
            memset(&mpm_fields_of(&g.p)->affine[i], 0, sizeof mpm_fields_of(&g.p)->affine[i]);
        }
        tobi_launch_each(&g.exec, g.kernels->scatter_unstressed, &g.view, g.grid.block_count, came);
        tobi_launch_each(&g.exec, g.kernels->energy_unstressed, &g.view, g.grid.patch_count, unstressed);
        assert_true(unstressed[0] < (1 + 1e-6)*came[1] && unstressed[0] > 0.999*came[1]);
        end(&g);
    }
}

/* Where each kernel over blocks meets its oracle; packs of contacts meet theirs in test_pack_oracle.c. */
#define oracle_of_scatter transfers_match_the_oracle
#define oracle_of_collect transfers_match_the_oracle
#define oracle_of_gather transfers_match_the_oracle
#define oracle_of_filter transfers_match_the_oracle
#define oracle_of_filter_nodes transfers_match_the_oracle
#define oracle_of_scatter_unstressed energies_match_sums
#define oracle_of_energy_unstressed energies_match_sums
#define oracle_of_energy_nodes energies_match_sums
static const struct { const char *name; size_t offset; void (*oracle)(void **); } kernels[] = {
#define BLOCK(K, SUMS, MAXIMA, DOC) {#K, offsetof(mpm_kernels, K), oracle_of_##K},
#define PACK(K, SUMS, MAXIMA, DOC)
#include "mpm/kernels.def"
#undef BLOCK
#undef PACK
};

static void kernels_keep_to_their_totals(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        rig g;
        make(&g, dim, -1, 0.1, 1, 0, TOBI_XPIC);
        step(&g, TOBI_XPIC, 0);
        for (size_t n = 0; n < sizeof kernels/sizeof *kernels; n++) {
            const tobi_kernel k = *(const tobi_kernel *)((const char *)g.kernels + kernels[n].offset);
            double t[TOBI_TOTALS] = {0};
            const int blocks = strstr(kernels[n].name, "gather") || strstr(kernels[n].name, "scatter") ||
                               !strcmp(kernels[n].name, "filter");
            assert_non_null(kernels[n].oracle);
            k.run(&g.view, 0, blocks ? g.grid.block_count : g.grid.patch_count, t);
            if (!tobi_kernel_keeps(k, t)) fail_msg("%s: totals beside those of its line", kernels[n].name);
        }
        end(&g);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decomposition_gives_back),
        cmocka_unit_test(transfers_match_the_oracle),
        cmocka_unit_test(energies_match_sums),
        cmocka_unit_test(kernels_keep_to_their_totals),
        cmocka_unit_test(shown_stress_matches_the_oracle),
        cmocka_unit_test(oldest_instruction_set_matches_the_oracle),
        cmocka_unit_test(neither_threads_nor_instruction_sets_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
