/* The state and the step of isph, which eisph shares. */
#pragma once
#include "sph/isph/fields.h"
#include "sph/isph/solve.h"
#include "sph/stages.h"
#include "sph/state.h"
#include "sph/undo.h"

/* Numbers that survive a restart. */
enum { ISPH_MEMORY = 5 };

typedef struct isph {
    sph_state common;
    tobi_isph_def def;
    sph_view view;                   /* of what it shares with the other SPH methods                */
    const sph_kernels *kernel;
    isph_solver solver;
    sph_undo undo;
    /* vessel: SPH_VESSEL_*; failures: steps in a row that did not converge; of eisph: depth: m, of the
       liquid along gravity; started: 1 after the first solve */
    struct { double speed, vessel, failures, depth, started; } memory;
    double motion_dt;                /* s, the step that motion alone allows                        */
    double volume_dt;                /* s, the same by the default of cfl                           */
    int sides_due;                   /* 1: the info has no pressure on the sides of the domain yet  */
} isph;

/* The state of a system, by isph's parameters: those of eisph are a part of them. TOBI_NO_MEMORY. */
tobi_status isph_create_state(tobi_system *s, const tobi_isph_def *def, tobi_error *err);
/* dt <= min(cfl d/|v|, 0.25 sqrt(d/g), viscous limit, that of surface tension). */
double isph_choose_dt(tobi_system *s);
/* Of a tobi_method, as ISPH_VERBS names them. */
int isph_list_memory(tobi_system *s, double **values);
tobi_status isph_remember(tobi_system *s, tobi_error *err);
void isph_take_back(tobi_system *s);
tobi_status isph_begin(tobi_system *s, tobi_error *err);
void isph_forces(tobi_system *s);
tobi_status isph_solve(tobi_system *s, tobi_error *err);
void isph_move(tobi_system *s);
tobi_status isph_refresh(tobi_system *s, tobi_error *err);
void isph_measure(tobi_system *s);
void isph_follow_gravity(tobi_system *s, int loaded);
void isph_derive(tobi_system *s, const char *field);
void isph_read(const tobi_system *s, const char *field, int64_t i, double *out);
int64_t isph_estimate(const tobi_system *s, const tobi_system_plan *plan);
void isph_account(const tobi_system *s, tobi_account *a);
void isph_free_state(void *state);

#define ISPH_VERBS                                                                                  \
    .fields = &sph_field_list, .outputs = isph_outputs, .remember = isph_remember,                        \
    .take_back = isph_take_back, .forces = isph_forces, .solve = isph_solve, .move = isph_move,     \
    .finish = sph_finish, .refresh = isph_refresh, .read = isph_read, .derive = isph_derive,         \
    .measure = isph_measure, .follow_gravity = isph_follow_gravity, .memory = isph_list_memory,      \
    .estimate = isph_estimate, .account = isph_account, .free = isph_free_state,
