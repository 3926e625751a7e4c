/* What a picture shows, its size, and where the eye is: as given, or so that the domain fills it. Drawback:
   what lies outside of the domain may be outside of the picture. */
#define _GNU_SOURCE 1
#include "view/draw.h"
#include <string.h>

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
    const double left = f->axes ? view_axis_room(v, f, 1) : 0, right = v->width*(0.96 - bar);
    if (c->center_x - 0.5*wide*c->focal < left) {      /* moved aside, and smaller if that is not enough */
        c->focal = (float)fmin(c->focal, (right - left)/wide);
        c->center_x = (float)(left + 0.5*wide*c->focal);
    }
    for (int k = 0; k < 2; k++) c->eye[k] = 0.5*(f->box_min[k] + f->box_max[k]);
    c->eye[2] = 0;
    c->near = -INFINITY;
    v->sky_up = (vec){ 0, 1, 0 };
    v->light = vec_unit((vec){ -0.4f, 0.6f, -0.9f });
}

tobi_status view_aim(canvas *v, const char *path, const tobi_picture *f, tobi_error *err)
{
    if (f->dimension == 3) return aim_camera(v, path, f, err);
    aim_front(v, f);
    return TOBI_OK;
}

/* Movies need even sizes. */
static int even(double pixels) { return 2*(int)lround(fmin(fmax(pixels, 16), 8192)/2); }

/* The size that is not given: in 2-D the box fills the picture beside a colour bar and under a title. */
static void fit_size(tobi_picture *p)
{
    const double wide = p->box_max[0] - p->box_min[0], high = p->box_max[1] - p->box_min[1];
    double aspect = 16.0/9;
    if (p->dimension == 2 && wide > 0 && high > 0) aspect = fmin(fmax(1.04*wide/high, 0.75), 4);
    if (p->width == 0) p->width = even(p->height ? p->height*aspect : sqrt(1280*720*aspect));
    if (p->height == 0) p->height = even(p->width/aspect);
}

void tobi_picture_set_view(tobi_picture *p, const tobi_view_def *view)
{
    if (!p || !view) return;
    p->has_camera = view->angle > 0 && p->dimension == 3;
    if (p->has_camera) p->field_of_view = view->angle;
    p->width = view->width;
    p->height = view->height;
    fit_size(p);
    p->samples = view->samples;
    p->look = view->look;
    p->axes = view->axes;
    p->isolines = view->isolines;
    p->streamlines = view->streamlines;
    p->transparent = view->transparent;
    p->slice = view->slice;
    for (int a = 0; a < 3; a++) {
        p->eye[a] = view->position[a];
        p->target[a] = view->look_at[a];
        p->clip_point[a] = view->clip_point[a];
        p->clip_normal[a] = view->clip_normal[a];
        p->clip |= view->clip_normal[a] != 0;
    }
}
