/* Three-component vector arithmetic on plain double[3], inlined everywhere. */
#pragma once
#include <math.h>

static inline void vec3_sub(double out[3], const double a[3], const double b[3])
{
    out[0] = a[0] - b[0];
    out[1] = a[1] - b[1];
    out[2] = a[2] - b[2];
}

/* out = a + s b */
static inline void vec3_add_scaled(double out[3], const double a[3], double s, const double b[3])
{
    out[0] = a[0] + s*b[0];
    out[1] = a[1] + s*b[1];
    out[2] = a[2] + s*b[2];
}

static inline double vec3_dot(const double a[3], const double b[3])
{
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}

static inline void vec3_cross(double out[3], const double a[3], const double b[3])
{
    double x = a[1]*b[2] - a[2]*b[1], y = a[2]*b[0] - a[0]*b[2], z = a[0]*b[1] - a[1]*b[0];
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

static inline double vec3_length(const double a[3]) { return sqrt(vec3_dot(a, a)); }

static inline double vec3_distance2(const double a[3], const double b[3])
{
    double d[3];
    vec3_sub(d, a, b);
    return vec3_dot(d, d);
}

/* Scales a to length 1; a zero vector stays zero. */
static inline void vec3_normalize(double a[3])
{
    double length = vec3_length(a), s = length > 0 ? 1/length : 0;
    a[0] *= s;
    a[1] *= s;
    a[2] *= s;
}
