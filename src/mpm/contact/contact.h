/* Contact of the particles of solids with bodies, each particle against the mesh. docs/theory/contact.md.

   A particle fills half a spacing around it; nearer than that to a surface it may not come within a step. The
   velocity of the material at the particle, relative to the surface there (the body's turning and deforming
   included), loses what would bring it nearer, with restitution, and as much of its sliding as Coulomb
   friction takes, at most all. The body gets the opposite impulses.

   The velocities are not the particles' own but those of the grid they move with: one who holds particles
   back while the grid goes on lets the material flow through its own stress, and it creeps. So the solver
   alternates: the method gives velocities at the contacts, a sweep answers with impulses, the method puts
   them on its grid. Impulses add up over the sweeps, and only their sums must push and obey friction. */
#pragma once
#include "mpm/cut/blade.h"
#include "core/particles.h"
#include "exec/exec.h"

/* One particle at one body, or a piece of a blade's edge in the material: that is held by an impulse within
   the plane of the cut, of at most limit times the share of it that points ahead (docs/theory/cutting.md). */
typedef struct tobi_contact {
    int32_t particle;                /* < 0: piece -1 - particle of an edge                      */
    int32_t sliding;                 /* 1: friction was not enough in the last sweep             */
    double  normal[3];               /* outward from the body; of an edge that of the cut        */
    double  ahead[3], limit;         /* of an edge: direction of cutting, and N s                */
    double  arm[3];                  /* m, from the body's centre to the place of contact        */
    double  depth;                   /* m, of the particle below that place, against the normal  */
    double  deforming[3];            /* m/s, what the surface moves besides the rigid motion     */
    double  gap;                     /* m, between the particle's edge and the surface           */
    double  bounce;                  /* m/s, by which it shall leave                             */
    double  mobility[2];             /* 1/kg, velocity by impulses of this size at all contacts:
                                        along the normal, along the surface                      */
    double  velocity[3];             /* m/s, of the material: along the normal that of the particle, along
                                        the surface that of the place; the method's to bring up to date */
    double  impulse[3];              /* N s, on the particle so far                              */
    double  change[3];               /* N s, by the last sweep                                   */
} tobi_contact;

/* Numbers that are summed over contacts at once: a matrix of 6 x 6 and a vector. */
enum { TOBI_CONTACT_SUMS = 42 };

/* A way by which an overlap of one particle is lessened. */
typedef struct tobi_shift { int32_t particle; double by[3]; } tobi_shift;

typedef struct tobi_contacts {
    tobi_contact *list;              /* of the present body                                      */
    int64_t count, room;
    tobi_shift *shift;               /* of this step, at all bodies so far                       */
    int64_t shift_count, shift_room;
    struct tobi_contact_run *run;
    int64_t *first;                  /* [chunk_room] of each chunk at a side: its place in the list */
    struct tobi_contact_candidates *candidates; /* of each body: particles that may touch it     */
    int candidates_next, candidates_room;
    double (*chunk_box)[6];          /* m, of every TOBI_BLOCK particles: lower and upper corner */
    double drift;                    /* m, how far they may be out of it                         */
    int marked;                      /* 1: particles remember other cuts than in the last step: the
                                        caller's to set                                          */
    double *partial;                 /* sums of parts of the list                                */
    int64_t chunk_room;
    double velocity[3], spin[3];     /* m/s, rad/s: of the present body, after the impulses      */
    double inverse[6][6];            /* its M^-1, joints included: the caller's to set           */
} tobi_contacts;

/* What contacts have taken from the energy, J, and the work of the bodies on the material: with the
   velocities at the end of the step. */
typedef struct tobi_contact_work { double fracture, friction, bodies; } tobi_contact_work;

typedef struct tobi_contact_step {
    double dt, before;               /* s, of this step and the one before, 0 in the first         */
    double whole;                    /* s, of the world's step, which may be several of these      */
    int system;                      /* whose load on the body this is                             */
    int body;                        /* its number                                                 */
    double radius;                   /* m, half a particle spacing                               */
    double reach;                    /* m, how deep inside a body a particle is still found      */
    double margin;                   /* m, how far from touching a particle is looked at         */
    double rest_speed;               /* m/s, slower approaches do not bounce                     */
    int dimension;
    const struct tobi_solid *solids;   /* of the particles; read where some are held              */
} tobi_contact_step;

/* Before a step. drift: m, how far particles have moved at most along an axis since they were last sorted; 0
   makes the boxes around their chunks anew, for finding. */
tobi_status tobi_contact_begin(tobi_contacts *c, const tobi_particles *p, double drift, tobi_exec *x,
                               tobi_error *err);
/* Lists the particles near a body at its present pose. The particle's impulse of the last step starts it: its
   normal part is kept in velocity.w, -N, by whoever moves the particles. */
tobi_status tobi_contact_find(tobi_contacts *c, const tobi_particles *p, tobi_body *b,
                              const tobi_contact_step *step, tobi_exec *x, tobi_error *err);
/* Room for so many in the list, and for their shifts; what is listed stays. */
tobi_status tobi_contact_reserve(tobi_contacts *c, int64_t count, tobi_error *err);
/* Adds a piece of a blade's edge to the list; full: the share of it that lies in material. */
tobi_status tobi_contact_add_edge(tobi_contacts *c, tobi_body *b, const tobi_blade_piece *piece, double full,
                                  const tobi_contact_step *step, tobi_error *err);
/* Whether and how fast contacts shall bounce, from the velocities as they are. */
void tobi_contact_aim(tobi_contacts *c, const tobi_body *b, const tobi_contact_step *step, tobi_exec *x);
/* Impulses that turn the listed velocities into allowed ones, given the mobilities: into change, and added to
   impulse and to the body's predicted velocities. first: 1 takes the starting impulses as the change. Returns
   the largest change over the largest impulse. */
double tobi_contact_sweep(tobi_contacts *c, tobi_body *b, const tobi_contact_step *step, int first,
                          tobi_exec *x);
/* After the sweeps: the impulses act on the body (rigid.impulse, rigid.twist, and its load: normal parts as
   pressure, tangential as friction) and are remembered by the particles, as velocity.w > 0. Particles that
   still overlap are shifted a little, which enters no momentum; *far is raised to the largest shift, m.
   work is added to. Returns how many contacts push. */
int64_t tobi_contact_finish(tobi_contacts *c, tobi_particles *p, tobi_body *b, const tobi_contact_step *step,
                            double *far, tobi_contact_work *work, tobi_exec *x);
/* Shifts the particles that overlapped. To be called when the grid has moved them: shifted before, they would
   take other velocities from it than they gave, and momentum would be lost. */
void tobi_contact_shift(tobi_contacts *c, tobi_particles *p);
void tobi_contact_free(tobi_contacts *c);
/* The 6x6 system a x = b, with x left in b. */
void tobi_contact_eliminate(double a[6][6], double b[6]);
