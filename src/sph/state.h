/* What the states of all SPH methods begin with. */
#pragma once
#include "core/system.h"
#include "sph/fields.h"
#include "sph/boundary/links.h"
#include "sph/soft.h"
#include "sph/reference_pressure.h"

typedef struct sph_state {
    tobi_boundary_links links;         /* particles that see a body                                        */
    sph_soft soft;                  /* particles that see soft solids                                   */
    tobi_reference reference;       /* what still water holds of gravity                                */
    double reference_volume;        /* m3 of fluid times the share of gravity so held                   */
    double open;                    /* particles at a surface beyond doubt, in full vessels as well     */
    double lowest;                  /* m, depth of the lowest particle at a free surface                */
    double middle;                  /* m, median depth of the free surface, of the step at hand         */
    double friction[3];             /* N, of implicit viscosity on the sides of the domain              */
    int marked;                     /* 1: the `held` of particles is that of the present rows       */
    tobi_float4 normal[TOBI_OPENING_LIMIT + 1];  /* of openings; none of the rim of a nest          */
    int mirrors;                    /* 1: walls are mirrors (isph), 0: integrals of the kernel          */
    int zones_answer;               /* 1: porous zones that bodies carry are known, until their force is    */
    int full;                       /* 1: there was no free surface at the start                        */
    int past_edges;                 /* 1: pairs past blunt edges of bodies stay, boundary/pairs.c     */
} sph_state;

static inline sph_state *sph_of(const tobi_system *s) { return s->state; }

/* Particles, for means over them: 1 where all have left, and sums are 0. */
static inline double sph_rows(const tobi_system *s)
{
    return s->particles.count > 0 ? (double)s->particles.count : 1;
}

/* In a range over entries: runs over them; those of one particle are handled together, where the first of
   them stands. */
#define SPH_FOR_NEAR_PARTICLES(s, k, i, e)                                                                 \
    for (int64_t k = begin; k < end; k++)                                                                  \
        for (int64_t i = sph_of(s)->links.link[k].particle,                                                \
                     once = sph_fields_of(&s->particles)->last_link[i] == k; once; once = 0)               \
            for (const tobi_boundary_entry *e = &sph_of(s)->links.entry[k]; e;                             \
                 e = tobi_boundary_next(&sph_of(s)->links, e))

extern const tobi_output sph_outputs[];
/* method->needs. */
unsigned sph_needs(const tobi_system *s, int full);
/* Pressure, density and sph_outputs of one particle. */
void sph_read(const tobi_system *s, const char *name, int64_t i, double *out);
/* What the state has in common with other SPH methods: method->account. */
void sph_account(const tobi_system *s, tobi_account *a);
