/* Which nests a world has, and where they are. Drawback: an outer world that is destroyed before its nests
   leaves them without one. */
#include "world/fit.h"
#include "world/nest.h"
#include <math.h>

void tobi_nest_join(tobi_world *w)
{
    tobi_world **last = &w->outer->first_nest;
    w->sim.nest.number = 1;
    for (; *last; last = &(*last)->next_nest) w->sim.nest.number = (*last)->sim.nest.number + 1;
    *last = w;
}

int tobi_nest_count(const tobi_world *outer)
{
    int count = 0;
    for (const tobi_world *n = outer->first_nest; n; n = n->next_nest) count++;
    return count;
}

tobi_world *tobi_nest_numbered(const tobi_world *outer, int number)
{
    tobi_world *n = outer->first_nest;
    while (n && n->sim.nest.number != number) n = n->next_nest;
    return n;
}

void tobi_nest_leave(tobi_world *w)
{
    for (tobi_world *n = w->first_nest; n; n = n->next_nest) n->outer = NULL;
    if (!w->outer) return;
    tobi_nest_let_go(w);
    tobi_world **at = &w->outer->first_nest;
    while (*at && *at != w) at = &(*at)->next_nest;
    if (*at) *at = w->next_nest;
}

tobi_world *tobi_world_nest_at(const tobi_world *outer, int index)
{
    tobi_world *n = outer ? outer->first_nest : NULL;
    for (int k = 0; n && k < index; k++) n = n->next_nest;
    return index < 0 ? NULL : n;
}

int tobi_world_nest_box(const tobi_world *w, double box[2][3], double *spacing)
{
    if (!w || !box || !spacing || !w->sim.nest.outer) return 0;
    for (int a = 0; a < 3; a++) {
        box[0][a] = w->sim.nest.lower[a] + w->system[0].box.lower[a];
        box[1][a] = w->sim.nest.upper[a] + w->system[0].box.lower[a];
    }
    *spacing = tobi_world_spacing(w, &w->system[0]);
    return 1;
}

double tobi_world_nest_most(const tobi_world *w)
{
    if (!w || !w->sim.nest.outer) return 0;
    const tobi_nest *n = &w->sim.nest;
    const tobi_system *s = &w->system[0];
    const double finer = n->outer->smoothing.spacing/s->smoothing.spacing;
    double room = 1, liquid = (double)n->outer->particles.count;
    for (int a = 0; a < s->box.dimension; a++) {
        const double low = fmax(n->lower[a] - n->rim, 0), high = fmin(n->upper[a] + n->rim, s->box.size[a]);
        room *= fmax(high - low, 0)/s->smoothing.spacing;
    }
    for (int a = 0; a < s->box.dimension; a++) liquid *= finer;
    return floor(n->outer->sim->opening_count || !w->outer->started ? room + 0.5 : fmin(room, liquid) + 0.5);
}
