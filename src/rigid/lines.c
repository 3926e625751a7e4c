/* Forces of lines at an instant: a spring by its stretch, a rope only when it is taut, a mooring line as the
   catenary that is in equilibrium at each instant. Drawback: no inertia and no drag of the line. */
#include "rigid/lines.h"
#include "geom/vec3.h"
#include <math.h>
#include <string.h>

/* m from the domain's lower corner, and m/s, of a place of a body. */
static void find_end(const tobi_rigid *r, const double local[3], double place[3], double velocity[3])
{
    double arm[3], spin[3], turn[3][3];
    tobi_quaternion_matrix(r->orientation, turn);
    for (int a = 0; a < 3; a++) arm[a] = vec3_dot(turn[a], local);
    vec3_cross(spin, r->angular_velocity, arm);
    vec3_add_scaled(place, r->position, 1, arm);
    vec3_add_scaled(velocity, r->velocity, 1, spin);
}

/* Where the upper end is, m, for the pulls H and V at it. */
static void hang(const tobi_line *l, double h, double v, double *span, double *height)
{
    const double w = l->weight, whole = w*l->length, ea = l->stiffness*l->length, a = v/h;
    if (l->rests && v < whole) {
        *span = l->length - v/w + h/w*asinh(a) + h*l->length/ea;
        *height = h/w*(sqrt(1 + a*a) - 1) + v*v/(2*ea*w);
        return;
    }
    const double b = (v - whole)/h;
    *span = h/w*(asinh(a) - asinh(b)) + h*l->length/ea;
    *height = h/w*(sqrt(1 + a*a) - sqrt(1 + b*b)) + l->length/ea*(v - 0.5*whole);
}

enum { HALVINGS = 60 };

/* V that lifts the upper end so high, for a given H; the height rises with V. */
static double find_vertical(const tobi_line *l, double h, double height)
{
    double low = 0, high = l->weight*l->length + l->stiffness*(height + l->length), span, at;
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5*(low + high);
        hang(l, h, middle, &span, &at);
        if (at < height) low = middle;
        else high = middle;
    }
    return 0.5*(low + high);
}

void tobi_catenary(const tobi_line *l, double span, double height, double pull[2])
{
    const double whole = l->weight*l->length;
    double low = log(1e-9*whole), high = log(whole + l->stiffness*(span + height + l->length));
    double at, level;
    if (l->rests && span + height <= l->length) {          /* slack: it hangs straight down */
        pull[0] = 0;
        pull[1] = l->weight*height;
        return;
    }
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5*(low + high), h = exp(middle);
        hang(l, h, find_vertical(l, h, height), &at, &level);
        if (at < span) low = middle;
        else high = middle;
    }
    pull[0] = exp(0.5*(low + high));
    pull[1] = find_vertical(l, pull[0], height);
}

/* A mooring line, whose other end is at `way` from the body's. */
static void pull_catenary(tobi_line *l, const double way[3])
{
    const double rise = vec3_dot(way, l->up);
    double level[3], pull[2];
    vec3_add_scaled(level, way, -rise, l->up);
    const double span = vec3_length(level);
    tobi_catenary(l, span, fabs(rise), pull);
    double lower = pull[1] - l->weight*l->length;                  /* what it lifts its lower end with */
    if (l->rests) lower = fmax(lower, 0);
    for (int a = 0; a < 3; a++) {
        const double across = span > 0 ? pull[0]/span*level[a] : 0;
        l->now[0].force[a] = across + (rise <= 0 ? -pull[1] : lower)*l->up[a];
        l->now[1].force[a] = -across + (rise <= 0 ? lower : -pull[1])*l->up[a];
    }
    l->info.tension = vec3_length(l->now[0].force);
}

/* A spring or a rope, which grows by `opening` m/s. */
static void pull_straight(tobi_line *l, const double way[3], double opening)
{
    const double distance = l->info.distance, stretch = distance - l->length;
    double pull = l->stiffness*stretch, damp = l->damping*opening;
    if (l->kind == TOBI_LINE_ROPE) {
        pull = fmax(pull, 0);
        damp = stretch > 0 ? fmax(damp, -pull) : 0;
    }
    for (int a = 0; a < 3; a++) {
        const double toward = distance > 0 ? way[a]/distance : 0;
        l->now[0].force[a] = pull*toward;
        l->damped[0].force[a] = damp*toward;
        l->now[1].force[a] = -pull*toward;
        l->damped[1].force[a] = -damp*toward;
    }
    l->info.tension = pull + damp;
}

static void set_torques(tobi_line *l, int end, const double place[3], const tobi_rigid *r)
{
    double arm[3];
    vec3_sub(arm, place, r->position);
    vec3_cross(l->now[end].torque, arm, l->now[end].force);
    vec3_cross(l->damped[end].torque, arm, l->damped[end].force);
}

void tobi_line_update(tobi_line *l, const tobi_body *bodies)
{
    tobi_line_info *info = &l->info;
    const tobi_body *b = &bodies[l->body];
    double from[3], to[3], velocity[3], other[3] = { 0 }, way[3], apart[3];
    memcpy(l->before, l->now, sizeof l->before);
    find_end(&b->rigid, l->point, from, velocity);
    memcpy(to, l->to, sizeof to);
    if (l->to_body >= 0) find_end(&bodies[l->to_body].rigid, l->to, to, other);
    vec3_sub(way, to, from);
    vec3_sub(apart, other, velocity);
    info->distance = vec3_length(way);
    if (l->kind == TOBI_LINE_CATENARY) pull_catenary(l, way);
    else pull_straight(l, way, info->distance > 0 ? vec3_dot(apart, way)/info->distance : 0);
    set_torques(l, 0, from, &b->rigid);
    if (l->to_body >= 0) set_torques(l, 1, to, &bodies[l->to_body].rigid);
    vec3_add_scaled(info->force, l->now[0].force, 1, l->damped[0].force);
    vec3_add_scaled(info->point, b->lower, 1, from);
    vec3_add_scaled(info->to, b->lower, 1, to);
}

static void add(tobi_line_load *sum, double factor, const tobi_line_load *load)
{
    vec3_add_scaled(sum->force, sum->force, factor, load->force);
    vec3_add_scaled(sum->torque, sum->torque, factor, load->torque);
}

void tobi_lines_add(const tobi_line *lines, int count, int body, tobi_line_when when, tobi_line_load *load)
{
    for (int k = 0; k < count; k++)
        for (int end = 0; end < 2; end++) {
            const tobi_line *l = &lines[k];
            if ((end ? l->to_body : l->body) != body) continue;
            if (when != TOBI_LINES_DAMPING) add(load, when == TOBI_LINES_NOW ? 1 : 0.5, &l->now[end]);
            if (when == TOBI_LINES_MEAN) add(load, 0.5, &l->before[end]);
            if (when != TOBI_LINES_NOW) add(load, 1, &l->damped[end]);
        }
}

/* Integral of the tension hypot(H, V) over V, from 0, N2. */
static double sum_tension(double h, double v)
{
    return 0.5*(v*hypot(h, v) + (h > 0 ? h*h*asinh(v/h) : 0));
}

/* What it takes to stretch a catenary and to lift it off its lower end: pulls H and V at its upper end. */
static double lift(const tobi_line *l, double h, double v)
{
    const double w = l->weight, ea = l->stiffness*l->length;
    const double low = l->rests ? fmax(v - w*l->length, 0) : v - w*l->length, free = (v - low)/w;
    const double rise = (sum_tension(h, v) - sum_tension(h, low))/w - free*hypot(h, low);
    if (!(h > 0)) return rise;       /* slack: the stretch is left out there */
    return rise + w/ea*free*free*(0.5*low + w*free/6) +
           (h*h*l->length + (v*v*v - low*low*low)/(3*w))/(2*ea);
}

double tobi_line_energy(const tobi_line *l)
{
    const tobi_line_info *i = &l->info;
    double way[3], level[3], pull[2];
    if (l->kind != TOBI_LINE_CATENARY) {
        double stretch = i->distance - l->length;
        if (l->kind == TOBI_LINE_ROPE) stretch = fmax(stretch, 0);
        return 0.5*l->stiffness*stretch*stretch;
    }
    vec3_sub(way, i->to, i->point);
    const double rise = vec3_dot(way, l->up);
    vec3_add_scaled(level, way, -rise, l->up);
    tobi_catenary(l, vec3_length(level), fabs(rise), pull);
    const double low = l->rests ? 0 : vec3_dot(rise < 0 ? i->to : i->point, l->up);
    return lift(l, pull[0], pull[1]) + l->weight*l->length*low;
}

double tobi_line_power(const tobi_line *l, const tobi_body *bodies)
{
    double sum = 0;
    for (int end = 0; end < 2; end++) {
        const int body = end ? l->to_body : l->body;
        double u[6];
        if (body < 0) continue;
        tobi_body_mean_velocity(&bodies[body], u);
        sum -= vec3_dot(l->damped[end].force, u) + vec3_dot(l->damped[end].torque, u + 3);
    }
    return sum;
}

/* m from the upper end of a catenary, out and down, after the share t of its length. */
static void go_along(const tobi_line *l, const double pull[2], double t, double *out, double *down)
{
    const double h = pull[0], w = l->weight, along = t*l->length, air = fmin(along, fmax(pull[1], 0)/w);
    const double lying = l->rests ? along - air : 0, hanging = along - lying, v = pull[1] - w*hanging;
    *out = lying;
    *down = hanging*(pull[1] - 0.5*w*hanging)/(l->stiffness*l->length);
    if (!(h > 0)) *down += hanging;
    else {
        *out += h/w*(asinh(pull[1]/h) - asinh(v/h)) + h*along/(l->stiffness*l->length);
        *down += (hypot(h, pull[1]) - hypot(h, v))/w;
    }
}

void tobi_line_shape(const tobi_line *l, int count, double (*points)[3])
{
    const double *from = l->info.point, *to = l->info.to;
    double way[3], level[3], pull[2] = { 0 };
    vec3_sub(way, to, from);
    const double rise = vec3_dot(way, l->up);
    const int hangs = l->kind == TOBI_LINE_CATENARY, turned = hangs && rise > 0;      /* upper end first */
    vec3_add_scaled(level, way, -rise, l->up);
    const double span = vec3_length(level);
    if (hangs) tobi_catenary(l, span, fabs(rise), pull);
    for (int k = 0; k < count; k++) {
        const double t = (double)k/(count - 1);
        double out = t, down = 0;
        if (hangs) {
            go_along(l, pull, t, &out, &down);
            out = span > 0 ? out/span*(turned ? -1 : 1) : 0;
        }
        for (int a = 0; a < 3; a++)
            points[k][a] = (turned ? to : from)[a] + out*(hangs ? level : way)[a] - down*l->up[a];
    }
}

/* 1/kg: how an impulse at a place, from the centre, moves it, at most. */
static double mobility(const tobi_body *b, const double local[3])
{
    if (b->rigid.kind == TOBI_PRESCRIBED) return 0;
    double least = fmin(fmin(b->rigid.inertia[0], b->rigid.inertia[4]), b->rigid.inertia[8]);
    const double arm = vec3_dot(local, local);
    return 1/b->rigid.mass + (arm > 0 && least > 0 ? arm/least : 0);
}

double tobi_lines_step_limit(const tobi_line *lines, int count, const tobi_body *bodies)
{
    double limit = INFINITY;
    for (int k = 0; k < count; k++) {
        const tobi_line *l = &lines[k];
        double m = mobility(&bodies[l->body], l->point);
        if (l->to_body >= 0) m += mobility(&bodies[l->to_body], l->to);
        if (!(m > 0)) continue;
        if (l->stiffness > 0) limit = fmin(limit, 1/(3*sqrt(l->stiffness*m)));
        if (l->damping > 0) limit = fmin(limit, 1/(3*l->damping*m));
    }
    return limit;
}
