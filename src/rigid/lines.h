/* Springs, ropes and mooring lines: forces between places of bodies, or of a body and of the domain. They
   have no state: the poses of the bodies are all that they depend on. */
#pragma once
#include "core/body.h"

/* On one end: N, and N m about the centre of its body. */
typedef struct tobi_line_load { double force[3], torque[3]; } tobi_line_load;

typedef struct tobi_line {
    char name[104];
    int kind;                        /* tobi_line_kind                                              */
    int body, to_body;               /* numbers; to_body -1: the domain                             */
    double point[3], to[3];          /* m, in rest axes about the body's centre; of the domain from its
                                        lower corner                                                */
    double length;                   /* m, without force                                            */
    double stiffness, damping;       /* N/m, N s/m                                                  */
    double weight;                   /* N/m, of a catenary                                          */
    int rests;                       /* 1: a catenary lies on a floor at its lower end               */
    double up[3];                    /* against gravity at the start                                 */
    tobi_line_load now[2], before[2];      /* on the body, on the other end: without damping, now and
                                              a step before                                         */
    tobi_line_load damped[2];        /* of damping                                                   */
    tobi_line_info info;             /* of the last step                                             */
} tobi_line;

/* Loads at the present poses and velocities; those of the last call become `before`. */
void tobi_line_update(tobi_line *line, const tobi_body *bodies);
/* Adds what the lines do to one body: now, which the next drift takes, in the mean over a step, which a
   kick takes (velocity Verlet: the energy of a spring neither grows nor fades), or by damping alone. */
typedef enum tobi_line_when { TOBI_LINES_NOW, TOBI_LINES_MEAN, TOBI_LINES_DAMPING } tobi_line_when;
void tobi_lines_add(const tobi_line *lines, int count, int body, tobi_line_when when,
                    tobi_line_load *load);
/* s: a third of a radian of the fastest oscillation that the lines make with the bodies; INFINITY: none. */
double tobi_lines_step_limit(const tobi_line *lines, int count, const tobi_body *bodies);

/* J, after its last update: of the stretch, and of the weight of a catenary, in liquid: against its lower end
   where it rests there, else against the origin. */
double tobi_line_energy(const tobi_line *line);
/* W, mean over the last step: that its damping takes. */
double tobi_line_power(const tobi_line *line, const tobi_body *bodies);

/* Points along a line after its last update, evenly along its length, from the upper end of a catenary, or
   from the body: m, in the world's coordinates. */
void tobi_line_shape(const tobi_line *line, int count, double (*points)[3]);

/* A catenary with elastic stretch between two ends, `span` apart horizontally and `height` >= 0 vertically,
   m (Jonkman 2007, Dynamics modeling and loads analysis of an offshore floating wind turbine,
   NREL/TP-500-41958, eqs. 2-34 to 2-37, without friction on the floor). pull: N, horizontal, and vertical
   at the upper end. */
void tobi_catenary(const tobi_line *line, double span, double height, double pull[2]);
