/* What every particle method steps: the box, the particles, the fluids, the bodies, the clock. */
#pragma once
#include "core/body.h"
#include "core/cells.h"
#include "core/contact.h"
#include "core/near.h"
#include "core/particles.h"
#include "core/plane.h"
#include "core/smoothing.h"
#include "core/still.h"
#include "tobiuo/tobiuo.h"

enum { TOBI_FLUID_LIMIT = 8, TOBI_SOLID_LIMIT = 255, TOBI_STAGE_LIMIT = 16, TOBI_RECALL_ROW = 9 };

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

/* Stage timers of a step, in the order of first use. */
typedef struct tobi_stages {
    const char *name[TOBI_STAGE_LIMIT];
    double seconds[TOBI_STAGE_LIMIT];
    int count;
} tobi_stages;

typedef struct tobi_simulation {
    tobi_world_def def;             /* strings inside are not used after creation            */
    tobi_exec exec;
    tobi_box box;
    tobi_smoothing_constants smoothing;
    tobi_cells cells;
    tobi_particles particles;
    tobi_fluid fluid[TOBI_FLUID_LIMIT];
    int fluid_count;
    tobi_solid *solids;             /* of the material point method; then there are no fluids */
    int solid_count;
    tobi_body *bodies;
    int body_count;
    tobi_fixed_plane plane[TOBI_PLANE_LIMIT];
    int plane_count;
    tobi_near_bodies near;          /* fluid particles that see a body                       */
    tobi_contacts contacts;         /* particles of solids that touch bodies                 */
    double time, dt;                /* s; dt of the last step                                */
    int64_t step;
    double gravity[3];              /* m/s2, what particles feel: see tobi_simulation_fill_up  */
    tobi_still still;               /* less what still water holds                             */
    double open;                    /* particles at a surface beyond doubt, in full vessels as well */
    double lowest;                  /* m, drop of the lowest particle at a free surface         */
    double still_volume;            /* m3 of fluid times the share of gravity so held          */
    double wall_speed;              /* m/s, fastest side of the domain                       */
    double body_speed;              /* m/s, fastest body point or side of the last step      */
    double start_speed;             /* m/s, fastest particle or free body at the start       */
    double start_head;              /* m2/s2, g times the height of the fluid at the start   */
    tobi_step_info info;            /* of the last step                                      */
    tobi_stages stages;
    tobi_stop_fn stop;              /* of the caller, NULL = none                             */
    void *stop_user;
    int stopped;                    /* it asked to stop, in this call                         */
} tobi_simulation;

enum { TOBI_LIQUIDS = -1 };            /* in place of the number of a solid                      */

/* A particle method: one static struct in one file, listed in world/methods.c. */
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
    tobi_status (*create)(tobi_simulation *s, const void *def, void **state, tobi_error *err);
    tobi_status (*step)(tobi_simulation *s, void *state, double max_dt, tobi_error *err);
    /* Brings density, averaged pressure (`product`), lists and walls up to the present positions. NULL:
       nothing is kept that could be stale. */
    tobi_status (*refresh)(tobi_simulation *s, void *state, tobi_error *err);
    /* Value of a field (world/read.c) of one particle, up to 9 components, after a refresh; changes nothing.
       NULL: the fields of the SPH methods, from the particle arrays. */
    void (*read)(const tobi_simulation *s, const void *state, const char *field, int64_t i, double *out);
    /* Refuses, in words, a solid that it cannot compute at this spacing, or leaves a note for the user; NULL:
       it takes all. */
    tobi_status (*accept)(const tobi_simulation *s, const void *def, int solid, char note[200],
                          tobi_error *err);
    /* The longest step that a solid's material, or the sound of TOBI_LIQUIDS, allows at a speed, m/s, in s;
       NULL: only the motion tells. */
    double (*stable_dt)(const tobi_simulation *s, const void *def, int solid, double speed);
    /* The nodes of its grid; the caller frees them, also after a failure. NULL: it has none. */
    tobi_status (*nodes)(const tobi_simulation *s, const void *state, tobi_grid *grid, tobi_error *err);
    /* Adds elastic_energy and energy_lost to s->info; NULL: there are none. */
    void (*measure)(tobi_simulation *s, const void *state);
    /* Writes a derived field into particles.accel after a refresh: "acceleration" or "vorticity". NULL: the
       method has neither. */
    void (*derive)(tobi_simulation *s, void *state, const char *field);
    /* Doubles that must survive a restart besides the particles; the first is the largest speed, m/s. */
    int (*memory)(void *state, double **values);
    /* Optional, the same of a size that changes: rows of TOBI_RECALL_ROW numbers, which the caller frees. */
    tobi_status (*keep)(const tobi_simulation *s, const void *state, double **rows, int64_t *count,
                        tobi_error *err);
    /* Optional, after a load: takes such rows over. */
    void (*recall)(void *state, double *rows, int64_t count);
    /* Bytes that the state has allocated; NULL = few. */
    int64_t (*bytes)(const void *state);
    void (*free)(void *state);
} tobi_method;

/* A speed nothing in the scene should exceed by much, m/s: free fall across the box, the bodies and the
   initial velocities. */
double tobi_simulation_speed_scale(const tobi_simulation *s);
/* A vessel without a free surface: gravity along axes with walls only makes a hydrostatic pressure there. It
   is taken from what the particles feel (s->gravity), which pressures that pull would have to hold, and
   added exactly where pressures and forces leave: the two functions below. Fluids have one density. */
void tobi_simulation_fill_up(tobi_simulation *s);
/* That pressure at x (m, from the lower corner), Pa: 0 at the middle of the box, and 0 in other vessels. */
double tobi_simulation_hydrostatic(const tobi_simulation *s, const double x[3]);
/* Adds its forces to those on the walls and the bodies of this step. */
void tobi_simulation_add_hydrostatic(tobi_simulation *s);
/* Adds that on one body to force and torque f, N and N m. */
void tobi_simulation_body_hydrostatic(const tobi_simulation *s, int body, double f[6]);
/* Energies, momentum and weight of the fluid into s->info. */
void tobi_simulation_measure(tobi_simulation *s);

/* The step to take where `dt` is stable and `max_dt` (0 = any) is left: not longer than both, and no crumb
   remains. */
double tobi_simulation_fit_dt(double dt, double max_dt);

/* Asks the caller whether to stop, until the answer is yes: then 1. */
int tobi_simulation_stops(tobi_simulation *s);
/* The same as a status: TOBI_STOPPED, in words. A step that answers it has changed nothing. */
tobi_status tobi_simulation_heed(tobi_simulation *s, tobi_error *err);

/* Adds the seconds since *since to a stage and moves *since to now. */
void tobi_stage_end(tobi_stages *st, const char *name, double *since);
