/* The picture of a moment of a run: from particles and surfaces, and from what of a world does not change, to
   a tobi_picture. Runs, `tobiuo picture` and the window draw by it, so that they show the same. */
#ifndef TOBIUO_DRAWING_H
#define TOBIUO_DRAWING_H
#include "tobiuo/picture.h"
#include "tobiuo/results.h"
#include "tobiuo/tobiuo.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A fluid or solid, by its number among those of all systems. */
typedef struct tobi_material_look {
    double color[3], core_color[3];    /* RGB, 0 to 255; -1 = none given                              */
    int    visible, liquid;
    int    kind;                       /* the first material with the same properties and colours     */
    double spacing;                    /* m, of its particles; 0 = that of the looks                  */
    tobi_picture_skin skin;            /* of a solid with a texture; image NULL = none                */
    tobi_image *image;                 /* owned, and what the skin looks in                           */
    void  *skin_user;
    void (*free_skin)(void *user);
} tobi_material_look;

/* A body, or a line that holds one. */
typedef struct tobi_body_look {
    char   name[96];                   /* of its surface in results                                   */
    char   body[64];                   /* its own name                                                */
    double color[3], opacity;          /* RGB, 0 to 255; -1 = by its number                           */
    double rest[3];                    /* m, mean of its vertices at rest                             */
    double middle[3];                  /* m, of the box around it when these looks were taken         */
    int64_t anchor[3];                 /* vertices of its surface far apart; those of a body that carries */
    double anchor_start[3][3];         /* m, where they start                                         */
    int    visible, hollow, is_line;
    tobi_image *image;                 /* owned; NULL = none                                          */
    float  (*uv)[3][2];                /* owned: of the corners of the triangles of its surface       */
    int64_t triangle_count;
} tobi_body_look;

/* Where an inlet holds the particles that it will let go, and from when to when they move, s. */
typedef struct tobi_inlet_look {
    double centre[3];                  /* m                                                           */
    double normal[3], along[3], across[3];     /* unit vectors; the flow goes along normal            */
    double half[2], radius;            /* m: half sides, or the radius of a disc, else 0              */
    double depth;                      /* m, behind the centre                                        */
    double (*flows)[2];                /* owned; from the first on, up to the second                  */
    int    flow_count;
} tobi_inlet_look;

/* An edge of a porous zone that a body carries. */
typedef struct tobi_zone_edge {
    double end[2][3];                  /* m, at the start                                             */
    int    body;                       /* of the looks                                                */
} tobi_zone_edge;

/* What of a world pictures need and does not change. Lists owned: tobi_looks_free. */
typedef struct tobi_looks {
    int    dimension, threads;
    int    is_nest;                    /* 1: these are of a nest; the caller sets it                  */
    double box_min[3], box_max[3], gravity[3], spacing;      /* m, m/s2; the spacing is the largest */
    double rim;                        /* m, of a nest whose liquids had these spacings               */
    double speed;                      /* m/s, where its colours end; 0 = each picture's own range    */
    int    material_count, body_count, inlet_count;
    tobi_material_look *materials;
    tobi_body_look *bodies;            /* and lines behind them */
    tobi_inlet_look *inlets;
    double (*zones)[2][3];             /* m, corners of porous zones that are boxes, within the domain */
    int    zone_count;
    double (*edges)[2][3];             /* m, ends of the edges of those by an outline, likewise       */
    int64_t edge_count;
    tobi_zone_edge *carried;           /* edges of those that bodies carry                             */
    int64_t carried_count;
} tobi_looks;

/* world: need not have begun. */
TOBI_API tobi_status tobi_world_looks(const tobi_world *world, tobi_looks *looks, tobi_error *err);
TOBI_API void tobi_looks_free(tobi_looks *looks);
/* Red, green, blue (sRGB) and opacity, 0 to 1, of a part of a material (0 skin, 1 core, 2 face of a cut). */
TOBI_API void tobi_looks_color(const tobi_looks *looks, int material, int part, float color[4]);

/* 1: materials differ in their spacings. Half the spacing of a material, m, of any number. */
TOBI_API int tobi_looks_differ(const tobi_looks *looks);
TOBI_API double tobi_looks_radius(const tobi_looks *looks, int material);

/* 1: a particle at x, m, waits in an inlet that does not flow at this time. Pictures and surfaces leave it
   out; results have it. */
TOBI_API int tobi_looks_hides(const tobi_looks *looks, double time, const double x[3]);

/* The number that a field's colour shows, of particle i: of a vector its length, of the vorticity in 2-D that
   about z, as files have it in floats. field: NULL gives 0. */
TOBI_API double tobi_drawing_value(const tobi_looks *looks, const tobi_moment_field *field, int64_t i);

/* Where the box of a nest is at a moment of the scene, or of the nest itself, whose looks these are. 0: it
   goes along with a body that the moment has no surface of. */
TOBI_API int tobi_nest_box(const tobi_looks *looks, const tobi_nest_def *nest, const tobi_moment *moment,
                           double box[2][3]);
/* Adds the particles of a nest at the same time, with the moment's fields, NAN where it has none of that
   name: those in the box and, for surfaces, near it. box: as in the moment. On failure nothing is added. */
TOBI_API tobi_status tobi_moment_add_nest(tobi_moment *moment, const tobi_moment *nest,
                                          const double box[2][3], double spacing, tobi_error *err);
/* 1: particle i is where its liquid counts: outside of all nests, or in the box of its own. */
TOBI_API int tobi_moment_shows(const tobi_moment *moment, int64_t i);

typedef struct tobi_drawing tobi_drawing;
/* The picture of a moment as a view shows it. It borrows looks and moment until it is freed. Fields that
   colours need: velocity, material, part, piece, particle_id, and that of the view; without them things have
   the plain colour. TOBI_NOT_FOUND: the moment has no field that the view names. */
TOBI_API tobi_status tobi_drawing_make(const tobi_looks *looks, const tobi_moment *moment,
                                       const tobi_view_def *view, tobi_drawing **drawing, tobi_error *err);
/* Valid until the drawing is freed; its members may be changed. */
TOBI_API tobi_picture *tobi_drawing_picture(tobi_drawing *drawing);
/* The name of the body that the camera is inside of, so that it hides all else; NULL: of none. */
TOBI_API const char *tobi_drawing_body_around(const tobi_drawing *drawing);
TOBI_API void tobi_drawing_free(tobi_drawing *drawing);      /* NULL is fine */

#ifdef __cplusplus
}
#endif
#endif
