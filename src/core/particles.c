/* One struct of pointers for all methods and one of each method's own; both are reached through the lists
   that they are made from. Drawback: a walk over fields finds its pointers by their offset, unseen by the
   compiler. */
#include "core/particles.h"
#include "exec/exec.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { DIGIT = 11, FIELD_LIMIT = 64 };

#define ROW(...) TOBI_FIELD_ROW(tobi_particles, __VA_ARGS__)
static const tobi_field common[] = { TOBI_COMMON_FIELDS(ROW) };
enum { COMMON = sizeof common/sizeof *common };

static int is_there(const tobi_field *f, unsigned needs) { return !f->need || f->need & needs; }

/* Field k of those that are there, and where its pointer is kept; NULL past the last. */
static const tobi_field *find_field(const tobi_particles *p, int k, char **slot)
{
    *slot = (char *)p + (k < COMMON ? common[k].offset : 0);
    if (k < COMMON) return &common[k];
    for (int j = 0, at = COMMON; p->list && j < p->list->count; j++) {
        const tobi_field *f = &p->list->field[j];
        if (!is_there(f, p->needs)) continue;
        *slot = (char *)p->own + f->offset;
        if (at++ == k) return f;
    }
    return NULL;
}

static void *get_array(const char *slot)
{
    void *data;
    memcpy(&data, slot, sizeof data);
    return data;
}

static void set_array(char *slot, void *data) { memcpy(slot, &data, sizeof data); }

void *tobi_particles_rows(int64_t rows, size_t row) { return tobi_array_zero(rows + TOBI_PAD_ROWS, row); }

static int is_leased(const tobi_field *f) { return f->life != TOBI_STATE && f->life != TOBI_SCRATCH; }

/* at[k]: where field k of the list, if it lives in stages, begins in a row of lent memory: in list order,
   each at the lowest place that no field of the same stage has. Returns the bytes of a row. */
static size_t place_leased(const tobi_field_list *list, unsigned needs, size_t at[FIELD_LIMIT])
{
    size_t row = 0;
    for (int k = 0; list && k < list->count; k++) {
        const tobi_field *f = &list->field[k];
        if (!is_leased(f) || !is_there(f, needs)) continue;
        at[k] = 0;
        for (int j = 0; j < k; j++) {
            const tobi_field *g = &list->field[j];
            if (!is_leased(g) || !is_there(g, needs) || !(f->life & g->life)) continue;
            if (at[k] >= at[j] + g->bytes || at[j] >= at[k] + f->bytes) continue;
            at[k] = at[j] + g->bytes;
            j = -1;                                    /* the ones before may be in the way now */
        }
        if (at[k] + f->bytes > row) row = at[k] + f->bytes;
    }
    return row;
}

/* Rows of lent arrays: each begins on a cache line, whatever its place. */
static size_t leased_rows(int64_t rows) { return ((size_t)rows + TOBI_PAD_ROWS + 63)/64*64; }

static int make_leased(tobi_particles *p, int64_t rows)
{
    size_t at[FIELD_LIMIT], row = place_leased(p->list, p->needs, at);
    tobi_particles_stage(p, 0);
    if (row == 0) return 1;
    char *made = tobi_particles_rows((int64_t)leased_rows(rows), row);
    if (!made) return 0;
    tobi_array_free(p->lent);
    p->lent = made;
    return 1;
}

/* Values that nobody should read. */
static inline int poison(void *data, size_t bytes)
{
    memset(data, 0xff, bytes);
    return 1;
}

void tobi_particles_stage(tobi_particles *p, int stages)
{
    size_t at[FIELD_LIMIT];
    const size_t rows = leased_rows(p->capacity);
    place_leased(p->list, p->needs, at);
    for (int k = 0; p->list && k < p->list->count; k++) {
        const tobi_field *f = &p->list->field[k];
        char *slot = (char *)p->own + f->offset;
        if (!is_leased(f) || !is_there(f, p->needs)) continue;
        if (get_array(slot) && !(f->life & stages)) assert(poison(get_array(slot), rows*f->bytes));
        set_array(slot, f->life & stages ? p->lent + rows*at[k] : NULL);
    }
    p->stages = stages;
}

/* All arrays for so many rows, what was in them kept; one after the other, so that no more than one is there
   twice. On failure each has at least the rows that it had. */
static int resize(tobi_particles *p, int64_t rows)
{
    char *slot;
    if (!make_leased(p, rows)) return 0;
    for (int k = 0;; k++) {
        const tobi_field *f = find_field(p, k, &slot);
        if (!f) break;
        if (is_leased(f)) continue;
        void *made = tobi_particles_rows(rows, f->bytes), *old = get_array(slot);
        if (!made) return 0;
        if (old) memcpy(made, old, (size_t)p->count*f->bytes);
        tobi_array_free(old);
        set_array(slot, made);
    }
    p->capacity = rows;
    return 1;
}

/* No arrays yet. */
static int begin(tobi_particles *p, const tobi_field_list *list, unsigned needs)
{
    *p = (tobi_particles){ .list = list, .needs = needs };
    if (list) p->own = calloc(1, list->size);
    return !list || p->own;
}

static tobi_status give_up(tobi_particles *p, int64_t rows, tobi_error *err)
{
    const int64_t each = tobi_particles_row_bytes(p->list, p->needs);
    tobi_particles_free(p);
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld particles (%lld bytes each)", (long long)rows,
                     (long long)each);
}

tobi_status tobi_particles_create(tobi_particles *p, const tobi_field_list *list, unsigned needs,
                                  int64_t capacity, tobi_error *err)
{
    return begin(p, list, needs) && resize(p, capacity) ? TOBI_OK : give_up(p, capacity, err);
}

void tobi_particles_free(tobi_particles *p)
{
    char *slot;
    if (p->own) tobi_particles_stage(p, 0);
    for (int k = 0; (k < COMMON || p->own) && find_field(p, k, &slot); k++) tobi_array_free(get_array(slot));
    tobi_array_free(p->lent);
    free(p->own);
    memset(p, 0, sizeof *p);
}

tobi_status tobi_particles_reserve(tobi_particles *p, const tobi_field_list *list, unsigned needs,
                                   int64_t capacity, tobi_error *err)
{
    char *slot;
    int good = begin(p, list, needs);
    for (int k = 0; good; k++) {
        const tobi_field *f = find_field(p, k, &slot);
        if (!f) break;
        if (f->life != TOBI_STATE) continue;
        void *made = tobi_array_make(capacity + TOBI_PAD_ROWS, f->bytes);
        set_array(slot, made);
        good = made != NULL;
    }
    p->capacity = capacity;
    return good ? TOBI_OK : give_up(p, capacity, err);
}

int64_t tobi_particles_add(tobi_particles *p)
{
    const int64_t i = p->count++;
    char *slot;
    for (int k = 0;; k++) {
        const tobi_field *f = find_field(p, k, &slot);
        if (!f) break;
        char *data = get_array(slot);
        if (data) memset(data + (size_t)i*f->bytes, 0, f->bytes);
    }
    p->id[i] = p->next_id++;
    return i;
}

tobi_status tobi_particles_fit(tobi_particles *p, tobi_error *err)
{
    return resize(p, p->count) ? TOBI_OK : give_up(p, p->count, err);
}

tobi_status tobi_particles_room(tobi_particles *p, int64_t rows, tobi_error *err)
{
    if (rows <= p->capacity || resize(p, rows + rows/8)) return TOBI_OK;
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld more particles", (long long)(rows - p->count));
}

tobi_status tobi_particles_insert(tobi_particles *p, int64_t count, int64_t *first, tobi_error *err)
{
    TOBI_TRY(tobi_particles_room(p, p->count + count, err));
    *first = p->count;
    for (int64_t k = 0; k < count; k++) tobi_particles_add(p);
    return TOBI_OK;
}

void tobi_particles_copy(tobi_particles *p, int64_t from, int64_t to)
{
    void *data;
    for (int k = 0;; k++) {
        const tobi_field *f = tobi_particles_state(p, k, &data);
        if (!f) return;
        memcpy((char *)data + (size_t)to*f->bytes, (char *)data + (size_t)from*f->bytes, f->bytes);
    }
}

void tobi_particles_remove(tobi_particles *p, const int32_t *rows, int64_t count)
{
    const int64_t left = p->count - count;
    int64_t last = p->count - 1, gone = count - 1;
    for (int64_t k = 0; k < count && rows[k] < left; k++) {
        for (; gone >= 0 && rows[gone] == last; gone--) last--;
        tobi_particles_copy(p, last--, rows[k]);
    }
    p->count = left;
}

int64_t tobi_particles_row_bytes(const tobi_field_list *list, unsigned needs)
{
    size_t bytes = 0, at[FIELD_LIMIT];
    for (int k = 0; k < COMMON; k++) bytes += common[k].bytes;
    for (int k = 0; list && k < list->count; k++)
        if (is_there(&list->field[k], needs) && !is_leased(&list->field[k])) bytes += list->field[k].bytes;
    return (int64_t)(bytes + place_leased(list, needs, at));
}

int64_t tobi_particles_state_bytes(const tobi_field_list *list, unsigned needs)
{
    size_t bytes = 0;
    for (int k = 0; k < COMMON; k++)
        if (common[k].life == TOBI_STATE) bytes += common[k].bytes;
    for (int k = 0; list && k < list->count; k++) {
        const tobi_field *f = &list->field[k];
        if (is_there(f, needs) && f->life == TOBI_STATE) bytes += f->bytes;
    }
    return (int64_t)bytes;
}

int64_t tobi_particles_widest(const tobi_particles *p)
{
    size_t widest = 0;
    void *data;
    const tobi_field *f;
    for (int k = 0; (f = tobi_particles_state(p, k, &data)); k++)
        if (f->bytes > widest) widest = f->bytes;
    return (int64_t)widest;
}

void tobi_particles_permute(tobi_particles *p, const int32_t *order, void *scratch, int threads)
{
    void *data;
    const tobi_field *f;
    for (int k = 0; (f = tobi_particles_state(p, k, &data)); k++)
        tobi_permute(threads, data, f->bytes, order, p->count, scratch);
}

/* By digits from the lowest, as many as the ids have. */
void tobi_particles_order(const tobi_particles *p, int32_t *rows, int32_t *spare)
{
    const int64_t n = p->count;
    int32_t *from = rows, *to = spare;
    for (int64_t k = 0; k < n; k++) rows[k] = (int32_t)k;
    for (int shift = 0; p->next_id >> shift > 0; shift += DIGIT) {
        int32_t start[(1 << DIGIT) + 1] = { 0 };
        for (int64_t k = 0; k < n; k++) start[(p->id[k] >> shift & ((1 << DIGIT) - 1)) + 1]++;
        for (int d = 0; d < 1 << DIGIT; d++) start[d + 1] += start[d];
        for (int64_t k = 0; k < n; k++) to[start[p->id[from[k]] >> shift & ((1 << DIGIT) - 1)]++] = from[k];
        int32_t *swap = from;
        from = to;
        to = swap;
    }
    if (from != rows) memcpy(rows, from, (size_t)n*sizeof *rows);
}

const tobi_field *tobi_particles_state(const tobi_particles *p, int number, void **data)
{
    char *slot;
    for (int k = 0, at = 0;; k++) {
        const tobi_field *f = find_field(p, k, &slot);
        if (!f || (f->life == TOBI_STATE && at++ == number)) {
            *data = f ? get_array(slot) : NULL;
            return f;
        }
    }
}
