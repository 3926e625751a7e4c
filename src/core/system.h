/* A system: particles that one method computes, in the world that all systems share. */
#pragma once
#include "core/contact.h"
#include "core/near.h"
#include "core/particles.h"
#include "core/simulation.h"
#include "core/smoothing.h"
#include "core/still.h"

enum { TOBI_FLUID_LIMIT = 8, TOBI_SOLID_LIMIT = 255, TOBI_RECALL_ROW = 9, TOBI_MEMORY_LIMIT = 64 };

typedef struct tobi_fluid {
    char name[64];
    double density, viscosity, tension;
    double color[3];                /* RGB, 0 to 255, or -1; for pictures                    */
    int visible;
} tobi_fluid;

typedef struct tobi_solid {
    char name[64];
    tobi_solid_def def;             /* its density is the one used: from the mass, if that was given */
} tobi_solid;

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
    tobi_near_bodies near;          /* fluid particles that see a body                       */
    tobi_contacts contacts;         /* particles of solids that touch bodies                 */
    double dt;                      /* s, of the step at hand, or of the last one            */
    int64_t step;                   /* its own steps                                         */
    double gravity[3];              /* m/s2, what particles feel: see tobi_system_fill_up    */
    tobi_still still;               /* less what still water holds                           */
    double open;                    /* particles at a surface beyond doubt, in full vessels as well */
    double lowest;                  /* m, drop of the lowest particle at a free surface      */
    double still_volume;            /* m3 of fluid times the share of gravity so held        */
    double start_speed;             /* m/s, fastest particle or free body at the start       */
    double start_head;              /* m2/s2, g times the height of the fluid at the start   */
    tobi_step_info info;            /* of the last step                                      */
    int32_t *row_of;                /* owned: rows in id order, for reading; see world/read.c */
} tobi_system;

enum { TOBI_LIQUIDS = -1 };            /* in place of the number of a solid                      */

/* A particle method: one const struct in one file, listed in world/methods.c. The verbs of a step in their
   order: remember, max_dt, begin, forces, solve, move, finish. None moves bodies or the clock: world/step.c
   does. */
typedef struct tobi_method {
    const char *name;
    const char *doc;
    size_t def_size;                                             /* of the parameter struct        */
    int fields;                                                  /* particle fields besides TOBI_ALL */
    int body_fields;                                             /* and where there are bodies, or
                                                                    liquid fills the domain         */
    int planes;                                                  /* 1: it knows planes in the domain */
    /* Smoothing kernel and support radius that the parameters ask for; stirred: something is moved in a
       vessel full of liquid. */
    void (*smoothing)(const void *def, int stirred, int *shape, double *support);
    tobi_status (*create)(tobi_system *s, tobi_error *err);

    /* Optional: keeps what a step changes until it moves, and takes back a step that was stopped by then:
       TOBI_STOPPED from `begin` or `solve`. */
    tobi_status (*remember)(tobi_system *s, tobi_error *err);
    void (*take_back)(tobi_system *s);
    /* The longest step, s, from the present state. */
    double (*max_dt)(tobi_system *s);
    /* Sort, neighbours, what it sees of the boundaries; bodies have their velocities of this step. */
    tobi_status (*begin)(tobi_system *s, tobi_error *err);
    /* Gravity, viscosity, tension. Optional. */
    void (*forces)(tobi_system *s);
    /* Pressure or stress, with the answer of bodies. */
    tobi_status (*solve)(tobi_system *s, tobi_error *err);
    /* The forces on walls and bodies, then the new positions. */
    void (*move)(tobi_system *s);
    /* Optional: after the bodies have moved, too. */
    void (*finish)(tobi_system *s);

    /* Brings density, averaged pressure (`product`), lists and walls up to the present positions. NULL:
       nothing is kept that could be stale. */
    tobi_status (*refresh)(tobi_system *s, tobi_error *err);
    /* Value of a field (world/read.c) of one particle, up to 9 components, after a refresh; changes nothing.
       NULL: the fields of the SPH methods, from the particle arrays. */
    void (*read)(const tobi_system *s, const char *field, int64_t i, double *out);
    /* Refuses, in words, a solid that it cannot compute at this spacing, or leaves a note for the user; NULL:
       it takes all. Before `create`, as is the next. */
    tobi_status (*accept)(const tobi_system *s, int solid, char note[200], tobi_error *err);
    /* The longest step that a solid's material, or the sound of TOBI_LIQUIDS, allows at a speed, m/s, in s;
       NULL: only the motion tells. */
    double (*stable_dt)(const tobi_system *s, int solid, double speed);
    /* The nodes of its grid; the caller frees them, also after a failure. NULL: it has none. */
    tobi_status (*nodes)(const tobi_system *s, tobi_grid *grid, tobi_error *err);
    /* Adds elastic_energy and energy_lost to s->info; NULL: there are none. */
    void (*measure)(tobi_system *s);
    /* Writes a derived field into particles.accel after a refresh: "acceleration" or "vorticity". NULL: the
       method has neither. */
    void (*derive)(tobi_system *s, const char *field);
    /* Doubles that must survive a restart besides the particles, TOBI_MEMORY_LIMIT at most; the first is the
       largest speed, m/s. */
    int (*memory)(tobi_system *s, double **values);
    /* Optional, the same of a size that changes: rows of TOBI_RECALL_ROW numbers, which the caller frees. */
    tobi_status (*keep)(const tobi_system *s, double **rows, int64_t *count, tobi_error *err);
    /* Optional, after a load: takes such rows over. */
    void (*recall)(tobi_system *s, double *rows, int64_t count);
    /* The world's gravity has changed between two steps, after a refresh if there were steps: what was
       derived from it follows. loaded: the state is a checkpoint's, of that gravity already. NULL: nothing is
       kept. */
    void (*follow_gravity)(tobi_system *s, int loaded);
    /* Bytes that the state has allocated; NULL = few. */
    int64_t (*bytes)(const tobi_system *s);
    void (*free)(void *state);
} tobi_method;

/* A speed nothing in the scene should exceed by much, m/s: free fall across the box, the bodies and the
   initial velocities. */
double tobi_system_speed_scale(const tobi_system *s);
/* A vessel without a free surface: gravity along axes with walls only makes a hydrostatic pressure there. It
   is taken from what the particles feel (s->gravity), which pressures that pull would have to hold, and
   added exactly where pressures and forces leave: the two functions below. Fluids have one density. */
void tobi_system_fill_up(tobi_system *s);
/* That pressure at x (m, from the lower corner), Pa: 0 at the middle of the box, and 0 in other vessels. */
double tobi_system_hydrostatic(const tobi_system *s, const double x[3]);
/* Adds its forces to those on the walls and to this system's load on the bodies. */
void tobi_system_add_hydrostatic(tobi_system *s);
/* Adds that on one body to force and torque f, N and N m. */
void tobi_system_body_hydrostatic(const tobi_system *s, int body, double f[6]);
/* Energies, momentum and weight of the fluid into s->info. */
void tobi_system_measure(tobi_system *s);
