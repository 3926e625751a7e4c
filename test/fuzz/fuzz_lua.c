/* Scripts: whatever a user's Lua does, loading and calling it end in a result or a text, and the
   process of the script does not crash. */
#include "target.h"
#include "rigid/script.h"
#include <math.h>
#include <signal.h>

#define SECONDS 0.1      /* of processor time per call */

/* A child ends by itself with 0, or is killed when its script is freed. */
static void watch_child(int signal, siginfo_t *info, void *context)
{
    (void)signal, (void)context;
    if (info->si_code == CLD_EXITED) PROMISE(info->si_status == 0);
    else PROMISE(info->si_code == CLD_KILLED && info->si_status == SIGKILL);
}

static int call(tobi_script *script, double t)
{
    static const double rest[3][3] = { { 0, 0, 0 }, { 0.1, -0.2, 0.3 }, { 1e9, 1e-9, -1 } };
    double position[3][3] = { { 0 } };
    tobi_error err = { 0 };
    tobi_pose pose;
    if (tobi_script_is_rigid(script)) {
        if (!passed(tobi_script_place(script, t, &pose, &err), &err)) return 0;
        for (int a = 0; a < 3; a++) PROMISE(isfinite(pose.shift[a] + pose.pivot[a] + pose.axis[a]));
        PROMISE(isfinite(pose.degrees));
    } else {
        if (!passed(tobi_script_deform(script, t, 3, rest, position, &err), &err)) return 0;
        for (int i = 0; i < 9; i++) PROMISE(isfinite(position[i/3][i%3]));
    }
    return 1;
}

static int control(tobi_script *script, double t)
{
    tobi_error err = { 0 };
    tobi_control_input in = { .time = t, .orientation = { 1 }, .mass = 1, .phase = 1 };
    tobi_control_output out = { .phase = 1 };
    if (!passed(tobi_script_control(script, &in, &out, &err), &err)) return 0;
    for (int k = 0; k < 3; k++) PROMISE(isfinite(out.force[k]) && isfinite(out.torque[k]));
    PROMISE(out.hold && strlen(out.hold) < 64);
    return 1;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[64];
    sigaction(SIGCHLD, &(struct sigaction){ .sa_sigaction = watch_child, .sa_flags = SA_SIGINFO }, NULL);
    int fd = make_file(data, size, path);
    tobi_script *script = NULL;
    tobi_error err = { 0 };
    static const char params[] = "{\"a\": 1.5, \"list\": [1, 2, 3], \"s\": \"x\"}";
    tobi_status status = tobi_script_load_within(path, params, TOBI_MOTION_SCRIPT, SECONDS, &script, &err);
    PROMISE(!script == !passed(status, &err));
    if (script && call(script, 0) && call(script, 0.25)) call(script, 1e300);
    tobi_script_free(script);
    status = tobi_script_load_within(path, params, TOBI_CONTROL_SCRIPT, SECONDS, &script, &err);
    PROMISE(!script == !passed(status, &err));
    if (script && control(script, 0)) control(script, 1e300);
    tobi_script_free(script);
    close(fd);
    return 0;
}
