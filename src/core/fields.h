/* A list of particle fields. A method says in one list which arrays its particles have; memory, sorting,
   checkpoints and the state hash walk it. The method's code has the same arrays by name, in a struct that is
   made from the same list:

       #define SPH_FIELDS(X) X(float, TOBI_F32, 1, pressure, TOBI_STATE, 0, "Pa", "pressure") ...
       typedef struct sph_fields { SPH_FIELDS(TOBI_FIELD_POINTER) } sph_fields;
*/
#pragma once
#include "base/type.h"

/* The life of a field. STATE fields survive a step: they are sorted with the particles and stored in
   checkpoints. SCRATCH fields are computed anew in every step. Any other number is a set of stages, bits that
   the method names: the field has memory in these stages only (tobi_particles_stage), which fields of other
   stages use in theirs. */
enum { TOBI_STATE = 0, TOBI_SCRATCH = -1 };

typedef struct tobi_field {
    const char *name;
    tobi_type type;
    int components;                 /* numbers of that type in a row                                    */
    size_t bytes;                   /* of a row                                                         */
    int life;                       /* TOBI_STATE, TOBI_SCRATCH or stages                               */
    unsigned need;                  /* 0: always there; else there if the method's `needs` has the bit  */
    size_t offset;                  /* of its pointer in the struct                                     */
    const char *unit, *doc;
} tobi_field;

typedef struct tobi_field_list {
    const tobi_field *field;
    int count;
    size_t size;                    /* bytes of the struct of pointers                                  */
} tobi_field_list;

/*      C type, type, components, name, life, need, unit, doc */
#define TOBI_FIELD_POINTER(ctype, type, components, name, life, need, unit, doc) ctype *name;
#define TOBI_FIELD_ROW(owner, ctype, type, components, name, life, need, unit, doc) \
    { #name, type, components, sizeof(ctype), life, need, offsetof(owner, name), unit, doc },
