/* Oracle of the shift of positions and of the velocity that goes with it; a part of test_isph_oracle.c. */
#pragma once

static void oracle_isph_shift(check *c, int64_t i, const sums *s)
{
    const double full = 1 - loss_of(s), d = view.spacing;
    double x[3], along[3], size = 0, n2 = 0, at = 0;
    const int surface = gate_of(i, s) > 0, fades = view.fades && !(view.last_link && view.last_link[i] >= 0);
    for (int a = 0; a < 3; a++) x[a] = surface && full < 0.6 ? 0 : -view.shifting*d*d*s->gradient_c[a];
    for (int a = 0; a < 3; a++) { n2 += s->normal[a]*s->normal[a]; at += x[a]*s->normal[a]; }
    for (int a = 0; a < 3; a++) {
        const double lost = surface ? full >= 0.6 : fades ? clip((sqrt(n2) - 0.3)/0.5) : 0;
        if (n2 > 1e-24) x[a] -= lost*at/n2*s->normal[a];
        x[a] = a < view.dimension ? x[a] + s->core[a] : 0;
        size += x[a]*x[a];
    }
    const double keep = size > 0.01*d*d ? 0.1*d/sqrt(size) : 1;
    isph_apply(&view.inverse[i], x, along);
    const double square = along[0]*along[0] + along[1]*along[1] + along[2]*along[2];
    for (int a = 0; a < 3; a++) {
        double change = 2*keep*square*s->bend[a];
        for (int b = 0; b < 3; b++) change += s->slope[3*a + b]*along[b];
        compare(c, (&view.accel[i].x)[a]*view.way*view.way, keep*x[a], d);
        const int none = a >= view.dimension || (view.open && full < 0.6);
        compare(c, (&view.shift_velocity[i].x)[a], none ? 0 : keep*change, 1);
    }
}
