/* A system in a checkpoint: its particle state fields in memory order and what its method remembers. */
#pragma once
#include "core/system.h"
#include "io/store.h"

enum { TOBI_LOADED_FIELDS = 16 };

/* As read, before the system takes it over. */
typedef struct tobi_loaded_system {
    int64_t count, step, next_id;         /* particles; its own steps; ids are below     */
    double clock[2];                      /* s, m/s: its last step, its start speed      */
    tobi_step_info info;
    double *memory;                       /* of the method, owned                        */
    int memory_count;
    void *field[TOBI_LOADED_FIELDS];      /* in the order of tobi_particles_state, owned */
    double *rows;                         /* of the method, owned until taken            */
    int64_t row_count;
} tobi_loaded_system;

/* number: of the system in its world. */
tobi_status tobi_system_put(tobi_system *s, int number, tobi_store *f, tobi_error *err);
/* Reads and checks; the system stays as it is. *l is to be freed in any case. */
tobi_status tobi_system_get(tobi_system *s, int number, tobi_store *f, const char *path,
                            tobi_loaded_system *l, tobi_error *err);
/* Takes over all but the rows, which tobi_system_recall does when the world is whole again. */
void tobi_system_take(tobi_system *s, const tobi_loaded_system *l);
void tobi_system_recall(tobi_system *s, tobi_loaded_system *l);
void tobi_loaded_system_free(tobi_loaded_system *l);
