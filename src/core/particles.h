/* The particles of a system. Every method has the common fields; its own list adds others. Arrays are laid
   out [own | ghost]: own rows are computed here, ghosts are copies that come behind them (none on one
   process). They are padded so that a few rows may be read past the end. Row numbers change with every sort
   and live no longer than a step; ids stay. */
#pragma once
#include "base/error.h"
#include "core/fields.h"
#include "exec/portable.h"
#include <stdint.h>

#define TOBI_COMMON_FIELDS(X) \
    X(tobi_double3, TOBI_F64, 3, position, TOBI_STATE, 0, "m",   "position from the lower corner") \
    X(tobi_float4,  TOBI_F32, 4, velocity, TOBI_STATE, 0, "m/s", "velocity; w: of mlsmpm, by contact") \
    X(int64_t,      TOBI_I64, 1, id,       TOBI_STATE, 0, "1",   "number that stays, of the system") \
    X(uint8_t,      TOBI_U8,  1, fluid,    TOBI_STATE, 0, "1",   "number of the fluid or solid")

enum { TOBI_PAD_ROWS = 16 };         /* rows that may be read past the end of an array */

typedef struct tobi_particles {
    int64_t count;                  /* own rows                                                        */
    int64_t ghosts;                 /* rows behind them                                                */
    int64_t capacity;               /* rows that there is memory for                                   */
    int64_t next_id;                /* ids given so far are below                                      */
    const tobi_field_list *list;    /* of the method, NULL = none                                      */
    unsigned needs;                 /* bits of fields that are there though not always                 */
    void *own;                      /* the method's struct of pointers, owned                          */
    char *lent;                     /* memory of the fields that live in stages, owned                 */
    int stages;                     /* those at hand                                                   */
    TOBI_COMMON_FIELDS(TOBI_FIELD_POINTER)
} tobi_particles;

/* Allocates the common fields and those of `list` that `needs` asks for, zero, for `capacity` particles;
   count becomes 0. */
tobi_status tobi_particles_create(tobi_particles *p, const tobi_field_list *list, unsigned needs,
                                  int64_t capacity, tobi_error *err);
void tobi_particles_free(tobi_particles *p);
/* Room for at most `capacity` particles that tobi_particles_add places: state fields only, and memory only
   for those that are placed. tobi_particles_fit then makes all fields, for as many as there are: capacity
   becomes count. On failure nothing is left to free. */
tobi_status tobi_particles_reserve(tobi_particles *p, const tobi_field_list *list, unsigned needs,
                                   int64_t capacity, tobi_error *err);
/* A new particle, all zero but its id: its row. There must be room. */
int64_t tobi_particles_add(tobi_particles *p);
tobi_status tobi_particles_fit(tobi_particles *p, tobi_error *err);
/* Room for so many rows; arrays may move, rows stay. On failure nothing has changed. */
tobi_status tobi_particles_room(tobi_particles *p, int64_t rows, tobi_error *err);
/* `count` new particles behind the last, all zero but their ids: the first row into *first. Arrays may move;
   there must be no ghosts. On failure nothing has changed. */
tobi_status tobi_particles_insert(tobi_particles *p, int64_t count, int64_t *first, tobi_error *err);
/* Copies the state fields of row `from` over row `to`: rows are removed by keeping the others. */
void tobi_particles_copy(tobi_particles *p, int64_t from, int64_t to);
/* Removes rows, ascending: the last ones that stay take their places. */
void tobi_particles_remove(tobi_particles *p, const int32_t *rows, int64_t count);
/* Begins stages: fields that live in none of them lose their memory (NULL; NaN in dev builds), those that
   live in one have it. What lives on from the stages before keeps its values; the rest is undefined. */
void tobi_particles_stage(tobi_particles *p, int stages);
/* An array of so many rows of so many bytes, zero, padded, for cache lines; NULL without memory. */
void *tobi_particles_rows(int64_t rows, size_t row);
/* Bytes per particle, without neighbour lists; those of its state alone. */
int64_t tobi_particles_row_bytes(const tobi_field_list *list, unsigned needs);
int64_t tobi_particles_state_bytes(const tobi_field_list *list, unsigned needs);

/* Reorders every state field: row k takes the old row order[k]. scratch holds count rows of the widest state
   field (tobi_particles_widest bytes each). */
void tobi_particles_permute(tobi_particles *p, const int32_t *order, void *scratch, int threads);
int64_t tobi_particles_widest(const tobi_particles *p);

/* Rows in the order of their ids; spare holds as many numbers. */
void tobi_particles_order(const tobi_particles *p, int32_t *rows, int32_t *spare);

/* The state fields by number; NULL past the end. */
const tobi_field *tobi_particles_state(const tobi_particles *p, int number, void **data);
