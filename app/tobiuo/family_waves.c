/* The wave tank that `tobiuo new` writes: piston, water, a beach a wave long, level sensors. Dimensions that
   are left out follow from the length of the waves. Drawback: that length is by linear theory. */
#include "family.h"
#include "language.h"
#include <math.h>

#define PI 3.14159265358979323846
static const double G = 9.81;
/* Wave lengths between piston and beach; periods that pass when the first waves have reached the beach. */
static const double ROOM = 2, PASS = 6;
/* H L^2/h^3 up to which a piston of second order makes no second crest (Madsen 1971). */
static const double MADSEN = 8*PI*PI/3;
/* Goring: a solitary wave reaches so far over its kappa to either side of its crest. */
static const double REACH = 3.8;

const family_option wave_options[] = {
    SPACING(0.02),
    { "until", "s", 0, 1e-6, 1e5, TEXT("end of the run; 0: six periods after waves reach the beach"), 0 },
    LENGTH("length", 0, TEXT("of the tank, along x; 0: two wave lengths and the beach")),
    ACROSS("width", 0.1, TEXT("of the tank, along y")), LENGTH("height", 0.5, TEXT("of the tank, along z")),
    LENGTH("depth", 0.3, TEXT("of the water")),
    LENGTH("wave-height", 0.06, TEXT("from trough to crest; of a solitary wave above the still water")),
    { "period", "s", 1.2, 0, 1e5, TEXT("of regular waves; 0: one solitary wave"), 0 },
    { "ramp", TEXT("periods"), 2, 0, 100, TEXT("in which the stroke of the piston grows from 0"), 0 },
    { "beach", TEXT("wave lengths"), 1, 0, 100, TEXT("of the damping zone at the far end; 0: none, a wall"),
     0 },
    { "slope", "1", 0, 0, 1000, TEXT("N of a slope of 1 : N at the far end in place of the beach; 0: none"),
     0 },
    LENGTH("maker-at", 0.3, TEXT("where the water begins: the face of the piston at rest")), { 0 } };

/* A slope ends so many wave heights above the still water, or at the height of the tank. */
static const double RUN_UP = 4;

/* What follows from the choice. length, speed, group: of the waves, m, m/s, m/s; the others in m and s.
   beach: length of the damping zone; slope, top: length and height of the slope. */
typedef struct plan { double length, speed, group, tank, beach, slope, top, ramp, until; } plan;

/* Up to two digits, as somebody would draw it. */
static double round_up(double x)
{
    const double unit = pow(10, floor(log10(x)) - 1);
    return ceil(x/unit - 1e-9)*unit;
}

static double tidy(double x) { return floor(x*1e4 + 0.5)/1e4; }

/* k h of omega^2 = g k tanh kh, by Newton's method. */
static double wave_number_depth(double period, double depth)
{
    const double deep = 4*PI*PI/(period*period*G)*depth;
    double kh = deep/sqrt(tanh(deep));
    for (int n = 0; n < 20; n++) kh -= (kh*tanh(kh) - deep)/(tanh(kh) + kh*(1 - tanh(kh)*tanh(kh)));
    return kh;
}

static void plan_slope(const family_choice *c, plan *p)
{
    if (!(chosen(c, "slope") > 0)) return;
    p->beach = 0;
    p->top = fmin(chosen(c, "height"), chosen(c, "depth") + RUN_UP*chosen(c, "wave-height"));
    p->slope = chosen(c, "slope")*p->top;
}

static plan plan_regular(const family_choice *c)
{
    const double period = chosen(c, "period"), depth = chosen(c, "depth");
    const double kh = wave_number_depth(period, depth), length = 2*PI*depth/kh;
    plan p = { .length = length, .speed = length/period, .ramp = period*chosen(c, "ramp") };
    p.group = p.speed*(0.5 + kh/sinh(2*kh));
    if (chosen(c, "beach") > 0) p.beach = round_up(length*chosen(c, "beach"));
    plan_slope(c, &p);
    p.tank = chosen(c, "length") > 0 ? chosen(c, "length")
                                     : round_up(chosen(c, "maker-at") + ROOM*length + p.beach + p.slope);
    p.until = chosen(c, "until");
    const double way = p.tank - p.beach - p.slope - chosen(c, "maker-at");
    if (!(p.until > 0)) p.until = period*ceil((p.ramp + way/p.group)/period + PASS);
    return p;
}

/* It runs through its own length to the far wall, and back. */
static plan plan_solitary(const family_choice *c)
{
    const double depth = chosen(c, "depth"), height = chosen(c, "wave-height");
    const double kappa = sqrt(0.75*height/(depth*depth*depth)), speed = sqrt(G*(depth + height));
    plan p = { .length = 2*REACH/kappa, .speed = speed, .group = speed };
    plan_slope(c, &p);
    p.tank = chosen(c, "length") > 0 ? chosen(c, "length")
                                     : round_up(chosen(c, "maker-at") + p.length + p.slope);
    p.until = chosen(c, "until");
    if (!(p.until > 0)) p.until = round_up((p.length/2 + 2*(p.tank - chosen(c, "maker-at")))/speed);
    return p;
}

static plan make_plan(const family_choice *c)
{
    return chosen(c, "period") > 0 ? plan_regular(c) : plan_solitary(c);
}

const char *object_wave(const family_choice *c)
{
    const double depth = chosen(c, "depth");
    if (depth > chosen(c, "height")) return TEXT("the water is higher than the tank, --height");
    if (chosen(c, "wave-height") > 0.78*depth)
        return TEXT("--wave-height is more than 0.78 of --depth: such waves break");
    if (!(chosen(c, "period") > 0) && (is_given(c, "ramp") || is_given(c, "beach")))
        return TEXT("a solitary wave, --period 0, has neither --ramp nor --beach");
    if (chosen(c, "slope") > 0 && is_given(c, "beach") && chosen(c, "beach") > 0)
        return TEXT("the far end has --slope or --beach, not both");
    const plan p = make_plan(c);
    if (chosen(c, "maker-at") >= p.tank) return TEXT("the piston stands beyond the tank");
    if (p.slope > 0 && chosen(c, "maker-at") + p.slope >= p.tank)
        return TEXT("piston and slope fill the tank: give more --length, a smaller --slope, or no --length");
    return chosen(c, "maker-at") + p.beach >= p.tank
         ? TEXT("piston and beach fill the tank: give more --length, less --beach, or no --length") : NULL;
}

static void put_piston(const family_choice *c, FILE *out, const plan *p, const double size[3])
{
    const double at = chosen(c, "maker-at"), height = chosen(c, "wave-height"), depth = chosen(c, "depth");
    const double back[3] = { at - fmin(4*chosen(c, "spacing"), at/2), 0, 0 };
    const double face[3] = { at, size[1], size[2] };
    const int second = height*p->length*p->length <= MADSEN*depth*depth*depth;
    fputs("  \"bodies\": [\n    { \"name\": \"piston\", \"box\": { ", out);
    put_corners(c, out, back, face);
    fprintf(out, " },\n      \"motion\": { \"piston\": {\n"
            "        \"depth\": %.10g,                  // %s\n", depth, tr("m, of the still water"));
    if (chosen(c, "period") > 0)
        fprintf(out, "        \"ramp\": %.10g,                   // %s\n        // %s%s (Madsen 1971)\n"
                "        \"regular\": { \"height\": %.10g, \"period\": %.10g, \"order\": %d }\n", p->ramp,
                tr("s, in which its stroke grows from 0"), tr("height: m from trough to crest; period: s; "),
                second ? tr("order 2: no free waves of half the period")
                : tr("too long and high for order 2"),
                height, chosen(c, "period"), second ? 2 : 1);
    else
        fprintf(out, "        \"solitary\": { \"height\": %.10g } // %s\n", height,
                tr("m above the still water"));
    fputs("      } } }", out);
    if (p->slope > 0) {
        fprintf(out, ",\n    // %s\n    { \"name\": \"slope\", \"sealed\": true,         // %s\n"
                "      \"outline\": { \"points\": [[%.10g, 0], [%.10g, %.10g]], \"base\": 0",
                tr("points of its upper side, m; base: what the body reaches down to"),
                tr("no water below it"), p->tank - p->slope, p->tank, p->top);
        if (c->dimension == 3) fprintf(out, ", \"from\": 0, \"to\": %.10g", size[1]);
        fputs(" } }", out);
    }
    fputs("\n  ],\n", out);
}

/* Along the slope, half a spacing above it, from half of the depth on. */
static void put_run_up(const family_choice *c, FILE *out, const plan *p, double y)
{
    const double n = chosen(c, "slope"), off = 0.5*chosen(c, "spacing")*sqrt(1 + 1/(n*n));
    const double low = 0.5*chosen(c, "depth"), toe = p->tank - p->slope, high = 0.98*p->top - off;
    fputs(",\n    { \"name\": \"runup\", \"kind\": \"run-up\", \"position\": ", out);
    put_place(c, out, tidy(toe + n*low), y, tidy(low + off));
    fputs(", \"end\": ", out);
    put_place(c, out, tidy(toe + n*high), y, tidy(high + off));
    fputs(" }", out);
}

static void put_beach(const family_choice *c, FILE *out, const plan *p, const double size[3])
{
    const double low[3] = { p->tank - p->beach, 0, 0 };
    if (!(p->beach > 0)) return;
    fprintf(out, tr("  // The beach: velocities of the water decay at a rate that grows along the box to\n"
            "  // %.10g 1/s at its end, 10 over the period.\n"), tidy(10/chosen(c, "period")));
    fputs("  \"damping_zones\": [ { \"box\": { ", out);
    put_corners(c, out, low, size);
    fprintf(out, " }, \"rate\": %.10g } ],\n", tidy(10/chosen(c, "period")));
}

/* G1 to G3 of regular waves stand 1/10 and 1/4 of their length apart, which tells waves that come back
   (Mansard and Funke 1980). */
static void put_gauges(const family_choice *c, FILE *out, const plan *p, const double size[3])
{
    static const double apart[] = { 0, 0.1, 0.25 };
    const double at = chosen(c, "maker-at"), room = p->tank - p->beach - p->slope - at;
    const int regular = chosen(c, "period") > 0;
    fprintf(out, "  // %s%s%s\n  \"probes\": [", tr("Sensors of the level, m above the floor, in probes.csv"),
            p->slope > 0 ? tr("; runup: how high water runs up, m")
                         : p->beach > 0 ? "" : tr("; wall: pressure, Pa"),
            regular ? tr(".\n  // G2 and G3 stand 1/10 and 1/4 of a wave length behind G1: such a row tells "
            "waves\n  // that come back: tobiuo waves DIR --gauges G1,G2,G3") : "");
    for (int k = 0; k < 3; k++) {
        const double x = regular ? at + room/2 + apart[k]*fmin(p->length, room) : at + (k + 1)*room/4;
        char name[16];
        snprintf(name, sizeof name, "G%d", k + 1);
        put_probe(c, out, k == 0, name, "level", tidy(x), size[1]/2, 0);
    }
    if (p->beach > 0) put_probe(c, out, 0, "end", "level", size[0], size[1]/2, 0);
    else if (p->slope > 0) put_run_up(c, out, p, size[1]/2);
    else put_probe(c, out, 0, "wall", "point", size[0], size[1]/2, chosen(c, "depth")/2);
    fputs("\n  ],\n", out);
}

void write_wave(const family_choice *c, FILE *out)
{
    const plan p = make_plan(c);
    const double size[3] = { p.tank, chosen(c, "width"), chosen(c, "height") };
    const double low[3] = { chosen(c, "maker-at"), 0, 0 }, high[3] = { size[0], size[1], chosen(c, "depth") };
    const int regular = chosen(c, "period") > 0;
    const double interval = regular ? chosen(c, "period")/10 : p.until/100;
    char title[512], end[128];
    if (p.slope > 0) snprintf(end, sizeof end, tr("runs up a slope of 1 : %.10g"), chosen(c, "slope"));
    else snprintf(end, sizeof end, "%s", p.beach > 0 ? tr("ends on a beach") : tr("meets a wall"));
    if (regular)
        snprintf(title, sizeof title, tr("a piston makes a train of waves, which %s\n// The waves are %.4g m "
                 "long and travel at %.4g m/s, their energy at %.4g m/s (linear theory)"), end, p.length,
                 p.speed, p.group);
    else
        snprintf(title, sizeof title, tr("a piston makes a solitary wave, which %s\n"
                 "// The wave is %.4g m long and travels at %.4g m/s (Goring 1978)"), end, p.length, p.speed);
    put_head(c, out, size, title, 0);
    fprintf(out, "  \"end_time\": %.10g,", p.until);
    if (regular) fprintf(out, tr("                   // s: %.4g periods"), p.until/chosen(c, "period"));
    fputc('\n', out);
    put_water(c, out, low, high);
    put_piston(c, out, &p, size);
    put_beach(c, out, &p, size);
    put_gauges(c, out, &p, size);
    fprintf(out, "  \"output\": { \"interval\": %.10g }       // %s\n}\n", interval,
            tr("s between pictures and files of particles"));
}
