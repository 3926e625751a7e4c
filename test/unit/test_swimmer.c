/* Free swimmers without water: nothing that a body does with its shape gives it momentum or angular momentum.
   Momenta are taken from where the mass is, step by step, and once more from a fine lattice of the body's
   points, which knows nothing of the mass points. What is refused. */
#include "rigid_rig.h"
#include "calls.h"
#include "geom/masspoints.h"
#include "world/world.h"

static const double NONE[3] = { 0, 0, 0 };
enum { CORNERS = 8, FINE = 24 };

/* A bend that is not symmetric, a twist, and a shift that a free body must not follow. The middle is at 5. */
static tobi_status bend(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                        tobi_error *err)
{
    const double *how = user, swing = how[0]*sin(3*t), twist = how[1]*(1 - cos(2*t));
    (void)err;
    for (int64_t i = 0; i < n; i++) {
        const double x = rest[i][0] - 5, y = rest[i][1] - 5, z = rest[i][2] - 5;
        const double angle = twist*x, c = cos(angle), s = sin(angle);
        out[i][0] = 5 + x + 0.2*t + 0.1*swing*y;
        out[i][1] = 5 + c*y - s*z + swing*(x + 0.4)*(x + 0.4);
        out[i][2] = 5 + s*y + c*z + how[2]*swing*x*x*x;
    }
    return TOBI_OK;
}

static tobi_body *add_eel(rig *g, double how[3], const double spin[3])
{
    tobi_body_def def = rig_def();
    def.spacing = 0.05;
    def.motion = bend;
    def.motion_user = how;
    memcpy(def.angular_velocity, spin, sizeof def.angular_velocity);
    return rig_box(g, def, (double[3]){ 2, 0.3, 0.5 }, (double[3]){ 5, 5, 5 });
}

/* Where material points of the body are: rest and out in world coordinates. */
static void place(tobi_body *b, double how[3], double t, int64_t n, const double (*rest)[3],
                  double (*out)[3])
{
    tobi_error err = { 0 };
    bend(how, t, n, rest, out, &err);
    tobi_body_pose_shape(b, n, out);
}

typedef struct sums { double momentum[3], angular[3], mass; } sums;

/* Momenta by differences of places over a step. */
static sums add_up(int64_t n, const double *mass, const double (*before)[3],
                   const double (*now)[3], double dt)
{
    sums s = { { 0 }, { 0 }, 0 };
    for (int64_t i = 0; i < n; i++) {
        double v[3], turn[3];
        const double m = mass ? mass[i] : 1.0/(double)n;
        vec3_sub(v, now[i], before[i]);
        vec3_cross(turn, before[i], now[i]);
        vec3_add_scaled(s.momentum, s.momentum, m/dt, v);
        vec3_add_scaled(s.angular, s.angular, m/dt, turn);
        s.mass += m;
    }
    return s;
}

typedef struct track { int64_t n; double (*rest)[3], (*at)[3], (*before)[3]; const double *mass; } track;

static track start_track(tobi_body *b, double how[3], int64_t n, const double (*rest)[3],
                         const double *mass)
{
    track k = { .n = n, .mass = mass };
    k.rest = calloc((size_t)n, sizeof *k.rest);
    k.at = calloc((size_t)n, sizeof *k.at);
    k.before = calloc((size_t)n, sizeof *k.before);
    memcpy(k.rest, rest, (size_t)n*sizeof *rest);
    place(b, how, 0, n, (const double (*)[3])k.rest, k.before);
    return k;
}

static track track_mass(tobi_body *b, double how[3])
{
    const tobi_swimmer *w = b->swimmer;
    return start_track(b, how, w->count, (const double (*)[3])w->rest, w->mass);
}

static sums follow(track *k, tobi_body *b, double how[3], double t, double dt)
{
    double (*swap)[3] = k->before;
    place(b, how, t, k->n, (const double (*)[3])k->rest, k->at);
    const sums s = add_up(k->n, k->mass, (const double (*)[3])k->before, (const double (*)[3])k->at, dt);
    k->before = k->at;
    k->at = swap;
    return s;
}

static void end_track(track *k) { free(k->rest); free(k->at); free(k->before); }

static double (*make_lattice(void))[3]
{
    double (*x)[3] = calloc(4*FINE*FINE*FINE, sizeof *x);
    for (int k = 0; k < 4*FINE*FINE*FINE; k++) {
        x[k][0] = 4 + (k%(4*FINE) + 0.5)*2/(4*FINE);
        x[k][1] = 4.85 + (k/(4*FINE)%FINE + 0.5)*0.3/FINE;
        x[k][2] = 4.75 + (k/(4*FINE)/FINE + 0.5)*0.5/FINE;
    }
    return x;
}

/* 400 steps of a body that starts at rest: worst momenta, over mass and what the shape's own motion has. */
static void test_no_drift(void **state)
{
    double how[3] = { 0.3, 0.8, 0.2 }, start[3], worst[2] = { 0 }, rough[2] = { 0 }, moved = 0;
    double (*lattice)[3] = make_lattice();
    rig g;
    (void)state;
    rig_open(&g, 10, NONE);
    tobi_body *b = add_eel(&g, how, NONE);
    rig_start(&g);
    memcpy(start, b->rigid.position, sizeof start);
    track mass = track_mass(b, how);
    track fine = start_track(b, how, 4*FINE*FINE*FINE, (const double (*)[3])lattice, NULL);
    for (int k = 0; k < 400; k++) {
        rig_step(&g, 0.005);
        const sums m = follow(&mass, b, how, g.time, 0.005), f = follow(&fine, b, how, g.time, 0.005);
        worst[0] = fmax(worst[0], vec3_length(m.momentum)/m.mass);
        worst[1] = fmax(worst[1], vec3_length(m.angular)/m.mass);
        rough[0] = fmax(rough[0], vec3_length(f.momentum));
        rough[1] = fmax(rough[1], vec3_length(f.angular));
        for (int64_t i = 0; i < b->mesh.vertex_count; i++)
            moved = fmax(moved, vec3_length(b->swimmer->flow[i]));
    }
    print_message("%.2g m/s and %.2g m2/s, by a lattice %.2g and %.2g, the surface moves at %.2g m/s\n",
                  worst[0], worst[1], rough[0], rough[1], moved);
    assert_true(moved > 0.3);
    assert_true(worst[0] < 1e-11 && worst[1] < 1e-11);
    assert_true(rough[0] < 1e-3 && rough[1] < 2e-3);
    for (int a = 0; a < 3; a++) assert_true(fabs(b->rigid.position[a] - start[a]) < 1e-11);
    end_track(&mass);
    end_track(&fine);
    free(lattice);
    rig_close(&g);
}

/* A body that spins keeps its angular momentum to the last bit, and turns as the shape then has it. */
static void test_spin(void **state)
{
    double how[3] = { 0.3, 0.8, 0.2 }, momentum[3], most = 0;
    rig g;
    (void)state;
    rig_open(&g, 10, NONE);
    tobi_body *b = add_eel(&g, how, (double[3]){ 1, 2, 1.5 });
    rig_start(&g);
    memcpy(momentum, b->rigid.momentum, sizeof momentum);
    track mass = track_mass(b, how);
    for (int k = 0; k < 400; k++) {
        double away[3];
        rig_step(&g, 0.005);
        const sums m = follow(&mass, b, how, g.time, 0.005);
        vec3_sub(away, m.angular, momentum);
        most = fmax(most, vec3_length(away)/vec3_length(momentum));
    }
    print_message("angular momentum of the places: %.2g off\n", most);
    assert_memory_equal(b->rigid.momentum, momentum, sizeof momentum);
    assert_true(most < 1e-11);
    end_track(&mass);
    rig_close(&g);
}

/* A skater who draws in the arms turns faster: a box that shrinks along x and y, about z alone. */
static tobi_status shrink(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                          tobi_error *err)
{
    const double f = 1 - 0.5*fmin(t, 1);
    (void)user;
    (void)err;
    for (int64_t i = 0; i < n; i++) {
        out[i][0] = 5 + f*(rest[i][0] - 5);
        out[i][1] = 5 + f*(rest[i][1] - 5);
        out[i][2] = 5 + (rest[i][2] - 5)/(f*f);
    }
    return TOBI_OK;
}

static void test_skater(void **state)
{
    tobi_body_def def = rig_def();
    rig g;
    (void)state;
    for (int k = 0; k < 3; k++) {
        rig_open(&g, 10, NONE);
        def.spacing = 0.1;
        def.motion = shrink;
        def.locked = k == 0 ? "" : k == 1 ? "turn_x,turn_y" : "turn";
        def.angular_velocity[2] = k == 2 ? 0 : 2;
        tobi_body *b = rig_box(&g, def, (double[3]){ 1, 0.6, 0.2 }, (double[3]){ 5, 5, 5 });
        rig_start(&g);
        if (k < 2) assert_true(fabs(b->rigid.inertia[8] - 1000*0.12*(1 + 0.36)/12) < 1e-10);
        for (int n = 0; n < 200; n++) rig_step(&g, 0.005);
        const double expected = k == 2 ? 0 : 8;
        if (fabs(b->rigid.angular_velocity[2] - expected) > 1e-9)
            fail_msg("locked '%s': turns at %.12g rad/s", def.locked, b->rigid.angular_velocity[2]);
        rig_close(&g);
    }
}

/* A body that wriggles on the floor stays above it: its vertices touch. */
static void test_floor(void **state)
{
    double how[3] = { 0.05, 0.2, 0 }, lowest = 0;
    rig g;
    (void)state;
    rig_open(&g, 10, (double[3]){ 0, 0, -9.81 });
    tobi_body *b = add_eel(&g, how, NONE);
    b->rigid.position[2] = 0.3;
    OK(tobi_body_place(b, 0, &err));
    rig_start(&g);
    for (int k = 0; k < 400; k++) {
        rig_step(&g, 0.005);
        for (int64_t i = 0; i < b->mesh.vertex_count; i++) lowest = fmin(lowest, b->vertex[i][2]);
    }
    print_message("lowest vertex %.2g m, centre at %.3g m\n", lowest, b->rigid.position[2]);
    assert_true(lowest > -0.05 && b->rigid.position[2] > 0.1 && b->rigid.position[2] < 0.4);
    rig_close(&g);
}

/* Mass points integrate over a body that is not convex as its exact integrals do, in both dimensions. */
static void test_mass_points(void **state)
{
    const char *const meshes[] = { "torus", "wedge", "cylinder" };
    (void)state;
    for (int k = 0; k < 6; k++) {
        tobi_mesh mesh;
        tobi_massprops exact;
        tobi_mass_points p;
        char path[200];
        double volume = 0, centre[3] = { 0 }, polar = 0;
        snprintf(path, sizeof path, TOBI_SOURCE_DIR "/test/meshes/%s.obj", meshes[k/2]);
        OK(tobi_mesh_read(path, &mesh, &err));
        for (int64_t i = 0; i < mesh.vertex_count; i++) mesh.vertices[i][2] -= 0.1;
        if (k%2) OK(tobi_massprops_volume(&mesh, &exact, &err));
        else OK(tobi_massprops_section(&mesh, &exact, &err));
        OK(tobi_mass_points_make(&mesh, k%2 ? 3 : 2, &p, &err));
        for (int64_t i = 0; i < p.count; i++) {
            volume += p.volume[i];
            for (int a = 0; a < 3; a++) centre[a] += p.volume[i]*p.at[i][a]/exact.volume;
            const double x = p.at[i][0] - exact.centre[0], y = p.at[i][1] - exact.centre[1];
            polar += p.volume[i]*(x*x + y*y);
        }
        if (!(fabs(volume/exact.volume - 1) < 1e-11 && fabs(polar/exact.inertia[8] - 1) < 1e-11))
            fail_msg("%s: volume %.15g and %.15g, polar %.15g and %.15g", path, volume, exact.volume, polar,
                     exact.inertia[8]);
        for (int a = 0; a < 3; a++) assert_true(fabs(centre[a] - exact.centre[a]) < 1e-11);
        tobi_mass_points_free(&p);
        tobi_mesh_free(&mesh);
    }
}

/* --- mistakes ---------------------------------------------------------------------------------- */

static tobi_status flatten(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                           tobi_error *err)
{
    const double end = *(const double *)user;
    (void)err;
    memcpy(out, rest, (size_t)n*sizeof *rest);
    const double f = end > 0 ? 1 + fmin(t, 1)*(end - 1) : t > 0.5 ? end : 1;
    for (int64_t i = 0; i < n; i++) out[i][2] = 5 + f*(rest[i][2] - 5);
    return TOBI_OK;
}

static tobi_status vanish(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                          tobi_error *err)
{
    (void)user;
    (void)err;
    memcpy(out, rest, (size_t)n*sizeof *rest);
    for (int64_t i = 0; i < n && t > 0.5; i++) out[i][1] = NAN;
    return TOBI_OK;
}

/* The surface stays, the inside is drawn to a point. */
static tobi_status implode(void *user, double t, int64_t n, const double (*rest)[3], double (*out)[3],
                           tobi_error *err)
{
    static const double half[3] = { 1, 0.15, 0.25 };
    (void)user;
    (void)err;
    for (int64_t i = 0; i < n; i++) {
        int inside = 1;
        for (int a = 0; a < 3; a++) inside &= fabs(rest[i][a] - 5) < half[a] - 1e-9;
        for (int a = 0; a < 3; a++) out[i][a] = inside && t > 0.5 ? 5 : rest[i][a];
    }
    return TOBI_OK;
}

static void run_until(tobi_motion_fn motion, double end, tobi_status expected, const char *words)
{
    tobi_body_def def = rig_def();
    tobi_error err = { 0 };
    rig g;
    double speed = 0;
    rig_open(&g, 10, NONE);
    def.spacing = 0.2;
    def.motion = motion;
    def.motion_user = &end;
    tobi_body *b = rig_box(&g, def, (double[3]){ 2, 0.3, 0.5 }, (double[3]){ 5, 5, 5 });
    rig_start(&g);
    tobi_status status = TOBI_OK;
    for (int k = 0; k < 100 && status == TOBI_OK; k++) {
        status = tobi_body_predict(b, g.time, 0.01, &speed, &err);
        if (status == TOBI_OK) status = tobi_body_advance(b, g.time + 0.01, 0.01, &err);
        g.time += 0.01;
    }
    if (status != expected || !strstr(err.text, words))
        fail_msg("%d: '%s' without '%s'", status, err.text, words);
    rig_close(&g);
}

static void test_shapes_refused(void **state)
{
    (void)state;
    run_until(flatten, 1e-6, TOBI_INVALID, "squeezes it at t = 1 s, to 1e-06 of its volume");
    run_until(flatten, -1, TOBI_INVALID, "turns it inside out");
    run_until(implode, 0, TOBI_INVALID, "which no body has");
    run_until(vanish, 0, TOBI_INVALID, "its motion puts a point at");
}

static void refuse(tobi_body_def def, const char *words)
{
    tobi_world_def d = tobi_default_world_def();
    tobi_world *w;
    const double end = 1;
    tobi_error err = { 0 };
    d.domain_max[0] = d.domain_max[1] = d.domain_max[2] = 10;
    d.spacing = 0.5;
    OK(tobi_world_create(&d, NULL, &w, &err));
    def.name = "eel";
    def.motion_user = (void *)&end;
    for (int a = 0; a < 3; a++) def.box_min[a] = 4, def.box_max[a] = 6;
    tobi_status status = tobi_world_add_body(w, &def, &err);
    if (status == TOBI_OK) status = tobi_world_start(w, &err);
    if (status == TOBI_OK || !strstr(err.text, words))
        fail_msg("%d: '%s' without '%s'", status, err.text, words);
    tobi_world_destroy(w);
}

static void test_bodies_refused(void **state)
{
    tobi_body_def def = tobi_default_body_def();
    (void)state;
    def.dynamics = TOBI_FREE;
    def.motion = flatten;
    tobi_body_def rigid = def, heavy = def, vessel = def, hinged = def, dry = def, low = def;
    rigid.motion_rigid = 1;
    refuse(rigid, "has a rigid motion");
    heavy.inertia[0] = heavy.inertia[1] = heavy.inertia[2] = 1;
    refuse(heavy, "its inertia follows from the shape");
    low.centre_of_mass[0] = low.centre_of_mass[1] = low.centre_of_mass[2] = 5;
    refuse(low, "its centre of mass follows from the shape");
    vessel.vessel = 1;
    refuse(vessel, "a vessel does not");
    hinged.hinge_axis[2] = 1;
    refuse(hinged, "a body on a hinge or guide does not");
    dry.density = 0;
    refuse(dry, "density");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mass_points), cmocka_unit_test(test_no_drift), cmocka_unit_test(test_spin),
        cmocka_unit_test(test_skater), cmocka_unit_test(test_floor),
        cmocka_unit_test(test_shapes_refused),
        cmocka_unit_test(test_bodies_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
