/* A PNG picture of a moment, drawn in software: particles as the surfaces of water or of solids, bodies,
   the domain's box. It is drawn from arrays alone: tobi_world_read and tobi_world_surface give those of a
   world.

   3-D: a smooth mesh around the particles (surface nets of their kernel sum, Gibson 1998; smoothing:
   Taubin 1995), lone particles as balls. Water bends, dims and mirrors light (decisions/0055). 2-D: front
   view of discs coloured by value. The same input gives the same picture for any number of threads and on
   every x86-64 processor. Needs about 60 bytes per pixel and 200 per particle while it runs. */
#ifndef TOBIUO_PICTURE_H
#define TOBIUO_PICTURE_H
#include "tobiuo/base.h"
#include "tobiuo/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An image for skins. TOBI_INVALID for what is no PNG or larger than 8192 x 8192 pixels. */
typedef struct tobi_image tobi_image;
TOBI_API tobi_status tobi_image_read(const char *path, tobi_image **image, tobi_error *err);
/* rgb: sRGB, row by row from the top, copied. */
TOBI_API tobi_status tobi_image_make(int width, int height, const uint8_t *rgb, tobi_image **image,
                                     tobi_error *err);
/* One more user, who frees it, too. */
TOBI_API tobi_image *tobi_image_share(tobi_image *image);
TOBI_API void tobi_image_free(tobi_image *image);             /* NULL is fine */
/* sRGB, 0 to 1, at texture coordinates: v rises from the lower edge. */
TOBI_API void tobi_image_color(const tobi_image *image, const float uv[2], float rgb[3]);
TOBI_API void tobi_image_size(const tobi_image *image, int *width, int *height, const uint8_t **rgb);

/* An image on the skin of a solid, found by where its particles were at rest. Calls come from any thread. */
typedef struct tobi_picture_skin {
    const tobi_image *image;           /* NULL: no image                                                */
    /* Coordinates of the place of the skin nearest to x, m; returns its distance, m. */
    double (*look)(const void *user, const double x[3], float uv[2]);
    /* Those of three corners, all in the plane of what of the skin is nearest to their middle. */
    void (*look_flat)(const void *user, const double corner[3][3], float uv[3][2]);
    const void *user;
    double stretch;                    /* 1/m, of coordinates along the skin, at most mostly            */
    double depth;                      /* m; deeper below the skin things have the colour `inside`      */
    float inside[3];                   /* sRGB, 0 to 1                                                  */
} tobi_picture_skin;

typedef struct tobi_picture_mesh {
    int64_t vertex_count;
    const double (*vertices)[3];       /* m                            */
    int64_t triangle_count;
    const int32_t (*triangles)[3];
    float color[3];                    /* sRGB, 0 to 1                 */
    float transparency;                /* 0 to 1; above 0 like glass   */
    int hollow;                        /* not 0: a clip plane opens it, else its cut is filled */
    const tobi_image *image;           /* instead of the colour; NULL = none                   */
    const float (*uv)[3][2];           /* with an image: of the corners of each triangle       */
} tobi_picture_mesh;

/* A line through points, seen through water, hidden by what is opaque. */
typedef struct tobi_picture_path {
    int64_t count;
    const double (*points)[3];         /* m                            */
    float color[3];                    /* sRGB, 0 to 1                 */
} tobi_picture_path;

/* How particles look: water and solids; surfaces in the colours of values, opaque; balls in those colours. */
enum { TOBI_LOOK_NATURAL, TOBI_LOOK_SURFACE, TOBI_LOOK_PARTICLES };
/* Which particles show the field of a view; the others have their own colours. */
enum { TOBI_FIELD_OF_ALL, TOBI_FIELD_OF_LIQUIDS, TOBI_FIELD_OF_SOLIDS };

/* Everything borrowed for the call. Obtain from tobi_default_picture and change members. */
typedef struct tobi_picture {
    int width, height;                 /* pixels, 16 to 8192                                            */
    int samples;                       /* per pixel and axis, 1 to 4                                    */
    int dimension;                     /* 2 or 3                                                        */

    double box_min[3], box_max[3];     /* m, the domain: drawn as lines and, without a camera, fitted   */
    const double (*zones)[2][3];       /* m, lower and upper corners of boxes that are drawn as lines   */
    int zone_count;
    const double (*edges)[2][3];       /* m, ends of lines that are drawn like those                    */
    int64_t edge_count;
    double up[3];                      /* direction against gravity; zero = z in 3-D (unused in 2-D)    */
    int    has_camera;                 /* 0: the view fits the box                                      */
    double eye[3], target[3];          /* m, 3-D only                                                   */
    double field_of_view;              /* degrees, vertical                                             */

    int64_t particle_count;
    const double (*positions)[3];      /* m; not finite = not drawn                                     */
    const float *values;               /* colour of each particle, e.g. speed; NULL = that of water     */
    const float (*own)[3];             /* sRGB, colours instead of those of values; red below 0: no colour;
                                          of a group all have one or none; NULL = none; with values only */
    const uint8_t *opaque;             /* not 0: the particle belongs to a solid; NULL = all are water  */
    const int32_t *group;              /* one surface around each group; NULL = all are one            */
    const tobi_picture_skin *skins;    /* with rest, in the look NATURAL: instead of colours            */
    int skin_count;
    const int16_t *skin;               /* of each particle, -1 = none; of a group all have one          */
    const double (*rest)[3];           /* m, where particles with a skin were at rest                   */
    const float (*palette)[3];         /* sRGB, the colour map from value_min to value_max; NULL = blue */
    int palette_count;                 /* at least 1 with a palette                                     */
    double radius;                     /* m, half the particle spacing                                  */
    const double *radii;               /* m, of each particle, at most radius; of a group all have one;
                                          NULL = all have radius                                        */
    double value_min, value_max;       /* of the colour map; equal = found from the values, from zero   */
    int look;                          /* TOBI_LOOK_*; in 2-D NATURAL is SURFACE                        */
    int clip;                          /* not 0: what is beyond a plane is not drawn                    */
    double clip_point[3], clip_normal[3];        /* m; from what is drawn to what is not                */
    double slice;                      /* m, > 0: what is within half of it from the plane is drawn     */
    const double (*velocities)[3];     /* m/s, drawn as arrows; NULL = none                             */
    int isolines;                      /* lines of equal value on surfaces, 0 to 100                     */
    int streamlines;                   /* so many side by side along the longest edge, 0 to 200          */
    const double (*flow)[3];           /* m/s, that streamlines of what is not opaque follow             */
    const tobi_picture_path *paths;
    int path_count;
    int axes;                          /* not 0: ticks along edges of the box                           */
    int transparent;                   /* not 0: the PNG's background is transparent                    */
    double clarity;                    /* m of water after which 1/e of the light is left; 0 = automatic */

    const tobi_picture_mesh *meshes;
    int mesh_count;

    const double (*nests)[2][3];       /* m, lower and upper corners of boxes; infinite: without a side */
    int nest_count;
    const uint8_t *nest;               /* of each particle k: only that in nests[k - 1] is shown, 0: only that
                                          outside of all; of a group all have one; NULL: all are shown  */

    int64_t foam_count;                /* spray, foam and bubbles: white points                         */
    const double (*foam)[3];           /* m; not finite = not drawn                                     */
    const uint8_t *foam_kind;          /* TOBI_SPRAY, TOBI_FOAM, TOBI_BUBBLE of tobiuo/foam.h           */

    float background_top[3], background_bottom[3];   /* sRGB */
    const char *title;                 /* UTF-8, upper left, "t = 0.25 s"; NULL = none                  */
    const char *label;                 /* UTF-8, of the colour bar, "speed [m/s]"; NULL = no bar        */

    int threads;                       /* 0 = all cores; any number gives the same picture              */
    double *stage_seconds;             /* NULL, or gets TOBI_PICTURE_STAGES times of the process, s     */
} tobi_picture;

/* Stages of a picture, for measurements. */
enum { TOBI_PICTURE_STAGES = 6 };
TOBI_API const char *tobi_picture_stage_name(int stage);      /* NULL beyond the last */

TOBI_API tobi_picture tobi_default_picture(void);
/* Size, camera, look and plane of a view; its colours, arrows and body to follow need values and are left.
   The picture has its dimension and box: a size of 0 is fitted to them. */
TOBI_API void tobi_picture_set_view(tobi_picture *picture, const tobi_view_def *view);

/* A palette that is even to the eye, by name, and its number of colours; NULL for an unknown name. */
TOBI_API const float (*tobi_color_map(const char *name, int *count))[3];
TOBI_API const char *tobi_color_map_name(int number);      /* NULL beyond the last */

/* TOBI_INVALID for sizes, ranges or indices out of bounds and for NULL where something must stand,
   TOBI_NO_MEMORY, TOBI_IO. The file appears whole or not at all. */
TOBI_API tobi_status tobi_picture_write(const char *path, const tobi_picture *picture, tobi_error *err);
/* The same picture into rgb, width x height x 3 bytes, sRGB, row by row from the top. */
TOBI_API tobi_status tobi_picture_draw(const tobi_picture *picture, uint8_t *rgb, tobi_error *err);

#ifdef __cplusplus
}
#endif
#endif
