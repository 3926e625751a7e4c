/* The inside of a tobi_world. */
#pragma once
#include "mpm/cut/pieces.h"
#include "tobiuo/tobiuo.h"
#include "world/fill.h"
#include "world/methods.h"
#include <assert.h>

/* def: its name and body are NULL. body: by number, -1 = none. */
/* body, fluid: by number, -1: none, all. */
typedef struct tobi_probe { tobi_probe_def def; char name[104]; int body, fluid; } tobi_probe;

typedef struct tobi_drive tobi_drive;

/* Parts of a step at which is looked for what comes within it: no period divides them all. */
enum { TOBI_LOOKS = 5 };
static const double TOBI_LOOK[TOBI_LOOKS] = { 1, 0.618, 0.382, 0.236, 0.091 };
typedef struct tobi_motor_source tobi_motor_source;

/* A particle near an outlet: coordinates along normal, along, across, m; its row and id. */
typedef struct tobi_beyond { double at[3]; int64_t row, id; } tobi_beyond;

enum { TOBI_ALIVE = 0x70b10 };

struct tobi_world {
    int alive;                     /* TOBI_ALIVE until it is destroyed                       */
    tobi_simulation sim;          /* what the systems share                                  */
    tobi_system system[TOBI_SYSTEM_LIMIT];    /* [0]: the one of the definition's method      */
    int system_count;
    struct tobi_drive *drive;      /* owned: gravity in time and the frame; NULL if there is neither */
    struct tobi_dynamics_state *dynamics;   /* NULL if no body is free or controlled        */
    struct tobi_absorbers *absorbers;       /* owned: pistons that absorb, from the start on */
    double step_cap;               /* s, the user's cap of the time step; bodies may lower it    */
    tobi_region *regions;
    int region_count;
    struct tobi_line *lines;       /* rigid/lines.h                                            */
    int line_count;
    tobi_motor_source *motors;     /* owned: what motors of hinges are told, motors.c             */
    int motor_count;
    tobi_probe *probes;
    int probe_count;
    int32_t *chosen;               /* owned: rows that an outlet takes or copies, of the step at hand */
    int64_t *chosen_block;         /* owned: their number in each block of rows                    */
    int64_t chosen_room, chosen_blocks;
    struct tobi_world *outer;      /* of a nest: whose liquid surrounds it; NULL                    */
    struct tobi_world *first_nest, *next_nest;      /* its own; of a nest: the next of the same world */
    int feeds;                     /* 1: that takes the nest's velocity                                */
    double (*pressed)[6], pressed_for;      /* owned: N s, N m s on each body, and s, since it last moved the
                                      outer bodies, nest_forces.c; NULL: it is none              */
    uint8_t *seen;                 /* owned: of outer particles by id, 1: in a nest; NULL: it is none  */
    int64_t seen_room;
    tobi_beyond *beyond;           /* owned: what lies beyond an outlet, backflow.c               */
    int64_t beyond_room;
    char **notes;                  /* owned texts                                            */
    int note_count;
    int step_noted;                /* 1: a note tells of a fixed time step that will be cut       */
    int started, fresh;            /* fresh: derived fields match the present positions       */
    tobi_error failure;            /* of a step that could not be taken back; TOBI_OK: none   */
    int idle_steps;                /* in a row that were too short to lead anywhere           */
    tobi_grid grid;                /* owned: of the last tobi_world_grid                      */
    tobi_piece_list pieces;        /* of the present state, empty until somebody asks          */
    struct tobi_image **body_image, **solid_image;      /* owned: of those with a texture; NULL = none */
    int body_images, solid_images; /* room of the lists                                          */
    float (*texture)[2];           /* of particles by id, from the first read on; NULL = none   */
};

/* For public calls that return a status; the assert finds, in dev builds, worlds destroyed before. */
#define TOBI_NEED_WORLD(w)                                                                         \
    do {                                                                                           \
        TOBI_NEED(w, "world");                                                                     \
        assert((w)->alive == TOBI_ALIVE);                                                          \
    } while (0)

/* A system that computes by a method; method_def: its parameters, or NULL = defaults. Fails as
   tobi_world_create does. */
tobi_status tobi_world_add_system(tobi_world *w, const tobi_method *method, const void *method_def,
                                  tobi_error *err);
/* Places its particles; then gives it all fields, for as many as there are; then its cells and its state. */
tobi_status tobi_world_fill_system(tobi_world *w, tobi_system *s, tobi_error *err);
tobi_status tobi_world_fit_systems(tobi_world *w, tobi_error *err);
tobi_status tobi_world_start_system(tobi_world *w, tobi_system *s, tobi_error *err);
void tobi_world_free_system(tobi_system *s);
/* The system of the solids, or of the fluids; NULL if there is none. */
tobi_system *tobi_world_solids(const tobi_world *w);
/* m, of the particles of a system, also before the start. */
double tobi_world_spacing(const tobi_world *w, const tobi_system *s);
/* N: of the fluids on a solid in the last step; 0 without. */
void tobi_world_liquid_force(const tobi_world *w, int solid, double force[3]);
tobi_system *tobi_world_fluids(const tobi_world *w);
/* The number of the body of this name, -1: there is none. */
int tobi_world_find_body(const tobi_world *w, const char *name);
/* Materials come in the order of systems: the number of the first of a system. */
int tobi_world_first_material(const tobi_world *w, const tobi_system *s);

/* Refuses a wave maker whose stroke takes it out of the domain before the end time. */
tobi_status tobi_world_check_stroke(const tobi_world *w, const tobi_body *b, tobi_error *err);
/* Adds a note for each wave maker in a liquid whose method damps waves or whose depth is another, and for
   each other body that a motion without a script takes through a side. */
tobi_status tobi_world_note_makers(tobi_world *w, tobi_error *err);
/* A zone's place, box and thickness. z->corners is the caller's, after a failure too. porous_place.c */
tobi_status tobi_porous_place(const tobi_world *w, const tobi_porous_def *def, tobi_porous *z,
                              tobi_error *err);
/* A unit vector across its thin side; of a ring 0, and z->radial is set; of a long cylinder 0. m: how thick
   it is along z->direction, in the mean. porous_place.c */
void tobi_porous_thin_direction(tobi_porous *z, int dimension, double direction[3]);
double tobi_porous_thickness(const tobi_porous *z, int dimension);
/* At the start: where the bodies that carry zones have them. When a step begins: where those are now, and how
   fast. porous.c */
void tobi_world_start_porous(tobi_world *w);
tobi_status tobi_world_carry_porous(tobi_world *w, tobi_error *err);
/* Adds a note for each porous zone that is thin, has stones, or no liquid in it. porous.c */
tobi_status tobi_world_note_porous(tobi_world *w, tobi_error *err);
/* Adds a note for each probe of a point that begins deep in a body. */
tobi_status tobi_world_note_probes(tobi_world *w, tobi_error *err);

/* Keeps each line of notes (ended by \n) as a text of its own: "kind 'name': line", "kind line" if name is
   NULL. */
tobi_status tobi_world_add_notes(tobi_world *w, const char *kind, const char *name, const char *notes,
                                 tobi_error *err);

/* Takes back all notes from number `count` on: those of a call that failed. */
void tobi_world_drop_notes(tobi_world *w, int count);

/* Particles of a region: exact for boxes, from the volume for others. */
int64_t tobi_world_guess_particles(const tobi_world *w, const tobi_region *r);
/* Notes what the filling of the regions left out; refuses a fluid or solid of which nothing is left. */
tobi_status tobi_world_note_regions(tobi_world *w, tobi_error *err);
/* The fastest point of a system's regions at the start, m/s. */
double tobi_world_start_speed(const tobi_world *w, const tobi_system *s);
/* The same of all systems, but for what scripts add, which only a start tells. */
double tobi_world_given_speed(const tobi_world *w);
/* Where the colours of the speed end, m/s; 0: nothing tells. expected_speed.c */
tobi_status tobi_world_expected_speed(const tobi_world *w, double *speed, tobi_error *err);
/* Adds a note for each body that lies so near to a side that the grid feels the side through it. */
tobi_status tobi_world_note_thin_bodies(tobi_world *w, tobi_error *err);
/* Finds the bodies that solids are clamped to, before these are placed; refuses those that cannot hold. */
tobi_status tobi_world_find_clamps(tobi_world *w, tobi_error *err);
/* Asks bodies that deform where they hold particles; refuses a solid of which a body holds none. */
tobi_status tobi_world_start_clamps(tobi_world *w, tobi_error *err);
/* Adds a note for each stationary solid that is too light to clamp what is bonded to it. */
tobi_status tobi_world_note_clamps(tobi_world *w, tobi_error *err);
/* Adds a note for each solid whose surface_friction was changed and that meets no solid. */
tobi_status tobi_world_note_friction(tobi_world *w, tobi_error *err);
/* Adds a note for each solid that is a liquid, which the SPH methods compute better. */
tobi_status tobi_world_note_liquids(tobi_world *w, tobi_error *err);
/* A note for each hinge of a body outside of the domain. */
tobi_status tobi_world_note_hinges(tobi_world *w, tobi_error *err);
/* Adds a note for each body that sets off at once in a liquid at rest and each fill of liquid that begins
   beside a wall. */
tobi_status tobi_world_note_starts(tobi_world *w, tobi_error *err);
/* Notes lines whose ends lie far from their bodies, and catenaries that start taut. */
tobi_status tobi_world_note_lines(tobi_world *w, tobi_error *err);
/* Notes bodies that their given centre of mass makes turn over. */
tobi_status tobi_world_note_balance(tobi_world *w, tobi_error *err);
/* Adds a note for each number that is likely in other units than metres, kilograms and seconds. */
tobi_status tobi_world_note_units(tobi_world *w, tobi_error *err);
/* Notes blades whose motion ends their cut at a side before the last layer of particles is parted. */
tobi_status tobi_world_note_edges(tobi_world *w, tobi_error *err);
/* Adds a note if the definition's fixed time step will be cut, once. */
tobi_status tobi_world_note_time_step(tobi_world *w, tobi_error *err);

/* The hydrostatic head of the common box of a system's regions, m2/s2. */
double tobi_world_start_head(const tobi_world *w, const tobi_system *s);
/* Refuses, with its words, a world that failed in the middle of a step. */
tobi_status tobi_world_check_whole(const tobi_world *w, tobi_error *err);

/* One step, not beyond time t, which is hit exactly by a step that covers all that is left; the caller
   goes on until `end`. */
tobi_status tobi_world_step_towards(tobi_world *w, double t, double end, tobi_error *err);

/* Brings derived fields and the id order up to date. */
tobi_status tobi_world_refresh(tobi_world *w, tobi_error *err);

/* Frees what was read of the grid of mlsmpm. */
void tobi_world_free_grid(tobi_world *w);

/* textures.c: whether a mesh with texture coordinates fills a solid; finds those of all particles, once. */
int tobi_world_has_textures(const tobi_world *w);
/* Reads the image of the next body, or solid, if path is not NULL; the mesh needs coordinates. */
tobi_status tobi_world_read_image(tobi_world *w, const char *kind, const char *name, const char *path,
                                  const struct tobi_texture *coordinates, tobi_error *err);
/* The image of a body or solid, or NULL. */
struct tobi_image *tobi_world_body_image(const tobi_world *w, int body);
struct tobi_image *tobi_world_solid_image(const tobi_world *w, int solid);
void tobi_world_free_images(tobi_world *w);
tobi_status tobi_world_find_texture(tobi_world *w, tobi_error *err);

/* Reads a probe of a world that has just stepped. */
void tobi_world_measure_probe(const tobi_world *w, int probe, tobi_probe_info *info);
