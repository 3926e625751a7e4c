/* Lines against closed solutions: a mass on a spring, a pendulum on a rope, catenaries in the air and on a
   floor; momentum between two bodies; what is refused. */
#include "rigid_rig.h"

static const double weightless[3] = { 0 }, downward[3] = { 0, 0, -10 };

/* A cube of 1 kg around a middle, held by a line from its middle to a place. */
static tobi_body *hang_cube(rig *g, tobi_line *line, const double middle[3], const double to[3])
{
    tobi_body_def def = rig_def();
    def.density = 1e3;
    tobi_body *b = rig_box(g, def, (double[3]){ 0.1, 0.1, 0.1 }, middle);
    line->to_body = -1;
    memcpy(line->to, to, sizeof line->to);
    g->world.lines = line;
    g->world.line_count = 1;
    return b;
}

/* s, from the rising zeros of x; energy as it goes. */
static double find_period(rig *g, int axis, double about, int cycles)
{
    double first = 0, last = 0, before = g->bodies[0].rigid.position[axis] - about;
    for (int found = 0; found <= cycles;) {
        const double t = g->time;
        rig_step(g, 1e-3);
        const double now = g->bodies[0].rigid.position[axis] - about;
        if (before < 0 && now >= 0) {
            last = t + (g->time - t)*before/(before - now);
            if (found++ == 0) first = last;
        }
        before = now;
    }
    return (last - first)/cycles;
}

static void a_mass_on_a_spring_has_its_period(void **state)
{
    (void)state;
    rig g;
    tobi_line line = { .kind = TOBI_LINE_SPRING, .stiffness = 40, .length = 0.5 };
    rig_open(&g, 4, weightless);
    hang_cube(&g, &line, (double[3]){ 2.1, 2, 2 }, (double[3]){ 1.5, 2, 2 });
    rig_start(&g);
    assert_true(tobi_rigid_step_limit(g.state) <= 1/(3*sqrt(40)) + 1e-12);
    const double exact = 2*acos(-1)/sqrt(40);
    assert_true(fabs(find_period(&g, 0, 2, 10)/exact - 1) < 1e-4);
    double far = 0;
    for (int k = 0; k < 1000; k++) {
        rig_step(&g, 1e-3);
        far = fmax(far, g.bodies[0].rigid.position[0] - 2);
    }
    assert_true(fabs(far/0.1 - 1) < 1e-3);                       /* no energy is lost */
    rig_close(&g);
}

static void a_damped_spring_comes_to_rest(void **state)
{
    (void)state;
    rig g;
    tobi_line line = { .kind = TOBI_LINE_SPRING, .stiffness = 40, .damping = 2*sqrt(40), .length = 0.5 };
    rig_open(&g, 4, downward);
    hang_cube(&g, &line, (double[3]){ 2, 2, 2.5 }, (double[3]){ 2, 2, 3 });
    rig_start(&g);
    rig_advance(&g, 5);
    assert_true(fabs(g.bodies[0].rigid.position[2] - (3 - 0.5 - 10.0/40)) < 1e-6);
    assert_true(fabs(line.info.tension - 10) < 1e-5 && fabs(line.info.force[2] - 10) < 1e-5);
    rig_close(&g);
}

static void a_pendulum_on_a_rope_has_its_period(void **state)
{
    (void)state;
    rig g;
    tobi_line line = { .kind = TOBI_LINE_ROPE, .stiffness = 1e5, .length = 1 };
    rig_open(&g, 4, downward);
    const double angle = 0.1;
    hang_cube(&g, &line, (double[3]){ 2 + sin(angle), 2, 3 - cos(angle) - 1e-4 }, (double[3]){ 2, 2, 3 });
    rig_start(&g);
    const double exact = 2*acos(-1)*sqrt(1/10.0)*(1 + angle*angle/16);
    assert_true(fabs(find_period(&g, 0, 2, 4)/exact - 1) < 1e-3);
    rig_close(&g);
}

static void a_slack_rope_does_not_push(void **state)
{
    (void)state;
    rig g;
    tobi_line line = { .kind = TOBI_LINE_ROPE, .stiffness = 1e3, .length = 1 };
    rig_open(&g, 4, downward);
    hang_cube(&g, &line, (double[3]){ 2, 2, 2.9 }, (double[3]){ 2, 2, 3 });
    rig_start(&g);
    rig_advance(&g, 0.3);
    assert_true(fabs(g.bodies[0].rigid.position[2] - (2.9 - 0.5*10*0.09)) < 1e-9);
    assert_true(line.info.tension == 0);
    rig_close(&g);
}

static void two_bodies_keep_their_momentum(void **state)
{
    (void)state;
    rig g;
    tobi_line line = { .kind = TOBI_LINE_SPRING, .stiffness = 100, .damping = 1, .length = 0.45, .body = 0,
                       .to_body = 1, .point = { 0.05, 0, 0.02 }, .to = { -0.05, 0.03, 0 } };
    rig_open(&g, 4, weightless);
    tobi_body_def def = rig_def();
    rig_box(&g, def, (double[3]){ 0.1, 0.1, 0.2 }, (double[3]){ 1.7, 2, 2 });
    def.density = 3e3;
    rig_box(&g, def, (double[3]){ 0.1, 0.2, 0.1 }, (double[3]){ 2.3, 2.1, 2 });
    g.world.lines = &line;
    g.world.line_count = 1;
    rig_start(&g);
    rig_advance(&g, 1);
    double sum[3] = { 0 }, spin[3] = { 0 }, size = 0;
    for (int k = 0; k < 2; k++) {
        const tobi_rigid *r = &g.bodies[k].rigid;
        double orbit[3];
        vec3_cross(orbit, r->position, r->velocity);
        size += r->mass*vec3_length(r->velocity);
        for (int a = 0; a < 3; a++) {
            sum[a] += r->mass*r->velocity[a];
            spin[a] += r->mass*orbit[a] + r->momentum[a];
        }
    }
    assert_true(size > 0.1);
    assert_true(vec3_length(sum) < 1e-12*size && vec3_length(spin) < 1e-12*size);
    rig_close(&g);
}

/* a = H/w of a line without stretch: L^2 = h^2 + (2 a sinh(s/2a))^2; V by its balance. */
static void a_hanging_catenary_has_its_shape(void **state)
{
    (void)state;
    const double w = 3, a = 20, height = 12, span = 45, chord = 2*a*sinh(span/(2*a));
    tobi_line line = { .kind = TOBI_LINE_CATENARY, .weight = w, .length = sqrt(height*height + chord*chord),
                       .stiffness = 1e9 };
    double pull[2];
    tobi_catenary(&line, span, height, pull);
    assert_true(fabs(pull[0]/(w*a) - 1) < 1e-6);
    /* y = a cosh(x/a) through both ends: the upper one is at x = s/2 + a asinh(h/chord). */
    assert_true(fabs(pull[1]/(w*a*sinh(span/(2*a) + asinh(height/chord))) - 1) < 1e-6);
}

/* The part in the air: V^2 = 2 H w h + (w h)^2; the rest lies. */
static void a_catenary_lies_on_the_floor(void **state)
{
    (void)state;
    const double w = 3, horizontal = 60, height = 12, a = horizontal/w, length = 100;
    const double vertical = sqrt(2*horizontal*w*height + w*w*height*height);
    const double span = length - vertical/w + a*asinh(vertical/horizontal);
    tobi_line line = { .kind = TOBI_LINE_CATENARY, .weight = w, .length = length, .stiffness = 1e9,
                       .rests = 1 };
    double pull[2];
    tobi_catenary(&line, span, height, pull);
    assert_true(fabs(pull[0]/horizontal - 1) < 1e-5 && fabs(pull[1]/vertical - 1) < 1e-5);
    tobi_catenary(&line, length - height - 1, height, pull);               /* slack */
    assert_true(pull[0] == 0 && pull[1] == w*height);
}

/* What hangs between a body and the domain weighs on both ends, whichever is higher. */
static void the_weight_of_a_line_is_carried(void **state)
{
    (void)state;
    for (int upper = 0; upper < 2; upper++) {
        rig g;
        tobi_line line = { .kind = TOBI_LINE_CATENARY, .weight = 2, .length = 1.5, .stiffness = 1e4,
                           .up = { 0, 0, 1 } };
        rig_open(&g, 4, downward);
        hang_cube(&g, &line, (double[3]){ 2, 2, upper ? 3 : 1.5 }, (double[3]){ 2.8, 2.6, 2.2 });
        rig_start(&g);
        assert_true(fabs(line.info.force[2] + line.now[1].force[2] + 2*1.5) < 1e-6);
        for (int k = 0; k < 2; k++) assert_true(fabs(line.info.force[k] + line.now[1].force[k]) < 1e-12);
        assert_true(line.info.force[0] > 0 && fabs(line.info.force[1]/line.info.force[0] - 0.75) < 1e-9);
        rig_close(&g);
    }
}

static void refuse(tobi_world *w, const tobi_line_def *def, tobi_status status, const char *words)
{
    tobi_error err = { 0 };
    assert_int_equal(tobi_world_add_line(w, def, &err), status);
    if (!strstr(err.text, words)) fail_msg("'%s' is not in '%s'", words, err.text);
}

static tobi_status wobble(void *user, double t, int64_t count, const double (*rest)[3], double (*out)[3],
                          tobi_error *err)
{
    (void)user, (void)t, (void)err;
    memcpy(out, rest, (size_t)count*sizeof *out);
    return TOBI_OK;
}

/* A line to a body that deforms, and one after the start. */
static void refuse_more(const tobi_world_def *w, tobi_body_def *b, const tobi_line_def *right)
{
    tobi_error err;
    tobi_world *world;
    tobi_line_def d = *right;
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    fill.box_max[0] = fill.box_max[1] = 1, fill.box_max[2] = 0.1;
    assert_int_equal(tobi_world_create(w, NULL, &world, &err), TOBI_OK);
    assert_int_equal(tobi_world_add_fluid(world, &fluid, &fill, 1, &err), TOBI_OK);
    for (int k = 0; k < 2; k++) {
        b->name = k ? "eel" : "boat";
        b->dynamics = k ? TOBI_PRESCRIBED : TOBI_FREE;
        b->motion = k ? wobble : NULL;
        b->motion_rigid = 0;
        for (int a = 0; a < 3; a++) b->box_min[a] = 0.2 + 0.4*k, b->box_max[a] = 0.4 + 0.4*k;
        assert_int_equal(tobi_world_add_body(world, b, &err), TOBI_OK);
    }
    d.to_body = "eel";
    refuse(world, &d, TOBI_UNSUPPORTED, "line 'l': body 'eel' deforms; a line goes to a rigid one");
    b->name = "gate", b->motion = NULL, b->absent_from = 0.1;
    assert_int_equal(tobi_world_add_body(world, b, &err), TOBI_OK);
    b->absent_from = 0;
    d.to_body = "gate";
    refuse(world, &d, TOBI_UNSUPPORTED, "line 'l': body 'gate' is absent at times; a line goes to one that");
    assert_int_equal(tobi_world_start(world, &err), TOBI_OK);
    d.to_body = NULL;
    refuse(world, &d, TOBI_INVALID, "a started world takes no more lines");
    tobi_world_destroy(world);
    b->motion = NULL;
}

static void wrong_lines_are_refused(void **state)
{
    (void)state;
    tobi_error err;
    tobi_world *world;
    tobi_world_def w = tobi_default_world_def();
    w.spacing = 0.05;
    for (int a = 0; a < 3; a++) w.domain_max[a] = 1;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    tobi_body_def b = tobi_default_body_def();
    for (int k = 0; k < 2; k++) {
        b.name = k ? "post" : "boat";
        b.dynamics = k ? TOBI_PRESCRIBED : TOBI_FREE;
        for (int a = 0; a < 3; a++) b.box_min[a] = 0.1 + 0.4*k, b.box_max[a] = 0.3 + 0.4*k;
        assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_OK);
    }
    const tobi_line_def right = { .name = "l", .body = "boat", .point = { 0.2, 0.2, 0.2 },
                                  .to = { 0.6, 0.6, 0.6 }, .stiffness = 10 };
    tobi_line_def d = right;
    d.body = "ship";
    refuse(world, &d, TOBI_INVALID, "line 'l': there is no body 'ship'");
    d.body = "post";
    refuse(world, &d, TOBI_INVALID, "line 'l': body 'post' is prescribed");
    d = right, d.to_body = "pier";
    refuse(world, &d, TOBI_INVALID, "line 'l': there is no body 'pier'");
    d.to_body = "boat";
    refuse(world, &d, TOBI_INVALID, "line 'l': both ends are at body 'boat'");
    d = right, memcpy(d.to, d.point, sizeof d.to);
    refuse(world, &d, TOBI_INVALID, "line 'l': its ends are at one place and it has no length");
    d = right, d.weight = 1;
    refuse(world, &d, TOBI_INVALID, "line 'l': weight and rests are of a catenary");
    d = right, d.kind = TOBI_LINE_CATENARY;
    refuse(world, &d, TOBI_INVALID, "line 'l': a catenary has a weight above 0 N/m");
    d.weight = 1, d.damping = 1;
    refuse(world, &d, TOBI_INVALID, "line 'l': damping is of springs and ropes");
    d = right, d.stiffness = -1;
    refuse(world, &d, TOBI_INVALID, "stiffness");
    d = right, d.to_body = "post";
    assert_int_equal(tobi_world_add_line(world, &d, &err), TOBI_OK);
    assert_int_equal(tobi_world_line_count(world), 1);
    assert_string_equal(tobi_world_line(world, 0, NULL), "l");
    assert_null(tobi_world_line(world, 1, NULL));
    refuse(world, &d, TOBI_INVALID, "line 'l': line 0 has that name already");
    char name[16];
    for (int k = 1; k < TOBI_LINE_LIMIT; k++) {
        snprintf(name, sizeof name, "l%d", k);
        d.name = name;
        assert_int_equal(tobi_world_add_line(world, &d, &err), TOBI_OK);
    }
    refuse(world, &d, TOBI_UNSUPPORTED, "more than 256 lines");
    tobi_world_destroy(world);
    refuse_more(&w, &b, &right);
    for (int a = 0; a < 3; a++) w.gravity[a] = 0;
    assert_int_equal(tobi_world_create(&w, NULL, &world, &err), TOBI_OK);
    b.name = "boat", b.dynamics = TOBI_FREE;
    assert_int_equal(tobi_world_add_body(world, &b, &err), TOBI_OK);
    d = right, d.kind = TOBI_LINE_CATENARY, d.weight = 1;
    refuse(world, &d, TOBI_INVALID, "line 'l': a catenary hangs, and there is no gravity");
    tobi_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mass_on_a_spring_has_its_period), cmocka_unit_test(a_damped_spring_comes_to_rest),
        cmocka_unit_test(a_pendulum_on_a_rope_has_its_period), cmocka_unit_test(a_slack_rope_does_not_push),
        cmocka_unit_test(two_bodies_keep_their_momentum), cmocka_unit_test(a_hanging_catenary_has_its_shape),
        cmocka_unit_test(a_catenary_lies_on_the_floor), cmocka_unit_test(the_weight_of_a_line_is_carried),
        cmocka_unit_test(wrong_lines_are_refused)
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
