/* Several fluids for test_isph_oracle.c: densities, distances from interfaces and curvatures at random. */
#pragma once
#include "sph/phases.h"

static int mixed;                    /* 1: two fluids */
static const float viscosities[2] = {1e-3f, 2e-3f};      /* m2/s */
static uint8_t fluids[4000];
static const float tensions[TOBI_MAX_FLUIDS][TOBI_MAX_FLUIDS] = {{0, 0.05f}, {0.05f, 0}};
static tobi_float4 phases[4000], interfaces[4000];

static void mix(isph_view *v)
{
    memset(fluids, 0, sizeof fluids);
    v->phase = v->interface = NULL;
    v->interface_tension = NULL;
    if (!mixed) return;
    v->phase = phases;
    v->interface = interfaces;
    v->interface_tension = tensions;
    v->fluid_count = 2;
    for (int64_t i = 0; i < v->count; i++) {
        fluids[i] = poisson_random() > 0;
        phases[i] = (tobi_float4){fluids[i] ? 400 : 1000, 1, (float)(v->h*(0.8 + 0.7*poisson_random())),
                                  fluids[i]};
        interfaces[i] = (tobi_float4){0, 0, 0, (float)(2e4*poisson_random())};
    }
}

/* Over the first density: of i; between two particles, eq. (51). */
static double relative(int64_t i) { return mixed ? phases[i].x/view.density : 1; }

static double between(int64_t i, int64_t j)
{
    const double s = mixed ? phases[i].z : 1, t = mixed ? phases[j].z : 1;
    return (s*relative(i) + t*relative(j))/(s + t);
}

/* Pa: by tension, of i over j. */
static double jump_of(int64_t i, int64_t j)
{
    return mixed ? 0.5*tensions[fluids[i]][fluids[j]]*((double)interfaces[i].w - (double)interfaces[j].w) : 0;
}

/* Viscosity is corrected where one is alone. */
static double alone(int64_t i) { return !mixed || phases[i].z >= (float)view.h; }
