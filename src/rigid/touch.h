/* Contacts between rigid bodies, and between bodies and the sides of the domain: where, along which
   normal, how far apart. One contact is one point; surfaces of any shape, convex or not, touch where a
   corner meets a face or two edges cross, and a ball where its surface is nearest (decision 0014). */
#pragma once
#include "core/body.h"
#include "core/plane.h"
#include "geom/facets.h"

typedef struct tobi_touch {
    int32_t a, b;                /* bodies, a < b; a side of the domain or a plane is b = -1 - number   */
    int64_t key;                 /* which features meet: the same from step to step                     */
    double point[3];             /* m, from the domain's lower corner                                   */
    double normal[3];            /* unit, pushes a away from b                                          */
    double gap;                  /* m, negative where the surfaces overlap                              */
    double slop;                 /* m, an overlap that is left alone                                    */
    double flow[3];              /* m/s, of a against b: what changes of their shapes add there         */
    double friction;             /* 1, of a side or plane with the body                                 */
    double impulse;              /* N s along the normal, in this step                                  */
    double slide[3];             /* N s, of friction                                                    */
} tobi_touch;

typedef struct tobi_touch_list {
    tobi_touch *at;
    int64_t count, capacity;
    int failed;                  /* memory ran out */
} tobi_touch_list;

/* What contact knows of a body besides its pose. The facets of a body that deforms are those of its
   present vertices, and of the tree that follows them (decision 0104). */
typedef struct tobi_shape {
    tobi_facets facets;
    double thickness;            /* m, 2 volume/area: a plate's thickness, a third of a cube's side     */
    int solid;                   /* 0: no body touches it                                               */
    int deforms;
    int is_fresh;                /* 0: corners and edges of the facets are those of an earlier shape    */
    double flow_speed;           /* m/s, of the fastest vertex: what its change of shape adds           */
    double flow_turn;            /* rad/s, at most: how fast that turns an edge of the mesh             */
} tobi_shape;

/* Of a body at rest, or of one that deforms as it is at the start; its facets are the caller's, with an error
   too. */
tobi_status tobi_shape_make(tobi_shape *s, tobi_body *b, int dimension, tobi_error *err);
/* Of a body that deforms and has moved: where it is and how fast it changes. Of others nothing. */
void tobi_shape_follow(tobi_shape *s, const tobi_body *b);
/* Then, for who looks at its corners and edges. */
void tobi_shape_refresh(tobi_shape *s);
/* The pose whose axes the facets are in: that of the body, or the domain's. */
const tobi_rigid *tobi_shape_axes(const tobi_shape *s, const tobi_body *b);
/* Adds `sign` times what the change of shape moves the surface with, nearest to x; m/s, x in the domain. */
void tobi_shape_add_flow(const tobi_shape *s, const tobi_body *b, const double x[3], int sign,
                         double flow[3]);

#define TOBI_TOUCH_DEEPEST 0.3   /* of the lesser thickness: overlaps beyond this are seen as none     */

/* Sides: 0 lower x, 1 upper x, 2 lower y, ...; then the planes of the scene. */
enum { TOBI_SIDES = 6 };

/* What may happen until the next look. */
typedef struct tobi_touch_look {
    double margin;               /* m, how near surfaces must be                                        */
    double turn;                 /* rad, how far the bodies turn against each other                     */
} tobi_touch_look;

/* Adds the contacts of two bodies, a < b by number. */
void tobi_touch_bodies(const tobi_body *a, const tobi_shape *sa, const tobi_body *b, const tobi_shape *sb,
                       tobi_touch_look look, tobi_touch_list *out);
/* Adds those of a body with a side of the domain or a plane, by its number. */
void tobi_touch_plane(const tobi_body *a, const tobi_shape *sa, const tobi_fixed_plane *plane, int number,
                      double margin, tobi_touch_list *out);

/* Memory for so many in all; NULL and out->failed when it is short. */
tobi_touch *tobi_touch_reserve(tobi_touch_list *out, int64_t room);
/* Room for one more; NULL and out->failed when memory is short. */
tobi_touch *tobi_touch_add(tobi_touch_list *out);
/* Keeps the deepest and the farthest apart of the contacts from first on. */
void tobi_touch_thin(tobi_touch_list *out, int64_t first);
