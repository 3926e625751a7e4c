/* Scripts of the user, seen from the process that loaded them.

   Each script runs in a process of its own: a fork without exec, which has no files and ends by a
   timer when a request takes it too long (script_process.c). So nothing that Lua or the user does
   can stop or crash the simulation: every call comes back with an answer or a text. Drawback: a
   process per script, and some ten microseconds per request; points therefore go over in batches. */
#define _GNU_SOURCE 1
#include "rigid/script_process.h"
#include "base/plain.h"
#include <errno.h>
#include <float.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { FILE_LIMIT = 4 << 20 };      /* bytes of a script file                                         */
#define SECONDS  3.0                /* of processor time that a request may take                     */
#define PATIENCE 20                 /* times as long is waited for a process that somebody has stopped */

struct tobi_script {
    char *label;                    /* "motion script PATH", for messages                             */
    const char *path;               /* its end                                                        */
    tobi_script_role role;
    bool rigid;
    double pivot[3];                /* m                                                              */
    double seconds;                 /* SECONDS, less in tests                                         */
    tobi_script_channel *channel;   /* shared with the process                                        */
    pid_t loader, process;          /* process 0: it has ended                                        */
    int fd;                         /* our end of the socket, -1: none                                */
    char why[1100];                 /* what went wrong last; stays when the process has ended         */
    char hold[64];                  /* the last answer of control                                     */
};

static const char *const role_name[] = { TR("motion script"), TR("control script"), TR("flow script") };

/* --- the process -------------------------------------------------------------------------- */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

/* Whether the process replies; false when it has ended or its time is over. What this process
   itself was stopped for (Ctrl-Z) does not count. */
static bool wait_reply(const tobi_script *s)
{
    for (double waited = 0; waited < PATIENCE*s->seconds;) {
        struct pollfd event = { .fd = s->fd, .events = POLLIN };
        double since = now();
        char byte;
        if (poll(&event, 1, 1000) > 0) {
            ssize_t n = recv(s->fd, &byte, 1, 0);
            if (n >= 0 || errno != EINTR) return n == 1;
        }
        waited += fmin(now() - since, 1);
    }
    return false;
}

/* A text of the script's process: ended, and without what could steer a terminal. */
static void copy_text(char *to, const char *from, size_t room)
{
    size_t n = 0;
    for (; n + 1 < room && from[n]; n++)
        to[n] = (unsigned char)from[n] < ' ' || from[n] == 127 ? ' ' : from[n];
    to[n] = '\0';
}

/* Ends the process, if it has not ended itself, and says why it is gone. */
static void end_process(tobi_script *s, bool silent)
{
    char where[200];
    int state = 0;
    pid_t reaped;
    kill(s->process, SIGKILL);
    do reaped = waitpid(s->process, &state, 0);
    while (reaped < 0 && errno == EINTR);
    close(s->fd);
    s->fd = -1;
    s->process = 0;
    if (s->channel->reply == TOBI_REPLY_LATE) {
        copy_text(where, s->channel->text, sizeof where);
        snprintf(s->why, sizeof s->why, tr("%sendless loop? stopped after %g s of processor time%s"), where,
                 s->seconds, where[0] ? "" : tr(", inside one call of a function such as table.sort"));
    } else if (silent) {
        snprintf(s->why, sizeof s->why, tr("its process did not answer for %g s"), PATIENCE*s->seconds);
    } else if (reaped > 0 && WIFSIGNALED(state)) {
        snprintf(s->why, sizeof s->why, tr("its process was ended by signal %d (%s)"), WTERMSIG(state),
                 strsignal(WTERMSIG(state)));
    } else {
        snprintf(s->why, sizeof s->why, tr("its process has ended"));
    }
}

/* Waits for the reply to the request in the channel. NULL, or what went wrong. */
static const char *take_reply(tobi_script *s)
{
    tobi_script_channel *c = s->channel;
    bool ended = false;
    if (!wait_reply(s)) {
        struct pollfd end = { .fd = s->fd, .events = POLLIN };
        ended = poll(&end, 1, 0) > 0;
        end_process(s, !ended);
        return s->why;
    }
    if (c->reply == TOBI_REPLY_DONE) return NULL;
    if (c->reply == TOBI_REPLY_FULL)
        snprintf(s->why, sizeof s->why, tr("needs more memory than a script may have, %d MiB"),
                 TOBI_SCRIPT_MEMORY >> 20);
    else copy_text(s->why, c->text, sizeof c->text);
    return s->why;
}

static const char *ask(tobi_script *s, tobi_script_request request)
{
    char byte = 0;
    if (s->loader != getpid()) return tr("only the process that loaded it can ask it");
    if (s->fd < 0) return s->why;
    s->channel->request = request;
    s->channel->reply = TOBI_REPLY_NONE;
    send(s->fd, &byte, 1, MSG_NOSIGNAL);      /* a dead process does not reply */
    return take_reply(s);
}

static tobi_status fail_start(const tobi_script *s, tobi_error *err)
{
    return tobi_fail(err, errno == ENOMEM ? TOBI_NO_MEMORY : TOBI_IO, "%s: its process cannot start: %s",
                     s->label, tobi_reason(errno));
}

/* Forks. Signals wait meanwhile, so that none is handled twice. */
static tobi_status start(tobi_script *s, const tobi_script_job *job, tobi_error *err)
{
    int ends[2];
    sigset_t all, before;
    s->channel = mmap(NULL, sizeof *s->channel, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                      -1, 0);
    if (s->channel == MAP_FAILED) s->channel = NULL;
    if (!s->channel || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return fail_start(s, err);
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    s->loader = getpid();
    s->process = fork();
    if (s->process == 0) tobi_script_serve(job, s->channel, ends[1]);
    int code = errno;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    close(ends[1]);
    s->fd = ends[0];
    if (s->process > 0) return TOBI_OK;
    s->process = 0;
    errno = code;
    return fail_start(s, err);
}

/* --- loading ------------------------------------------------------------------------------ */

static tobi_status load(tobi_script *s, const json_t *params, tobi_error *err)
{
    char *text;
    size_t length;
    TOBI_TRY(tobi_plain_read(s->path, tr(role_name[s->role]), FILE_LIMIT, &text, &length, err));
    const char *slash = strrchr(s->path, '/'), *file = slash ? slash + 1 : s->path;
    char *name = malloc(strlen(file) + 2);
    tobi_status status = TOBI_OK;
    if (memchr(text, '\0', length) || text[0] == '\x1b')
        status = tobi_fail(err, TOBI_SCRIPT, "%s: not a text file", s->label);
    else if (!name) status = tobi_fail(err, TOBI_NO_MEMORY, "%s: out of memory", s->label);
    if (status == TOBI_OK) {
        sprintf(name, "@%s", file);
        tobi_script_job job = { s->role, name, text, length, params, s->seconds };
        status = start(s, &job, err);
    }
    const char *why = status == TOBI_OK ? take_reply(s) : NULL;
    if (why) status = tobi_fail(err, TOBI_SCRIPT, "%s: %s", s->label, why);
    free(name);
    free(text);
    return status;
}

static tobi_script *create(const char *path, tobi_script_role role, double seconds)
{
    tobi_script *s = calloc(1, sizeof *s);
    size_t room = strlen(tr(role_name[role])) + strlen(path) + 2;
    if (!s || !(s->label = malloc(room))) {
        free(s);
        return NULL;
    }
    s->fd = -1;
    s->role = role;
    s->seconds = seconds;
    snprintf(s->label, room, "%s %s", tr(role_name[role]), path);
    s->path = s->label + strlen(tr(role_name[role])) + 1;
    return s;
}

tobi_status tobi_script_load_within(const char *path, const char *params_json, tobi_script_role role,
                                    double seconds, tobi_script **out, tobi_error *err)
{
    TOBI_NEED(out, "where the script goes");
    *out = NULL;
    TOBI_NEED(path, "the path");
    if (role != TOBI_MOTION_SCRIPT && role != TOBI_CONTROL_SCRIPT && role != TOBI_FLOW_SCRIPT)
        return tobi_fail(err, TOBI_INVALID, "script %s: there is no role %d", path, (int)role);
    json_error_t where;
    json_t *params = json_loads(params_json ? params_json : "{}", 0, &where);
    if (!json_is_object(params)) {
        json_decref(params);
        return tobi_fail(err, TOBI_INVALID, "%s params: %s", tr(role_name[role]),
                         params ? tr("must be a JSON object") : where.text);
    }
    tobi_script *s = create(path, role, seconds);
    tobi_status status = s ? load(s, params, err)
                           : tobi_fail(err, TOBI_NO_MEMORY, "script %s: out of memory", path);
    json_decref(params);
    if (status != TOBI_OK) {
        tobi_script_free(s);
        return status;
    }
    s->rigid = s->channel->rigid;
    memcpy(s->pivot, s->channel->pivot, sizeof s->pivot);
    *out = s;
    return TOBI_OK;
}

tobi_status tobi_script_load(const char *path, const char *params_json, tobi_script_role role,
                             tobi_script **out, tobi_error *err)
{
    return tobi_script_load_within(path, params_json, role, SECONDS, out, err);
}

void tobi_script_free(tobi_script *s)
{
    if (!s) return;
    if (s->process > 0 && s->loader == getpid()) end_process(s, false);
    if (s->fd >= 0) close(s->fd);
    if (s->channel) munmap(s->channel, sizeof *s->channel);
    free(s->label);
    free(s);
}

int tobi_script_is_rigid(const tobi_script *s) { return s->rigid; }

/* --- calls -------------------------------------------------------------------------------- */

static bool is_finite(const double v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

/* Calls the function of points. *why: what went wrong at point *bad, "" if its answer is not finite, NULL if
   nothing. */
static void walk(tobi_script *s, double t, int64_t n, const double (*from)[3], double (*to)[3], int64_t *bad,
                 const char **why)
{
    tobi_script_channel *c = s->channel;
    *why = NULL;
    for (int64_t first = 0; first < n; first += TOBI_SCRIPT_BATCH) {
        int64_t count = n - first < TOBI_SCRIPT_BATCH ? n - first : TOBI_SCRIPT_BATCH;
        c->count = count;
        c->time = t;
        c->at = 0;
        memcpy(c->from, from + first, (size_t)count*sizeof *c->from);
        *why = ask(s, TOBI_REQUEST_WALK);
        double at = c->at;
        *bad = first + (at > 0 && at < (double)count ? (int64_t)at : 0);
        if (*why) return;
        memcpy(to + first, c->to, (size_t)count*sizeof *c->to);
        for (int64_t i = first; i < first + count; i++) {
            if (is_finite(to[i])) continue;
            *bad = i;
            *why = "";
            return;
        }
    }
}

void tobi_script_steer(tobi_script *s, const double steer[3])
{
    memcpy(s->channel->steer, steer, sizeof s->channel->steer);
}

tobi_status tobi_script_deform(tobi_script *s, double t, int64_t n, const double (*rest)[3],
                               double (*position)[3], tobi_error *err)
{
    int64_t i;
    const char *why;
    walk(s, t, n, rest, position, &i, &why);
    if (!why) return TOBI_OK;
    return tobi_fail(err, TOBI_SCRIPT, "%s: %s (t = %.9g s, rest point %.6g %.6g %.6g)", s->label,
                     *why ? why : tr("deform returned a number that is not finite"), t, rest[i][0],
                     rest[i][1],
                     rest[i][2]);
}

tobi_status tobi_script_flow(void *user, int64_t n, const double (*place)[3], double (*velocity)[3],
                             tobi_error *err)
{
    TOBI_NEED(user, "the script");
    TOBI_NEED(n <= 0 || (place && velocity), "a list of places or velocities");
    tobi_script *s = user;
    int64_t i;
    const char *why;
    walk(s, 0, n, place, velocity, &i, &why);
    if (!why) return TOBI_OK;
    return tobi_fail(err, TOBI_SCRIPT, "%s: %s (at %.6g %.6g %.6g m)", s->label,
                     *why ? why : tr("velocity returned a number that is not finite"), place[i][0],
                     place[i][1],
                     place[i][2]);
}

/* Axis to unit length; a turn needs one. */
static tobi_status set_turn(const tobi_script *s, double t, const double r[7], tobi_pose *pose,
                            tobi_error *err)
{
    double length = sqrt(r[3] * r[3] + r[4] * r[4] + r[5] * r[5]);
    pose->degrees = r[6];
    if (r[6] == 0.0) return TOBI_OK;
    if (!(length > 0.0))
        return tobi_fail(err, TOBI_SCRIPT,
                         "%s: place returned a turn about a zero axis"
                         " (t = %.9g s)",
                         s->label, t);
    for (int a = 0; a < 3; a++) pose->axis[a] = r[3 + a] / length;
    return TOBI_OK;
}

tobi_status tobi_script_place(tobi_script *s, double t, tobi_pose *pose, tobi_error *err)
{
    double r[7] = { 0 };
    s->channel->time = t;
    const char *why = ask(s, TOBI_REQUEST_PLACE);
    if (why) return tobi_fail(err, TOBI_SCRIPT, "%s: %s (t = %.9g s)", s->label, why, t);
    int64_t count = s->channel->count;
    bool good = count == 3 || count == 7;
    for (int k = 0; good && k < count; k++) {
        r[k] = s->channel->to[k/3][k%3];
        good = isfinite(r[k]);
    }
    if (!good)
        return tobi_fail(err, TOBI_SCRIPT,
                         "%s: place must return three finite numbers "
                         "(shift) or seven (shift, axis, degrees) (t = %.9g s)",
                         s->label, t);
    *pose = (tobi_pose){ .shift = { r[0], r[1], r[2] }, .axis = { 0.0, 0.0, 1.0 } };
    memcpy(pose->pivot, s->pivot, sizeof pose->pivot);
    return count == 7 ? set_turn(s, t, r, pose, err) : TOBI_OK;
}

tobi_status tobi_script_control(void *user, const tobi_control_input *in, tobi_control_output *out,
                                tobi_error *err)
{
    TOBI_NEED(user, "the script");
    TOBI_NEED(in && out, "the input or the output");
    tobi_script *s = user;
    enum { JOINTS = 33 + TOBI_CONTROL_STATE, FROM = JOINTS + 3*TOBI_CONTROL_JOINTS,
           MOTORS = 10 + TOBI_CONTROL_STATE, INTO = MOTORS + TOBI_CONTROL_JOINTS };
    double from[FROM] = { in->time }, into[INTO] = { 0, 0, 0, 0, 0, 0, in->phase };
    memcpy(from + 1, in->position, 3*sizeof *from);
    memcpy(from + 4, in->orientation, 4*sizeof *from);
    memcpy(from + 8, in->velocity, 3*sizeof *from);
    memcpy(from + 11, in->angular_velocity, 3*sizeof *from);
    memcpy(from + 14, in->contact_force, 3*sizeof *from);
    memcpy(from + 17, in->contact_torque, 3*sizeof *from);
    from[20] = in->mass;
    from[21] = in->phase;
    from[22] = in->phase_time;
    from[23] = in->step;
    memcpy(from + 24, in->steer, 3*sizeof *from);
    memcpy(from + 27, in->inertia, sizeof in->inertia);
    memcpy(from + 33, in->state, sizeof in->state);
    memcpy(into + 7, in->steer, 3*sizeof *into);
    memcpy(into + 10, in->state, sizeof in->state);
    const int joints = in->joint_count < TOBI_CONTROL_JOINTS ? in->joint_count : TOBI_CONTROL_JOINTS;
    for (int k = 0; k < joints; k++) {
        from[JOINTS + 3*k] = in->joints[k].angle;
        from[JOINTS + 3*k + 1] = in->joints[k].speed;
        from[JOINTS + 3*k + 2] = in->joints[k].slides;
        snprintf(s->channel->joint[k], sizeof s->channel->joint[k], "%s", in->joints[k].name);
    }
    for (int k = 0; k < TOBI_CONTROL_JOINTS; k++) into[MOTORS + k] = TOBI_NOT_GIVEN;
    s->channel->count = joints;
    memcpy(s->channel->from, from, sizeof from);
    memcpy(s->channel->to, into, sizeof into);
    const char *why = ask(s, TOBI_REQUEST_CONTROL);
    if (why) return tobi_fail(err, TOBI_SCRIPT, "%s: %s (t = %.9g s)", s->label, why, in->time);
    memcpy(into, s->channel->to, sizeof into);
    for (int k = 0; k < INTO; k++) {
        const char *what = k < 3 ? "force" : k < 6 ? "torque" : k < 7 ? "phase" : k < 10 ? "steer" :
                           k < MOTORS ? "state" : "motor";
        if (!(fabs(into[k]) <= (k != 6 ? DBL_MAX : 1e9)))
            return tobi_fail(err, TOBI_SCRIPT, "%s: control returned a %s that is not finite (t = %.9g s)",
                             s->label, what, in->time);
    }
    copy_text(s->hold, s->channel->hold, sizeof s->hold);
    memcpy(out->force, into, sizeof out->force);
    memcpy(out->torque, into + 3, sizeof out->torque);
    out->phase = (int)into[6];
    memcpy(out->steer, into + 7, sizeof out->steer);
    memcpy(out->state, into + 10, sizeof out->state);
    memcpy(out->motor, into + MOTORS, sizeof out->motor);
    out->hold = s->hold;
    return TOBI_OK;
}
