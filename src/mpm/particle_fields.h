/* The particle fields of the material point method. */
#pragma once
#include "core/system.h"

/* Scenes with blades; solids beside a liquid; solids that bodies hold. */
enum { MPM_NEED_BLADES = 1, MPM_NEED_LIQUID = 2, MPM_NEED_CLAMP = 4 };

#define MPM_FIELDS(X) \
    X(tobi_columns, TOBI_F32, 12, strain, TOBI_STATE, 0, "1",   "F - I; w: see mpm/view.h") \
    X(tobi_columns, TOBI_F32, 12, affine, TOBI_STATE, 0, "1/s", "velocity gradient") \
    X(tobi_float4,  TOBI_F32, 4,  rest,   TOBI_STATE, 0, "m",   "at the start; w: 1 in the core") \
    X(tobi_columns, TOBI_F32, 12, cuts,   TOBI_STATE, MPM_NEED_BLADES, "1", "remembered, mpm/cut/cuts.h") \
    X(tobi_float4,  TOBI_F32, 4,  push,   TOBI_STATE, MPM_NEED_LIQUID, "N", "of the liquid, last step") \
    X(tobi_float4,  TOBI_F32, 4,  clamp,  TOBI_STATE, MPM_NEED_CLAMP, "m", "see mpm/contact/clamp.h")

typedef struct mpm_fields { MPM_FIELDS(TOBI_FIELD_POINTER) } mpm_fields;
extern const tobi_field_list mpm_field_list;

static inline mpm_fields *mpm_fields_of(const tobi_particles *p) { return p->own; }

extern const tobi_output mpm_outputs[];
/* method->needs. */
unsigned mpm_needs(const tobi_system *s, int full);
/* Verbs of tobi_method. */
void mpm_place(tobi_system *s, int64_t i, const tobi_start *start);
double mpm_mass(const tobi_system *s, int64_t i);
