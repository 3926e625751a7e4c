/* Points of soft solids in the sums of isph: neighbours that mirror the pressure and, across the surface, the
   velocity of the particle. Their pressures are those of liquid that is accelerated as they are, so that they
   leave no entry in the matrix. All of it goes to the sums before the first pair. */
#pragma once
#include "sph/isph/view.h"

/* Eight lanes of which the first has a number. */
TOBI_FN lane isph_first(double x)
{
    const float all[8] = {(float)x, 0, 0, 0, 0, 0, 0, 0};
    return lane_load(all);
}

TOBI_FN int32_t isph_soft_last(const isph_view *v, int64_t i) { return v->soft_last ? v->soft_last[i] : -1; }

/* Of the surface that i sees, towards the liquid; 0 where it sees as much of it on all sides. */
TOBI_FN void isph_soft_normal(const isph_view *v, int64_t i, double n[3])
{
    double square = 0;
    n[0] = n[1] = n[2] = 0;
    for (int32_t k = isph_soft_last(v, i); k >= 0; k = v->soft[k].previous)
        for (int a = 0; a < 3; a++) n[a] -= v->soft[k].gradient[a];
    for (int a = 0; a < 3; a++) square += n[a]*n[a];
    for (int a = 0; a < 3; a++) n[a] = square*v->h*v->h > 1e-6 ? n[a]/sqrt(square) : 0;
}

/* m/s: velocity of the mirrored particle less its own, along n. */
TOBI_FN double isph_soft_speed(const isph_view *v, int64_t i, const sph_soft_link *l, const double n[3])
{
    double speed = 0;
    for (int a = 0; a < 3; a++) {
        const double own = (&v->velocity[i].x)[a] - v->gravity_dt*(double)v->gravity[a];
        const double change = v->gravity_dt > 0 ? 0 : v->soft_change[l->point][a];
        speed += ((&v->soft_velocity[l->point].x)[a] + change - own)*n[a];
    }
    return 2*speed;
}

/* Pa: pressure at the point less that of the particle. */
TOBI_FN double isph_soft_difference(const isph_view *v, const sph_soft_link *l, const double n[3])
{
    double along = 0, change = 0, still = 0;
    for (int a = 0; a < 3; a++) {
        const double d = l->gradient[a]/l->rate;
        still += v->gravity[a]*d;
        along += n[a]*d;
        change += n[a]*v->soft_change[l->point][a];
    }
    return v->density*(still - change/v->dt*along);
}

/* The next link that counts; -1: there is none. */
TOBI_FN int32_t isph_soft_next(const isph_view *v, int32_t k)
{
    while (k >= 0 && !(v->soft[k].rate > 0)) k = v->soft[k].previous;
    return k;
}

#define ISPH_SOFT_LINKS(v, i, k)                                                                    \
    for (int32_t k = isph_soft_next(v, isph_soft_last(v, i)); k >= 0;                               \
         k = isph_soft_next(v, (v)->soft[k].previous))
