/* The order of drawing: bodies, shadows, particles, letters, each over one canvas in memory. Drawback:
   everything is drawn on the processor. */
#define _GNU_SOURCE 1
#include "view/draw.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

tobi_picture tobi_default_picture(void)
{
    return (tobi_picture){
        .width = 1280, .height = 720, .samples = 2, .dimension = 3, .field_of_view = 30,
        .background_top = { 0.60f, 0.68f, 0.75f }, .background_bottom = { 0.90f, 0.92f, 0.93f }
    };
}

static tobi_status check_mesh(const char *path, const tobi_picture_mesh *m, int number, tobi_error *err)
{
    if ((m->vertex_count > 0 && !m->vertices) || (m->triangle_count > 0 && !m->triangles))
        return tobi_fail(err, TOBI_INVALID, "%s: body %d has no vertices or no triangles", path, number);
    for (int64_t t = 0; t < m->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (m->triangles[t][k] < 0 || m->triangles[t][k] >= m->vertex_count)
                return tobi_fail(err, TOBI_INVALID,
                                 "%s: triangle %" PRId64 " of body %d uses vertex %d of %" PRId64,
                                 path, t, number, (int)m->triangles[t][k], m->vertex_count);
    return TOBI_OK;
}

static tobi_status check_frame(const char *path, const tobi_picture *f, tobi_error *err)
{
    if (f->width < 16 || f->height < 16 || f->width > 8192 || f->height > 8192)
        return tobi_fail(err, TOBI_INVALID, "%s: a picture of %d x %d pixels, allowed are 16 to 8192", path,
                         f->width, f->height);
    if (f->samples < 1 || f->samples > 4)
        return tobi_fail(err, TOBI_INVALID, "%s: %d samples per pixel and axis, allowed are 1 to 4", path,
                         f->samples);
    if (f->dimension != 2 && f->dimension != 3)
        return tobi_fail(err, TOBI_INVALID, "%s: dimension %d, allowed are 2 and 3", path, f->dimension);
    for (int k = 0; k < f->dimension; k++)
        if (!isfinite(f->box_min[k]) || !isfinite(f->box_max[k]) || !(f->box_min[k] < f->box_max[k]))
            return tobi_fail(err, TOBI_INVALID, "%s: the box is empty along %c", path, "xyz"[k]);
    if (f->particle_count < 0 || f->particle_count > INT32_MAX || (f->particle_count > 0 && !f->positions))
        return tobi_fail(err, TOBI_INVALID, "%s: %" PRId64 " particles cannot be drawn", path,
                         f->particle_count);
    if (f->particle_count > 0 && !(f->radius > 0 && isfinite(f->radius)))
        return tobi_fail(err, TOBI_INVALID, "%s: a particle radius of %g m, must be greater than 0", path,
                         f->radius);
    if (f->dimension == 3 && !(f->field_of_view >= 1 && f->field_of_view <= 150))
        return tobi_fail(err, TOBI_INVALID, "%s: a field of view of %g degrees, allowed are 1 to 150", path,
                         f->field_of_view);
    if (f->palette && f->palette_count < 1)
        return tobi_fail(err, TOBI_INVALID, "%s: a palette of %d colours, at least 1", path,
                         f->palette_count);
    if (f->mesh_count < 0 || (f->mesh_count > 0 && !f->meshes))
        return tobi_fail(err, TOBI_INVALID, "%s: %d bodies cannot be drawn", path, f->mesh_count);
    for (int i = 0; i < f->mesh_count; i++) TOBI_TRY(check_mesh(path, &f->meshes[i], i, err));
    return TOBI_OK;
}

static double dot(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }

static void cross(const double a[3], const double b[3], double out[3])
{
    double c[3] = { a[1]*b[2] - a[2]*b[1], a[2]*b[0] - a[0]*b[2], a[0]*b[1] - a[1]*b[0] };
    memcpy(out, c, sizeof c);
}

static bool normalize(double a[3])
{
    double n = sqrt(dot(a, a));
    if (!(n > 0) || !isfinite(n)) return false;
    for (int k = 0; k < 3; k++) a[k] /= n;
    return true;
}

/* forward is given; right and up follow from the wanted up. */
static void orient(camera *c, const double up[3])
{
    cross(c->forward, up, c->right);
    if (!normalize(c->right)) {
        double other[3] = { fabs(c->forward[0]) < 0.5, fabs(c->forward[0]) >= 0.5, 0 };
        cross(c->forward, other, c->right);
        normalize(c->right);
    }
    cross(c->right, c->forward, c->up);
}

/* From the box's middle towards a viewer who stands in front, a little to the right and above. */
static void choose_direction(const double up[3], double out[3])
{
    const double turn = 0.48, lift = 0.34;      /* radians */
    double right[3] = { 1, 0, 0 }, front[3];
    if (fabs(up[0]) > 0.9) right[0] = 0, right[1] = 1;
    double along = dot(right, up);
    for (int k = 0; k < 3; k++) right[k] -= along*up[k];
    normalize(right);
    cross(right, up, front);
    for (int k = 0; k < 3; k++)
        out[k] = cos(lift)*(cos(turn)*front[k] + sin(turn)*right[k]) + sin(lift)*up[k];
}

static void box_corner(const tobi_picture *f, int i, double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = i >> k & 1 ? f->box_max[k] : f->box_min[k];
}

/* Moves the eye until the eight corners fill the picture with a margin: the distance from the tightest
   corner, the sideways place from the extent of the projections, a few times in turn. */
static void fit_box(camera *c, const tobi_picture *f, double half_width, double half_height)
{
    const double margin = 0.90;
    double target[3], distance = 0;
    for (int k = 0; k < 3; k++) target[k] = 0.5*(f->box_min[k] + f->box_max[k]);
    for (int round = 0; round < 8; round++) {
        distance = 0;
        for (int i = 0; i < 8; i++) {
            double p[3], x, y, z;
            box_corner(f, i, p);
            for (int k = 0; k < 3; k++) p[k] -= target[k];
            x = fabs(dot(p, c->right)), y = fabs(dot(p, c->up)), z = dot(p, c->forward);
            double need = fmax(x*c->focal/(margin*half_width), y*c->focal/(margin*half_height)) - z;
            if (need > distance) distance = need;
        }
        double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
        for (int i = 0; i < 8; i++) {
            double p[3];
            box_corner(f, i, p);
            for (int k = 0; k < 3; k++) p[k] -= target[k];
            double z = distance + dot(p, c->forward), at[2] = { dot(p, c->right)/z, dot(p, c->up)/z };
            for (int k = 0; k < 2; k++) low[k] = fmin(low[k], at[k]), high[k] = fmax(high[k], at[k]);
        }
        for (int k = 0; k < 3; k++)
            target[k] += 0.5*distance*((low[0] + high[0])*c->right[k] + (low[1] + high[1])*c->up[k]);
    }
    for (int k = 0; k < 3; k++) c->eye[k] = target[k] - distance*c->forward[k];
}

static tobi_status aim_camera(canvas *v, const char *path, const tobi_picture *f, tobi_error *err)
{
    camera *c = &v->camera;
    double up[3] = { f->up[0], f->up[1], f->up[2] }, half_width = 0.5*v->width, half_height = 0.5*v->height;
    if (!normalize(up)) up[0] = up[1] = 0, up[2] = 1;
    double bar = f->label ? 0.08 : 0, top = f->title ? 0.05 : 0;      /* of the picture, for text */
    *c = (camera){ .center_x = (float)(half_width*(1 - bar)), .center_y = (float)(half_height*(1 + top)) };
    c->focal = (float)(half_height/tan(f->field_of_view*(M_PI/360)));
    if (f->has_camera) {
        for (int k = 0; k < 3; k++) {
            c->eye[k] = f->eye[k];
            c->forward[k] = f->target[k] - f->eye[k];
        }
        if (!normalize(c->forward))
            return tobi_fail(err, TOBI_INVALID, "%s: the camera's eye and target are the same point", path);
        orient(c, up);
    } else {
        choose_direction(up, c->forward);
        for (int k = 0; k < 3; k++) c->forward[k] = -c->forward[k];
        orient(c, up);
        fit_box(c, f, half_width*(1 - bar), half_height*(1 - top));
    }
    double size = 0;
    for (int k = 0; k < 3; k++) size += (f->box_max[k] - f->box_min[k])*(f->box_max[k] - f->box_min[k]);
    c->near = (float)(1e-3*sqrt(size));
    v->sky_up = (vec){ (float)dot(up, c->right), (float)dot(up, c->up), (float)dot(up, c->forward) };
    /* The key light stands high to the left, a little behind the viewer. */
    v->light = vec_unit(vec_add(vec_scale(0.9f, v->sky_up), (vec){ -0.45f, 0.1f, -0.4f }));
    return TOBI_OK;
}

/* 2-D: x to the right, y up, the box with a margin, more on the right where the colour bar stands. */
static void aim_front(canvas *v, const tobi_picture *f)
{
    camera *c = &v->camera;
    double bar = f->label ? 0.09 : 0, top = f->title ? 0.06 : 0;
    double wide = f->box_max[0] - f->box_min[0], high = f->box_max[1] - f->box_min[1];
    double across = v->width*(0.92 - bar), down = v->height*(0.92 - top);
    *c = (camera){ .right = { 1, 0, 0 }, .up = { 0, 1, 0 }, .forward = { 0, 0, -1 }, .orthographic = true };
    c->focal = (float)fmin(across/wide, down/high);
    c->center_x = (float)(v->width*0.5*(1 - bar));
    c->center_y = (float)(v->height*0.5*(1 + top));
    for (int k = 0; k < 2; k++) c->eye[k] = 0.5*(f->box_min[k] + f->box_max[k]);
    c->eye[2] = 0;
    c->near = -INFINITY;
    v->sky_up = (vec){ 0, 1, 0 };
    v->light = vec_unit((vec){ -0.4f, 0.6f, -0.9f });
}

static void free_canvas(canvas *c)
{
    free(c->color);
    free(c->depth);
    free(c->surface);
    free(c->thickness);
    free(c->value);
    free(c->scratch);
    free(c->shadow.depth);
    free(c->shadow.range);
}

/* What the loops over the rows of a canvas or of the picture need. */
typedef struct row_view { const canvas *c; vec top, bottom; int samples; image *out; } row_view;

static void clear_rows(const void *view, int64_t begin, int64_t end)
{
    const row_view *v = view;
    const canvas *c = v->c;
    for (int y = (int)begin; y < end; y++)
        for (int x = 0; x < c->width; x++) {
            size_t k = (size_t)y*(size_t)c->width + (size_t)x;
            c->color[k] = vec_mix(v->top, v->bottom, (float)y/(float)c->height);
            c->depth[k] = INFINITY;
            if (c->surface) c->surface[k] = INFINITY;
        }
}

static tobi_status make_canvas(canvas *c, const tobi_picture *f, tobi_error *err)
{
    *c = (canvas){ .width = f->width*f->samples, .height = f->height*f->samples,
                    .palette = f->palette, .palette_count = f->palette_count };
    size_t n = (size_t)c->width*(size_t)c->height;
    bool water = f->dimension == 3 && f->particle_count > 0;
    c->color = malloc(n*sizeof *c->color);
    c->depth = malloc(n*sizeof(float));
    if (water) {
        c->surface = malloc(n*sizeof(float));
        c->thickness = calloc(n, sizeof(float));
        c->value = calloc(n, sizeof(float));
        c->scratch = calloc(n, sizeof(float));
    }
    if (!c->color || !c->depth || (water && (!c->surface || !c->thickness || !c->value || !c->scratch))) {
        free_canvas(c);
        return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture of %d x %d samples", c->width,
                         c->height);
    }
    const row_view view = { .c = c, .top = linear_color(f->background_top),
                            .bottom = linear_color(f->background_bottom) };
    tobi_loop(0, c->height, 0, clear_rows, &view);
    return TOBI_OK;
}

static void average_rows(const void *view, int64_t begin, int64_t end)
{
    const row_view *v = view;
    const canvas *c = v->c;
    const int s = v->samples, width = v->out->width;
    for (int y = (int)begin; y < end; y++)
        for (int x = 0; x < width; x++) {
            vec sum = { 0, 0, 0 };
            for (int j = 0; j < s; j++)
                for (int i = 0; i < s; i++) {
                    vec one = c->color[(size_t)(y*s + j)*(size_t)c->width + (size_t)(x*s + i)];
                    /* A sample brighter than white must not spread over its pixel's edge. */
                    sum = vec_add(sum, (vec){ fminf(one.x, 1), fminf(one.y, 1), fminf(one.z, 1) });
                }
            v->out->color[(size_t)y*(size_t)width + (size_t)x] = vec_scale(1/(float)(s*s), sum);
        }
}

/* Averages the samples of each pixel. */
static tobi_status develop(const canvas *c, const tobi_picture *f, image *out, tobi_error *err)
{
    *out = (image){ f->width, f->height, malloc((size_t)f->width*(size_t)f->height*sizeof(vec)) };
    if (!out->color) return tobi_fail(err, TOBI_NO_MEMORY, "no memory for a picture");
    const row_view view = { .c = c, .samples = f->samples, .out = out };
    tobi_loop(0, f->height, 0, average_rows, &view);
    return TOBI_OK;
}

static void find_range(const tobi_picture *f, double *low, double *high)
{
    *low = f->value_min;
    *high = f->value_max;
    if (*low < *high && isfinite(*low) && isfinite(*high)) return;
    *low = *high = 0;
    for (int64_t i = 0; f->values && i < f->particle_count; i++) {
        if (!isfinite(f->values[i])) continue;
        *low = fmin(*low, f->values[i]);
        *high = fmax(*high, f->values[i]);
    }
    if (!(*low < *high)) *high = *low + 1;
}

static tobi_status draw(canvas *c, const char *path, const tobi_picture *f, double low, double high,
                        tobi_error *err)
{
    if (f->dimension == 2) {
        aim_front(c, f);
        view_draw_floor(c, f);
        TOBI_TRY(view_draw_discs(c, f, low, high, err));
        TOBI_TRY(view_draw_meshes(c, f, err));
    } else {
        TOBI_TRY(aim_camera(c, path, f, err));
        TOBI_TRY(view_make_shadow(c, f, err));
        view_draw_floor(c, f);
        TOBI_TRY(view_draw_meshes(c, f, err));
        if (f->opaque) TOBI_TRY(view_draw_grains(c, f, low, high, err));
        if (f->particle_count > 0) TOBI_TRY(view_draw_water(c, f, low, high, err));
    }
    view_draw_box(c, f);
    return TOBI_OK;
}

tobi_status tobi_picture_write(const char *path, const tobi_picture *frame, tobi_error *err)
{
    TOBI_NEED(path, "the path");
    TOBI_NEED(frame, "the picture");
    TOBI_TRY(check_frame(path, frame, err));
    canvas c;
    image i = { 0 };
    double low, high;
    find_range(frame, &low, &high);
    TOBI_TRY(make_canvas(&c, frame, err));
    tobi_status status = draw(&c, path, frame, low, high, err);
    if (status == TOBI_OK) status = develop(&c, frame, &i, err);
    free_canvas(&c);
    if (status == TOBI_OK) {
        if (frame->title) view_draw_title(&i, frame->title);
        if (frame->label) view_draw_color_bar(&i, frame->label, low, high);
        status = view_write_png(path, &i, err);
    }
    free(i.color);
    return status;
}
