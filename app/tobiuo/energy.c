/* Energy from nothing. Without friction the sum of kinetic, potential and elastic energy stays, with it the
   sum falls. Drawback: a small gain in a deep pool, or one that friction has eaten by the next output, is
   not seen. */
#include "energy.h"
#include <math.h>

/* Of the energy at the start: liquid that is squeezed and swells again moves it by less. */
static const double GAIN = 0.1;
/* Kinetic energy over all that was there. */
static const double ABSURD = 2;

void energy_begin(energy_watch *e, const tobi_world *world, double kinetic, double potential, double elastic)
{
    *e = (energy_watch){ 0 };
    e->start = e->least = kinetic + potential + elastic;
    e->closed = tobi_world_closed(world, &e->bodies) && e->start > 0;
}

void energy_look(energy_watch *e, double time, double kinetic, double potential, double elastic)
{
    const double sum = kinetic + potential + elastic, gain = sum - e->least;
    e->kinetic = kinetic;
    if (gain > e->gain) e->gain = gain, e->time = time;
    if (!(e->bodies > 0)) e->least = fmin(e->least, sum);
}

int energy_gained(const energy_watch *e)
{
    return e->closed && e->gain > GAIN*e->start + e->bodies;
}

int energy_absurd(const energy_watch *e)
{
    return e->closed && e->kinetic > ABSURD*(e->start + e->bodies);
}
