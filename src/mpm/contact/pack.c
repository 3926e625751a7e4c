/* Contacts of one block of the grid stand together, and blocks of one colour share no nodes, so that
   threads need no locks and sums have one order. Drawback: contacts crowded in few blocks keep few
   threads busy. */
#include "mpm/contact/pack.h"
#include "base/error.h"
#include <string.h>

enum { BACK = 8 };                     /* packs of a run that a contact may still join             */

void mpm_packs_free(mpm_packs *p)
{
    tobi_array_free(p->pack);
    tobi_array_free(p->run);
    tobi_array_free(p->weight);
    memset(p, 0, sizeof *p);
}

static tobi_status fail_memory(int64_t contacts, tobi_error *err)
{
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld contacts", (long long)contacts);
}

/* At most as many packs and runs as contacts. */
static tobi_status reserve(mpm_packs *p, int64_t contacts, tobi_error *err)
{
    if (contacts <= p->room) return TOBI_OK;
    tobi_array_free(p->pack);
    tobi_array_free(p->run);
    p->room = contacts + contacts/4 + 64;
    p->pack = tobi_array_make(p->room, sizeof *p->pack);
    p->run = tobi_array_make(p->room*2, sizeof *p->run);         /* as found, and by colour */
    if (p->pack && p->run) return TOBI_OK;
    p->room = 0;
    return fail_memory(contacts, err);
}

static tobi_status reserve_weights(mpm_packs *p, int64_t contacts, tobi_error *err)
{
    if (p->weight_count <= p->weight_room) return TOBI_OK;
    tobi_array_free(p->weight);
    p->weight_room = p->weight_count + p->weight_count/4 + 4096;
    p->weight = tobi_array_make(p->weight_room, sizeof *p->weight);
    if (p->weight) return TOBI_OK;
    p->weight_room = 0;
    return fail_memory(contacts, err);
}

static int64_t entry_of(const mpm_pack_entries *e, int64_t k)
{
    return k < e->edge_first ? k*e->each : e->edge_first*e->each + (k - e->edge_first)*e->edge_each;
}

/* Tiles of blocks that are not neighbours share no nodes. */
static int colour_of(const mpm_block *b)
{
    return (b->corner[0] >> 2 & 1)*4 + (b->corner[1] >> 2 & 1)*2 + (b->corner[2] >> 2 & 1);
}

/* Runs of contacts, those of one block each and that of the edge, sorted by colour. */
static void list_runs(mpm_packs *p, const mpm_pack_entries *e, const int32_t *particle, size_t stride,
                      const mpm_grid *g)
{
    mpm_pack_run *found = p->run + p->room;
    const mpm_block *b = g->block;
    int64_t count = 0, next[MPM_PACK_COLOURS + 1] = { 0 };
    for (int64_t k = 0; k < e->edge_first; k++) {
        const int32_t i = *(const int32_t *)((const char *)particle + (size_t)k*stride);
        if (count > 0 && i < b->end) {
            found[count - 1].end = k + 1;
            continue;
        }
        while (i >= b->end) b++;
        found[count++] = (mpm_pack_run){ .first = k, .end = k + 1, .colour = colour_of(b) };
    }
    if (e->contacts > e->edge_first)
        found[count++] = (mpm_pack_run){ .first = e->edge_first, .end = e->contacts,
                                         .colour = MPM_PACK_COLOURS - 1 };
    for (int64_t n = 0; n < count; n++) next[found[n].colour + 1]++;
    for (int c = 0; c < MPM_PACK_COLOURS; c++) next[c + 1] += next[c];
    memcpy(p->colour, next, sizeof next);
    for (int64_t n = 0; n < count; n++) p->run[next[found[n].colour]++] = found[n];
    p->run_count = count;
}

/* Puts a contact into one of the last packs of the run that has its nodes, or opens another. */
static void join(mpm_packs *p, const mpm_pack_entries *e, const mpm_pack_run *run, int64_t k)
{
    const int64_t first = entry_of(e, k), count = entry_of(e, k + 1) - first;
    for (int64_t n = p->count - 1; n >= run->begin && n >= p->count - BACK; n--) {
        mpm_pack *at = &p->pack[n];
        if (at->used == 4 || memcmp(e->node + at->node, e->node + first, (size_t)count*sizeof *e->node))
            continue;
        at->contact[at->used++] = (int32_t)k;
        return;
    }
    const int32_t c = (int32_t)k;
    p->pack[p->count++] = (mpm_pack){ .contact = {c, c, c, c}, .used = 1, .count = (int32_t)count,
                                      .node = first, .weight = p->weight_count };
    p->weight_count += 8*count;
}

static void spread_weights(const mpm_packs *p, const mpm_pack_entries *e, const mpm_pack *at)
{
    static const float none[2*MPM_PACK_NODES] = { 0 };
    const float *from[4];
    float *to = p->weight + at->weight;
    for (int k = 0; k < 4; k++) from[k] = k < at->used ? e->weight + 2*entry_of(e, at->contact[k]) : none;
    for (int n = 0; n < 2*at->count; n++)
        for (int k = 0; k < 4; k++) to[4*n + k] = from[k][n];
}

tobi_status mpm_packs_make(mpm_packs *p, const mpm_pack_entries *e, const int32_t *particle, size_t stride,
                           const mpm_grid *g, tobi_error *err)
{
    TOBI_TRY(reserve(p, e->contacts, err));
    list_runs(p, e, particle, stride, g);
    p->count = p->weight_count = 0;
    for (int64_t r = 0; r < p->run_count; r++) {
        mpm_pack_run *run = &p->run[r];
        run->begin = p->count;
        for (int64_t k = run->first; k < run->end; k++) join(p, e, run, k);
        run->last = p->count;
    }
    TOBI_TRY(reserve_weights(p, e->contacts, err));
    for (int64_t n = 0; n < p->count; n++) spread_weights(p, e, &p->pack[n]);
    return TOBI_OK;
}

typedef struct visiting { const mpm_pack_run *run; tobi_kernel kernel; const mpm_pack_view *view; } visiting;

static void visit_runs(const void *view, int64_t begin, int64_t end)
{
    const visiting *v = view;
    for (int64_t r = begin; r < end; r++) v->kernel.run(v->view, v->run[r].begin, v->run[r].last, NULL);
}

void mpm_packs_visit(const mpm_packs *p, tobi_kernel kernel, const mpm_pack_view *view, int threads)
{
    if (threads == 1) {
        kernel.run(view, 0, p->count, NULL);
        return;
    }
    for (int c = 0; c < MPM_PACK_COLOURS; c++) {
        const visiting runs = { p->run + p->colour[c], kernel, view };
        tobi_loop(threads, p->colour[c + 1] - p->colour[c], 1, visit_runs, &runs);
    }
}
