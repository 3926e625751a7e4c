#include "core/particles.h"
#include "exec/exec.h"
#include <stdlib.h>
#include <string.h>

enum { PAD_ROWS = 16 };

static size_t bytes_of(int64_t rows, size_t row) { return (((size_t)rows + PAD_ROWS)*row + 63)/64*64; }

static void *make_zero(int64_t rows, size_t row)
{
    void *data = aligned_alloc(64, bytes_of(rows, row));
    if (data) memset(data, 0, bytes_of(rows, row));
    return data;
}

static tobi_status give_up(tobi_particles *p, int64_t rows, int owners, tobi_error *err)
{
    tobi_particles_free(p);
    return tobi_fail(err, TOBI_NO_MEMORY, "no memory for %lld particles (%lld bytes each)", (long long)rows,
                     (long long)tobi_particles_row_bytes(owners));
}

tobi_status tobi_particles_create(tobi_particles *p, int64_t capacity, int owners, tobi_error *err)
{
    int failed = 0;
    memset(p, 0, sizeof *p);
    p->capacity = capacity;
#define X(type, name, life, owner, unit, doc)                                          \
    if ((owner) & owners) failed |= !(p->name = make_zero(capacity, sizeof(type)));
    TOBI_PARTICLE_FIELDS(X)
#undef X
    return failed ? give_up(p, capacity, owners, err) : TOBI_OK;
}

void tobi_particles_free(tobi_particles *p)
{
#define X(type, name, life, owner, unit, doc) free(p->name);
    TOBI_PARTICLE_FIELDS(X)
#undef X
    memset(p, 0, sizeof *p);
}

tobi_status tobi_particles_reserve(tobi_particles *p, int64_t capacity, int owners, tobi_error *err)
{
    int failed = 0;
    memset(p, 0, sizeof *p);
    p->capacity = capacity;
#define X(type, name, life, owner, unit, doc)                                          \
    if ((owner) & owners && (life) == TOBI_STATE)                                      \
        failed |= !(p->name = aligned_alloc(64, bytes_of(capacity, sizeof(type))));
    TOBI_PARTICLE_FIELDS(X)
#undef X
    return failed ? give_up(p, capacity, owners, err) : TOBI_OK;
}

int64_t tobi_particles_add(tobi_particles *p)
{
    int64_t i = p->count++;
#define X(type, name, life, owner, unit, doc)                                          \
    if (p->name) memset(&p->name[i], 0, sizeof(type));
    TOBI_PARTICLE_FIELDS(X)
#undef X
    return i;
}

/* One field after the other, so that no more than one is there twice. */
tobi_status tobi_particles_fit(tobi_particles *p, int owners, tobi_error *err)
{
    int failed = 0;
#define X(type, name, life, owner, unit, doc)                                          \
    if ((owner) & owners) {                                                            \
        type *made = make_zero(p->count, sizeof(type));                                \
        if (made && p->name) memcpy(made, p->name, (size_t)p->count*sizeof(type));     \
        free(p->name);                                                                 \
        p->name = made;                                                                \
        failed |= !made;                                                               \
    }
    TOBI_PARTICLE_FIELDS(X)
#undef X
    p->capacity = p->count;
    return failed ? give_up(p, p->count, owners, err) : TOBI_OK;
}

int64_t tobi_particles_row_bytes(int owners)
{
    int64_t bytes = 0;
#define X(type, name, life, owner, unit, doc) bytes += (owner) & owners ? (int64_t)sizeof(type) : 0;
    TOBI_PARTICLE_FIELDS(X)
#undef X
    return bytes;
}

int64_t tobi_particles_widest(int owners)
{
    return owners & TOBI_MPM ? (int64_t)sizeof(tobi_columns) : (int64_t)sizeof(tobi_double3);
}

void tobi_particles_permute(tobi_particles *p, const int32_t *order, void *scratch, int threads)
{
#define X(type, name, life, owner, unit, doc) \
    if ((life) == TOBI_STATE && p->name)                                                                   \
        tobi_permute(threads, p->name, sizeof(type), order, p->count, scratch);
    TOBI_PARTICLE_FIELDS(X)
#undef X
}

void tobi_particles_copy(tobi_particles *p, int64_t from, int64_t to)
{
#define X(type, name, life, owner, unit, doc) \
    if ((life) == TOBI_STATE && p->name) p->name[to] = p->name[from];
    TOBI_PARTICLE_FIELDS(X)
#undef X
}

tobi_field_ref tobi_particles_state(tobi_particles *p, int index)
{
    int k = 0;
#define X(type, name, life, owner, unit, doc) \
    if ((life) == TOBI_STATE && p->name && k++ == index)                                                   \
        return (tobi_field_ref){#name, p->name, sizeof(type)};
    TOBI_PARTICLE_FIELDS(X)
#undef X
    return (tobi_field_ref){NULL, NULL, 0};
}
