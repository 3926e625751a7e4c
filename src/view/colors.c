/* Colours of values: the picture's own palette, or from deep blue over light blue to aqua, which
   stands out from the light background. Half of the latter lies below a quarter of the largest value: waves
   move at a tenth of the speed of a fall. Drawback: fast water differs less. */
#include "view/draw.h"
#include <stdlib.h>

vec view_color_of(const tobi_picture *f, float value)
{
    static const float usual[5][3] = {
        { 0.02f, 0.16f, 0.42f }, { 0.04f, 0.36f, 0.70f }, { 0.16f, 0.56f, 0.85f }, { 0.36f, 0.78f, 0.90f },
        { 0.66f, 0.96f, 0.88f }
    };
    const float (*map)[3] = f->palette ? f->palette : usual;
    const int last = f->palette ? f->palette_count - 1 : 4;
    const float v = clampf(value, 0, 1), t = (f->palette ? v : sqrtf(v))*(float)last;
    const int i = t < (float)last ? (int)t : last, next = i < last ? i + 1 : last;
    return vec_mix(linear_color(map[i]), linear_color(map[next]), t - (float)i);
}

void view_find_range(const tobi_picture *f, double *low, double *high)
{
    *low = f->value_min;
    *high = f->value_max;
    if (*low < *high && isfinite(*low) && isfinite(*high)) return;
    *low = *high = 0;
    for (int64_t i = 0; f->values && i < f->particle_count; i++) {
        if (!isfinite(f->values[i]) || view_has_own(f, i) || !view_is_in_nest(f, i)) continue;
        *low = fmin(*low, f->values[i]);
        *high = fmax(*high, f->values[i]);
    }
    if (!(*low < *high)) *high = *low + 1;
}

enum { STEPS = SCALE_STEPS };

typedef struct coloring {
    const tobi_picture *f;
    double low, high;
    vec step[STEPS + 1];
    vec *palette, *out;
} coloring;

static void color_range(const void *view, int64_t begin, int64_t end)
{
    const coloring *c = view;
    for (int64_t i = begin; i < end; i++) {
        const double t = c->f->values ? (c->f->values[i] - c->low)/(c->high - c->low) : 0;
        const float value = t == t ? clampf((float)t, 0, 1) : 1;
        const float exact = value*(float)(c->f->palette_count - 1);
        const bool number = c->f->palette && exact == (float)(int)exact;      /* of a colour */
        c->out[i] = view_has_own(c->f, i) ? linear_color(c->f->own[i]) : number ? c->palette[(int)exact]
            : c->step[(int)(value*STEPS + 0.5f)];
    }
}

vec *view_color_particles(const tobi_picture *f, double low, double high)
{
    coloring c = { .f = f, .low = low, .high = high, .out = malloc(((size_t)f->particle_count
                                                                    + 1)*sizeof(vec)) };
    if (f->palette) c.palette = malloc((size_t)f->palette_count*sizeof *c.palette);
    if (!c.out || (f->palette && !c.palette)) {
        free(c.out);
        free(c.palette);
        return NULL;
    }
    for (int k = 0; f->palette && k < f->palette_count; k++) c.palette[k] = linear_color(f->palette[k]);
    view_make_scale(f, c.step);
    tobi_loop(f->threads, f->particle_count, 0, color_range, &c);
    free(c.palette);
    return c.out;
}

void view_make_scale(const tobi_picture *f, vec scale[SCALE_STEPS + 1])
{
    for (int k = 0; k <= SCALE_STEPS; k++) scale[k] = view_color_of(f, (float)k/SCALE_STEPS);
}

vec *view_scale_particles(const tobi_picture *f, double low, double high)
{
    vec *out = malloc(((size_t)f->particle_count + 1)*sizeof *out);
    for (int64_t i = 0; out && i < f->particle_count; i++) {
        const double t = (f->values[i] - low)/(high - low);
        out[i] = view_has_own(f, i) ? linear_color(f->own[i])
            : (vec){ t == t ? clampf((float)t, -1e6f, 1e6f) : 1, 0, 0 };
    }
    return out;
}
