/* Fixed planes in the domain, beside its sides: solids and rigid bodies stay before them. */
#pragma once

typedef struct tobi_fixed_plane {
    double normal[3], offset;        /* 1, m: behind is normal . x < offset, x from the lower corner  */
    int    kind;                     /* tobi_plane_kind                                               */
    double friction;                 /* 1, Coulomb                                                    */
} tobi_fixed_plane;

static inline double tobi_plane_height(const tobi_fixed_plane *p, const double x[3])
{
    return p->normal[0]*x[0] + p->normal[1]*x[1] + p->normal[2]*x[2] - p->offset;
}
