/* The families of scenes: a table of options and a writer each. Lengths are measured from the lower corner of
   the tank, x along it, y across, z up; a 2-D scene has x and z as its x and y. Drawback: dimensions of
   experiments stand here and in the physics cases alike. */
#include "family.h"
#include "language.h"
#include <math.h>
#include <string.h>

#define AIR { "air", "kg/m3", 0, 0, 100, TEXT("density of the air in the rest of the tank: 1.2; 0: none"), 0 }
#define UNTIL(t) { "until", "s", t, 1e-6, 1e5, TEXT("simulated time at which the run ends"), 0 }
#define TANK(l, w, h) \
    LENGTH("length", l, TEXT("of the tank, along x")), ACROSS("width", w, TEXT("of the tank, along y")), \
    LENGTH("height", h, TEXT("of the tank, along z"))

double chosen(const family_choice *c, const char *option)
{
    const family_option *o;
    for (int k = 0; (o = family_option_at(c->family, k)); k++)
        if (strcmp(o->name, option) == 0) return c->value[k];
    return 0;
}

/* --- parts of a scene ---------------------------------------------------------------------- */

void put_place(const family_choice *c, FILE *out, double x, double y, double z)
{
    if (c->dimension == 2) fprintf(out, "[%.10g, %.10g]", x, z);
    else fprintf(out, "[%.10g, %.10g, %.10g]", x, y, z);
}

void put_corners(const family_choice *c, FILE *out, const double low[3], const double high[3])
{
    fputs("\"min\": ", out);
    put_place(c, out, low[0], low[1], low[2]);
    fputs(", \"max\": ", out);
    put_place(c, out, high[0], high[1], high[2]);
}

void put_head(const family_choice *c, FILE *out, const double size[3], const char *title, double tilt)
{
    static const double origin[3];
    const double g = 9.81, turn = tilt*acos(-1)/180;
    fprintf(out, tr("// %s: %s.\n"), c->family->name, title);
    fprintf(out, tr("// Written by \"tobiuo new %s\". SI units; \"tobiuo describe\" tells any key.\n"),
            c->family->name);
    fputs("{\n", out);
    fprintf(out, "  \"method\": \"%s\",\n", c->method);
    if (c->dimension == 2)
        fprintf(out, "  \"dimension\": 2,                    // %s\n", tr("x along the tank, y up"));
    if (chosen(c, "support") > 0)
        fprintf(out, "  \"%s\": { \"support\": %.10g },           // %s\n", c->method, chosen(c, "support"),
                tr("CSML, spacings"));
    fputs("  \"domain\": { ", out);
    put_corners(c, out, origin, size);
    fprintf(out, " },     // %s\n  \"gravity\": ", tr("its sides are walls without friction"));
    put_place(c, out, g*sin(turn), 0, -g*cos(turn));
    fprintf(out, ",\n  \"spacing\": %.10g,\n", chosen(c, "spacing"));
}

static void put_world(const family_choice *c, FILE *out, const double size[3], const char *title, double tilt)
{
    put_head(c, out, size, title, tilt);
    fprintf(out, "  \"end_time\": %.10g,\n", chosen(c, "until"));
}

/* In all of the tank that is above or behind water up to `high`. */
static void put_air(const family_choice *c, FILE *out, const double high[3])
{
    const double size[3] = { chosen(c, "length"), chosen(c, "width"), chosen(c, "height") };
    const double low[2][3] = { { 0, 0, high[2] }, { high[0], 0, 0 } };
    const double top[2][3] = { { size[0], size[1], size[2] }, { size[0], size[1], high[2] } };
    const int room[2] = { high[2] < size[2], high[0] < size[0] };
    if (!(chosen(c, "air") > 0) || !(room[0] || room[1])) return;
    fprintf(out, ",\n    { \"name\": \"air\", \"density\": %.10g, \"viscosity\": 1.8e-5, \"visible\": false,"
            "     // %s\n      \"fill\": [", chosen(c, "air"), tr("cushions impacts"));
    for (int k = 0; k < 2; k++) {
        if (!room[k]) continue;
        fputs(k > 0 && room[0] ? ",\n                { \"box\": { " : " { \"box\": { ", out);
        put_corners(c, out, low[k], top[k]);
        fputs(" } }", out);
    }
    fputs(" ] }", out);
}

void put_water(const family_choice *c, FILE *out, const double low[3], const double high[3])
{
    fputs("  \"fluids\": [\n    { \"name\": \"water\", \"density\": 1000, \"viscosity\": 1.0e-3,\n"
          "      \"fill\": [ { \"box\": { ", out);
    put_corners(c, out, low, high);
    fputs(" } } ] }", out);
    put_air(c, out, high);
    fputs("\n  ],\n", out);
}

void put_probe(const family_choice *c, FILE *out, int first, const char *name, const char *kind,
                      double x, double y, double z)
{
    fprintf(out, "%s\n    { \"name\": \"%s\", ", first ? "" : ",", name);
    if (strcmp(kind, "point") != 0) fprintf(out, "\"kind\": \"%s\", ", kind);
    if (strcmp(kind, "level") == 0 && chosen(c, "air") > 0) fputs("\"fluid\": \"water\", ", out);
    fputs("\"position\": ", out);
    put_place(c, out, x, y, z);
    fputs(" }", out);
}

static void put_output(const family_choice *c, FILE *out)
{
    fprintf(out, "  \"output\": { \"interval\": %.10g }\n}\n", chosen(c, "until")/100);
}

static const char above[] = TEXT("the water is higher than the tank, --height");
static const char beyond[] = TEXT("the water is longer than the tank, --length");

/* --- static pressure ----------------------------------------------------------------------- */

static const family_option static_options[] = {
    SPACING(0.0125), UNTIL(2), TANK(0.2, 0.1, 0.15), LENGTH("depth", 0.1, TEXT("of the water")), { 0 } };

static const char *object_static(const family_choice *c)
{
    return chosen(c, "depth") > chosen(c, "height") ? above : NULL;
}

static void write_static(const family_choice *c, FILE *out)
{
    const double size[3] = { chosen(c, "length"), chosen(c, "width"), chosen(c, "height") };
    const double zero[3] = { 0 }, water[3] = { size[0], size[1], chosen(c, "depth") };
    put_world(c, out, size, tr("water at rest; sensors on the floor, at half depth on a wall, and the level"),
              0);
    put_water(c, out, zero, water);
    fputs("  \"probes\": [", out);
    put_probe(c, out, 1, "floor", "point", size[0]/2, size[1]/2, 0);
    put_probe(c, out, 0, "wall", "point", size[0], size[1]/2, water[2]/2);
    put_probe(c, out, 0, "gauge", "level", size[0]/2, size[1]/2, 0);
    fputs("\n  ],\n", out);
    put_output(c, out);
}

/* --- dam breaks ---------------------------------------------------------------------------- */

#define COLUMN(l, h) \
    LENGTH("water-length", l, TEXT("of the column of water, along x")), \
    LENGTH("water-height", h, TEXT("of the column of water"))

static const family_option dam_options[] = {
    SPACING(0.01), UNTIL(1), TANK(1, 0.15, 0.5), COLUMN(0.3, 0.25), AIR, { 0 } };
static const family_option lobovsky_options[] = {
    SPACING(0.015), UNTIL(1.1), LENGTH("water-height", 0.3, TEXT("0.3 or 0.6 in the experiment")),
    LENGTH("height", 0.6, TEXT("of the computed air and water")),
    { "gate-speed", "m/s", 0, 0, 100, TEXT("of a gate drawn up at time 0; 0: the water is let go at once"),
      0 },
    { 0 } };
static const family_option kamra_options[] = {
    SPACING(0.015), UNTIL(1), COLUMN(0.2, 0.2), LENGTH("height", 0.6, TEXT("of the tank")),
    { "post", "1", 1, 0, 2, TEXT("1: square, 0.05 m wide; 2: round, 0.05 m across; 0: none"), 0 }, { 0 } };
static const family_option impact_options[] = {
    SPACING(0.04), UNTIL(1.5), COLUMN(1.228, 0.55), TANK(3.22, 1, 1),
    LENGTH("box-length", 0.16, TEXT("of the box that is hit, along x")),
    ACROSS("box-width", 0.4, TEXT("of the box, along y")),
    LENGTH("box-height", 0.16, TEXT("of the box")),
    LENGTH("box-at", 2.4, TEXT("where the box begins, along x")), { 0 } };

static const char *object_dam(const family_choice *c)
{
    if (chosen(c, "water-height") > chosen(c, "height")) return above;
    return chosen(c, "water-length") >= chosen(c, "length") ? beyond : NULL;
}

static void write_dam(const family_choice *c, FILE *out)
{
    const double size[3] = { chosen(c, "length"), chosen(c, "width"), chosen(c, "height") }, zero[3] = { 0 };
    const double water[3] = { chosen(c, "water-length"), size[1], chosen(c, "water-height") };
    put_world(c, out, size, tr("a column of water collapses and hits the far wall"), 0);
    put_water(c, out, zero, water);
    fputs("  \"probes\": [", out);
    put_probe(c, out, 1, "floor", "point", 0, size[1]/2, 0);
    put_probe(c, out, 0, "wall", "point", size[0], size[1]/2, 0.1*water[2]);
    put_probe(c, out, 0, "gauge", "level", (size[0] + water[0])/2, size[1]/2, 0);
    fputs("\n  ],\n", out);
    put_output(c, out);
}

static const char *object_lobovsky(const family_choice *c)
{
    return chosen(c, "water-height") > chosen(c, "height") ? above : NULL;
}

static void put_gate(const family_choice *c, FILE *out, double at, double width)
{
    const double speed = chosen(c, "gate-speed"), d = chosen(c, "spacing"), thick = fmax(2*d, 0.01);
    const double low[3] = { at, 0, 0 }, high[3] = { at + thick, width, chosen(c, "water-height") };
    if (!(speed > 0)) return;
    fputs("  \"bodies\": [\n    { \"name\": \"gate\", \"box\": { ", out);
    put_corners(c, out, low, high);
    fputs(" },\n      \"motion\": { \"translation\": { \"velocity\": ", out);
    put_place(c, out, 0, 0, speed);
    fputs(" } } }\n  ],\n", out);
}

static void write_lobovsky(const family_choice *c, FILE *out)
{
    static const double gauges[] = { 0.3, 0.865, 1.114, 1.3625 };
    static const double heights[] = { 0.003, 0.015, 0.03, 0.08 };
    const double size[3] = { 1.61, 0.15, chosen(c, "height") }, zero[3] = { 0 };
    const double water[3] = { 0.6, size[1], chosen(c, "water-height") };
    char name[16];
    put_world(c, out, size, tr("the dam break of Lobovsky et al., Ocean Eng. 82 (2014) 150"), 0);
    put_water(c, out, zero, water);
    put_gate(c, out, water[0], size[1]);
    fputs("  \"probes\": [", out);
    for (int k = 0; k < 4; k++) {
        snprintf(name, sizeof name, "P%d", k + 1);
        put_probe(c, out, k == 0, name, "point", size[0], size[1]/2, heights[k]);
    }
    put_probe(c, out, 0, "P2L", "point", size[0], 0.05625, heights[1]);
    for (int k = 0; k < 4; k++) {
        snprintf(name, sizeof name, "H%d", k + 1);
        put_probe(c, out, 0, name, "level", gauges[k], size[1]/2, 0);
    }
    fputs("\n  ],\n", out);
    put_output(c, out);
}

static const char *object_kamra(const family_choice *c)
{
    if (chosen(c, "water-height") > chosen(c, "height")) return above;
    return chosen(c, "water-length") >= 0.6 ? TEXT("the water reaches the post, 0.6 m from the wall") : NULL;
}

static void write_kamra(const family_choice *c, FILE *out)
{
    const double size[3] = { 0.8, 0.2, chosen(c, "height") }, zero[3] = { 0 };
    const double water[3] = { chosen(c, "water-length"), size[1], chosen(c, "water-height") };
    const double low[3] = { 0.6, 0.075, 0 }, high[3] = { 0.65, 0.125, size[2] };
    put_world(c, out, size, tr("a dam breaks on a post that stands in the tank (Kamra et al. 2019)"), 0);
    put_water(c, out, zero, water);
    if (chosen(c, "post") == 1) {
        fputs("  \"bodies\": [ { \"name\": \"post\", \"box\": { ", out);
        put_corners(c, out, low, high);
        fputs(" } } ],\n", out);
    } else if (chosen(c, "post") == 2) {
        fputs("  \"bodies\": [ { \"name\": \"post\", \"cylinder\": { \"radius\": 0.025, \"start\": ", out);
        put_place(c, out, 0.625, 0.1, low[2]);
        fputs(", \"end\": ", out);
        put_place(c, out, 0.625, 0.1, high[2]);
        fputs(" } } ],\n", out);
    }
    fputs("  \"probes\": [", out);
    put_probe(c, out, 1, "post", "point", 0.6, 0.1, 0.011);
    put_probe(c, out, 0, "wall", "point", 0.8, 0.1, 0.004);
    fputs("\n  ],\n", out);
    put_output(c, out);
}

static const char *object_impact(const family_choice *c)
{
    if (chosen(c, "box-at") + chosen(c, "box-length") >= chosen(c, "length"))
        return TEXT("the box does not fit into the tank");
    if (chosen(c, "box-width") > chosen(c, "width")) return TEXT("the box is wider than the tank");
    if (chosen(c, "water-length") >= chosen(c, "box-at")) return TEXT("the water reaches the box");
    return object_dam(c);
}

static void write_impact(const family_choice *c, FILE *out)
{
    const double size[3] = { chosen(c, "length"), chosen(c, "width"), chosen(c, "height") }, zero[3] = { 0 };
    const double water[3] = { chosen(c, "water-length"), size[1], chosen(c, "water-height") };
    const double at = chosen(c, "box-at"), half = chosen(c, "box-width")/2, up = chosen(c, "box-height");
    const double low[3] = { at, size[1]/2 - half, 0 };
    const double high[3] = { at + chosen(c, "box-length"), size[1]/2 + half, up };
    put_world(c, out, size, tr("a dam breaks onto a box, as in SPHERIC test 2 (Kleefsman et al. 2005)"), 0);
    put_water(c, out, zero, water);
    fputs("  \"bodies\": [ { \"name\": \"box\", \"box\": { ", out);
    put_corners(c, out, low, high);
    fputs(" } } ],\n  \"probes\": [", out);
    for (int k = 0; k < 4; k++) {
        char name[16];
        snprintf(name, sizeof name, "P%d", k + 1);
        put_probe(c, out, k == 0, name, "point", at, size[1]/2 - 0.07*half, up*(0.13 + 0.25*k));
    }
    put_probe(c, out, 0, "gauge", "level", (water[0] + at)/2, size[1]/2, 0);
    fputs("\n  ],\n", out);
    put_output(c, out);
}

/* --- sloshing ------------------------------------------------------------------------------ */

static const family_option slosh_options[] = {
    SPACING(0.02), UNTIL(4), TANK(0.9, 0.1, 0.5), LENGTH("depth", 0.2, TEXT("of the water")),
    { "angle", "degrees", 4, -45, 45, TEXT("that the end at --length is lowered by, first"), 0 },
    { "period", "s", 0, 0, 1e5, TEXT("of its turns, which grow for a fifth of it; 0: tilted at once"), 0 },
    AIR, { 0 } };

/* The turn to and fro as a frame: the tank stands still, gravity and inertia turn. A positive angle lowers
   the far end first: about y in 3-D, against z in 2-D, where y is up. */
static void put_frame(const family_choice *c, FILE *out, const double size[3])
{
    if (!(chosen(c, "period") > 0)) return;
    const int flat = c->dimension == 2;
    fprintf(out, "  \"frame\": { \"%s\": { \"amplitude\": %.10g, \"period\": %.10g, \"ramp\": %.10g,\n"
            "    \"centre\": ", flat ? "yaw" : "pitch", flat ? -chosen(c, "angle") : chosen(c, "angle"),
            chosen(c, "period"), chosen(c, "period")/5);
    put_place(c, out, size[0]/2, size[1]/2, 0);
    fputs(" } },\n", out);
}

static void write_slosh(const family_choice *c, FILE *out)
{
    const double size[3] = { chosen(c, "length"), chosen(c, "width"), chosen(c, "height") };
    const double zero[3] = { 0 }, water[3] = { size[0], size[1], chosen(c, "depth") };
    put_world(c, out, size, tr("water swings in a tank that is tilted; all is seen from the tank"),
              chosen(c, "period") > 0 ? 0 : chosen(c, "angle"));
    put_frame(c, out, size);
    put_water(c, out, zero, water);
    fputs("  \"probes\": [", out);
    put_probe(c, out, 1, "left", "level", 0, size[1]/2, 0);
    put_probe(c, out, 0, "right", "level", size[0], size[1]/2, 0);
    put_probe(c, out, 0, "wall", "point", size[0], size[1]/2, water[2]/2);
    fputs("\n  ],\n", out);
    put_output(c, out);
}

/* --- a hose -------------------------------------------------------------------------------- */

static const family_option hose_options[] = {
    SPACING(0.005), UNTIL(1), TANK(0.06, 0.06, 0.12),
    LENGTH("depth", 0.015, TEXT("of the water at the start")),
    LENGTH("diameter", 0.02, TEXT("of the hose")),
    { "speed", "m/s", 0.5, 1e-6, 1e3, TEXT("of the water in the hose"), 0 }, { 0 } };

static const char *object_hose(const family_choice *c)
{
    const double width = c->dimension == 2 ? chosen(c, "length") : fmin(chosen(c, "length"), chosen(c,
        "width"));
    if (chosen(c, "depth") > 0.7*chosen(c,
                                        "height")) return TEXT("the glass is full before the hose begins");
    return chosen(c, "diameter") > width ? TEXT("the hose is wider than the glass") : NULL;
}

/* The domain is the glass, and holds the end of the hose above it. */
static void write_hose(const family_choice *c, FILE *out)
{
    const double d = chosen(c, "spacing"), up = chosen(c, "height");
    const double size[3] = { chosen(c, "length"), chosen(c, "width"), up + 6*d };
    const double zero[3] = { 0 }, water[3] = { size[0], size[1], chosen(c, "depth") };
    const double wide = chosen(c, "diameter");
    put_world(c, out, size, tr("a hose fills a glass"), 0);
    put_water(c, out, zero, water);
    fputs("  \"inlets\": [ { \"name\": \"hose\", \"centre\": ", out);
    put_place(c, out, size[0]/2, size[1]/2, 0.8*up);
    fputs(", \"normal\": ", out);
    put_place(c, out, 0, 0, -1);
    fprintf(out, ", \"%s\": %.10g, \"speed\": %.10g } ],\n", c->dimension == 2 ? "width" : "radius",
            c->dimension == 2 ? wide : wide/2, chosen(c, "speed"));
    fputs("  \"probes\": [", out);
    put_probe(c, out, 1, "gauge", "level", 0, size[1]/2, 0);
    put_probe(c, out, 0, "floor", "point", size[0]/2, size[1]/2, 0);
    fputs(",\n    { \"name\": \"glass\", \"kind\": \"volume\", \"position\": ", out);
    put_place(c, out, size[0]/2, size[1]/2, 0.4*up);
    fprintf(out, ", \"length\": %.10g, ", size[0]);
    if (c->dimension == 3) fprintf(out, "\"width\": %.10g, ", size[1]);
    fprintf(out, "\"height\": %.10g }\n  ],\n", 0.8*up);
    put_output(c, out);
}

static const family families[] = {
    { "static_pressure", TEXT("water at rest in a tank"), static_options, 1, object_static, write_static },
    { "dam_break", TEXT("a column of water collapses in a tank"), dam_options, 1, object_dam, write_dam },
    { "lobovsky", TEXT("the dam break of Lobovsky et al. (2014), with its sensors"), lobovsky_options, 1,
      object_lobovsky, write_lobovsky },
    { "kamra", TEXT("a dam breaks on a square or round post (Kamra et al. 2019)"), kamra_options, 0,
      object_kamra, write_kamra },
    { "sloshing", TEXT("water swings in a tank that is tilted, at once or to and fro"), slosh_options, 1,
      object_static,
      write_slosh },
    { "wave_tank", TEXT("a piston makes regular waves, which end on a beach, or a solitary one"),
      wave_options, 1,
      object_wave, write_wave },
    { "hose", TEXT("a hose fills a glass"), hose_options, 1, object_hose, write_hose },
    { "wave_impact", TEXT("a dam breaks onto a box (SPHERIC test 2)"), impact_options, 1, object_impact,
      write_impact },
};

const family *family_at(int index)
{
    return index >= 0 && index < (int)(sizeof families/sizeof *families) ? &families[index] : NULL;
}
