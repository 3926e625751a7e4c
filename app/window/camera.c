/* The camera of the window: the projection is that of tobi_picture without title and label. Drawback: it is
   written here once more, since the picture keeps its own to itself. */
#include "camera.h"
#include <math.h>
#include <string.h>

static const double HALF_TURN = 3.14159265358979323846, MARGIN = 0.92;       /* MARGIN: of pictures in 2-D */

static double dot(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }
static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1]*b[2] - a[2]*b[1];
    out[1] = a[2]*b[0] - a[0]*b[2];
    out[2] = a[0]*b[1] - a[1]*b[0];
}
static double normalize(double a[3])
{
    const double length = sqrt(dot(a, a));
    for (int k = 0; k < 3 && length > 0; k++) a[k] /= length;
    return length;
}

/* front points to the viewer at yaw 0. */
static void set_axes(camera *c, const double up[3])
{
    memcpy(c->up, up, sizeof c->up);
    if (!(normalize(c->up) > 0)) memcpy(c->up, (double[3]){ 0, 0, 1 }, sizeof c->up);
    const double least[3] = { fabs(c->up[1]) < 0.9 ? 0 : 1, fabs(c->up[1]) < 0.9 ? -1 : 0, 0 };
    cross(c->up, least, c->side);
    normalize(c->side);
    cross(c->side, c->up, c->front);
}

static void set_screen(const camera *c, double right[3], double down[3], double away[3]);

/* How far from its middle the whole domain is seen, in a window half again as wide as high, with margins. */
static double fit_distance(const camera *c, const double low[3], const double high[3])
{
    const double half = 0.86*tan(c->angle*HALF_TURN/360), wide = 1.5*half;
    double right[3], down[3], away[3], distance = 0;
    set_screen(c, right, down, away);
    for (int i = 0; i < 8; i++) {
        double p[3];
        for (int k = 0; k < 3; k++) p[k] = (i >> k & 1 ? 0.5 : -0.5)*(high[k] - low[k]);
        const double need = fmax(fabs(dot(p, right))/wide, fabs(dot(p, down))/half);
        distance = fmax(distance, need + dot(p, away));
    }
    return distance;
}

void camera_home(camera *c, int dimension, const double low[3], const double high[3], const double up[3],
                 const double eye[3], const double target[3], double angle)
{
    double size = 0, away[3];
    *c = (camera){ .dimension = dimension, .angle = angle > 0 ? angle : 30 };
    memcpy(c->low, low, sizeof c->low);
    memcpy(c->high, high, sizeof c->high);
    set_axes(c, up);
    for (int k = 0; k < 3; k++) {
        c->target[k] = angle > 0 ? target[k] : 0.5*(low[k] + high[k]);
        away[k] = eye[k] - target[k];
    }
    c->yaw = 0.48;
    c->pitch = 0.34;
    c->distance = fit_distance(c, low, high);
    if (!(angle > 0) || !((size = normalize(away)) > 0)) return;
    c->distance = size;
    c->pitch = asin(fmax(-1, fmin(1, dot(away, c->up))));
    c->yaw = atan2(dot(away, c->side), dot(away, c->front));
}

static void look_back(const camera *c, double away[3])
{
    for (int k = 0; k < 3; k++)
        away[k] = cos(c->pitch)*(cos(c->yaw)*c->front[k] + sin(c->yaw)*c->side[k]) + sin(c->pitch)*c->up[k];
}

void camera_eye(const camera *c, double eye[3])
{
    double away[3];
    look_back(c, away);
    for (int k = 0; k < 3; k++) eye[k] = c->target[k] + c->distance*away[k];
}

void camera_orbit(camera *c, double yaw, double pitch)
{
    c->yaw += yaw;
    c->pitch = fmax(-1.55, fmin(1.55, c->pitch + pitch));
}

static void set_screen(const camera *c, double right[3], double down[3], double away[3])
{
    look_back(c, away);
    cross(c->up, away, right);
    normalize(right);
    cross(right, away, down);
}

void camera_pan(camera *c, double x, double y, int height)
{
    double right[3], down[3], away[3];
    if (c->dimension == 2) {
        const double m = (c->high[1] - c->low[1])/(MARGIN*height);
        for (int k = 0; k < 2; k++) {
            const double shift = k == 0 ? -x*m : y*m;
            c->low[k] += shift;
            c->high[k] += shift;
        }
        return;
    }
    const double m = 2*c->distance*tan(c->angle*HALF_TURN/360)/height;
    set_screen(c, right, down, away);
    for (int k = 0; k < 3; k++) c->target[k] -= m*(x*right[k] + y*down[k]);
}

void camera_zoom(camera *c, double factor)
{
    c->distance *= factor;
    for (int k = 0; k < 2 && c->dimension == 2; k++) {
        const double centre = 0.5*(c->low[k] + c->high[k]), half = 0.5*factor*(c->high[k] - c->low[k]);
        c->low[k] = centre - half;
        c->high[k] = centre + half;
    }
}

int camera_project(const camera *c, int width, int height, const double point[3], double pixel[3],
                   double *scale)
{
    double right[3], down[3], away[3], eye[3], to[3];
    if (c->dimension == 2) {
        *scale = fmin(MARGIN*width/(c->high[0] - c->low[0]), MARGIN*height/(c->high[1] - c->low[1]));
        pixel[0] = 0.5*width + *scale*(point[0] - 0.5*(c->low[0] + c->high[0]));
        pixel[1] = 0.5*height - *scale*(point[1] - 0.5*(c->low[1] + c->high[1]));
        pixel[2] = 0;
        return 1;
    }
    camera_eye(c, eye);
    set_screen(c, right, down, away);
    for (int k = 0; k < 3; k++) to[k] = point[k] - eye[k];
    pixel[2] = -dot(to, away);
    if (!(pixel[2] > 1e-9*c->distance)) return 0;
    *scale = 0.5*height/tan(c->angle*HALF_TURN/360)/pixel[2];
    pixel[0] = 0.5*width + *scale*dot(to, right);
    pixel[1] = 0.5*height + *scale*dot(to, down);
    return 1;
}
