/* The kernels over packs of contacts once more, in double, contact by contact: no packs, no lanes. Nodes and
   weights are random; packs of one to four contacts share nodes. */
#include "exec/exec.h"
#include "mpm/kernels.h"
#include "mpm/contact/pack.k.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

enum { PACKS = 60, CONTACTS = 4*PACKS, NODES = 400, EACH = 27, ISAS = 3 };

/* A contact: the nodes of its pack, and its own weights along the normal and across. */
typedef struct contact { int pack, lane; double weight[EACH][2]; } contact;

typedef struct state {
    mpm_pack pack[PACKS];
    uint32_t node[PACKS*EACH];
    float weight[PACKS*EACH*8];
    tobi_float4 velocity[NODES], push[2*CONTACTS], moving[2*CONTACTS];
    mpm_response response[NODES];
    contact contact[CONTACTS];
    int contacts;
} state;

static uint64_t seed;
static double random_unit(void)
{
    seed = seed*6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11)/9007199254740992.0;
}

static tobi_float4 random_four(double last)
{
    return (tobi_float4){ (float)(random_unit() - 0.5), (float)(random_unit() - 0.5),
                          (float)(random_unit() - 0.5), (float)last };
}

/* Weights across have either sign; some nodes are empty. */
static void fill(state *s)
{
    memset(s, 0, sizeof *s);
    seed = 5;
    for (int n = 0; n < NODES; n++) s->velocity[n] = random_four(n%17 == 0 ? 0 : 0.2 + random_unit());
    for (int p = 0; p < PACKS; p++) {
        mpm_pack *k = &s->pack[p];
        *k = (mpm_pack){ .used = 1 + p%4, .count = p%5 == 0 ? 9 : EACH, .node = p*EACH, .weight = p*EACH*8 };
        const uint32_t first = (uint32_t)(random_unit()*(NODES - EACH));
        for (int n = 0; n < k->count; n++) s->node[k->node + n] = first + (uint32_t)n;
        for (int l = 0; l < 4; l++) k->contact[l] = l < k->used ? s->contacts + l : s->contacts;
        for (int l = 0; l < k->used; l++) {
            contact *c = &s->contact[s->contacts++];
            *c = (contact){ .pack = p, .lane = l };
            for (int n = 0; n < k->count; n++)
                for (int m = 0; m < 2; m++) {
                    const float w = (float)(m ? random_unit() - 0.5 : random_unit());
                    c->weight[n][m] = s->weight[k->weight + 8*n + 4*m + l] = w;
                }
        }
    }
    for (int c = 0; c < 2*CONTACTS; c++) s->push[c] = random_four(0);
}

static mpm_pack_view see(state *s)
{
    return (mpm_pack_view){ s->pack, s->node, s->weight, s->velocity, s->response, s->push, s->moving };
}

static int node_of(const state *s, const contact *c, int n)
{
    return (int)s->node[s->pack[c->pack].node + n];
}

static void close_to(double made, double expected, double size)
{
    if (!(fabs(made - expected) <= 2e-6*size + 1e-30)) fail_msg("%g instead of %g", made, expected);
}

/* Sums of the sizes of all weights at each node, over its mass. */
static void find_load(const state *s, double load[NODES][2])
{
    memset(load, 0, NODES*sizeof *load);
    for (int c = 0; c < s->contacts; c++)
        for (int n = 0; n < s->pack[s->contact[c].pack].count; n++)
            for (int m = 0; m < 2; m++) {
                const int at = node_of(s, &s->contact[c], n);
                if (s->velocity[at].w > 0)
                    load[at][m] += fabs(s->contact[c].weight[n][m])/(double)s->velocity[at].w;
            }
}

static int best_isa(void)
{
    tobi_exec exec;
    assert_int_equal(tobi_exec_init(&exec, 1, NULL), TOBI_OK);
    const int best = exec.isa;
    tobi_exec_free(&exec);
    return best;
}

static void run(state *s, tobi_kernel kernel)
{
    const mpm_pack_view v = see(s);
    kernel.run(&v, 0, PACKS, NULL);
}

static void loads_and_answers(void **unused)
{
    const int best = best_isa();
    static state s;
    static double load[NODES][2];
    (void)unused;
    for (int isa = 2; isa < 2 + ISAS && isa <= best; isa++) {
        const mpm_pack_kernels *k = mpm_pack_kernels_for(isa);
        fill(&s);
        find_load(&s, load);
        run(&s, k->load);
        for (int n = 0; n < NODES; n++)
            for (int m = 0; m < 2; m++) close_to(s.response[n].load[m], load[n][m], load[n][m]);
        run(&s, k->answer);
        for (int c = 0; c < s.contacts; c++)
            for (int m = 0; m < 2; m++) {
                double sum = 0;
                for (int n = 0; n < s.pack[s.contact[c].pack].count; n++)
                    sum += fabs(s.contact[c].weight[n][m])*load[node_of(&s, &s.contact[c], n)][m];
                close_to(s.moving[2*c + m].w, sum, sum);
            }
        run(&s, k->forget);
        for (int n = 0; n < NODES; n++) assert_true(s.response[n].load[0] == 0 && s.response[n].load[1] == 0);
    }
}

/* The velocity along is sum w v, that across sum w' v. */
static void reads(void **unused)
{
    const int best = best_isa();
    static state s;
    (void)unused;
    for (int isa = 2; isa < 2 + ISAS && isa <= best; isa++) {
        fill(&s);
        run(&s, mpm_pack_kernels_for(isa)->read);
        for (int c = 0; c < s.contacts; c++)
            for (int m = 0; m < 2; m++)
                for (int a = 0; a < 3; a++) {
                    double sum = 0, size = 0;
                    for (int n = 0; n < s.pack[s.contact[c].pack].count; n++) {
                        const tobi_float4 u = s.velocity[node_of(&s, &s.contact[c], n)];
                        sum += s.contact[c].weight[n][m]*(&u.x)[a];
                        size += fabs(s.contact[c].weight[n][m]*(&u.x)[a]);
                    }
                    close_to((&s.moving[2*c + m].x)[a], sum, size);
                }
    }
}

/* Each node gains (w J + w' J')/m of all contacts; what goes over is the sum of the impulses. */
static void pushes(void **unused)
{
    const int best = best_isa();
    static state s;
    static double gain[NODES][3], size[NODES][3];
    (void)unused;
    for (int isa = 2; isa < 2 + ISAS && isa <= best; isa++) {
        const mpm_pack_kernels *k = mpm_pack_kernels_for(isa);
        fill(&s);
        run(&s, k->load);
        for (int n = 0; n < NODES; n++)
            for (int a = 0; a < 3; a++) size[n][a] = fabs(gain[n][a] = (&s.velocity[n].x)[a]);
        for (int c = 0; c < s.contacts; c++)
            for (int n = 0; n < s.pack[s.contact[c].pack].count; n++)
                for (int a = 0; a < 3; a++) {
                    const int at = node_of(&s, &s.contact[c], n);
                    const double mass = s.velocity[at].w;
                    for (int m = 0; m < 2 && mass > 0; m++) {
                        const double more = s.contact[c].weight[n][m]*(&s.push[2*c + m].x)[a]/mass;
                        gain[at][a] += more;
                        size[at][a] += fabs(more);
                    }
                }
        run(&s, k->push);
        for (int n = 0; n < NODES; n++)
            for (int a = 0; a < 3; a++) close_to((&s.velocity[n].x)[a], gain[n][a], size[n][a]);
    }
}

/* Where each kernel of the list meets its oracle. */
#define oracle_of_load loads_and_answers
#define oracle_of_answer loads_and_answers
#define oracle_of_forget loads_and_answers
#define oracle_of_read reads
#define oracle_of_push pushes

int main(void)
{
    const struct CMUnitTest tests[] = {
#define BLOCK(K, SUMS, MAXIMA, DOC)
#define PACK(K, SUMS, MAXIMA, DOC) cmocka_unit_test(oracle_of_##K),
#include "mpm/kernels.def"
#undef BLOCK
#undef PACK
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
