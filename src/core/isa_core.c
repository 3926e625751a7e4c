/* Turns kernels.def into loops, compiled once per instruction set, and the neighbour search. For each cell
   the rows of cells around it are contiguous runs; their records are unpacked once for all particles of the
   cell, which then test as many candidates at once as a register holds and pack the hits to the front.
   Drawback: the search is written for wide registers alone, a device will need another. */
#include "core/cells.k.h"
#include "core/kernels.h"

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)

#if defined(__AVX512F__)
enum { MANY = 16 };           /* candidates tested at once: no bit of a list depends on it */
#else
enum { MANY = 8 };
#endif
typedef float   many     __attribute__((vector_size(4*MANY)));
typedef int32_t many_int __attribute__((vector_size(4*MANY)));
typedef uint32_t many_uint __attribute__((vector_size(4*MANY)));

enum {
    BATCH = 16,               /* particles of one cell that are searched for together     */
    CHUNK = 512,              /* candidates unpacked at once                              */
    MAX_NEIGHBORS = TOBI_LIST_LIMIT, ROOM = MAX_NEIGHBORS + 32, MAX_RUNS = 27,
    FOUND = 2*BATCH*ROOM      /* entries kept before they go to the region of their block  */
};

/* Bit k: candidate k is nearer than sqrt(h2) and is not i itself. */
static inline unsigned test(many r2, float h2, many_int index, int32_t i)
{
#if defined(__AVX512F__)
    __mmask16 near = _mm512_cmp_ps_mask((__m512)r2, _mm512_set1_ps(h2), _CMP_LT_OQ);
    return _mm512_mask_cmpneq_epi32_mask(near, (__m512i)index, _mm512_set1_epi32(i));
#else
    many_int hit = (r2 < h2) & (index != i);
#if defined(__AVX2__)
    return (unsigned)_mm256_movemask_ps((__m256)hit);
#else
    unsigned m = 0;
    for (int k = 0; k < MANY; k++) m |= (unsigned)(hit[k] & 1) << k;
    return m;
#endif
#endif
}

/* Writes the elements of index whose bit is set to out (MANY slots); returns how many. */
static inline int pack(int32_t *out, many_int index, unsigned m)
{
#if defined(__AVX512F__)
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32((__mmask16)m, (__m512i)index));
#elif defined(__AVX2__) && defined(__BMI2__)
    uint64_t bytes = _pdep_u64(m, 0x0101010101010101u)*0xFF;
    uint64_t order = _pext_u64(0x0706050403020100u, bytes);
    __m256i perm = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((int64_t)order));
    _mm256_storeu_si256((__m256i *)(void *)out, _mm256_permutevar8x32_epi32((__m256i)index, perm));
#else
    int n = 0;
    for (int k = 0; k < MANY; k++) {
        out[n] = index[k];
        n += m >> k & 1;
    }
#endif
    return __builtin_popcount(m);
}

typedef struct run { int32_t begin, end; } run;

/* The contiguous index ranges that hold all candidates of a particle in cell (cx, cy, cz). */
static int find_runs(const tobi_cells_view *c, int cx, int cy, int cz, run *runs)
{
    int count = 0;
    int depth = c->n[2] > 1 ? 1 : 0;
    for (int dz = -depth; dz <= depth; dz++) {
        int z = cz + dz;
        if (c->periodic[2]) z = (z + c->n[2])%c->n[2];
        else if (z < 0 || z >= c->n[2]) continue;
        for (int dy = -1; dy <= 1; dy++) {
            int y = cy + dy;
            if (c->periodic[1]) y = (y + c->n[1])%c->n[1];
            else if (y < 0 || y >= c->n[1]) continue;
            int64_t row = cells_row(c, y, z);
            int first = cx > 0 ? cx - 1 : 0, last = cx + 1 < c->n[0] ? cx + 1 : c->n[0] - 1;
            runs[count++] = (run){c->start[row + first], c->start[row + last + 1]};
            if (!c->periodic[0]) continue;
            if (cx == 0) runs[count++] = (run){c->start[row + c->n[0] - 1], c->start[row + c->n[0]]};
            if (cx == c->n[0] - 1) runs[count++] = (run){c->start[row], c->start[row + 1]};
        }
    }
    return count;
}

typedef struct candidates {
    int count;
    int32_t x[CHUNK + MANY], y[CHUNK + MANY], z[CHUNK + MANY], index[CHUNK + MANY];
} candidates;

static inline many_int load(const int32_t *p)
{
    many_int a;
    __builtin_memcpy(&a, p, sizeof a);
    return a;
}

/* Unpacks records [begin, end), at most CHUNK less those there already; returns the first left over. */
static int32_t unpack(const tobi_cells_view *v, int32_t begin, int32_t end, candidates *c)
{
    static const int32_t STEP[TOBI_LANES] = {0, 1, 2, 3, 4, 5, 6, 7};
    if (end - begin > CHUNK - c->count) end = begin + CHUNK - c->count;
    for (int32_t j = begin; j < end; j += TOBI_LANES) {
        lane_int x, y, z, index = lane_load_index(STEP) + j;
        lane w;
        int at = c->count + (j - begin);
        lane_load_record(v->record + j, STEP, &x, &y, &z, &w);
        __builtin_memcpy(c->x + at, &x, sizeof x);
        __builtin_memcpy(c->y + at, &y, sizeof y);
        __builtin_memcpy(c->z + at, &z, sizeof z);
        __builtin_memcpy(c->index + at, &index, sizeof index);
    }
    c->count += end - begin;
    return end;
}

/* own - x in metres; wraps around periodic sides. */
static inline many distance(int32_t own, const int32_t *x, float from_fixed)
{
    many_int d = (many_int)((uint32_t)own - (many_uint)load(x));
    return __builtin_convertvector(d, many)*from_fixed;
}

/* Appends the neighbours of i among the candidates to its n hits; returns how many it has now. */
static int search(const tobi_cells_view *v, int32_t i, const candidates *c, int32_t *out, int n)
{
    const tobi_record own = v->record[i];
    for (int k = 0; k < c->count && n <= MAX_NEIGHBORS; k += MANY) {
        many dx = distance(own.x, c->x + k, v->from_fixed[0]);
        many dy = distance(own.y, c->y + k, v->from_fixed[1]);
        many dz = distance(own.z, c->z + k, v->from_fixed[2]);
        many_int index = load(c->index + k);
        unsigned hit = test(dx*dx + dy*dy + dz*dz, v->h2, index, i);
        if (k + MANY > c->count) hit &= (1u << (c->count - k)) - 1;
        n += pack(out + n, index, hit);
    }
    return n;
}

typedef struct batch { int32_t begin, end; int count[BATCH]; int32_t hits[BATCH][ROOM]; } batch;

/* The neighbours of particles of one cell, by run; 0: too many. */
static int search_cell(const tobi_cells_view *v, const run *runs, int run_count, batch *b)
{
    candidates c;
    c.count = 0;
    __builtin_memset(b->count, 0, sizeof b->count);
    for (int r = 0; r < run_count; r++)
        for (int32_t j = runs[r].begin, last = r + 1 == run_count; j < runs[r].end || last;) {
            if (j < runs[r].end) j = unpack(v, j, runs[r].end, &c);
            int done = last && j >= runs[r].end;
            if (c.count < CHUNK && !done) continue;
            for (int32_t i = b->begin; i < b->end; i++) {
                int *n = &b->count[i - b->begin];
                *n = search(v, i, &c, b->hits[i - b->begin], *n);
                if (*n > MAX_NEIGHBORS - 16) return 0;
            }
            c.count = 0;
            if (done) break;
        }
    return 1;
}

/* Lists of particles [begin, end) on their way into the region; starts count from their first. groups: those
   before them. */
typedef struct lists { int32_t begin, end; int64_t used, groups; int32_t found[FOUND]; } lists;

/* Whole groups of 8, padded with the particle itself, packed if the lists are. */
static void append(const tobi_cells_view *v, batch *b, lists *l)
{
    for (int32_t i = b->begin; i < b->end; i++) {
        int n = b->count[i - b->begin];
        int32_t *hits = b->hits[i - b->begin];
        v->list_start[i] = (uint32_t)(l->used/8);
        v->list_groups[i] = (uint16_t)((n + 7)/8);
        while (n & 7) hits[n++] = i;
        if (!v->list_far) __builtin_memcpy(l->found + l->used, hits, (size_t)n*sizeof *hits);
        else if (!tobi_list_pack(hits, n, i, &v->list_far[i], (uint16_t *)l->found + l->used))
            *v->far_apart = 1;
        l->used += n;
    }
    l->end = b->end;
}

/* What does not fit is counted only. */
static void move_lists(const tobi_cells_view *v, const tobi_list_region *to, lists *l)
{
    const int64_t start = to->begin + l->groups;
    l->groups += l->used/8;
    if (l->groups <= to->room) {
        const size_t size = tobi_list_size(v->list_far);
        __builtin_memcpy((char *)v->list + 8*(size_t)start*size, l->found, (size_t)l->used*size);
        for (int32_t i = l->begin; i < l->end; i++) v->list_start[i] += (uint32_t)start;
    }
    l->begin = l->end;
    l->used = 0;
}

/* [begin, end): one block. */
static void cells_search(const void *view, int64_t begin, int64_t end, double *totals)
{
    const tobi_cells_view *v = view;
    tobi_list_region *to = &v->region[begin/TOBI_BLOCK];
    run runs[MAX_RUNS];
    lists l;
    batch b;
    (void)totals;
    if (to->filled) return;
    l.begin = l.end = (int32_t)begin;
    l.used = l.groups = 0;
    for (int32_t i = (int32_t)begin; i < end; i = b.end) {
        tobi_double3 q = v->position[i];
        int x = cells_along(v, 0, q.x), y = cells_along(v, 1, q.y), z = cells_along(v, 2, q.z);
        int32_t next = v->start[cells_row(v, y, z) + x + 1];
        b.begin = i;
        b.end = next < end ? next : (int32_t)end;
        if (b.end > i + BATCH) b.end = i + BATCH;
        if (!search_cell(v, runs, find_runs(v, x, y, z, runs), &b)) {
            *v->overflow = 1;
            return;
        }
        if (l.used > FOUND/2) move_lists(v, to, &l);
        append(v, &b, &l);
    }
    move_lists(v, to, &l);
    to->groups = (uint32_t)l.groups;
    to->filled = to->groups <= to->room;
}

#define CELLS(K, SUMS, MAXIMA, DOC) TOBI_FOR_LOOP(K, tobi_cells_view, run_##K)
#define SEARCH(K, SUMS, MAXIMA, DOC)
#include "core/kernels.def"
#undef CELLS
#undef SEARCH

const tobi_core_kernels JOIN(tobi_core_kernels, TOBI_ISA) = {
#define CELLS(K, SUMS, MAXIMA, DOC) .K = {run_##K, SUMS, MAXIMA},
#define SEARCH(K, SUMS, MAXIMA, DOC) .K = {K, SUMS, MAXIMA},
#include "core/kernels.def"
};
