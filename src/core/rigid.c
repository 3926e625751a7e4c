/* Drift of a rigid body by implicit midpoint in the body frame, which keeps its energy and, to the
   last bit, its angular momentum. Drawback: a turn of radians in one step has no solution and is told. */
#include "core/rigid.h"
#include "geom/vec3.h"
#include <stdio.h>
#include <string.h>

#define FRICTION 0.5     /* of two bodies that give none */

enum { ALL_SHIFTS = 7, ALL_TURNS = 56 };

static int bits_of(const tobi_rigid *r) { return r->locked | (int)r->hold; }

void tobi_quaternion_matrix(const double q[4], double m[3][3])
{
    double w = q[0], x = q[1], y = q[2], z = q[3];
    m[0][0] = 1 - 2*(y*y + z*z); m[0][1] = 2*(x*y - w*z);     m[0][2] = 2*(x*z + w*y);
    m[1][0] = 2*(x*y + w*z);     m[1][1] = 1 - 2*(x*x + z*z); m[1][2] = 2*(y*z - w*x);
    m[2][0] = 2*(x*z - w*y);     m[2][1] = 2*(y*z + w*x);     m[2][2] = 1 - 2*(x*x + y*y);
}

void tobi_rigid_between(const tobi_rigid *a, const tobi_rigid *b, double turn[3][3], double shift[3])
{
    double ma[3][3], mb[3][3], d[3];
    tobi_quaternion_matrix(a->orientation, ma);
    tobi_quaternion_matrix(b->orientation, mb);
    vec3_sub(d, a->position, b->position);
    for (int i = 0; i < 3; i++) {
        shift[i] = mb[0][i]*d[0] + mb[1][i]*d[1] + mb[2][i]*d[2];
        for (int j = 0; j < 3; j++) turn[i][j] = mb[0][i]*ma[0][j] + mb[1][i]*ma[1][j] + mb[2][i]*ma[2][j];
    }
}

void tobi_quaternion_product(const double p[4], const double q[4], double out[4])
{
    double r[4] = { p[0]*q[0] - p[1]*q[1] - p[2]*q[2] - p[3]*q[3],
                    p[0]*q[1] + p[1]*q[0] + p[2]*q[3] - p[3]*q[2],
                    p[0]*q[2] - p[1]*q[3] + p[2]*q[0] + p[3]*q[1],
                    p[0]*q[3] + p[1]*q[2] - p[2]*q[1] + p[3]*q[0] };
    memcpy(out, r, sizeof r);
}

static void normalize(double q[4])
{
    double size = sqrt(q[0]*q[0] + q[1]*q[1] + q[2]*q[2] + q[3]*q[3]);
    for (int k = 0; k < 4; k++) q[k] /= size;
}

void tobi_quaternion_turn(double q[4], const double w[3])
{
    double turn[4] = { 1, 0.5*w[0], 0.5*w[1], 0.5*w[2] };
    tobi_quaternion_product(turn, q, q);
    normalize(q);
}

static void multiply(const double m[9], const double v[3], double out[3])
{
    for (int a = 0; a < 3; a++) out[a] = m[3*a]*v[0] + m[3*a + 1]*v[1] + m[3*a + 2]*v[2];
}

/* The cofactors of a matrix over its determinant. */
int tobi_rigid_invert(const double m[9], double out[9])
{
    double c[9];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1)%3, i2 = (i + 2)%3, j1 = (j + 1)%3, j2 = (j + 2)%3;
            c[3*j + i] = m[3*i1 + j1]*m[3*i2 + j2] - m[3*i1 + j2]*m[3*i2 + j1];
        }
    double det = m[0]*c[0] + m[1]*c[3] + m[2]*c[6];
    for (int k = 0; k < 9; k++) out[k] = c[k]/det;
    return det > 0;
}

int tobi_rigid_axes(const char *words, char unknown[32])
{
    static const char *const names[] = { "x", "y", "z", "turn_x", "turn_y", "turn_z", "shift", "turn" };
    static const int bits[] = { 1, 2, 4, 8, 16, 32, ALL_SHIFTS, ALL_TURNS };
    int sum = 0;
    for (const char *word = words; word && *word;) {
        size_t n = strcspn(word, ", "), k = 0;
        while (k < 8 && (strlen(names[k]) != n || strncmp(names[k], word, n) != 0)) k++;
        if (n > 0 && k == 8) {
            snprintf(unknown, 32, "%.*s", (int)(n < 31 ? n : 31), word);
            return -1;
        }
        if (n > 0) sum |= bits[k];
        word += n + (word[n] != '\0');
    }
    return sum;
}

/* Is tr(I)/2 - I, the second moments of the mass, free of negative ones? So that no principal moment is
   larger than the sum of the other two; thin plates and rods are on the limit. */
static int is_of_mass(const double m[9])
{
    double half = 0.5*(m[0] + m[4] + m[8]), second[9], unused[9];
    for (int k = 0; k < 9; k++) second[k] = (k%4 ? 0 : half*(1 + 1e-6)) - m[k];
    double minor = second[0]*second[4] - second[1]*second[3];
    return second[0] > 0 && minor > 0 && tobi_rigid_invert(second, unused);
}

/* A mesh gives an inertia that a body can have; numbers of the scene may not. */
static tobi_status set_inertia(tobi_rigid *r, const tobi_body_def *def, const tobi_massprops *rest,
                               int dimension, tobi_error *err)
{
    const double *d = def->inertia, *o = def->inertia_products;
    double density = r->mass/rest->volume;
    const int given = d[0] != 0 || d[1] != 0 || d[2] != 0;
    for (int k = 0; k < 9; k++) r->inertia[k] = density*rest->inertia[k];
    if (!given && (o[0] != 0 || o[1] != 0 || o[2] != 0))
        return tobi_fail(err, TOBI_INVALID, "body '%s': products of inertia need the inertia, too",
                         def->name ? def->name : "");
    if (given) {
        double matrix[9] = { d[0], o[0], o[1], o[0], d[1], o[2], o[1], o[2], d[2] };
        memcpy(r->inertia, matrix, sizeof matrix);
    }
    if (r->kind == TOBI_PRESCRIBED) return TOBI_OK;
    const double *m = r->inertia;
    double minor = m[0]*m[4] - m[1]*m[3];
    if (dimension == 2 && m[8] > 0) return TOBI_OK;
    if (dimension == 3 && m[0] > 0 && minor > 0 && tobi_rigid_invert(m, r->inverse)) {
        if (!given || is_of_mass(m)) return TOBI_OK;
        return tobi_fail(err, TOBI_INVALID,
                         "body '%s': no body has the inertia (%g, %g, %g) kg m2 with products (%g, %g, %g): "
                         "each of its principal moments must be at most the sum of the other two",
                         def->name ? def->name : "", m[0], m[4], m[8], m[1], m[2], m[5]);
    }
    return tobi_fail(err, TOBI_INVALID,
                     "body '%s': the inertia (%g, %g, %g) kg m2 with products (%g, %g, %g) is not positive "
                     "definite", def->name ? def->name : "", m[0], m[4], m[8], m[1], m[2], m[5]);
}

static tobi_status set_locks(tobi_rigid *r, const tobi_body_def *def, int dimension, tobi_error *err)
{
    char unknown[32];
    r->locked = tobi_rigid_axes(def->locked, unknown);
    if (r->locked < 0)
        return tobi_fail(err, TOBI_INVALID,
                         "body '%s': locked has '%s'; allowed are x, y, z, turn_x, turn_y, turn_z, shift "
                         "(all three) and turn (all three)", def->name ? def->name : "", unknown);
    /* "shift" and "turn" have them */
    const int flat = ((r->locked & ALL_SHIFTS) == ALL_SHIFTS ? 0 : 4) |
                     ((r->locked & ALL_TURNS) == ALL_TURNS ? 0 : 8 | 16);
    if (dimension == 2 && r->locked & flat)
        return tobi_at_key(err, tobi_fail(err, TOBI_INVALID, "body '%s': locked is '%s', and in 2-D there "
                                          "are x, y and turn_z; shift and turn are all of them",
                                          def->name ? def->name : "", def->locked), "locked");
    if (dimension == 2) r->locked |= 4 | 8 | 16;
    int turns = r->locked & ALL_TURNS;
    if (turns == 8 || turns == 16 || turns == 32)
        return tobi_fail(err, TOBI_UNSUPPORTED,
                         "body '%s': the turn about one axis is locked; allowed are none, two and three",
                         def->name ? def->name : "");
    return TOBI_OK;
}

/* A motion of a body that moves by forces changes its shape, and nothing else of it is given. */
static tobi_status check_swimmer(const tobi_body_def *def, const char *name, tobi_error *err)
{
    if (!def->motion) return TOBI_OK;
    if (def->motion_rigid)
        return tobi_fail(err, TOBI_INVALID,
                         "body '%s' is %s and has a rigid motion; the motion of a body that moves by forces "
                         "changes its shape: a script with deform, see docs/swimmers.md", name,
                         def->dynamics == TOBI_FREE ? "free" : "controlled");
    if (def->centre_of_mass[0] != TOBI_NO_PLACE)
        return tobi_fail(err, TOBI_INVALID, "body '%s' changes its shape, so that its centre of mass follows "
                         "from the shape", name);
    if (vec3_dot(def->inertia, def->inertia) > 0)
        return tobi_fail(err, TOBI_INVALID, "body '%s' changes its shape, so that its inertia follows from "
                         "the shape; give mass or density instead of inertia", name);
    const double *hinge = def->hinge_axis, *guide = def->guide_axis;
    const int joined = vec3_dot(hinge, hinge) + vec3_dot(guide, guide) > 0;
    if (def->vessel || def->blade || joined)
        return tobi_fail(err, TOBI_UNSUPPORTED, "body '%s' changes its shape and moves by forces; a %s does "
                         "not", name, joined ? tr("body on a hinge or guide") : def->vessel ? tr("vessel")
                         : tr("blade"));
    return TOBI_OK;
}

static tobi_status check_moving(const tobi_body_def *def, tobi_error *err)
{
    const char *name = def->name ? def->name : "";
    if (def->dynamics == TOBI_PRESCRIBED) {
        const double *given[] = { def->velocity, def->angular_velocity, def->force, def->torque };
        double sum = def->air_resistance;
        for (int k = 0; k < 4; k++) sum += vec3_dot(given[k], given[k]);
        if (sum > 0 || def->locked)
            return tobi_fail(err, TOBI_INVALID,
                             "body '%s' is prescribed: velocities, force, torque, air resistance and locked "
                             "axes are for free and controlled bodies", name);
        if (!def->control) return TOBI_OK;
        return tobi_fail(err, TOBI_INVALID, "body '%s' has a control program but is not controlled", name);
    }
    TOBI_TRY(check_swimmer(def, name, err));
    if (def->dynamics == TOBI_CONTROLLED && !def->control)
        return tobi_fail(err, TOBI_INVALID, "body '%s' is controlled but has no control program", name);
    if (def->dynamics == TOBI_FREE && def->control)
        return tobi_fail(err, TOBI_INVALID, "body '%s' has a control program but is not controlled", name);
    return TOBI_OK;
}

/* A start along or about a locked axis would be dropped without a word. */
static tobi_status check_start(const tobi_rigid *r, const tobi_body_def *def, const char *key,
                               const double given[3], const double has[3], tobi_error *err)
{
    if (!r->locked || !(vec3_distance2(given, has) > 1e-12*vec3_dot(given, given))) return TOBI_OK;
    const tobi_status status = tobi_fail(err, TOBI_INVALID, "body '%s' cannot start with that %s: what is "
                                         "locked stays at rest; a line or joint to a body with a motion "
                                         "tows it", def->name ? def->name : "", key);
    return tobi_at_key(err, status, "%s", key);
}

tobi_status tobi_rigid_init(tobi_rigid *r, const tobi_body_def *def, const tobi_massprops *rest,
                            const double centre[3], int dimension, tobi_error *err)
{
    memset(r, 0, sizeof *r);
    TOBI_TRY(check_moving(def, err));
    r->kind = def->dynamics;
    r->deforms = r->kind != TOBI_PRESCRIBED && def->motion != NULL;
    r->restitution = def->restitution;
    r->yields = def->friction_coefficient == TOBI_NOT_GIVEN;
    r->friction = r->yields ? FRICTION : def->friction_coefficient;
    r->mass = def->mass > 0 ? def->mass : def->density*rest->volume;
    r->orientation[0] = r->next_orientation[0] = 1;
    memcpy(r->position, centre, sizeof r->position);
    memcpy(r->next_position, centre, sizeof r->position);
    TOBI_TRY(set_inertia(r, def, rest, dimension, err));
    TOBI_TRY(set_locks(r, def, dimension, err));
    double lower[3];
    vec3_sub(lower, rest->centre, centre);
    if (r->kind == TOBI_PRESCRIBED) return tobi_joint_init(r, def, lower, dimension, err);
    r->air_resistance = def->air_resistance;
    r->control = def->control;
    r->control_user = def->control_user;
    r->phase = 1;
    memcpy(r->force, def->force, sizeof r->force);
    memcpy(r->torque, def->torque, sizeof r->torque);
    memcpy(r->velocity, def->velocity, sizeof r->velocity);
    multiply(r->inertia, def->angular_velocity, r->momentum);
    tobi_rigid_apply_locks(r);
    TOBI_TRY(check_start(r, def, "velocity", def->velocity, r->velocity, err));
    TOBI_TRY(check_start(r, def, "angular_velocity", def->angular_velocity, r->angular_velocity, err));
    return tobi_joint_init(r, def, lower, dimension, err);
}

double tobi_rigid_friction(const tobi_rigid *a, const tobi_rigid *b)
{
    return a->yields ? b->friction : b->yields ? a->friction : sqrt(a->friction*b->friction);
}

/* --- drift ---------------------------------------------------------------------------------- */

/* Solves m = L + dt/2 m x (J m), the middle of the step's angular momenta in the body frame (R.3), by
   Newton's method. 0 if it does not settle, which takes a turn of radians in one step. */
static int find_middle(const double inverse[9], const double L[3], double dt, double m[3])
{
    double size = vec3_length(L);
    memcpy(m, L, 3*sizeof *m);
    for (int k = 0; k < 20; k++) {
        double w[3], t[3], f[3], j[9], ji[9], step[3];
        multiply(inverse, m, w);
        vec3_cross(t, m, w);
        for (int a = 0; a < 3; a++) f[a] = m[a] - L[a] - 0.5*dt*t[a];
        for (int c = 0; c < 3; c++) {
            double e[3] = { c == 0, c == 1, c == 2 }, u[3], v[3], je[3];
            multiply(inverse, e, je);
            vec3_cross(u, e, w);
            vec3_cross(v, m, je);
            for (int a = 0; a < 3; a++) j[3*a + c] = e[a] - 0.5*dt*(u[a] + v[a]);
        }
        if (!tobi_rigid_invert(j, ji)) return 0;
        multiply(ji, f, step);
        for (int a = 0; a < 3; a++) m[a] -= step[a];
        if (vec3_length(step) <= 4e-16*size) return 1;
        if (k > 4 && vec3_length(step) <= 1e-14*size) return 1;     /* as good as rounding lets it be */
    }
    return 0;
}

/* Turns q by implicit midpoint: R1 = R0 cay(dt w) with w = J m, so that R1 L1 = R0 L0 (R.4). */
static void turn_free(const tobi_rigid *r, double q[4], double dt, int depth)
{
    double m[3][3], L[3], middle[3], w[3];
    tobi_quaternion_matrix(q, m);
    for (int a = 0; a < 3; a++)
        L[a] = m[0][a]*r->momentum[0] + m[1][a]*r->momentum[1] + m[2][a]*r->momentum[2];
    if (!find_middle(r->inverse, L, dt, middle) && depth < 10) {
        turn_free(r, q, 0.5*dt, depth + 1);
        turn_free(r, q, 0.5*dt, depth + 1);
        return;
    }
    multiply(r->inverse, middle, w);
    double turn[4] = { 1, 0.5*dt*w[0], 0.5*dt*w[1], 0.5*dt*w[2] };
    tobi_quaternion_product(q, turn, q);
    normalize(q);
}

/* The same for a swimmer: the rotation A with sum m y0 x A y1 = dt L, which is the discrete equation of Moser
   & Veselov (Commun. Math. Phys. 139, 1991) for a shape that changes (R.17), by Newton's method. */
static void turn_shape(const tobi_rigid *r, double q[4], double dt)
{
    double m[3][3], L[3], way[4] = { 1, 0, 0, 0 };
    const double size = fabs(r->moments[0][0]) + fabs(r->moments[1][1]) + fabs(r->moments[2][2]);
    tobi_quaternion_matrix(q, m);
    for (int a = 0; a < 3; a++)
        L[a] = m[0][a]*r->momentum[0] + m[1][a]*r->momentum[1] + m[2][a]*r->momentum[2];
    for (int k = 0; k < 50; k++) {
        double A[3][3], now[3][3], slope[9], inverse[9], f[3], step[3];
        tobi_quaternion_matrix(way, A);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) now[i][j] = vec3_dot(r->moments[i], A[j]);
        const double trace = now[0][0] + now[1][1] + now[2][2];
        for (int i = 0; i < 3; i++) {
            f[i] = dt*L[i] - (now[(i + 1)%3][(i + 2)%3] - now[(i + 2)%3][(i + 1)%3]);
            for (int j = 0; j < 3; j++) slope[3*i + j] = (i == j ? trace : 0) - now[j][i];
        }
        if (vec3_length(f) <= 1e-17*size || !tobi_rigid_invert(slope, inverse)) break;
        multiply(inverse, f, step);
        const double most = vec3_length(step);
        for (int a = 0; a < 3 && most > 0.5; a++) step[a] *= 0.5/most;
        tobi_quaternion_turn(way, step);
        if (most <= 1e-16) break;
    }
    tobi_quaternion_product(q, way, q);
    normalize(q);
}

/* About the world's axis k alone: g sin(angle + shift) = dt L. */
static void turn_shape_about(const tobi_rigid *r, int k, double q[4], double dt)
{
    const int i = (k + 1)%3, j = (k + 2)%3;
    double m[3][3], now[3][3] = { { 0 } };
    tobi_quaternion_matrix(q, m);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int c = 0; c < 3; c++)
                for (int d = 0; d < 3; d++) now[a][b] += m[a][c]*r->moments[c][d]*m[b][d];
    const double along = now[i][i] + now[j][j], across = now[i][j] - now[j][i], g = hypot(along, across);
    if (!(g > 0)) return;
    const double half = 0.5*(asin(fmin(fmax(dt*r->momentum[k]/g, -1), 1)) - atan2(across, along));
    double turn[4] = { cos(half), 0, 0, 0 };
    turn[1 + k] = sin(half);
    tobi_quaternion_product(turn, q, q);
    normalize(q);
}

void tobi_rigid_drift_freely(tobi_rigid *r, double dt)
{
    double *q = r->next_orientation, w[3];
    int turns = bits_of(r) & ALL_TURNS;
    if (r->joint.kind) {
        tobi_joint_place(r, dt*tobi_joint_rate(r) +
                            vec3_dot(r->joint.axis, r->joint.kind == TOBI_JOINT_HINGE ? r->turn : r->push));
        return;
    }
    vec3_add_scaled(r->next_position, r->position, dt, r->velocity);
    vec3_add_scaled(r->next_position, r->next_position, 1, r->push);
    memcpy(q, r->orientation, sizeof r->orientation);
    if (turns == 0 && r->deforms) turn_shape(r, q, dt);
    else if (turns == 0 && vec3_dot(r->momentum, r->momentum) > 0) turn_free(r, q, dt, 0);
    for (int a = 0; a < 3 && r->deforms && turns != 0; a++)
        if (turns == (ALL_TURNS & ~(8 << a))) turn_shape_about(r, a, q, dt);
    if (turns != 0 && turns != ALL_TURNS && !r->deforms)
        for (int a = 0; a < 3; a++)
            if (r->angular_velocity[a] != 0) {
                double half = 0.5*dt*r->angular_velocity[a], turn[4] = { cos(half), 0, 0, 0 };
                turn[1 + a] = sin(half);
                tobi_quaternion_product(turn, q, q);
                normalize(q);
            }
    memcpy(w, r->turn, sizeof w);
    if (vec3_dot(w, w) > 0) tobi_quaternion_turn(q, w);
}

void tobi_rigid_drift_by(tobi_rigid *r, const double velocity[3], const double spin[3], double dt)
{
    double turn[3];
    if (r->joint.kind) {
        const int hinge = r->joint.kind == TOBI_JOINT_HINGE;
        tobi_joint_place(r, vec3_dot(r->joint.axis, hinge ? spin : velocity)*dt +
                            vec3_dot(r->joint.axis, hinge ? r->turn : r->push));
        r->joint.driven = 1;
        return;
    }
    tobi_rigid_drift_freely(r, dt);
    for (int a = 0; a < 3; a++) {
        r->next_position[a] += (velocity[a] - r->velocity[a])*dt;
        turn[a] = (spin[a] - r->angular_velocity[a])*dt;
    }
    tobi_quaternion_turn(r->next_orientation, turn);
}

/* Coasts by the mean of the velocities before and after the kick (R.15). */
void tobi_rigid_drift(tobi_rigid *r, double dt)
{
    double keep = tobi_rigid_keep(r, dt);
    r->is_corrected = r->is_clamped = 0;
    if (r->joint.kind) {
        tobi_joint_drift(r, dt);
        return;
    }
    tobi_rigid mean = *r;
    for (int a = 0; a < 3; a++) {
        mean.velocity[a] = 0.5*(r->velocity[a] + keep*(r->velocity[a] + dt*r->pull[a])) +
                           r->constraint[a]/r->mass;
        mean.momentum[a] = 0.5*(r->momentum[a] + keep*(r->momentum[a] + dt*r->pull_torque[a])) +
                           r->constraint[3 + a];
    }
    tobi_rigid_apply_locks(&mean);
    tobi_rigid_drift_freely(&mean, dt);
    memcpy(r->next_position, mean.next_position, sizeof r->next_position);
    memcpy(r->next_orientation, mean.next_orientation, sizeof r->next_orientation);
}

/* --- velocities ----------------------------------------------------------------------------- */

void tobi_rigid_inverse(const tobi_rigid *r, double shift[3], double turn[3][3])
{
    int bits = bits_of(r), turns = bits & ALL_TURNS;
    double m[3][3];
    memset(turn, 0, 9*sizeof(double));
    for (int a = 0; a < 3; a++)
        shift[a] = r->kind == TOBI_PRESCRIBED || r->joint.kind || (bits >> a & 1) ? 0 : 1/r->mass;
    if (r->kind == TOBI_PRESCRIBED || r->joint.kind || turns == ALL_TURNS) return;
    tobi_quaternion_matrix(r->orientation, m);
    const double *body = turns ? r->inertia : r->inverse;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++) turn[a][b] += m[a][i]*body[3*i + j]*m[b][j];
    for (int a = 0; a < 3 && turns; a++)
        for (int b = 0; b < 3; b++)
            turn[a][b] = a == b && !(turns >> (3 + a) & 1) ? 1/turn[a][b] : 0;
}

double tobi_rigid_keep(const tobi_rigid *r, double dt)
{
    const double joint = r->joint.damping > 0 ? r->joint.damping/r->joint.mass : 0;
    return exp(-(r->air_resistance + joint)*dt);
}

void tobi_rigid_answer(const tobi_rigid *r, const double f[6], double out[6])
{
    for (int a = 0; a < 3; a++) {
        out[a] = r->mobility[a]*f[a];
        out[3 + a] = vec3_dot(r->turn_mobility[a], f + 3);
    }
    if (!r->joint.kind) return;
    const double *s = r->joint_mobility, along = vec3_dot(s, f) + vec3_dot(s + 3, f + 3);
    for (int a = 0; a < 6; a++) out[a] += along*s[a];
}

int tobi_rigid_has_pull(const tobi_rigid *r)
{
    return vec3_dot(r->pull, r->pull) + vec3_dot(r->pull_torque, r->pull_torque) > 0;
}

int tobi_rigid_drop_pull(tobi_rigid *r)
{
    const int before = tobi_rigid_has_pull(r);
    memset(r->pull, 0, sizeof r->pull);
    memset(r->pull_torque, 0, sizeof r->pull_torque);
    return before;
}

void tobi_rigid_apply_locks(tobi_rigid *r)
{
    int bits = bits_of(r);
    double shift[3], turn[3][3];
    if (r->joint.kind) {
        tobi_joint_set_rate(r, tobi_joint_rate(r));
        return;
    }
    for (int a = 0; a < 3; a++) {
        if (bits >> a & 1) r->velocity[a] = 0;
        if (bits >> (3 + a) & 1) r->momentum[a] = 0;
    }
    tobi_rigid_inverse(r, shift, turn);
    for (int a = 0; a < 3; a++) r->angular_velocity[a] = vec3_dot(turn[a], r->momentum);
}

/* A point r from the centre moves by v + W r and feels a + B r with B = G + C W: the sums of both over the
   mass need its second moments S = tr(I)/2 - I alone. */
void tobi_rigid_feel(tobi_rigid *r, const tobi_acceleration *f)
{
    const double *w = r->angular_velocity;
    const double W[3][3] = { { 0, -w[2], w[1] }, { w[2], 0, -w[0] }, { -w[1], w[0], 0 } };
    double m[3][3], at[3], B[3][3], moments[3][3] = { { 0 } }, P[3][3] = { { 0 } };
    const double half = 0.5*(r->inertia[0] + r->inertia[4] + r->inertia[8]);
    tobi_quaternion_matrix(r->orientation, m);
    tobi_acceleration_at(f, r->position, at);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) at[i] += f->turning[i][k]*r->velocity[k];
        r->inertial[i] = r->mass*at[i];
        for (int j = 0; j < 3; j++) {
            B[i][j] = f->gradient[i][j];
            for (int k = 0; k < 3; k++) B[i][j] += f->turning[i][k]*W[k][j];
            for (int a = 0; a < 3; a++)
                for (int b = 0; b < 3; b++)
                    moments[i][j] += m[i][a]*((a == b ? half : 0) - r->inertia[3*a + b])*m[j][b];
        }
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) P[i][j] += B[i][k]*moments[k][j];
    for (int i = 0; i < 3; i++) r->inertial[3 + i] = P[(i + 2)%3][(i + 1)%3] - P[(i + 1)%3][(i + 2)%3];
}

double tobi_rigid_kinetic_energy(const tobi_rigid *r)
{
    return 0.5*r->mass*vec3_dot(r->velocity, r->velocity) + 0.5*vec3_dot(r->momentum, r->angular_velocity);
}
