/* Definitions: plain structs that say everything about a simulation before it exists.
   Obtain each from its tobi_default_* function, change members, hand it to tobi_world_create and
   friends. Every member carries its unit, default and range in the tables of src/world/params*.c,
   which the scene reader, `tobiuo describe`, resolved.json and the documentation all read.
   Strings are borrowed: they must live until the call that takes the definition returns. */
#ifndef TOBIUO_TYPES_H
#define TOBIUO_TYPES_H
#include "tobiuo/base.h"
#include "tobiuo/kinds.h"
#include "tobiuo/methods.h"
#include "tobiuo/outline.h"
#include "tobiuo/porous.h"
#include "tobiuo/scalar.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The largest speed of anything, m/s: of bodies and sides, and of particles at the start. A particle that
   becomes faster has diverged. */
#define TOBI_SPEED_LIMIT 1e6

/* At most so many in a world; regions are those of all fluids and solids, fills those of one in a scene. */
enum {
    TOBI_FLUID_LIMIT = 8, TOBI_SOLID_LIMIT = 255, TOBI_FILL_LIMIT = 256,
    TOBI_REGION_LIMIT = (TOBI_FLUID_LIMIT + TOBI_SOLID_LIMIT)*TOBI_FILL_LIMIT,
    TOBI_BODY_LIMIT = 1024, TOBI_PLANE_LIMIT = 26, TOBI_PROBE_LIMIT = 1024,
    TOBI_INLET_LIMIT = 32, TOBI_OUTLET_LIMIT = 32, TOBI_INTERFACE_LIMIT = 28
};

typedef enum tobi_smoothing {
    TOBI_KERNEL_WENDLAND_C2, TOBI_KERNEL_CUBIC_SPLINE, TOBI_KERNEL_QUARTIC_SPLINE, TOBI_KERNEL_QUINTIC_SPLINE,
    TOBI_KERNEL_WENDLAND_C4, TOBI_KERNEL_WENDLAND_C6
} tobi_smoothing;
typedef enum tobi_friction { TOBI_SLIP, TOBI_NO_SLIP } tobi_friction;
typedef enum tobi_compression {
    TOBI_COMPRESS_NONE, TOBI_COMPRESS_ZLIB, TOBI_COMPRESS_LZ4, TOBI_ASCII
} tobi_compression;

typedef enum tobi_krylov { TOBI_CG, TOBI_BICGSTAB, TOBI_GMRES } tobi_krylov;
typedef enum tobi_preconditioner { TOBI_MULTIGRID, TOBI_JACOBI } tobi_preconditioner;
typedef enum tobi_transfer { TOBI_APIC, TOBI_FLIP, TOBI_XPIC } tobi_transfer;
/* Of the weights, where stress pushes the grid; automatic: spline where nothing is cut or breaks. */
typedef enum tobi_gradient { TOBI_GRADIENT_AUTOMATIC, TOBI_GRADIENT_SPLINE, TOBI_GRADIENT_MLS } tobi_gradient;
/* Of particles beyond a side that is not open. */
typedef enum tobi_leaving { TOBI_KEEP, TOBI_REMOVE } tobi_leaving;
typedef enum tobi_seeding { TOBI_SEED_REGULAR, TOBI_SEED_BLUE_NOISE } tobi_seeding;

/* The box, the fluid resolution and the clock. */
typedef struct tobi_world_def {
    const char *method;          /* name in the method list: "dfsph", "isph", "mlsmpm", ...          */
    int         dimension;       /* 2 or 3; 2-D lives in x-y, masses and forces are per metre depth   */
    double      domain_min[3];   /* m, any sign                                                      */
    double      domain_max[3];   /* m                                                                */
    int         wall_min[3];     /* tobi_wall of the side at domain_min, per axis                    */
    int         wall_max[3];     /* tobi_wall of the side at domain_max; periodic comes in pairs     */
    double      wall_velocity_min[3][3];   /* m/s, of the no-slip sides at domain_min, along themselves */
    double      wall_velocity_max[3][3];   /* m/s, at domain_max                                       */
    double      gravity[3];      /* m/s2                                                             */
    double      spacing;         /* m, particle spacing d of the fluid                               */
    double      end_time;        /* s                                                                */
    double      time_step;       /* s, fixed, but for the last eight before an output; 0 = adaptive  */
    double      time_step_max;   /* s, cap of the adaptive step; 0 = none                            */
    double      cfl;             /* 1, dt <= cfl d / |v|max                                          */
    double      contact_angle;   /* degrees, in the liquid, at the sides of the box                  */
    double      friction;        /* 1, Coulomb coefficient of "separate" sides and solids            */
    double      speed_limit;     /* m/s, a faster particle stops the run as diverged; 0 = automatic  */
    int         implicit_viscosity, threads;   /* 1: viscosity bounds no step; 0 = all cores          */
} tobi_world_def;

/* A solid (or liquid, snow, sand) of the material point method: one material. */
typedef struct tobi_solid_def {
    const char *name;
    int    model;                     /* tobi_model                                                   */
    double density;                   /* kg/m3, unless mass is given                                  */
    double mass;                      /* kg (per metre in 2-D) of all its regions; 0 = by density     */
    double youngs_modulus;            /* Pa; liquids: see bulk_modulus                                */
    double poissons_ratio;            /* 1                                                            */
    double bulk_modulus;              /* Pa, of liquids                                               */
    double viscosity;                 /* Pa s, of liquids                                             */
    double yield_stress;              /* Pa, von Mises                                                */
    double hardening;                 /* Pa for von Mises (d yield/d strain), 1 for snow (exponent)   */
    double critical_compression;      /* 1, snow                                                      */
    double critical_stretch;          /* 1, snow                                                      */
    double friction_angle;            /* degrees, sand, and solids where they are broken              */
    double friction_rise;             /* 1, sand in fast flow, above the tangent of friction_angle    */
    double grain_diameter;            /* m, sand with a friction_rise                                 */
    double inertial_number;           /* 1, sand: at which half of friction_rise is there             */
    double strength;                  /* Pa, tension per area at the start that breaks it; 0 = never  */
    double fracture_energy;           /* J/m2, of a crack, per area at the start                      */
    double cut_friction;              /* 1, Coulomb, between the faces of a cut                       */
    double surface_friction;          /* 1, Coulomb, against solids that it is not bonded to          */
    int    liquid_friction;           /* tobi_friction, of fluids beside it                           */
    double damping;                   /* 1/s, velocities decay like exp(-damping t)                   */
    const char *clamped_to;           /* bodies that hold what starts in them or near: "a,b"; NULL = none */
    int    seeding;                   /* tobi_seeding                                                 */
    int    bonded;                    /* 1: sticks to other bonded solids that it touches              */
    double color[3];                  /* RGB, 0 to 255, in pictures; all -1 = by its speed            */
    double core_color[3];             /* RGB of what was below the surface at the start; all -1 = color */
    const char *texture;              /* path: PNG on the skin of its meshes in pictures; NULL = none  */
    int    visible;                   /* 0: left out of pictures                                      */
} tobi_solid_def;

/* A fluid: one material. */
typedef struct tobi_fluid_def {
    const char *name;
    double density;       /* kg/m3 */
    double viscosity;     /* Pa s, dynamic; Pa s^n with another flow index */
    double yield_stress, flow_index, creep_rate;    /* Pa, 1, 1/s: viscosity.md, eq. (6) */
    double smagorinsky;   /* 1, the constant of eq. (6) */
    double surface_tension; /* N/m, of its free surface */
    double color[3];      /* RGB, 0 to 255, in pictures; all -1 = by its speed */
    int    visible;       /* 0: left out of pictures */
} tobi_fluid_def;

/* The interface of two fluids, by their names. */
typedef struct tobi_interface_def {
    const char *fluid, *to_fluid;
    double tension;       /* N/m */
} tobi_interface_def;

/* Velocities (m/s) at n places (m) when the world starts, added to velocity and spin of a region. Returns
   TOBI_OK, or a status with a text in err. */
typedef tobi_status (*tobi_flow_fn)(void *user, int64_t n, const double (*place)[3], double (*velocity)[3],
                                    tobi_error *err);

/* One region filled with a fluid or solid at the start: a box, a sphere (in 2-D a disc), the inside of a
   mesh, or what a vessel holds. */
typedef struct tobi_fill_def {
    double      box_min[3], box_max[3];  /* m; used when mesh is NULL and radius is 0 */
    double      centre[3], radius;       /* m; the sphere, when radius > 0            */
    const char *mesh;                    /* path of a closed mesh, or NULL */
    tobi_outline_def outline;            /* placed as a mesh, by scale, rotation and translation */
    const char *vessel;                  /* name of a body that is one, or NULL    */
    double      level;                   /* m, how high: coordinate along gravity, upwards */
    double      seed[3];                 /* m, a place in the compartment to be filled; at the default all */
    double      scale[3], translation[3];
    double      rotation_axis[3], rotation_angle;  /* degrees; after the scale, before the translation */
    double      velocity[3];             /* m/s */
    double      spin[3];                 /* rad/s, about the middle of the region */
    tobi_flow_fn flow;                   /* NULL = none; called once, by tobi_world_start */
    void       *flow_user;               /* handed to flow; owned by the caller, must outlive that call */
} tobi_fill_def;

/* Maps rest positions to positions at time t. Points are mesh vertices, in metres, already placed
   by scale, rotation and translation. Must be a pure function of (user, t, rest). `rigid` motions
   move all points by one rigid transform. Returns TOBI_OK, or a status with a text in err. */
typedef tobi_status (*tobi_motion_fn)(void *user, double t, int64_t n, const double (*rest)[3],
                                      double (*position)[3], tobi_error *err);
/* Hands to a motion what a control program steers it with, before each call of it. */
typedef void (*tobi_steer_fn)(void *user, const double steer[3]);

/* At rest or moved by a motion, whatever pushes; by forces; by forces and a program's force and torque. */
typedef enum tobi_dynamics { TOBI_PRESCRIBED, TOBI_FREE, TOBI_CONTROLLED } tobi_dynamics;

/* Numbers that a control program keeps from step to step. */
enum { TOBI_CONTROL_STATE = 16 };
/* Joints that it sees: those of its body, the first so many. */
enum { TOBI_CONTROL_JOINTS = 16 };
typedef struct tobi_control_joint {
    const char *name;           /* as in joints.csv: of the joint, or of a body with a hinge         */
    union { double angle, position; };  /* degrees since the start, of body against to_body; m        */
    double speed;               /* degrees/s, m/s                                                    */
    int    slides;              /* 1: a guide or slide, with position and speed in m                 */
} tobi_control_joint;
/* What a control program sees of its body, in world axes, and what it answers. */
typedef struct tobi_control_input {
    double time;                /* s                                                                 */
    double position[3];         /* m, centre of mass                                                 */
    double orientation[4];      /* unit quaternion w x y z against the rest pose                     */
    double velocity[3];         /* m/s                                                               */
    double angular_velocity[3]; /* rad/s                                                             */
    double contact_force[3];    /* N, of particles, bodies and sides, mean over the last step        */
    double contact_torque[3];   /* N m about the centre of mass                                      */
    double mass;                /* kg                                                                */
    double inertia[6];          /* kg m2 about the centre, now: xx, yy, zz, xy, xz, yz               */
    int    phase;               /* 1 at the start, then what the program said last                   */
    double phase_time;          /* s since this phase began                                          */
    double step;                /* s, length of the last step                                        */
    double steer[3];            /* what the program said last; 0 at the start                        */
    double state[TOBI_CONTROL_STATE];   /* the same                                                  */
    tobi_control_joint joints[TOBI_CONTROL_JOINTS];     /* hinges or guide of the body               */
    int    joint_count;
} tobi_control_input;
typedef struct tobi_control_output {
    double force[3];            /* N on the centre of mass                                           */
    double torque[3];           /* N m                                                               */
    int    phase;               /* of the next step on                                               */
    const char *hold;           /* axes held still in this step, like tobi_body_def.locked, or NULL  */
    double steer[3];            /* numbers for the motion of a body that changes its shape           */
    double state[TOBI_CONTROL_STATE];   /* of the next step on, for the program alone: integrals     */
    double motor[TOBI_CONTROL_JOINTS];  /* what the motor of each of the input's joints is told from the
                                   next step on, in its unit; TOBI_NOT_GIVEN = as before             */
} tobi_control_output;
/* Must be a pure function of its input, or restarts would not repeat a run. At first out holds zeros, the
   input's phase, steer and state, and TOBI_NOT_GIVEN. hold must stay valid until the next call. */
typedef tobi_status (*tobi_control_fn)(void *user, const tobi_control_input *in,
                                       tobi_control_output *out, tobi_error *err);

#define TOBI_NOT_GIVEN (-1e9)

/* The motor of a hinge: one of speed, angle and torque, or a file; of a guide one of speed, position and
   force. tobi_default_joint_def and tobi_default_body_def give none of them, which is no motor. */
typedef struct tobi_motor_def {
    double speed;                   /* degrees/s, of a guide m/s; or TOBI_NOT_GIVEN                   */
    union { double angle, position; };  /* degrees, m, since the start; or TOBI_NOT_GIVEN             */
    union { double torque, force; };    /* N m, N; or TOBI_NOT_GIVEN                                  */
    const char *file;               /* CSV: time (s) and one of those; NULL = none                    */
    double amplitude, period, phase;    /* of a swing that is added: in the unit of that; s; degrees  */
    double start, ramp;             /* s: 0 until start, then it grows so long, as motions do         */
    union { double torque_max, force_max; };    /* N m, N, of a speed or angle, position; 0 = no bound */
} tobi_motor_def;

/* A body: the inside of a closed mesh, or of one of the shapes, prescribed or moved by forces. */
typedef struct tobi_body_def {
    const char *name;
    const char *mesh;           /* path: OBJ, STL or PLY; NULL = a shape                              */
    double box_min[3], box_max[3];  /* m, corners of a plain box, when there is no mesh and no shape  */
    double sphere_centre[3], sphere_radius;              /* m; a shape is there when its radius or    */
    double cylinder_start[3], cylinder_end[3], cylinder_radius;      /* thickness is above 0          */
    double capsule_start[3], capsule_end[3], capsule_radius;         /* half a sphere at both ends    */
    double plate_centre[3], plate_normal[3], plate_along[3];         /* along: of its length; 0 = any */
    double plate_length, plate_width, plate_thickness;
    double knife_edge[3], knife_direction[3], knife_along[3];        /* middle; from back to edge; of it */
    double knife_length, knife_height, knife_thickness, knife_angle; /* m; degrees between its faces     */
    tobi_outline_def outline;   /* a polygon                                                         */
    const char *terrain_file;   /* path: ESRI ASCII grid, or CSV of x, y, z; NULL = no terrain       */
    double terrain_base;        /* m: it reaches down to it                                          */
    double scale[3];            /* 1, per axis, about the mesh's own origin, first                   */
    double rotation_axis[3];    /* direction; second                                                 */
    double rotation_angle;      /* degrees                                                           */
    double translation[3];      /* m; last                                                           */
    int    vessel;              /* 1: a vessel; a mesh without walls of its own is its inner surface */
    int    sealed;              /* 1: no liquid reaches the gap where it lies on a side or a body    */
    double wall_thickness;      /* m, outside of that surface; 0 = its own walls, or else 2 spacings */
    double open_side[3];        /* direction of the flat side that a vessel has not; 0 = it has all  */
    double density;             /* kg/m3                                                             */
    double spacing;             /* m, spacing of the body's own particles; 0 = the fluid's           */
    int    friction;            /* tobi_friction felt by the fluid                                   */
    int    visible;             /* 0: left out of pictures                                           */
    double color[3];            /* RGB, 0 to 255, in pictures; all -1 = by its number                */
    const char *texture;        /* path: PNG that pictures put on a mesh with coordinates; NULL = none */
    double opacity;             /* 1, up to 1, in pictures; 0 chooses: 0.15 of a vessel in 3-D, else 1 */
    double contact_angle;       /* degrees, in the liquid                                            */
    tobi_motion_fn motion;      /* NULL = fixed                                                      */
    void  *motion_user;         /* handed to motion; owned by the caller, must outlive the world     */
    int    motion_rigid;        /* 1: the motion is one rigid transform for all points               */
    double absent_from, absent_until;   /* s, of a prescribed body: nothing sees it in between; from 0 =
                                   never, until 0 = to the end                                       */
    int    dynamics;            /* tobi_dynamics; what follows is for free and controlled bodies, but
                                   restitution and friction_coefficient for what touches any body    */
    double mass;                /* kg (per metre of depth in 2-D); 0 = density times volume          */
    double centre_of_mass[3];   /* m, as the body starts; [0] TOBI_NO_PLACE = the middle of the mesh */
    double inertia[3];          /* kg m2, xx, yy, zz at the start, about the centre; 0 = by the mesh */
    double inertia_products[3]; /* kg m2, entries xy, xz, yz of the inertia matrix                   */
    double velocity[3];         /* m/s at the start                                                  */
    double angular_velocity[3]; /* rad/s at the start                                                */
    double force[3], torque[3]; /* N, N m, constant, in world axes                                   */
    double air_resistance;      /* 1/s, c: velocities decay like exp(-c t)                           */
    double restitution;         /* 1, of collisions; of two bodies the larger one counts, against sides,
                                   planes and solids the body's alone                                */
    double friction_coefficient;/* 1, Coulomb; of two bodies, and with a separate plane, the square root
                                   of the product counts, against sides and solids the body's alone;
                                   TOBI_NOT_GIVEN = that of the other body, else 0.5                 */
    int    blade;               /* 1: its edge cuts solids of mlsmpm                                 */
    double edge_resistance;     /* J/m2, to make new surface with the edge                           */
    double edge_angle;          /* degrees, at most between the faces that meet at its edge          */
    double edge_start[3], edge_end[3];  /* m, of a straight edge as the body starts; both 0 = found
                                   in the mesh. In 2-D the edge is the point edge_start              */
    const char *locked;         /* "x,y,z,turn_x,turn_y,turn_z,shift,turn", any of them, or NULL     */
    double hinge_point[3], hinge_axis[3];   /* m, direction: it turns about a fixed axis; axis 0 = no  */
    double hinge_lower, hinge_upper;        /* degrees from the start, stops; both 0 = none           */
    double hinge_stiffness, hinge_damping;  /* N m/rad, N m s/rad                                     */
    tobi_motor_def hinge_motor;
    double guide_axis[3];                   /* direction: it slides along a fixed axis; 0 = no        */
    double guide_lower, guide_upper;        /* m from the start, stops; both 0 = none                 */
    double guide_stiffness, guide_damping;  /* N/m, N s/m                                             */
    tobi_motor_def guide_motor;
    tobi_control_fn control;    /* of a controlled body                                              */
    void  *control_user;        /* handed to control; owned by the caller, must outlive the world    */
    tobi_steer_fn motion_steer; /* of a controlled body with a motion, gets motion_user; NULL = none */
} tobi_body_def;

/* A fixed plane in the domain; solids of mlsmpm and bodies stay on the side that its normal points to. */
typedef enum tobi_plane_kind { TOBI_PLANE_SEPARATE, TOBI_PLANE_SLIP, TOBI_PLANE_NO_SLIP } tobi_plane_kind;
typedef struct tobi_plane_def {
    double point[3];            /* m, one of its points, in the domain                               */
    double normal[3];           /* of any length above 0, out of the plane; in 2-D without z         */
    int    kind;                /* tobi_plane_kind                                                   */
    double friction;            /* 1, Coulomb, where solids and bodies may separate from it          */
} tobi_plane_def;

/* Where liquid comes in: a rectangle, or a disc when radius > 0; in 2-D a line of that width. Behind its
   plane lies a buffer of particles, a support radius deep, that must be in the domain and free of bodies. */
typedef struct tobi_inlet_def {
    const char *name;
    const char *fluid;          /* name of what comes in; NULL = the first                            */
    double centre[3];           /* m, middle of the patch                                            */
    double normal[3];           /* the way that the liquid goes, of any length                       */
    double along[3];            /* direction of the width, across normal; 0 = any                    */
    double width, height;       /* m; in 2-D width alone                                             */
    double radius;              /* m                                                                 */
    double speed;               /* m/s, mean over the patch, or                                      */
    double flow_rate;           /* m3/s (2-D: m2/s), or                                              */
    const char *file;           /* CSV: time (s), speed or flow_rate; no start, stop, ramp; NULL = none */
    int    profile;             /* tobi_profile                                                      */
    double start, stop;         /* s; stop 0 = to the end                                            */
    double ramp;                /* s, in which the speed rises from 0 to its own                     */
} tobi_inlet_def;
typedef enum tobi_profile { TOBI_PROFILE_UNIFORM, TOBI_PROFILE_PARABOLIC } tobi_profile;

#define TOBI_NO_LEVEL (-1e9)
/* Where liquid goes out: what has passed it by a support radius is taken away. */
typedef struct tobi_outlet_def {
    const char *name;
    double centre[3], normal[3], along[3];     /* as of inlets: normal is the way that the liquid goes */
    double width, height, radius;
    double level, pressure;     /* m, of the liquid beyond (TOBI_NO_LEVEL); or Pa, at the centre (-1: none) */
} tobi_outlet_def;

/* A sensor in the domain. A point reports pressure and velocity of the fluid there, a level how high the
   fluid stands on the plumb line through the position (its coordinate along gravity does not matter), a
   run-up
   how far it reaches along a line. A patch is a rectangle on a wall that feels the fluid, a flow a rectangle
   that the fluid passes through, a volume a box. Their axes: along, normal x along, normal. */
typedef enum tobi_probe_kind {
    TOBI_PROBE_POINT, TOBI_PROBE_LEVEL, TOBI_PROBE_PATCH, TOBI_PROBE_RUN_UP, TOBI_PROBE_FLOW,
    TOBI_PROBE_VOLUME
} tobi_probe_kind;
typedef struct tobi_probe_def {
    const char *name;
    int    kind;                /* tobi_probe_kind                                                   */
    double position[3];         /* m, the middle of a rectangle or box, the wet end of a run-up      */
    double end[3];              /* m, the other end of a run-up                                      */
    double normal[3], along[3]; /* of any length; 0 = up, and any direction that is normal to normal */
    double length, width, height;   /* m; in 2-D a rectangle is a line and a box has no width        */
    const char *body;           /* name of the body that it sits on and moves with, or NULL          */
    const char *fluid;          /* name of the fluid that a level, run-up, flow or volume is of; NULL = all */
    double rate;                /* Hz, of its values; 0 = as output.probe_interval says              */
    double cutoff;              /* Hz, of its low pass; 0 = none                                     */
    int    order;               /* 0: of first order, 1: Butterworth of second order                 */
} tobi_probe_def;

/* A spring, a rope or a mooring line between a body and the domain or another body. */
enum { TOBI_LINE_LIMIT = 256 };
typedef enum tobi_line_kind { TOBI_LINE_SPRING, TOBI_LINE_ROPE, TOBI_LINE_CATENARY } tobi_line_kind;
typedef struct tobi_line_def {
    const char *name;
    int    kind;                /* tobi_line_kind                                                    */
    const char *body;           /* name of a free or controlled body                                 */
    double point[3];            /* m, the place on it, where the body starts                         */
    const char *to_body;        /* name of another body, not a deforming one; NULL = the domain      */
    double to[3];               /* m, the other end at the start                                     */
    double length;              /* m, without force; 0 = the distance at the start                   */
    double stiffness;           /* N/m, force per stretch; of a catenary EA/length                   */
    double damping;             /* N s/m, of springs and taut ropes                                  */
    double weight;              /* N/m, of a catenary in the liquid                                  */
    int    rests;               /* 1: a catenary may lie on a floor at the height of its lower end   */
} tobi_line_def;

/* A line after a step. */
typedef struct tobi_line_info {
    double tension;             /* N at the body; below 0 a spring pushes                            */
    double distance;            /* m between the ends                                                */
    double force[3];            /* N on the body                                                     */
    double point[3], to[3];     /* m, the ends                                                       */
} tobi_line_info;

/* A joint of a body with another one, or with the domain. */
enum { TOBI_JOINT_LIMIT = 64 };
typedef struct tobi_joint_def {
    const char *name;
    int    kind;                /* tobi_joint_between; in 2-D a ball joint is a hinge                */
    const char *body;           /* name of a free or controlled body                                 */
    const char *to_body;        /* name of another body, not a deforming one; NULL = the domain      */
    double point[3], axis[3];   /* m, of any length: as the bodies start. axis of a hinge, 0: z; of a slide */
    double lower, upper, rest;  /* degrees, of a slide m: stops, both 0 = none; where its spring rests */
    double stiffness, damping;  /* N m/rad, N m s/rad; of a slide N/m, N s/m                         */
    tobi_motor_def motor;       /* of a hinge, or as of a guide                                      */
} tobi_joint_def;

/* A joint after a step. */
typedef struct tobi_joint_info {
    double force[3];            /* N on the body, mean over the step                                 */
    double moment[3];           /* N m on it, at the place of the body; of a hinge across its axis     */
    double angle, position;     /* degrees, of a guide or slide m: since the start, against the other */
    double gap;                 /* m between what is joined                                          */
    double motor_torque;        /* N m about the axis on the body, of a motor, mean over the step    */
    double motor_force;         /* N along the guide on the body, likewise                           */
    double power;               /* W that damper and motor take from the bodies, mean over the step  */
    int    has_motor, has_power;    /* 1: it has a motor; a motor or a damper                        */
    int    slides;              /* 1: a guide or a slide                                             */
} tobi_joint_info;

/* What pictures show, and from where. */
enum { TOBI_VIEW_LIMIT = 8 };        /* views besides the output's own */
typedef struct tobi_view_def {
    const char *name;                 /* of the files of a further view; NULL: the output's own       */
    double      position[3];          /* m, of the camera, if there is an angle                       */
    double      look_at[3];           /* m, what it looks at                                          */
    double      angle;                /* degrees, vertical field of view; 0 = a view that fits        */
    int         look, field_of;       /* TOBI_LOOK_*, TOBI_FIELD_OF_* of tobiuo/picture.h             */
    int         map;                  /* of colours, see tobi_color_map_name                          */
    int         nests;                /* 1: in the boxes of nests their liquid instead of the scene's */
    const char *field;                /* that gives the colours; NULL = none                          */
    double      min, max;             /* values at the ends of the colours; equal = of each picture   */
    int         width, height;        /* pixels; 0 = one that fits                                    */
    int         samples;              /* per pixel and axis                                           */
    int         arrows;               /* 1: velocities as arrows                                      */
    int         isolines, streamlines;      /* of equal value; so many along the longest edge         */
    int         paths;                /* 1: where the centres of bodies have been                     */
    int         axes, transparent;    /* 1: ticks along edges of the domain, nothing behind           */
    int         foam;                 /* 1: spray, foam and bubbles, where tobi_foam_write wrote them   */
    const char *follow;               /* name of the body that the camera moves with; NULL = none     */
    double      clip_point[3], clip_normal[3];       /* m, 1; a normal of 0 = no plane                */
    double      slice;                /* m; 0 = all on one side of the plane                          */
} tobi_view_def;

/* Files of a run. */
typedef struct tobi_output_def {
    double      interval;             /* s of simulated time between outputs, hit exactly            */
    double      checkpoint_interval;  /* s of simulated time between checkpoints; 0 = only at the end */
    int         compression;          /* tobi_compression                                             */
    double      probe_interval;       /* s of simulated time between rows of probes.csv; 0 = every step */
    const char *fields;               /* names separated by commas, see tobi_world_field_name; "usual" */
    int         surfaces;             /* 1: write each body's surface as VTP and STL                  */
    int         frames;               /* 1: write a PNG picture at each output                        */
    int         tractions;            /* 1: write pressure and shear on each body's surface           */
    int         grid;                 /* 1: write the nodes of the grid of mlsmpm                     */
    int         ply;                  /* 1: write the fluid's positions as PLY                        */
    int         obj;                  /* 1: write each body's surface as OBJ                          */
    int         surface;              /* 1: write the surface of fluids and solids as VTP             */
    double      surface_cell;         /* spacings, cell of its grid                                   */
    int         surface_smoothing;    /* rounds                                                       */
    const char *surface_fields;       /* names separated by commas, of its vertices                   */
    tobi_view_def view;               /* the pictures frames/frame_000000.png                         */
    const tobi_view_def *views;       /* further ones, frames/NAME_000000.png; read at the start      */
    int         view_count;
} tobi_output_def;

/* Measured or published values that a column of a run's tables is compared with. */
typedef struct tobi_reference_def {
    const char *file;             /* path of a CSV file: a row of names, then numbers; # begins comments */
    const char *column;           /* of history.csv, or of bodies.csv or probes.csv, see below       */
    const char *body;             /* name of a body: column is one of bodies.csv; or NULL            */
    const char *probe;            /* name of a probe: column is what it measures, "pressure"; or NULL */
    const char *x;                /* column of file with the times                                   */
    const char *y;                /* column of file with the values; NULL = named like column        */
    double x_scale, y_scale;      /* factors that turn x into s and y into the unit of column        */
    double x_offset, y_offset;    /* s, unit of column: added after that                             */
    const char *label;            /* name in pictures; NULL = the file's                             */
} tobi_reference_def;

/* A zone in which the liquid is damped: a beach, where waves end. The rate at a place is `rate` times the
   square of the way into the box along `direction` over `length`, at most 1. */
typedef struct tobi_damping_def {
    double box_min[3], box_max[3];    /* m                                                             */
    double direction[3];              /* where the rate grows, of any length                           */
    double length;                    /* m, over which it grows; 0 = all of the box                    */
    double rate;                      /* 1/s, at its end                                               */
} tobi_damping_def;

/* Gravity as a function of time, in place of the constant one: by the rows of a file, and a swing added to
   that. The constant one stays what still water, energies and gauges refer to. */
typedef struct tobi_gravity_def {
    const char *file;             /* CSV: time (s), x, y, z (m/s2, a missing one as the constant); or NULL */
    double amplitude[3];          /* m/s2, of the swing amplitude sin(2 pi t/period + phase)         */
    double period;                /* s; 0 = no swing                                                 */
    double phase[3];              /* degrees                                                         */
    double start, ramp;           /* s, of the swing: tobi_motion_set_times                          */
} tobi_gravity_def;

/* A force on all liquid and bodies towards a place, which grows with the distance: acceleration
   -rate^2 (x - centre), in the axes of the frame. */
typedef struct tobi_central_def {
    double centre[3];             /* m                                                               */
    double rate;                  /* 1/s                                                             */
} tobi_central_def;

/* What one step did. */
typedef struct tobi_step_info {
    int64_t step;                 /* number of this step, first = 1                                   */
    double  time, dt;             /* s, after the step                                                */
    int     density_iterations, divergence_iterations, viscosity_iterations;
    int     density_converged, divergence_converged, viscosity_failed;   /* the last: stopped short    */
    double  density_error_mean, density_error_max;   /* 1, |rho/rho0 - 1| compression over all fluid   */
    double  surface_share;        /* 1, share of the fluid's particles that are at a free surface      */
    double  divergence_mean, divergence_max;         /* 1/s over all fluid                             */
    double  pressure_residual;    /* 1, relative residual of the pressure; of dfsph in the density solve */
    double  volume_drift;         /* 1, mean error of volume away from a free surface; isph alone     */
    double  wall_force[3];        /* N, force of the fluid on the domain's walls                      */
    double  weight;               /* N, |m g| of all fluid                                            */
    double  kinetic_energy, potential_energy;        /* J; potential against domain_min               */
    double  elastic_energy;       /* J, stored in solids and compressed liquids of mlsmpm             */
    double  work_bodies;          /* J, done by bodies and fluids on the solids of mlsmpm so far      */
    double  energy_lost;          /* J, gone from the solids so far; the next seven are its parts     */
    double  transfer_dissipation; /* J, by the way to the grid and back; if mlsmpm measures it        */
    double  plastic_work;         /* J, by plastic flow and viscosity; if measured                    */
    double  step_work;            /* J, by the length of time steps, impact included; if measured     */
    double  damping_work;         /* J, by the damping of solids                                      */
    double  friction_work;        /* J, by friction and impact at bodies and at faces of cuts         */
    double  fracture_work;        /* J, by the edges of blades and by cracks, for new surface         */
    double  side_work;            /* J, by friction at sides of the domain; < 0: they drive           */
    double  momentum[3];          /* kg m/s of all fluid                                              */
    double  force_sum;            /* N, sum of |F| over particles, the scale of momentum errors       */
    double  speed_max;            /* m/s                                                              */
    int64_t fluid_particles;
    double  mass_in, mass_out;    /* kg (2-D: kg/m), through inlets and outlets so far                */
    double  mass_held;            /* kg, of fluid in the domain, that in buffers of openings included */
    int64_t particles_in, particles_out;             /* the same as particles                         */
    int64_t particles_lost;       /* left the domain so far                                           */
    int64_t put_back;             /* times that a particle of mlsmpm was put back into it so far      */
    int64_t capped;               /* particles slowed to the speed cap in this step                   */
    int64_t contacts;             /* particles held back at a surface by position in this step        */
} tobi_step_info;

/* What a probe measures; members that its kind does not measure are 0. */
typedef struct tobi_probe_info {
    double pressure;              /* Pa; of a patch the mean                                          */
    double velocity[3], scalar[TOBI_SCALAR_LIMIT];       /* m/s; by tobi_scalar_field                */
    double level;                 /* m, coordinate of the surface along gravity                       */
    double force[3], moment[3];   /* N, N m about the middle: of the fluid on a patch; 2-D: per m     */
    double distance, run_up;      /* m, of the water's end from the begin; its coordinate along gravity */
    double flow;                  /* m3/s along the normal (2-D: m2/s), against the body that it sits on */
    double volume;                /* m3 (2-D: m2)                                                     */
} tobi_probe_info;

/* A solid: what it is made of. Before the start `particles` is a good guess for spheres and meshes, and
   nothing is cut out by bodies yet. */
typedef struct tobi_solid_info {
    const char *name;             /* owned by the world                                               */
    int64_t particles;
    double density, volume, mass; /* kg/m3, m3, kg of the regions at the start; 2-D: m2, kg/m         */
    double time_step;             /* s, the longest that it and gravity allow at rest                 */
    double centre[3], velocity[3];       /* m, m/s: of its mass, once the world has started           */
    double liquid_force[3];       /* N: of the fluids on it, in the last step                         */
} tobi_solid_info;

/* A connected piece of a solid. Particles are linked within 1.5 spacings unless a cut lies between them. */
typedef struct tobi_piece {
    int     solid;                /* number of the solid                                              */
    int     fragment;             /* 1: fewer particles than a grid cell holds (8; 2-D: 4): debris    */
    int64_t particles;
    int64_t first_id;             /* smallest id of its particles                                     */
    double  mass, volume;         /* kg, m3 as it is deformed; 2-D: kg/m, m2                          */
    double  centre[3];            /* m, centre of mass                                                */
} tobi_piece;

/* All pieces of all solids: `count` pieces by falling mass, then `fragments` of them that are debris, by
   falling mass; of equal ones that with the smaller first_id comes first. */
typedef struct tobi_pieces {
    int64_t count, fragments;
    double  mass, volume;         /* sums over `piece`, in its order                                  */
    const tobi_piece *piece;      /* [count + fragments]                                              */
} tobi_pieces;

/* What a body is doing. Pressure and viscous parts apart; torque about `position`. */
typedef struct tobi_body_info {
    double position[3];           /* m, centre of mass                                                */
    double orientation[4];        /* unit quaternion w x y z against the rest pose                    */
    double velocity[3];           /* m/s of the centre of mass                                        */
    double angular_velocity[3];   /* rad/s                                                            */
    double pressure_force[3], viscous_force[3];      /* N, of the fluid on the body                   */
    double pressure_torque[3], viscous_torque[3];    /* N m                                           */
    double contact_force[3], contact_torque[3];      /* N, N m: of bodies and sides that touch it     */
    double edge_force[3];         /* N, the part of pressure_force that a blade's edge takes to cut   */
    double mass, volume, inertia[9];    /* kg, m3, kg m2 about the centre, by integrals of the mesh   */
    int64_t particles;            /* body particles                                                   */
    double sampled_volume;        /* m3, number of body particles times spacing^3                     */
} tobi_body_info;

/* Energy of a body that moves by forces, 0 of others, and what it is given: power, mean over the last step.
   Summed over the steps, power times dt is the work. In 2-D all is per m. */
typedef struct tobi_body_energy {
    double kinetic, potential;    /* J: of centre of mass and turn; in gravity against domain_min     */
    double power;                 /* W, by fluids and solids; of a body with a motion, it takes -power */
    double contact_power;         /* W, by bodies and sides that touch it                             */
    double motion_power;          /* W, by its motion: -power; of a swimmer by its change of shape    */
    double force_power;           /* W, by its constant force and torque and its control program      */
    double air_power, nest_power; /* W, by its air resistance; by nest_force of bodies.csv            */
    double field_power;           /* W, by a frame that moves, gravity in time, a central force       */
} tobi_body_energy;

/* Energy of a world besides that of its fluids and solids. */
typedef struct tobi_energy {
    double kinetic, potential;    /* J, of all bodies that move by forces                             */
    double springs;               /* J, in springs of joints, hinges, guides, and in lines            */
    double motion_power;          /* W, that motions of bodies give, of swimmers by their shapes       */
    double joint_power;           /* W, that dampers and motors of joints take from the bodies        */
    double line_power;            /* W, that damping of lines takes from them                         */
    double force_power, air_power, field_power, nest_power;    /* W, of all bodies, as above          */
    double porous_power;          /* W, that porous zones take from liquids                           */
    double buoyancy_power;        /* W, that weight by temperature and concentration gives them       */
} tobi_energy;

#ifdef __cplusplus
}
#endif
#endif
