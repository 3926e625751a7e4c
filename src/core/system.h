/* A system: particles that one method computes, in the world that all systems share. */
#pragma once
#include "base/param.h"
#include "core/particles.h"
#include "core/simulation.h"
#include "core/smoothing.h"

enum { TOBI_RESTORED_ROW = 9, TOBI_MEMORY_LIMIT = 64 };

/* What the memory of a system depends on, before there is one. */
typedef struct tobi_system_plan {
    tobi_cell_points cells;
    int64_t particles;
    double entries;                  /* in the list of each, in the mean                               */
} tobi_system_plan;

/* Bytes of memory by what they hold. */
enum { TOBI_ACCOUNT_LIMIT = 24 };
typedef struct tobi_account {
    int count;
    const char *name[TOBI_ACCOUNT_LIMIT];
    int64_t bytes[TOBI_ACCOUNT_LIMIT];
} tobi_account;

/* To what the name has already; 0 bytes are left out. */
void tobi_account_add(tobi_account *a, const char *name, int64_t bytes);

typedef struct tobi_fluid {
    char name[64];
    double density, viscosity, tension;
    double yield_stress, flow_index, creep_rate;    /* Pa, 1, 1/s */
    double smagorinsky;             /* constant of turbulence below the spacing              */
    double interface_tension[TOBI_FLUID_LIMIT];      /* N/m, towards each other fluid */
    double color[3];                /* RGB, 0 to 255, or -1; for pictures                    */
    int visible;
} tobi_fluid;

/* Whether its viscosity is the same everywhere. */
static inline int tobi_fluid_is_newtonian(const tobi_fluid *f)
{
    return f->yield_stress == 0 && f->flow_index == 1 && f->smagorinsky == 0;
}

typedef struct tobi_solid {
    char name[64];
    tobi_solid_def def;             /* its density is the one used: from the mass, if that was given;
                                       clamped_to is only whether it is there */
    char *clamped_to;               /* owned: names of the bodies that hold it, with commas  */
    int *clamp;                     /* owned: their numbers, from the start on               */
    int clamp_count;
} tobi_solid;

/* 1 if the body holds particles of the solid. */
static inline int tobi_solid_is_clamped(const tobi_solid *s, int body)
{
    for (int k = 0; k < s->clamp_count; k++)
        if (s->clamp[k] == body) return 1;
    return 0;
}

typedef struct tobi_system {
    tobi_simulation *sim;           /* the world's                                           */
    int number;                     /* of the world's systems: whose load on a body it adds to */
    const struct tobi_method *method;
    void *def;                      /* owned: the method's parameters                        */
    void *state;                    /* owned: the method's own, from `create` on             */
    tobi_box box;
    tobi_smoothing_constants smoothing;
    tobi_cells cells;
    tobi_particles particles;
    tobi_fluid fluid[TOBI_FLUID_LIMIT];
    int fluid_count;
    tobi_solid *solids;             /* of the material point method; then there are no fluids */
    int solid_count;
    double dt;                      /* s, of the step at hand, or of the last one            */
    int64_t step;                   /* its own steps                                         */
    double gravity[3];              /* m/s2, what particles feel, see sph/hydrostatic.h       */
    double start_speed;             /* m/s, fastest particle at the start, or point of a body
                                       since, or fall in a gravity that was changed        */
    double pushed_speed;            /* m/s, the most so far of tobi_system_pushed_speed      */
    double start_head;              /* m2/s2, g times the height of the fluid at the start   */
    tobi_step_info info;            /* of the last step                                      */
    int64_t first_id;               /* of the world's ids; particles.id count from there     */
    int64_t started;                /* particles that it began with                          */
    int32_t *row_of;                /* owned: rows in id order, for reading; see world/read.c */
    int64_t row_capacity;
} tobi_system;

enum { TOBI_LIQUIDS = -1 };            /* in place of the number of a solid                      */

/* What a particle starts with, besides its position and velocity. */
typedef struct tobi_start {
    double volume, mass;                 /* m3, kg: its share of its region                         */
    double spin[3];                      /* 1/s, of the region                                      */
    int core;                            /* 1: below the skin of a solid                            */
} tobi_start;

/* A field for results that a method computes. */
typedef struct tobi_output {
    const char *name;
    int components;                      /* of 6: xx, yy, zz, xy, yz, zx, as in ParaView; of 9: by rows */
    const char *unit;
    int derived;                         /* 1: the method's `derive` prepares it                        */
} tobi_output;

/* A particle method: one const struct in one file, listed in world/methods.def. The verbs of a step in their
   order: remember, max_dt, begin, forces, solve, move, finish. None moves bodies or the clock: world/step.c
   does. */
typedef struct tobi_method {
    const char *name;
    const char *doc;
    const tobi_param_table *params;                              /* of its parameter struct        */
    int solids;                                                  /* 1: computes solids, 0: fluids  */
    const tobi_field_list *fields;                               /* of particles, NULL = no others */
    const tobi_output *outputs;                                  /* ends with a NULL name          */
    /* The bits of the optional fields that this system needs. full: liquid fills the domain. NULL: 0. */
    unsigned (*needs)(const tobi_system *s, int full);
    int planes;                                                  /* 1: it knows planes in the domain */
    double density_ratio;                                        /* largest over least of its fluids */
    int packs_lists;                             /* 1: neighbours are 16 bits, half the memory      */
    int fills_pipes;                             /* 1: inlets and outlets may leave no free surface */
    int nests;                                   /* 1: a world of it may be a nest; 2: one that moves
                                                    bodies                                          */
    int damps_waves;                             /* 1: waves lose height on the way                  */
    int rough_forces;                            /* 1: of a liquid on bodies and on solids they are not the
                                                    opposite of what the liquid feels, to a few per cent */
    /* Smoothing kernel and support radius that the parameters ask for; driven: something is moved in a
       vessel full of liquid. NULL: it has no kernel. */
    void (*smoothing)(const void *def, int driven, int *shape, double *support);
    /* Its state. NULL: it has none. */
    tobi_status (*create)(tobi_system *s, tobi_error *err);
    /* Optional: the method's own state fields of a new particle. */
    void (*place)(tobi_system *s, int64_t i, const tobi_start *start);
    /* kg, of a particle. NULL: a cell of its fluid. */
    double (*mass)(const tobi_system *s, int64_t i);

    /* Optional: keeps what a step changes until it moves, and takes back a step that was stopped by then:
       TOBI_STOPPED from `begin` or `solve`. */
    tobi_status (*remember)(tobi_system *s, tobi_error *err);
    void (*take_back)(tobi_system *s);
    /* The longest step, s, from the present state. */
    double (*max_dt)(tobi_system *s);
    /* Optional: sort, neighbours, what it sees of the boundaries; bodies have their velocities of this
       step. */
    tobi_status (*begin)(tobi_system *s, tobi_error *err);
    /* Gravity, viscosity, tension. Optional. */
    void (*forces)(tobi_system *s);
    /* Pressure or stress, with the answer of bodies. Optional. */
    tobi_status (*solve)(tobi_system *s, tobi_error *err);
    /* The forces on walls and bodies, then the new positions. */
    void (*move)(tobi_system *s);
    /* Optional: after the bodies have moved, too. */
    void (*finish)(tobi_system *s);

    /* Brings outputs, lists and walls up to the present positions. NULL:
       nothing is kept that could be stale. */
    tobi_status (*refresh)(tobi_system *s, tobi_error *err);
    /* One of `outputs`, of one particle, after a refresh; changes nothing. NULL: they are numbers in state
       fields of these names. */
    void (*read)(const tobi_system *s, const char *field, int64_t i, double *out);
    /* Refuses, in words, a solid that it cannot compute at this spacing, or leaves a note for the user; NULL:
       it takes all. Before `create`, as is the next. */
    tobi_status (*accept)(const tobi_system *s, int solid, char note[200], tobi_error *err);
    /* The longest step that a solid's material, or the sound of TOBI_LIQUIDS, allows at a speed, m/s, in s;
       NULL: only the motion tells. */
    double (*stable_dt)(const tobi_system *s, int solid, double speed);
    /* m/s, of sound that its parameters give to liquids. NULL: they do not. */
    double (*sound)(const tobi_system *s);
    /* Points of its solids for a liquid, into s->sim->soft; NULL: it has none. */
    tobi_status (*points)(tobi_system *s, tobi_error *err);
    /* The nodes of its grid; the caller frees them, also after a failure. NULL: it has none. */
    tobi_status (*nodes)(const tobi_system *s, tobi_grid *grid, tobi_error *err);
    /* Adds elastic_energy and energy_lost to s->info; NULL: there are none. */
    void (*measure)(tobi_system *s);
    /* Prepares an output that is derived, after a refresh; NULL where none is. */
    void (*derive)(tobi_system *s, const char *field);
    /* Doubles that must survive a restart besides the particles, TOBI_MEMORY_LIMIT at most; the first is the
       largest speed, m/s. NULL: that of `info` alone. Called by tobi_system_memory. */
    int (*memory)(tobi_system *s, double **values);
    /* Optional, the same of a size that changes: rows of TOBI_RESTORED_ROW numbers, the caller's to free. */
    tobi_status (*keep)(const tobi_system *s, double **rows, int64_t *count, tobi_error *err);
    /* Optional, after a load: takes such rows over. */
    void (*restore)(tobi_system *s, double *rows, int64_t count);
    /* Optional: rows have been inserted, arrays may have moved. */
    void (*inserted)(tobi_system *s);
    /* The world's gravity has changed between two steps, after a refresh if there were steps: what was
       derived from it follows. loaded: the state is a checkpoint's, of that gravity already. NULL: nothing is
       kept. */
    void (*follow_gravity)(tobi_system *s, int loaded);
    /* Bytes that the state will take, before there is one; NULL = little. */
    int64_t (*estimate)(const tobi_system *s, const tobi_system_plan *plan);
    /* Adds what the state has allocated; NULL = little. */
    void (*account)(const tobi_system *s, tobi_account *a);
    void (*free)(void *state);
} tobi_method;

/* The method's `memory`: how many doubles, where. */
int tobi_system_memory(tobi_system *s, double **values);
/* Whether its fluids differ in density or viscosity, or an interface has tension. */
int tobi_system_is_mixed(const tobi_system *s);
/* Least and largest density of its fluids, kg/m3; it has one at least. */
void tobi_system_densities(const tobi_system *s, double *least, double *most);
/* Largest over least density of its fluids; 1 for one or none. */
double tobi_system_density_ratio(const tobi_system *s);
/* Tension over density and spacing, the most of all fluids, m2/s2. */
double tobi_system_capillary(const tobi_system *s);
/* A speed nothing in the scene should exceed by much, m/s: free fall across the box and from the pressure of
   outlets, the bodies, the initial velocities, and the flow of inlets and bodies through a narrow place. */
double tobi_system_speed_scale(const tobi_system *s);
/* What gravity and the pressure of outlets make of it alone, m/s. */
double tobi_system_fall_speed(const tobi_system *s);
/* How many times as fast as what feeds it the liquid in a narrow place may be. */
enum { TOBI_NARROWEST = 10 };
/* After a step, m/s: how fast the liquid that bodies with a motion push may be in a narrow place. */
double tobi_system_pushed_speed(const tobi_system *s);
/* Room for so many rows, lists and all; nothing else changes, also on failure. */
tobi_status tobi_system_room(tobi_system *s, int64_t rows, tobi_error *err);
/* `count` new particles between two steps of a world that has started: the first row into *first, all zero
   but their ids, which go on from the world's. The caller places them (position, velocity, fluid) and calls
   method->place. On failure no particle is new. */
tobi_status tobi_system_insert(tobi_system *s, int64_t count, int64_t *first, tobi_error *err);
/* Energies, momentum and weight of the fluid into s->info. */
void tobi_system_measure(tobi_system *s);
