/* Tobiuo: particle-method simulation. See types.h for the definitions.

   Ownership: a tobi_world is opaque and owned by the caller from create to destroy. Arrays returned
   by pointer stay owned by the world and are valid until the next call that changes it. A failing
   call leaves the world as it was, except these:
   - A step that fails after it has moved something: TOBI_DIVERGED, and a control program or memory that fails
     there. The world stays readable. It steps no more and answers with the same status and text until
     tobi_world_load gives it a whole state. A motion that fails is asked before anything moves: the world
     can go on.
   - TOBI_STALLED: the step was made; who wants to go on steps again.
   - tobi_world_load, save, read and others that need particles start the world, see tobi_world_start.
   All units are SI. No call prints or exits. tobi_set_language alone keeps global state.

   Mistakes of the calling program: a NULL where something must stand, a number out of range and an index of
   nothing are answered with TOBI_INVALID or TOBI_NOT_FOUND by calls that return a status, with 0 or NULL by
   the others. A world that was destroyed must not be used; dev builds stop at an assert.

   Names: a fluid, solid or body has a name that no other of the three has, and so have probes, lines and
   joints, each among themselves: TOBI_INVALID. The default names serve for one of each. They stand in
   tables: commas, quotes and control characters are TOBI_INVALID.

   Threads: different worlds may be used from different threads, one world from one thread at a time. After a
   fork the child must not use worlds of its parent, whose threads it has not; exec is fine.
   Callbacks (motions, flows, control programs, stop) are called from the thread that calls the library. They
   must not use the world that asks them, and they must return: C++ exceptions and longjmp must not leave
   them. Numbers that are not finite, and speeds above TOBI_SPEED_LIMIT, are refused with body and time. */
#ifndef TOBIUO_H
#define TOBIUO_H
#include "tobiuo/nest.h"
#include "tobiuo/types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tobi_world tobi_world;

TOBI_API const char *tobi_version(void);
/* Names of the methods by number ("dfsph"), NULL past the end. */
TOBI_API const char *tobi_method_name(int index);
/* A word for a program, in English. */
TOBI_API const char *tobi_status_text(tobi_status status);
/* The language of the texts of errors, mistakes of scenes and notes: "en", as at the start, or "ja". It holds
   for all that the process says from then on; what was said stays. As with setlocale, no other thread may be
   within a call of the library. Keys, names, numbers and units are the same in both. */
TOBI_API tobi_status tobi_set_language(const char *name, tobi_error *err);
/* A text of the library in that language, for programs that show others than messages: "fluid". Itself where
   there is no other. */
TOBI_API const char *tobi_text(const char *english);

TOBI_API tobi_world_def  tobi_default_world_def(void);
TOBI_API tobi_dfsph_def  tobi_default_dfsph_def(void);
TOBI_API tobi_wcsph_def  tobi_default_wcsph_def(void);
TOBI_API tobi_isph_def   tobi_default_isph_def(void);
TOBI_API tobi_eisph_def  tobi_default_eisph_def(void);
TOBI_API tobi_mlsmpm_def tobi_default_mlsmpm_def(void);
TOBI_API tobi_fluid_def  tobi_default_fluid_def(void);
TOBI_API tobi_interface_def tobi_default_interface_def(void);
TOBI_API tobi_solid_def  tobi_default_solid_def(void);
TOBI_API tobi_fill_def   tobi_default_fill_def(void);
TOBI_API tobi_body_def   tobi_default_body_def(void);
TOBI_API tobi_plane_def  tobi_default_plane_def(void);
TOBI_API tobi_inlet_def  tobi_default_inlet_def(void);
TOBI_API tobi_outlet_def tobi_default_outlet_def(void);
TOBI_API tobi_probe_def  tobi_default_probe_def(void);
TOBI_API tobi_line_def   tobi_default_line_def(void);
TOBI_API tobi_joint_def  tobi_default_joint_def(void);
TOBI_API tobi_output_def tobi_default_output_def(void);
TOBI_API tobi_reference_def tobi_default_reference_def(void);
TOBI_API tobi_gravity_def tobi_default_gravity_def(void);
TOBI_API tobi_central_def tobi_default_central_def(void);
TOBI_API tobi_damping_def tobi_default_damping_def(void);
TOBI_API tobi_porous_def tobi_default_porous_def(void);
TOBI_API tobi_nest_def tobi_default_nest_def(void);
TOBI_API tobi_scalar_def tobi_default_scalar_def(void);
TOBI_API tobi_scalar_value_def tobi_default_scalar_value_def(void);

/* Creates an empty world. method_def points to the method's parameters (tobi_dfsph_def, ...), NULL = its
   defaults. On failure *world is NULL and err says why. */
TOBI_API tobi_status tobi_world_create(const tobi_world_def *def, const void *method_def,
                                       tobi_world **world, tobi_error *err);
TOBI_API void tobi_world_destroy(tobi_world *world);

/* Adds a fluid with the regions it fills. Boxes take whole layers, spread evenly; the spacing of the world
   gives way by up to 5 % until the particles of all boxes hold their volume, which the notes tell. Other
   regions take the points (i + 1/2) d from their lower corner that lie inside. Those in a body are cut out
   at start. */
TOBI_API tobi_status tobi_world_add_fluid(tobi_world *world, const tobi_fluid_def *def,
                                          const tobi_fill_def *fills, int fill_count, tobi_error *err);
/* Tension between two fluids that were added, for the SPH methods; once for each pair. TOBI_INVALID for names
   of no fluid, or of one. */
TOBI_API tobi_status tobi_world_add_interface(tobi_world *world, const tobi_interface_def *def,
                                              tobi_error *err);
/* Parameters of the material point method for solids beside the fluids of another method; before the first
   solid. def NULL: the defaults. */
TOBI_API tobi_status tobi_world_use_solids(tobi_world *world, const tobi_mlsmpm_def *def, tobi_error *err);
/* Adds a solid of the material point method with the regions it fills. Beside fluids of another method it
   presses them and they press it; the fluid is cut out where solids start. */
TOBI_API tobi_status tobi_world_add_solid(tobi_world *world, const tobi_solid_def *def,
                                          const tobi_fill_def *fills, int fill_count, tobi_error *err);
/* Adds a body. Its mesh is closed and oriented outwards if the file leaves no doubt how; what was
   repaired is in the notes. */
TOBI_API tobi_status tobi_world_add_body(tobi_world *world, const tobi_body_def *def, tobi_error *err);

/* Adds a plane, for methods that know them (mlsmpm); others are TOBI_UNSUPPORTED. TOBI_INVALID if its point
   lies outside the domain or its normal has no direction. */
TOBI_API tobi_status tobi_world_add_plane(tobi_world *world, const tobi_plane_def *def, tobi_error *err);

/* Adds an opening, after the fluids, for the SPH methods; others are TOBI_UNSUPPORTED. TOBI_INVALID for one
   that is no patch, leaves the domain with its buffer, or would need speeds beyond the limit. The start
   refuses one in a body, and an outlet that faces inwards. */
TOBI_API tobi_status tobi_world_add_inlet(tobi_world *world, const tobi_inlet_def *def, tobi_error *err);
TOBI_API tobi_status tobi_world_add_outlet(tobi_world *world, const tobi_outlet_def *def, tobi_error *err);

/* Adds a probe, at any time. TOBI_INVALID if it sits outside the domain. */
TOBI_API tobi_status tobi_world_add_probe(tobi_world *world, const tobi_probe_def *def, tobi_error *err);

/* Adds a line, after the bodies that it names. TOBI_INVALID if they are not there, if `body` is prescribed,
   or for constants that its kind does not have; TOBI_UNSUPPORTED if to_body deforms. */
TOBI_API tobi_status tobi_world_add_line(tobi_world *world, const tobi_line_def *def, tobi_error *err);
TOBI_API int tobi_world_line_count(const tobi_world *world);
/* Name and, if info is not NULL, values after the last step; NULL past the end. */
TOBI_API const char *tobi_world_line(const tobi_world *world, int line, tobi_line_info *info);

/* Adds a joint, after the bodies that it names. TOBI_INVALID if they are not there, if `body` is prescribed,
   or for an axis that its kind does not have; TOBI_UNSUPPORTED if one deforms or is absent at times. */
TOBI_API tobi_status tobi_world_add_joint(tobi_world *world, const tobi_joint_def *def, tobi_error *err);
/* Of joints, and then of bodies with a hinge or guide of their own, which have the name of the body. */
TOBI_API int tobi_world_joint_count(const tobi_world *world);
/* Name and, if info is not NULL, values after the last step; NULL past the end. */
TOBI_API const char *tobi_world_joint(const tobi_world *world, int joint, tobi_joint_info *info);

/* What was repaired or looks odd in the meshes of bodies and fluids, a sentence each, by index; NULL past
   the end. Owned by the world, valid until it is destroyed. */
TOBI_API const char *tobi_world_note(const tobi_world *world, int note);
/* Adds a note of the caller's own, a copy. */
TOBI_API tobi_status tobi_world_add_note(tobi_world *world, const char *text, tobi_error *err);

/* Makes a world, before its start, a nest of an outer one: of the same domain, method, fluids and bodies,
   with a spacing that is smaller by the refinement. It has liquid in the box and in a rim around it, which
   follows the outer liquid. The caller steps the outer world, then the nest up to the same time, then calls
   tobi_world_feed.
   Its bodies are moved by motions; tobi_nest_motion moves one as the outer world does. The outer world must
   outlive it. TOBI_INVALID, TOBI_UNSUPPORTED in words (docs/decisions/0157-nests.md). */
TOBI_API tobi_status tobi_world_nest(tobi_world *world, tobi_world *outer, const tobi_nest_def *def,
                                     tobi_error *err);
/* The nests of a world by number; NULL past the end. */
TOBI_API tobi_world *tobi_world_nest_at(const tobi_world *outer, int index);
/* 1 for a nest: where its box is now, m, infinite where a side of the domain is nearer than the rim is wide,
   and its spacing, m; else 0. */
TOBI_API int tobi_world_nest_box(const tobi_world *nest, double box[2][3], double *spacing);
/* How many particles a nest may come to have: as many as have room in its box and the rim, and, of a started
   world without openings, no more than the outer liquid makes. 0 for a world that is none. */
TOBI_API double tobi_world_nest_most(const tobi_world *nest);
/* A box of a nest goes on, to infinity, across each side of the domain that its rim would reach beyond, and
   along axes that the dimension does not have. box, domain: lower and upper corner, m. */
TOBI_API void tobi_nest_open_sides(double box[2][3], const double domain[2][3], double rim, int dimension);
/* Whether a name fits a nest, and the folder of its results: letters, digits, _ and -, at most 63. */
TOBI_API int tobi_nest_name_fits(const char *name);
/* One of the steps that tobi_world_advance takes to time t, s, which the last one hits exactly: the nests of
   the world follow after each. */
TOBI_API tobi_status tobi_world_step_to(tobi_world *world, double t, tobi_error *err);
/* Of a nest that has caught up with the outer world: bodies there that move by forces and lie in the box feel
   in the next step what the nest pressed them with more, by isph. With feedback the outer liquid in the box,
   two outer spacings from its sides, has the velocity of the nest. TOBI_INVALID for a world that is none. */
TOBI_API tobi_status tobi_world_feed(tobi_world *nest, tobi_error *err);
/* A tobi_motion_fn, rigid but for swimmers: as a body of an outer world goes, in the last step of that; user:
   a tobi_nest_body, which must outlive the world. */
typedef struct tobi_nest_body { const tobi_world *outer; int body; } tobi_nest_body;
TOBI_API tobi_status tobi_nest_motion(void *user, double t, int64_t n, const double (*rest)[3],
                                      double (*position)[3], tobi_error *err);
/* Counts particles and bytes without allocating them, and notes a fixed time step that will be cut. */
TOBI_API tobi_status tobi_world_estimate(tobi_world *world, int64_t *fluid_particles,
                                         int64_t *body_particles, int64_t *bytes, tobi_error *err);
/* Places the particles; no fluid or body may be added after it. Called by the first step if not
   called before. TOBI_INVALID if there is no particle at all, or none in a fluid or solid that has regions;
   TOBI_NO_MEMORY before allocating more than the machine has. */
TOBI_API tobi_status tobi_world_start(tobi_world *world, tobi_error *err);

/* One time step, not longer than max_dt (s; 0 = no cap). info may be NULL. TOBI_STALLED when time stands
   still, or when the end, end_time of the definition, lies more than 1e9 steps of the present length away. */
TOBI_API tobi_status tobi_world_step(tobi_world *world, double max_dt, tobi_step_info *info,
                                     tobi_error *err);
/* Steps until time t (s), hit exactly; nothing if the world is there already. TOBI_INVALID for a t before
   its time. */
TOBI_API tobi_status tobi_world_advance(tobi_world *world, double t, tobi_step_info *info, tobi_error *err);

/* Asked by the thread that steps, between steps and between the iterations of a solve; an answer other than 0
   ends the call with TOBI_STOPPED. It may read what a signal handler or another thread sets (sig_atomic_t,
   an atomic); it may not call functions of this world. */
typedef int (*tobi_stop_fn)(void *user);
/* NULL takes it away. user is owned by the caller. */
TOBI_API void tobi_world_set_stop(tobi_world *world, tobi_stop_fn stop, void *user);

/* What may be changed before the start and between two steps, from the next step on. Checkpoints hold it.
   Gravity, m/s2, in 2-D without z. Still water, the sums of energies and the bounds of the time step follow.
   TOBI_INVALID beyond the range of the definition's gravity. */
TOBI_API tobi_status tobi_world_set_gravity(tobi_world *world, const double gravity[3], tobi_error *err);
/* Before the start. A damping zone; TOBI_INVALID for boxes without an inside and for negative rates,
   TOBI_UNSUPPORTED in mlsmpm and for more than 16. */
TOBI_API tobi_status tobi_world_add_damping(tobi_world *world, const tobi_damping_def *def, tobi_error *err);
/* Before the start, after the fluids. A porous zone; TOBI_INVALID for shapes without an inside, that cross
   themselves, outside of the domain or in another zone, for oblique cylinders, and for a zone that has none
   or two kinds of contents; TOBI_NOT_FOUND and TOBI_IO for the file of an outline; TOBI_UNSUPPORTED in
   mlsmpm, for more than 16, and for outlines and cylinders along different axes whose boxes overlap. */
TOBI_API tobi_status tobi_world_add_porous(tobi_world *world, const tobi_porous_def *def, tobi_error *err);
/* Name and, if info is not NULL, what it does; NULL past the end. */
TOBI_API const char *tobi_world_porous(const tobi_world *world, int zone, tobi_porous_info *info);
/* Before the start. Temperature or concentration of the liquids; TOBI_INVALID for one that is given already,
   TOBI_UNSUPPORTED in mlsmpm. */
TOBI_API tobi_status tobi_world_add_scalar(tobi_world *world, const tobi_scalar_def *def, tobi_error *err);
/* Before the start, after scalars, fluids, bodies and inlets: where it has another value. TOBI_INVALID for
   none or two places, names that are none, sides that are no walls and walls that have it already. */
TOBI_API tobi_status tobi_world_add_scalar_value(tobi_world *world, const tobi_scalar_value_def *def,
                                                 tobi_error *err);
/* 1 and, if info is not NULL, what the liquids have of it; 0 past the last. */
TOBI_API int tobi_world_scalar(const tobi_world *world, int number, tobi_scalar_info *info);
/* Name of a side or body with a value or flux and, if flow is not NULL, what comes through; NULL past the
   end. */
TOBI_API const char *tobi_world_scalar_flow(const tobi_world *world, int number, tobi_scalar_flow *flow);
/* Before the start. Gravity as a function of time; TOBI_INVALID for numbers out of range and rows that go
   back in time, TOBI_NOT_FOUND and TOBI_IO for the file. Checkpoints do not hold it. */
TOBI_API tobi_status tobi_world_set_gravity_in_time(tobi_world *world, const tobi_gravity_def *def,
                                                    tobi_error *err);
/* Before the start. A force towards a place; TOBI_INVALID for numbers out of range and, at the start, for a
   periodic domain, where the force would jump; then TOBI_UNSUPPORTED in mlsmpm. Energies leave it out;
   field_power has what it gives bodies. */
TOBI_API tobi_status tobi_world_set_central_force(tobi_world *world, const tobi_central_def *def,
                                                  tobi_error *err);
/* Before the start. All of the world is seen from a frame that moves, by a rigid motion from the pose of time
   0, instead of a tank that does: the liquid feels the fictitious forces. user must outlive the world.
   TOBI_UNSUPPORTED for a frame that turns, in mlsmpm. */
TOBI_API tobi_status tobi_world_set_frame(tobi_world *world, tobi_motion_fn motion, void *user,
                                          tobi_error *err);
/* Constant force (N, on the centre of mass) and torque (N m) on a free or controlled body, in place of those
   of its definition. TOBI_NOT_FOUND for a number that is no body, TOBI_INVALID for a prescribed one and for
   numbers that are not finite. */
TOBI_API tobi_status tobi_world_set_body_force(tobi_world *world, int body, const double force[3],
                                               const double torque[3], tobi_error *err);
/* Another motion for a body that was defined with one, rigid or not as that one. user must outlive the world.
   At the present time it must have the body where it is, to a tenth of the spacing: TOBI_INVALID. Functions
   are not stored: after tobi_world_load of a state that had its motion set, steps are TOBI_INVALID until it
   is set again. */
TOBI_API tobi_status tobi_world_set_body_motion(tobi_world *world, int body, tobi_motion_fn motion,
                                                void *user, tobi_error *err);

TOBI_API double  tobi_world_time(const tobi_world *world);
TOBI_API const tobi_step_info *tobi_world_info(const tobi_world *world);
TOBI_API int     tobi_world_body_count(const tobi_world *world);
TOBI_API tobi_status tobi_world_body(const tobi_world *world, int body, tobi_body_info *info);
/* Energy and power of a body; of bodies, joints, lines, porous zones. Powers are known after a step. */
TOBI_API tobi_status tobi_world_body_energy(const tobi_world *world, int body, tobi_body_energy *energy);
TOBI_API tobi_status tobi_world_energy(const tobi_world *world, tobi_energy *energy);
TOBI_API const char *tobi_world_body_name(const tobi_world *world, int body);
TOBI_API int     tobi_world_solid_count(const tobi_world *world);
TOBI_API tobi_status tobi_world_solid(const tobi_world *world, int solid, tobi_solid_info *info);
/* The longest step that the stiffness of the solids, or the sound of wcsph, and the speed at the start allow,
   s; 0 = there is neither. */
TOBI_API double  tobi_world_stable_step(const tobi_world *world);
/* 1 where nothing gives the world energy after its start: no motion, force or control of a body, no inlet or
   outlet, line, joint, moving side, surface tension, change of gravity, and gravity only downwards along
   axes that are not periodic. *bodies (J; may be NULL): what free bodies have now, against domain_min. */
TOBI_API int     tobi_world_closed(const tobi_world *world, double *bodies);
TOBI_API int     tobi_world_probe_count(const tobi_world *world);
TOBI_API tobi_status tobi_world_probe(tobi_world *world, int probe, tobi_probe_info *info, tobi_error *err);
/* NULL for a number that is no probe; kind may be NULL. */
TOBI_API const char *tobi_world_probe_name(const tobi_world *world, int probe, tobi_probe_kind *kind);

/* Particle sets: the fluid, or the particles of the bodies. In both, rows are in the order of rising ids. An
   id names a particle from the start to the end, over restarts too. Those of the fluid count from 0; a
   particle that has left takes its id with it. Those of bodies follow, body after body. */
typedef enum tobi_set { TOBI_FLUID, TOBI_BODIES } tobi_set;
TOBI_API int64_t tobi_world_count(const tobi_world *world, tobi_set set);
/* Names of all fields by index, NULL past the end; components is 1, 3, 6 (xx, yy, zz, xy, yz, zx) or 9 (by
   rows). tobi_world_read refuses those that the method, or bodies, do not have. */
TOBI_API const char *tobi_world_field_name(int field, int *components, const char **unit);
/* The field that a name tells, whole or by a component: "velocity", "velocity_x", "stress_zx". component: its
   number, -1 of the whole. NULL: there is no such field; component and unit may be NULL. */
TOBI_API const char *tobi_world_find_field(const char *name, int *component, const char **unit);
/* Writes what a picture calls a field or component of one, or "speed", in the language of tobi_set_language:
   "velocity_x [m/s]". Any other name is written as it is. */
TOBI_API void tobi_field_label(const char *name, char *text, size_t size);
/* The names of the fields of a method by index, of all fields if it is unknown; NULL past the end. */
TOBI_API const char *tobi_method_field(const char *method, int index);
/* 1 if the particles of bodies have the field, by the number of tobi_world_field_name. */
TOBI_API int tobi_body_has_field(int field);
/* Copies a field into buffer (count x components doubles, row-major, id order). "id" is another name of
   "particle_id". Of a world that has diverged pressures, and others that follow from neighbours, are NaN
   by the methods of fluids. TOBI_NOT_FOUND for a temperature or concentration that the world has not. */
TOBI_API tobi_status tobi_world_read(tobi_world *world, tobi_set set, const char *field,
                                     double *buffer, int64_t count, tobi_error *err);
/* Copies the ids as integers; the same errors. */
TOBI_API tobi_status tobi_world_read_ids(tobi_world *world, tobi_set set, int64_t *buffer, int64_t count,
                                         tobi_error *err);
/* Sets "velocity" or "pressure" of the fluid (count rows, id order), for initial conditions. TOBI_INVALID,
   and nothing is set, for numbers that are not finite or speeds above TOBI_SPEED_LIMIT. */
TOBI_API tobi_status tobi_world_write(tobi_world *world, const char *field, const double *buffer,
                                      int64_t count, tobi_error *err);
/* The moving surface of a body: vertices (m) and triangles, owned by the world. While it is absent: none. */
TOBI_API tobi_status tobi_world_surface(const tobi_world *world, int body, int64_t *vertex_count,
                                        const double (**vertices)[3], int64_t *triangle_count,
                                        const int32_t (**triangles)[3]);

/* The nodes of the material point method's grid that particles reach, as the particles at the present time
   make them: positions (m), velocities (m/s, of the particles' momentum; walls and bodies are not asked),
   mass (kg; 2-D: kg/m) and mean Cauchy stress (Pa: xx, yy, zz, xy, yz, zx) by volume. Owned by the world,
   valid until the next call of this function. TOBI_UNSUPPORTED for the other methods. */
typedef struct tobi_grid {
    int64_t count;
    double (*position)[3], (*velocity)[3], *mass, (*stress)[6];
} tobi_grid;
TOBI_API tobi_status tobi_world_grid(tobi_world *world, const tobi_grid **grid, tobi_error *err);

/* The connected pieces of the solids at the present time; liquids have none. Costs about as much as a few
   steps; later calls and the field "piece" (a piece's index here, liquids -1) are free until the world steps.
   Owned by the world, valid until the next call that changes it. TOBI_UNSUPPORTED for methods without
   solids. */
TOBI_API tobi_status tobi_world_pieces(tobi_world *world, const tobi_pieces **pieces, tobi_error *err);

/* Hash of the whole state (positions, velocities, pressures in id order): equal for any thread count. */
TOBI_API uint64_t tobi_world_hash(tobi_world *world);
/* Bytes the world has allocated for its systems. */
TOBI_API int64_t tobi_world_bytes(const tobi_world *world);
/* The same by what they hold: name and bytes by index, NULL past the end. */
TOBI_API const char *tobi_world_memory(const tobi_world *world, int part, int64_t *bytes);
/* Time spent per stage so far: name and seconds by index, NULL past the end. */
TOBI_API const char *tobi_world_stage(const tobi_world *world, int stage, double *seconds);

/* Writes / reads the complete state, so that run = run + restart bit for bit. The world read into
   must have been created and filled by the same definitions. The file appears whole or not at all, and
   outlasts a power cut; at path there may be a plain file or nothing: TOBI_INVALID. A file that cannot be
   loaded, TOBI_DAMAGED, TOBI_INVALID for that of another scene, TOBI_UNSUPPORTED for that of another version,
   leaves the world as it was. A world that failed in a step has no state to be saved. */
TOBI_API tobi_status tobi_world_save(tobi_world *world, const char *path, tobi_error *err);
TOBI_API tobi_status tobi_world_load(tobi_world *world, const char *path, tobi_error *err);

#ifdef __cplusplus
}
#endif
#endif
