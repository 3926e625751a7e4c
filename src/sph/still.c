#include "sph/still.h"
#include <math.h>

/* In support radii. COVER keeps clear of kernels that a surface cuts. The pressure of REST stays with the
   solve: pressures that fluctuate about zero order no particles, and a tank then never rests. */
static const double COVER = 1, RAMP = 3, REST = 0.5;
enum { DROPS = 1024 };

void sph_still_set(tobi_simulation *s, double low)
{
    tobi_still *w = &s->still;
    double g2 = 0, h = s->smoothing.h;
    *w = (tobi_still){.cover = COVER*h, .ramp = RAMP*h, .rest = REST*h};
    w->level = low - 0.5*s->smoothing.spacing;
    for (int a = 0; a < s->box.dimension; a++)
        if (!s->box.periodic[a]) g2 += s->gravity[a]*s->gravity[a];
    for (int f = 1; f < s->fluid_count; f++)
        if (s->fluid[f].density != s->fluid[0].density) g2 = 0;
    if (!(g2 > 0)) return;
    for (int a = 0; a < s->box.dimension; a++) {
        if (s->box.periodic[a]) continue;
        w->down[a] = s->gravity[a]/sqrt(g2);
        w->corner[a] = w->down[a] > 0 ? 0 : s->box.size[a];
    }
    w->push = low > 0 ? s->fluid[0].density*sqrt(g2) : 0;
}

double sph_still_low(const tobi_simulation *s)
{
    const float *drop = s->particles.delta;
    int64_t n[DROPS] = {0}, count = s->particles.count;
    double scale = DROPS/(1.0001*s->lowest);
    if (!(s->lowest > 0)) return 0;
    #pragma omp parallel for num_threads(s->exec.threads) schedule(static) reduction(+ : n[:DROPS])
    for (int64_t i = 0; i < count; i++)
        if (drop[i] > 0) n[(int)(drop[i]*scale)]++;
    double few = 1 + 0.02*(s->box.dimension == 3 ? cbrt((double)count*(double)count) : sqrt((double)count));
    int k = DROPS - 1;
    for (int64_t deeper = n[k]; k > 0 && (double)deeper <= few; deeper += n[k]) k--;
    return k/scale;
}

/* Down with the surface, but not faster than anything moves: a void that opens in the depth, as behind a
   body that sets off, is no part of it. Up slowly. */
static double follow(const tobi_simulation *s, double before, double low, double speed)
{
    double g = 0;
    if (!(low > 0) || !(before > 0)) return low;
    for (int a = 0; a < 3; a++) g += s->still.down[a]*s->gravity[a];
    double rise = 0.1*sqrt(g*s->smoothing.spacing)*s->dt;
    return fmin(fmax(low, before - rise), before + speed*s->dt);
}

void sph_still_move(tobi_simulation *s, tobi_still *before, double low, double speed, double *level)
{
    sph_still_set(s, *level);
    *before = s->still;
    *level = follow(s, *level, low, speed);
}
