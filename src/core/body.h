/* Bodies in the fluid: a closed surface of quadrature points that moves as its mesh moves, and the
   body's own particles, which serve output only. */
#pragma once
#include "core/cells.h"
#include "core/rigid.h"
#include "core/swimmer.h"
#include "geom/bvh.h"
#include "geom/massprops.h"
#include "geom/mesh.h"
#include "geom/sample.h"
#include "geom/sharp.h"
#include "geom/quadrature.h"
#include "tobiuo/types.h"

/* A straight piece of a blade's edge as it cuts now, in rest axes about the centre of mass. */
typedef struct tobi_blade_edge {
    double from[3];                  /* m, its first end                                       */
    double along[3], ahead[3], normal[3];    /* unit vectors: the piece, where it cuts to, of the cut */
    double length;                   /* m; in 2-D 1, per metre of depth                        */
    int cuts;                        /* 0: tagged without a direction, and at rest             */
} tobi_blade_edge;

/* What of the mesh is nearest to a piece of the edge, in the rest pose. */
typedef struct tobi_edge_foot {
    int32_t triangle;                /* -1: not looked for yet                                 */
    double  barycentric[3];
} tobi_edge_foot;

/* What one system presses a body with, mean over the world's step: N, and N m about the centre. */
typedef struct tobi_body_load {
    double pressure[6], friction[6], edge[3];
    double shape;                    /* W, of the velocities by which the body changes its shape */
} tobi_body_load;
enum { TOBI_SYSTEM_LIMIT = 2 };

/* What a point of a body's surface knows of the water: none; particles see it; it faces a side or another
   body so near that not all of what presses it are particles; it lies in another body, out of reach. */
enum { TOBI_DRY, TOBI_WET, TOBI_WET_GAP, TOBI_BURIED };
#define TOBI_COVERED 16777216.0
#define TOBI_OUTERMOST 1e-4
/* Of the spacing of quadrature points, half that of the particles. */
#define TOBI_THICK 1.8

/* What does work on a body: fluids and solids; what touches it; its motion; its force, torque and control
   program; its air resistance; what acts besides gravity; the finer liquid of a nest. Run states have them
   by their numbers. */
enum { TOBI_BY_PARTICLES, TOBI_BY_CONTACT, TOBI_BY_MOTION, TOBI_BY_FORCE, TOBI_BY_AIR, TOBI_BY_FIELD,
       TOBI_BY_NEST, TOBI_POWERS };

typedef struct tobi_body {
    char name[64];
    tobi_mesh mesh;                  /* rest pose, world coordinates                           */
    tobi_massprops rest;             /* exact integrals of the mesh, unit density; its centre is the
                                        centre of mass that the scene gives, if it does        */
    double middle[3];                /* m, of the volume about that centre, in rest axes       */
    double density;                  /* kg/m3                                                  */
    int vessel;                      /* 1: liquid is filled into it                            */
    int sealed;                      /* 1: no liquid is in its gaps                            */
    int dry_outside;                 /* 1: a vessel with no liquid around it                   */
    int blade;                       /* 1: its edge cuts solids                                */
    double edge_resistance;          /* J/m2 of new surface                                    */
    tobi_edge *edge;                 /* of a blade: about the centre of mass, in rest axes     */
    int64_t edge_count;
    tobi_blade_edge *edge_now;       /* [edge_count], by tobi_blade_update                     */
    double (*edge_share)[3];         /* [piece_count] 1: what each piece of the edge pushed the material with
                                        in the last step, over the most that it can; the mean of all where
                                        there is no material                                   */
    tobi_edge_foot *edge_foot;       /* [piece_count]                                          */
    int64_t piece_count;
    double contact_cosine;           /* of the angle of contact, in the liquid                 */
    int friction;                    /* tobi_friction                                          */
    double spacing;                  /* m, of the body's own particles                         */
    double color[3];                 /* RGB, 0 to 255, or -1; for pictures                     */
    int visible;
    double opacity;                  /* of its surface, for pictures; 0: as tobi_looks has it   */
    tobi_motion_fn motion;           /* NULL = fixed                                           */
    void *motion_user;
    tobi_steer_fn steer;             /* NULL: the motion is not steered                        */
    double shift[3];                 /* m, that a piston which absorbs adds to its motion      */
    int motion_set;                  /* 1: not that of its definition any more                 */
    int motion_due;                  /* 1: so it was before a load, and must be set again      */
    double absent[2];                /* s, from and until when nothing sees it; from 0: never  */
    int is_absent;                   /* 1: its vertices are `away` from where they should be   */
    double away[3];                  /* m, so far that nothing is near                         */
    double lower[3];                 /* the box's lower corner: origin of what follows         */

    double (*vertex)[3];             /* now                                                    */
    double (*next)[3];               /* at the end of the step                                 */
    double (*vertex_velocity)[3];    /* mean over the step                                     */
    double (*vertex_before)[3];      /* of a body with a motion, in the step before; first 0; of a
                                        swimmer its flow                                       */
    tobi_bvh *bvh;                   /* of `vertex`; of a rigid body, as the quadrature points, only
                                        where tobi_body_place or tobi_body_update_surface last put
                                        it: contact uses rest_bvh */

    tobi_quadrature surface;            /* pieces of the triangles                                */
    double (*piece)[3], (*piece_normal)[3], (*piece_velocity)[3];
    double *piece_area;
    int32_t *point_of;               /* [pieces] the quadrature point a piece belongs to       */
    int64_t point_count;             /* quadrature points: neighbouring pieces of one side     */
    double (*point)[3], (*normal)[3], (*point_velocity)[3];
    double (*point_before)[3];       /* velocities by vertex_before, by tobi_body_set_previous_velocities */
    uint8_t *wet;                    /* [points] TOBI_DRY to TOBI_BURIED                       */
    uint32_t *covered;               /* [points] share of a half space of water that particles cover, in
                                        units of 1/TOBI_COVERED                                */
    uint8_t *outermost;              /* [points] 1: the body is rigid, and no part of it lies more than
                                        TOBI_OUTERMOST spacings above the point's tangent plane */
    int convex;                      /* 1: it is rigid, and its mesh convex: where it is nearest to a point
                                        outside, the plane across the way there has no part of it above */
    int thick;                       /* 1: it is rigid, and no part of it is thinner than TOBI_THICK */
    double *area, *weight;           /* |sum of area vectors|, sum of areas                    */

    double (*particle_rest)[3];      /* body particles, rest pose, world coordinates           */
    double (*particle)[3];           /* now, world coordinates                                 */
    int64_t particle_count;

    double centre[3];                /* centre of mass now, world coordinates                  */
    double frame[3][3];              /* rows: where the rest axes point now, at the centre     */
    tobi_rigid rigid;                /* pose and velocities, of bodies of every kind           */
    int deforms;                     /* its motion is not rigid: `rigid` is an approximation   */
    tobi_swimmer *swimmer;           /* of a body that deforms and moves by forces, owned; else NULL */
    double (*rest_vertex)[3];        /* vertices about the centre of mass, in rest axes        */
    tobi_bvh *rest_bvh;              /* of rest_vertex; NULL before tobi_body_build_rest       */
    tobi_body_load load[TOBI_SYSTEM_LIMIT];      /* of this step: each system adds to its own  */
    double start[9];                 /* m/s, rad/s, kg m2/s: velocities and angular momentum, when the step
                                        began                                                  */
    double touch_power;              /* W, of contact, as tobi_body_load.shape                 */
    double power[TOBI_POWERS];       /* W: that each gives it; tobi_body_find_power            */
    tobi_body_info info;             /* its forces: tobi_body_sum_loads                        */
} tobi_body;

/* Reads, places, checks and samples a body at time 0, in the domain box. point_spacing: of the
   quadrature points, m. What was repaired or looks odd is in b->mesh.notes. */
tobi_status tobi_body_create(tobi_body *b, const tobi_body_def *def, const tobi_box *box,
                             double point_spacing, tobi_error *err);
void tobi_body_free(tobi_body *b);
/* Bytes of its mesh, surface and particles. */
int64_t tobi_body_bytes(const tobi_body *b);
/* 1 if any of the bodies is free or controlled. */
int tobi_body_any_free(const tobi_body *bodies, int count);
/* 1 if any of them changes its shape. */
int tobi_body_any_deforms(const tobi_body *bodies, int count);
/* Fills `outermost`, `convex` and `thick` of a body that has just been placed. outermost.c */
void tobi_body_find_outermost(tobi_body *b, double point_spacing);
/* Makes the centre of mass of the definition, if any, that of `rest`; notes one outside of the mesh. */
void tobi_body_take_centre(tobi_body *b, const tobi_body_def *def, int dimension);
/* Builds rest_vertex and rest_bvh, for queries in the body's own axes, if they are not there yet. */
tobi_status tobi_body_build_rest(tobi_body *b, tobi_error *err);
/* Finds the edge of a blade, or takes the one that the definition gives; of other bodies nothing. The body
   must be placed at time 0. TOBI_INVALID in words where there is none. */
tobi_status tobi_body_find_edge(tobi_body *b, const tobi_body_def *def, int dimension, tobi_error *err);
/* Puts the body where its motion has it at time t; a free one where its state has it. */
tobi_status tobi_body_place(tobi_body *b, double t, tobi_error *err);
/* Puts a body with a motion where a checkpoint has it: vertices, and the centre and frame of tobi_body. */
typedef struct tobi_body_at { double centre[3], frame[3][3]; } tobi_body_at;
void tobi_body_restore(tobi_body *b, const double (*vertex)[3], const tobi_body_at *place);
/* From where the motion of a swimmer has n points at the body's present time to where they are in the
   world. */
void tobi_body_pose_shape(const tobi_body *b, int64_t n, double (*at)[3]);
/* Where points of the body, in the pose of its mesh, are at t; those of one that moves by forces where its
   present pose has them. World coordinates. */
tobi_status tobi_body_locate(const tobi_body *b, double t, int64_t n, const double (*rest)[3],
                             double (*out)[3], tobi_error *err);
/* The same of a swimmer, where they were when the last step began, at t. */
tobi_status tobi_body_locate_start(const tobi_body *b, double t, int64_t n, const double (*rest)[3],
                                   double (*out)[3], tobi_error *err);
/* Moves the body's own particles to time t, for output. */
tobi_status tobi_body_place_particles(tobi_body *b, double t, tobi_error *err);
/* Evaluates the motion at t + dt: `next` and the mean velocities of the step, (next - vertex)/dt in
   double: the central difference at its middle. A free body drifts by its velocities and pull instead.
   *speed is raised to the fastest point. */
tobi_status tobi_body_predict(tobi_body *b, double t, double dt, double *speed, tobi_error *err);
/* Between the two calls, for a free body: it drifts by these velocities (m/s, rad/s) and no pull instead,
   because contact has changed them. */
void tobi_body_correct(tobi_body *b, const double velocity[3], const double spin[3], double dt);
/* The vertices at the end of the step, of a free body whose next pose was changed. */
void tobi_body_place_next(tobi_body *b);
/* Gives every point of a free body the velocities of a rigid motion at its present pose (m/s, rad/s). */
void tobi_body_set_velocity(tobi_body *b, const double velocity[3], const double spin[3]);
/* m/s: of a place, m from the lower corner of the box, by velocities u of the body (m/s, rad/s). */
void tobi_body_carry(const tobi_body *b, const double place[3], const double u[6], double out[3]);
/* Its mesh, in the pose of the definition before scale, rotation and translation: the file's or that of its
   one shape. body_shape.c */
/* Which key of a definition gives the shape: "mesh", "box" ... */
const char *tobi_body_shape_key(const tobi_body_def *def);
tobi_status tobi_body_make_mesh(tobi_body *b, const tobi_body_def *def, const tobi_box *box, tobi_error *err);
/* When the body is absent. TOBI_INVALID for bodies that are not prescribed, and times in the wrong order. */
tobi_status tobi_body_plan_absence(tobi_body *b, const tobi_body_def *def, const tobi_box *box,
                                   tobi_error *err);
/* Takes it away, or brings it back, if that is due at t, s. Between two steps. */
void tobi_body_follow_absence(tobi_body *b, double t);
/* Whether it is away, by its vertices. */
void tobi_body_find_absence(tobi_body *b);
/* Where the motion, which b has, puts n points at t, with the shift of a piston that absorbs, m, in world
   coordinates. TOBI_INVALID in words for numbers that are not finite, and for z in 2-D. */
tobi_status tobi_body_ask_motion(const tobi_body *b, double t, int64_t n, const double (*rest)[3],
                                 double (*out)[3], tobi_error *err);
/* Where the material at the rest centre is at t, m, and how it is turned: as tobi_body.frame. */
tobi_status tobi_body_find_frame(const tobi_body *b, double t, double centre[3], double frame[3][3],
                                 tobi_error *err);
/* Quaternion w x y z of the rotation whose columns are the frame's rows. */
void tobi_frame_quaternion(const double frame[3][3], double q[4]);
/* rad/s, the angular velocity that turns one frame into another in dt. */
void tobi_frame_rate(const double from[3][3], const double to[3][3], double dt, double omega[3]);
/* For a substep: puts a body with a motion where it is `way` s after t, as a rigid body; one that deforms is
   moved by `more` s along the mean velocities of the step. `next` stays. */
tobi_status tobi_body_place_within(tobi_body *b, double t, double way, double more, tobi_error *err);
/* Gives the quadrature points of a body with a motion the velocities that tobi_body_predict found for its
   vertices. */
void tobi_body_set_point_velocities(tobi_body *b);
/* Gives them, as point_before, those of the step before. Before tobi_body_set_point_velocities. */
void tobi_body_set_previous_velocities(tobi_body *b);
/* Brings the quadrature points and the tree of a rigid body to its present pose. */
void tobi_body_update_surface(tobi_body *b);
/* Makes `next` the present pose at time t. */
tobi_status tobi_body_advance(tobi_body *b, double t, double dt, tobi_error *err);
/* Before a step: no system presses; keeps the velocities as `start`. */
void tobi_body_clear_loads(tobi_body *b);
/* m/s2: of a quadrature point of a body with a motion along its normal, over the last step; of a swimmer by
   its flow alone. */
double tobi_body_point_acceleration(const tobi_body *b, int64_t point, double dt);
/* m/s: of a quadrature point, and of a place on a triangle of the mesh (m from the lower corner of the box),
   what a change of shape adds in this step to the rigid motion by `start`; of a body that deforms. */
void tobi_body_point_flow(const tobi_body *b, int64_t point, double flow[3]);
void tobi_body_place_flow(const tobi_body *b, int32_t triangle, const double barycentric[3],
                          const double place[3], double flow[3]);
/* After a step: its mean velocities in it, m/s, rad/s. An impulse J gives a free body the work J of them. */
void tobi_body_mean_velocity(const tobi_body *b, double u[6]);
/* After that: W, mean over the step of dt, s. */
void tobi_body_find_power(tobi_body *b, double dt);
/* After a step: the sums of the loads as the forces of `info`. */
void tobi_body_sum_loads(tobi_body *b);
/* Copies pose and velocities of a free body from `rigid` into `info`. */
void tobi_body_report(tobi_body *b);
