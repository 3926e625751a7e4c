/* Runs with nests: what is refused before a file is touched, checkpoints that do not belong together, whose
   failure and whose trouble it is. */
#include "calls.h"
#include "nest_rig.h"
#include "record_rig.h"
#include <dirent.h>
#include <math.h>
#include <sys/resource.h>
#include <signal.h>

static const char text[] =
    "{\"method\": \"isph\", \"dimension\": 2, \"domain\": {\"min\": [0, 0], \"max\": [0.4, 0.2]},"
    " \"spacing\": 0.02, \"end_time\": 0.1, \"threads\": 1, \"fluids\": [{\"name\": \"water\", \"fill\": "
    "[{\"box\": {\"min\": [0, 0], \"max\": [0.4, 0.1]}}]}],"
    " \"nests\": [{\"name\": \"left\", \"box\": {\"min\": [0, 0], \"max\": [0.1, 0.2]}},"
    "             {\"name\": \"right\", \"box\": {\"min\": [0.3, 0], \"max\": [0.4, 0.2]},"
    "              \"feedback\": true}],"
    " \"output\": {\"interval\": 0.02}}";

static nest_rig make(void)
{
    nest_rig a;
    OK(nest_rig_build(text, &a, &err));
    OK(tobi_nests_create(a.scene, a.world, &a.nests, &err));
    return a;
}

static tobi_status record(nest_rig *a, const char *dir, int how, tobi_error *err)
{
    const tobi_output_def *output = tobi_scene_output_def(a->scene);
    char *scene = tobi_scene_resolved(a->scene);
    tobi_status status = tobi_nests_prepare(a->nests, dir, how, err);
    if (status == TOBI_OK)
        status = how == TOBI_NESTS_RESUME ? tobi_run_resume(a->world, output, dir, &a->run, err)
               : tobi_run_create(a->world, output, dir, how == TOBI_NESTS_REPLACE, scene, &a->run, err);
    free(scene);
    if (status == TOBI_OK) status = tobi_nests_record(a->nests, a->run, dir, how, err);
    return status;
}

static void step_to(nest_rig *a, double t)
{
    while (!tobi_run_done(a->run, t)) OK(tobi_run_step(a->run, t, NULL, &err));
}

static void a_world_knows_its_nests(void **state)
{
    (void)state;
    nest_rig a = make();
    double box[2][3], spacing;
    for (int k = 0; k < 2; k++)
        assert_ptr_equal(tobi_world_nest_at(a.world, k), tobi_nests_world(a.nests, k, NULL));
    assert_null(tobi_world_nest_at(a.world, 2));
    assert_null(tobi_world_nest_at(a.world, -1));
    assert_int_equal(tobi_world_nest_box(a.world, box, &spacing), 0);
    assert_int_equal(tobi_world_nest_box(tobi_world_nest_at(a.world, 1), box, &spacing), 1);
    assert_true(tobi_world_nest_most(a.world) == 0);
    assert_true(tobi_world_nest_most(tobi_world_nest_at(a.world, 1)) > 10*20);      /* with the rim */
    assert_true(fabs(box[0][0] - 0.3) < 1e-12 && isinf(box[1][0]) && fabs(spacing - 0.01) < 1e-12);
    tobi_nests_free(a.nests);
    a.nests = NULL;
    assert_null(tobi_world_nest_at(a.world, 0));
    nest_rig_drop(&a);
}

/* A run to 0.04 s with checkpoints at 0.02 and 0.04. */
static void make_checkpoints(const char *dir)
{
    nest_rig a = make();
    OK(record(&a, dir, TOBI_NESTS_CREATE, &err));
    for (int k = 1; k < 3; k++) {
        step_to(&a, 0.02*k);
        OK(tobi_run_checkpoint(a.run, &err));
    }
    OK(tobi_run_finish(a.run, "interrupted", &err));
    nest_rig_drop(&a);
}

/* Removes those of the newest, or all. */
static void remove_checkpoints(const char *dir, bool every)
{
    char last[256] = "", path[1024];
    DIR *list = opendir(dir);
    const struct dirent *e;
    assert_non_null(list);
    while ((e = readdir(list)))
        if (strncmp(e->d_name, "checkpoint_", 11) == 0 && strcmp(e->d_name, last) > 0)
            snprintf(last, sizeof last, "%s", e->d_name);
    last[strcspn(last, ".")] = '\0';
    rewinddir(list);
    while ((e = readdir(list)))
        if (e->d_name[0] != '.' && (every || strncmp(e->d_name, last, strlen(last)) == 0)) {
            snprintf(path, sizeof path, "%s/%s", dir, e->d_name);
            unlink(path);
        }
    closedir(list);
}

static void go_on(const char *dir, const char *why)
{
    nest_rig a = make();
    if (why) REFUSED(record(&a, dir, TOBI_NESTS_RESUME, &err), TOBI_DAMAGED, why);
    else {
        OK(record(&a, dir, TOBI_NESTS_RESUME, &err));
        assert_true(tobi_world_time(a.world) < 0.021);
        step_to(&a, 0.04);
        OK(tobi_run_finish(a.run, "complete", &err));
    }
    nest_rig_drop(&a);
}

/* A power cut between the checkpoint of a nest and that of the scene, or one of them lost. */
static void checkpoints_belong_together(void **state)
{
    (void)state;
    make_checkpoints(at("whole"));
    make_checkpoints(at("ahead"));
    remove_checkpoints(at("ahead/checkpoints"), false);
    go_on(at("ahead"), NULL);
    assert_same_file(at("whole/nests/right/history.csv"), at("ahead/nests/right/history.csv"));
    assert_same_file(at("whole/history.csv"), at("ahead/history.csv"));
    make_checkpoints(at("behind"));
    remove_checkpoints(at("behind/nests/left/checkpoints"), false);
    go_on(at("behind"), "the run around it one of 0.04 s: remove that, for an earlier one");
    remove_checkpoints(at("behind/checkpoints"), false);
    go_on(at("behind"), NULL);
    make_checkpoints(at("early"));
    remove_checkpoints(at("early/checkpoints"), true);
    go_on(at("early"), "no checkpoint that is as early as that of the run around it, of 0 s");
}

static void what_is_refused_costs_nothing(void **state)
{
    (void)state;
    nest_rig a = make();
    OK(record(&a, at("kept"), TOBI_NESTS_CREATE, &err));
    for (int k = 0; k < 2; k++) OK(tobi_run_add_nest(a.run, a.run, &err));
    REFUSED(tobi_run_add_nest(a.run, a.run, &err), TOBI_INVALID, "a run has 4 nests or fewer");
    nest_rig_drop(&a);
    a = make();
    unlink(at("kept/history.csv"));
    unlink(at("kept/resolved.json"));
    REFUSED(tobi_nests_prepare(a.nests, at("kept"), TOBI_NESTS_CREATE, &err), TOBI_INVALID,
            "kept/nests/left: holds the results of a run; nothing was changed");
    assert_int_equal(mkdir(at("odd"), 0777), 0);
    assert_int_equal(mkdir(at("odd/nests"), 0777), 0);
    write_file(at("odd/nests/left"), "mine");
    REFUSED(record(&a, at("odd"), TOBI_NESTS_REPLACE, &err), TOBI_INVALID, "nests/left is no folder");
    unlink(at("odd/nests/left"));
    assert_int_equal(symlink(at("kept"), at("odd/nests/right")), 0);
    REFUSED(record(&a, at("odd"), TOBI_NESTS_REPLACE, &err), TOBI_INVALID, "right is a symbolic link");
    assert_false(exists(at("odd/history.csv")));
    unlink(at("odd/nests/right"));
    rmdir(at("odd/nests"));
    assert_int_equal(symlink(at("kept"), at("odd/nests")), 0);
    REFUSED(record(&a, at("odd"), TOBI_NESTS_REPLACE, &err), TOBI_INVALID, "odd/nests is a symbolic link");
    nest_rig_drop(&a);
}

static tobi_status fail_late(void *user, double t, int64_t n, const double (*rest)[3], double (*position)[3],
                             tobi_error *err)
{
    (void)user;
    memcpy(position, rest, (size_t)n*sizeof *rest);
    return t < 0.015 ? TOBI_OK : tobi_fail(err, TOBI_SCRIPT, "%s", "the hinge broke");
}

static void a_failure_has_the_name_of_the_nest(void **state)
{
    (void)state;
    nest_rig a = make();
    tobi_body_def b = tobi_default_body_def();
    b.name = "plate";
    b.box_min[0] = 0.03;
    b.box_max[0] = 0.07;
    b.box_min[1] = 0.03;
    b.box_max[1] = 0.07;
    b.motion = fail_late;
    b.motion_rigid = 1;
    OK(tobi_world_add_body(tobi_nests_world(a.nests, 0, NULL), &b, &err));
    OK(record(&a, at("broken"), TOBI_NESTS_CREATE, &err));
    tobi_error why = { 0 };
    tobi_status status = TOBI_OK;
    while (status == TOBI_OK && !tobi_run_done(a.run, 0.1)) status = tobi_run_step(a.run, 0.1, NULL, &why);
    assert_int_equal(status, TOBI_SCRIPT);
    if (!strstr(why.text, "nest 'left': ") || !strstr(why.text, "the hinge broke")) fail_msg("%s", why.text);
    nest_rig_drop(&a);
}

/* No file may grow beyond a byte: the scene's run tells what its nests lack, too. */
static void trouble_of_nests_is_told(void **state)
{
    (void)state;
    const struct rlimit none = { 1, RLIM_INFINITY };
    struct rlimit before;
    nest_rig a = make();
    OK(record(&a, at("full"), TOBI_NESTS_CREATE, &err));
    tobi_run_go_on(a.run, 1);
    getrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &none);
    step_to(&a, 0.02);
    int of_nest = 0;
    const char *told;
    const tobi_status status = tobi_run_finish(a.run, "complete", NULL);      /* waits for all writers */
    setrlimit(RLIMIT_FSIZE, &before);
    for (int k = 0; (told = tobi_run_trouble(a.run, k)); k++) of_nest += strstr(told, "nests/") != NULL;
    const int64_t unwritten = tobi_run_unwritten(a.run);
    assert_int_equal(status, TOBI_OK);
    assert_true(of_nest >= 2 && unwritten >= 3);
    if (!strstr(tobi_run_losses(a.run), "nest left: ") || !strstr(tobi_run_losses(a.run), "nest right: "))
        fail_msg("%s", tobi_run_losses(a.run));
    nest_rig_drop(&a);
}

/* One nest cannot write its end: that is told, and the others and the scene end all the same. */
static void one_nest_that_cannot_end(void **state)
{
    (void)state;
    nest_rig a = make();
    size_t length;
    OK(record(&a, at("ended"), TOBI_NESTS_CREATE, &err));
    step_to(&a, 0.02);
    assert_int_equal(mkdir(at("ended/nests/left/summary.json"), 0777), 0);
    REFUSED(tobi_run_finish(a.run, "complete", &err), TOBI_INVALID, "left/summary.json");
    char *scene = read_file(at("ended/summary.json"), &length);
    char *right = read_file(at("ended/nests/right/summary.json"), &length);
    assert_non_null(strstr(scene, "\"outcome\": \"failed\""));
    assert_non_null(strstr(right, "\"outcome\": \"complete\""));
    free(scene);
    free(right);
    nest_rig_drop(&a);
}

/* Nests step without a run, too; a run that ends leaves their worlds; sizes add up. */
static void nests_without_a_run(void **state)
{
    (void)state;
    nest_rig a = make();
    tobi_run_size size, with;
    OK(tobi_run_estimate(a.world, tobi_scene_output_def(a.scene), 0.1, &size, &err));
    with = size;
    OK(tobi_nests_estimate(a.nests, 0.1, &with, &err));
    assert_true(with.files >= 2.9*size.files && with.files <= 3.1*size.files && with.bytes > 1.5*size.bytes);
    OK(tobi_nests_follow(a.nests, &err));
    while (tobi_world_time(a.world) < 0.05) {
        OK(tobi_world_step_to(a.world, 0.05, &err));
        OK(tobi_nests_follow(a.nests, &err));
    }
    assert_true(tobi_world_time(a.world) == 0.05);
    for (int k = 0; k < 2; k++) assert_true(tobi_world_time(tobi_nests_world(a.nests, k, NULL)) == 0.05);
    REFUSED(tobi_world_step_to(a.world, INFINITY, &err), TOBI_INVALID, "not finite");
    tobi_nests_close(a.nests);
    tobi_nests_close(NULL);
    OK(tobi_nests_follow(NULL, &err));
    nest_rig_drop(&a);
}

/* The scene with one piece of its text replaced. */
static tobi_status make_other(const char *old, const char *other, nest_rig *a, tobi_error *err)
{
    char scene[2000];
    const char *place = strstr(text, old);
    assert_non_null(place);
    snprintf(scene, sizeof scene, "%.*s%s%s", (int)(place - text), text, other, place + strlen(old));
    TOBI_TRY(nest_rig_build(scene, a, err));
    return tobi_nests_create(a->scene, a->world, &a->nests, err);
}

static void what_a_scene_may_not_have(void **state)
{
    char more[600];
    nest_rig a;
    (void)state;
    REFUSED(make_other("left", "to the left", &a, &err), TOBI_INVALID,
            "\"to the left\" names a folder: allowed are letters, digits, _ and -");
    nest_rig_drop(&a);
    snprintf(more, sizeof more, "\"solids\": [{\"name\": \"jelly\", \"fill\": [{\"box\": {\"min\": "
             "[0.1, 0.1], \"max\": [0.2, 0.16]}}]}], \"output\"");
    REFUSED(make_other("\"output\"", more, &a, &err), TOBI_UNSUPPORTED, "nests are for liquids alone");
    nest_rig_drop(&a);
}

static void states_are_of_their_world(void **state)
{
    (void)state;
    nest_rig a = make();
    tobi_world *nest = tobi_nests_world(a.nests, 0, NULL);
    OK(tobi_nests_follow(a.nests, &err));
    OK(tobi_world_save(a.world, at("outer.h5"), &err));
    OK(tobi_world_save(nest, at("nest.h5"), &err));
    REFUSED(tobi_world_load(a.world, at("nest.h5"), &err), TOBI_INVALID, "is of a nest, which goes on");
    REFUSED(tobi_world_load(nest, at("outer.h5"), &err), TOBI_INVALID, "is of a world that is no nest");
    OK(tobi_world_load(nest, at("nest.h5"), &err));
    nest_rig_drop(&a);
}

static int enter(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int leave(void **state)
{
    char command[300];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_world_knows_its_nests),
        cmocka_unit_test(checkpoints_belong_together), cmocka_unit_test(what_is_refused_costs_nothing),
        cmocka_unit_test(a_failure_has_the_name_of_the_nest), cmocka_unit_test(trouble_of_nests_is_told),
        cmocka_unit_test(one_nest_that_cannot_end),
        cmocka_unit_test(nests_without_a_run), cmocka_unit_test(what_a_scene_may_not_have),
        cmocka_unit_test(states_are_of_their_world)
    };
    return cmocka_run_group_tests(tests, enter, leave);
}
