/* Neighbour search, compiled once per instruction set. For each particle the rows of cells around it
   are contiguous runs; eight candidates are tested at once and the hits packed to the front. */
#include "core/cells.h"

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)

enum { GROUP = 32, MAX_NEIGHBORS = 1024, MAX_RUNS = 27 };

/* Writes the elements of idx whose mask is set to out (8 slots are overwritten); returns how many. */
static inline int pack(int32_t *out, lane_int idx, lane_int mask)
{
#if defined(__AVX512VL__)
    __mmask8 m = (__mmask8)_mm256_movemask_ps((__m256)mask);
    _mm256_storeu_si256((__m256i *)(void *)out, _mm256_maskz_compress_epi32(m, (__m256i)idx));
    return __builtin_popcount(m);
#elif defined(__AVX2__) && defined(__BMI2__)
    unsigned m = (unsigned)_mm256_movemask_ps((__m256)mask);
    uint64_t bytes = _pdep_u64(m, 0x0101010101010101u)*0xFF;
    uint64_t order = _pext_u64(0x0706050403020100u, bytes);
    __m256i perm = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((int64_t)order));
    _mm256_storeu_si256((__m256i *)(void *)out, _mm256_permutevar8x32_epi32((__m256i)idx, perm));
    return __builtin_popcount(m);
#else
    int n = 0;
    for (int k = 0; k < 8; k++) {
        out[n] = idx[k];
        n += mask[k] != 0;
    }
    return n;
#endif
}

typedef struct run { int32_t begin, end; } run;

/* The contiguous index ranges that hold all candidates of a particle in cell (cx, cy, cz). */
static int find_runs(const tobi_cells *c, int cx, int cy, int cz, run *runs)
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
            int64_t row = tobi_cells_row(c, y, z);
            int first = cx > 0 ? cx - 1 : 0, last = cx + 1 < c->n[0] ? cx + 1 : c->n[0] - 1;
            runs[count++] = (run){c->start[row + first], c->start[row + last + 1]};
            if (!c->periodic[0]) continue;
            if (cx == 0) runs[count++] = (run){c->start[row + c->n[0] - 1], c->start[row + c->n[0]]};
            if (cx == c->n[0] - 1) runs[count++] = (run){c->start[row], c->start[row + 1]};
        }
    }
    return count;
}

static int search_runs(const tobi_list_view *v, int32_t i, const run *runs, int run_count, int32_t *out)
{
    static const int32_t STEP[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    tobi_record own = v->record[i];
    int n = 0;
    for (int r = 0; r < run_count; r++)
        for (int32_t j = runs[r].begin; j < runs[r].end; j += 8) {
            lane_int x, y, z, idx = lane_load_index(STEP) + j;
            lane w;
            lane_load_record(v->record + j, STEP, &x, &y, &z, &w);
            lane dx = lane_from_int(lane_sub_wrap(own.x, x))*v->from_fixed[0];
            lane dy = lane_from_int(lane_sub_wrap(own.y, y))*v->from_fixed[1];
            lane dz = lane_from_int(lane_sub_wrap(own.z, z))*v->from_fixed[2];
            lane r2 = dx*dx + dy*dy + dz*dz;
            lane_int hit = (r2 < v->h2) & (idx < runs[r].end) & (idx != i);
            n += pack(out + n, idx, hit);
            if (n > MAX_NEIGHBORS - 16) return n;
        }
    while (n & 7) out[n++] = i;
    return n;
}

static int cell_of(const tobi_cells *c, int axis, double x)
{
    int k = (int)__builtin_floor(x*c->inverse[axis]);
    return k < 0 ? 0 : k >= c->n[axis] ? c->n[axis] - 1 : k;
}

/* A group of particles collects its lists on the stack, then claims room in the shared list. */
static void search_group(const tobi_list_view *v, int32_t begin, int32_t end)
{
    int32_t found[(GROUP + 1)*MAX_NEIGHBORS];
    int count[GROUP], total = 0, at[3] = {-1, -1, -1}, runs = 0;
    run run_list[MAX_RUNS];
    for (int32_t i = begin; i < end; i++) {
        tobi_double3 q = v->position[i];
        int cell[3] = {cell_of(v->cells, 0, q.x), cell_of(v->cells, 1, q.y), cell_of(v->cells, 2, q.z)};
        if (cell[0] != at[0] || cell[1] != at[1] || cell[2] != at[2])
            runs = find_runs(v->cells, cell[0], cell[1], cell[2], run_list);
        __builtin_memcpy(at, cell, sizeof at);
        int n = search_runs(v, i, run_list, runs, found + total);
        if (n > MAX_NEIGHBORS - 16) {
            *v->overflow = 2;
            return;
        }
        count[i - begin] = n;
        total += n;
    }
    int64_t start = __atomic_fetch_add(v->used, total, __ATOMIC_RELAXED);
    if (start + total > v->capacity) {
        if (*v->overflow == 0) *v->overflow = 1;
        return;
    }
    __builtin_memcpy(v->list + start, found, (size_t)total*sizeof *found);
    for (int32_t i = begin; i < end; i++) {
        v->list_start[i] = (uint32_t)(start/8);
        v->list_groups[i] = (uint16_t)(count[i - begin]/8);
        start += count[i - begin];
    }
}

void JOIN(tobi_neighbors, TOBI_ISA)(const void *view, int64_t begin, int64_t end, double *totals)
{
    (void)totals;
    for (int64_t i = begin; i < end; i += GROUP)
        search_group(view, (int32_t)i, (int32_t)(i + GROUP < end ? i + GROUP : end));
}
