/* Logarithm and exponential of lanes, by series: the same bits on every processor, as those of a library are
   not. */
#pragma once
#include "exec/portable.h"

/* ln(1 + x), exact for small x; 1 + x below 1e-3 counts as 1e-3. */
TOBI_FN lane lane_log1p(lane x)
{
    x = lane_where_less(x, lane_set(-0.999f), lane_set(-0.999f), x);
    lane u = x + 1.0f;
    lane_int bits = lane_bits(u), shifted = bits - 0x3f3504f3;        /* so that m lies around 1 */
    lane_int e = shifted >> 23;
    lane m = lane_from_bits(bits - (shifted & (int32_t)0xff800000));
    lane z = lane_where_equal(e, lane_set_int(0), x, m - 1.0f);
    lane y = z/(z + 2.0f), y2 = y*y;
    lane series = y2*(0.66666667f + y2*(0.4f + y2*(0.28571429f + y2*0.22222222f)));
    return lane_from_int(e)*0.69314718f + y*(series + 2.0f);
}

/* exp(x), |x| < 80. */
TOBI_FN lane lane_exp(lane x)
{
    x = lane_where_less(x, lane_set(-80), lane_set(-80), x);
    x = lane_where_less(lane_set(80), x, lane_set(80), x);
    lane_int n = lane_to_int(x*1.44269504f +
                             lane_where_less(x, lane_set(0), lane_set(-0.5f), lane_set(0.5f)));
    lane r = (x - lane_from_int(n)*0.693359375f) + lane_from_int(n)*2.12194440e-4f;
    lane s = 1.0f + r*(1.0f + r*(0.5f +
                                 r*(0.16666667f + r*(0.041666668f + r*(0.0083333310f + r*0.0013888889f)))));
    return s*lane_from_bits((n + 127) << 23);
}
