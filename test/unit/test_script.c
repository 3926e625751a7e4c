/* Scripts in their processes: limits of time and memory, death, signals, hosts with threads, and
   that two runs see the same. What motions make of scripts is in test_motion.c. */
#include "rigid/script.h"
#include <dirent.h>
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <cmocka.h>

#define REST(p) ((const double (*)[3])(p))
#define SHORT   0.1      /* s, limit of processor time */

static tobi_status load(const char *text, double seconds, tobi_script **script, tobi_error *err)
{
    char path[] = "/tmp/tobiuo_script_XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, strlen(text)), (ssize_t)strlen(text));
    close(fd);
    tobi_status status = tobi_script_load_within(path, NULL, TOBI_MOTION_SCRIPT, seconds, script, err);
    unlink(path);
    return status;
}

static tobi_script *load_good(const char *text, double seconds)
{
    tobi_script *script;
    tobi_error err = { 0 };
    if (load(text, seconds, &script, &err) != TOBI_OK) fail_msg("<%s>: %s", text, err.text);
    return script;
}

/* The script fails while it is loaded, or for the first point. */
static void expect(const char *text, const char *part, const char *absent)
{
    tobi_script *script;
    tobi_error err = { 0 };
    double point[1][3] = { { 1, 2, 3 } }, moved[1][3];
    tobi_status status = load(text, SHORT, &script, &err);
    if (status == TOBI_OK) {
        status = tobi_script_deform(script, 0.5, 1, REST(point), moved, &err);
        tobi_script_free(script);
    }
    const char *said = strstr(err.text, ": ");          /* the name of the file may hold any letters */
    if (status != TOBI_SCRIPT || !said || !strstr(said, part) || (absent && strstr(said, absent)))
        fail_msg("<%.200s>: status %d, message <%s>, expected <%s>", text, status, err.text, part);
    assert_memory_equal(err.text, "motion script /", 15);
}

/* The child of this process; a test has one at a time. */
static pid_t find_child(void)
{
    char path[64];
    int child = 0;
    snprintf(path, sizeof path, "/proc/self/task/%d/children", (int)getpid());
    FILE *file = fopen(path, "r");
    if (!file) skip();
    if (fscanf(file, "%d", &child) != 1) child = 0;
    fclose(file);
    return child;
}

static const char still[] = "function deform(x, y, z, t) return x, y, z end";

#define LOOP ": endless loop? stopped after 0.1 s of processor time"
#define CALL ": endless loop? stopped after 0.1 s of processor time, inside one call of a function"

static void endless_loops_end(void **state)
{
    (void)state;
    static const struct { const char *text, *part; } bad[] = {
        { "while true do end", ":1" LOOP },
        { "\n\nrepeat until false", ":3" LOOP },
        { "for i = 1, 1/0 do end", ":1" LOOP },
        { "for i = 1, 0, 0 do end local function f() return f() end f()", ":1" LOOP },
        { "local x = 0\n::a::\nx = x + 1\ngoto a", LOOP },
        { "local f = function(a) return a(a) end f(f)", ":1" LOOP },
        { "function deform(x, y, z, t)\n while t do end end", ":2" LOOP },
        { "local t = {} for k = 1, 1e5 do t[k] = k end\n"
          "while true do for _ in pairs(t) do end end", ":2" LOOP },
        /* the guard of former versions took these for comments and texts */
        { "--\rwhile true do end\n", LOOP },
        { "local s = 'a\\z\n  ' while true do end --'", ":2" LOOP },
        { "local s = 'a\\\r\n' while true do end --'", ":2" LOOP },
        { "table.insert({}, 2^53, 1)", CALL },
        { "local s = 'x' for k = 1, 22 do s = s .. s end\n"
          "local a, b, t = s .. 'a', s .. 'b', {}\n"
          "for k = 1, 20000 do t[k] = k % 2 == 0 and a or b end\n"
          "table.sort(t)", CALL },
    };
    for (size_t k = 0; k < sizeof bad/sizeof *bad; k++) expect(bad[k].text, bad[k].part, NULL);
}

/* Late in a run, when the function is long compiled; the point in work is named, and the end is final. */
static void a_stopped_script_stays_stopped(void **state)
{
    (void)state;
    tobi_script *s = load_good("function deform(x, y, z, t)\n"
                               "    local k = 0\n"
                               "    while k < 5 or (t > 0.5 and x > 8999) do k = k + 1 end\n"
                               "    return x + k, y, z\nend", 0.2);
    tobi_error err = { 0 };
    enum { N = 10000 };
    static double rest[N][3], p[N][3];
    for (int i = 0; i < N; i++) rest[i][0] = i;
    for (int step = 0; step < 20; step++) {
        assert_int_equal(tobi_script_deform(s, 0.01*step, N, REST(rest), p, &err), TOBI_OK);
        for (int i = 0; i < N; i++) assert_true(p[i][0] == i + 5);
    }
    for (int call = 0; call < 2; call++) {
        assert_int_equal(tobi_script_deform(s, 0.51, N, REST(rest), p, &err), TOBI_SCRIPT);
        assert_non_null(strstr(err.text, ":3: endless loop? stopped after 0.2 s"));
        assert_non_null(strstr(err.text, "(t = 0.51 s, rest point "));
        if (!call) assert_non_null(strstr(err.text, "point 9000 0 0)"));
    }
    assert_int_equal(find_child(), 0);
    tobi_script_free(s);
}

/* Time is counted per question: a script that works long in all is no endless loop. */
static void time_is_counted_anew(void **state)
{
    (void)state;
    tobi_script *s = load_good("function place(t)\n"
                               "    local k = 0\n"
                               "    for i = 1, 1e5 do k = k + math.sin(i) end\n"
                               "    return k*0, 0, 0\nend", 0.5);
    tobi_error err = { 0 };
    tobi_pose pose;
    clockid_t clock;
    struct timespec used = { 0 };
    assert_int_equal(clock_getcpuclockid(find_child(), &clock), 0);
    for (int k = 0; (double)used.tv_sec + 1e-9*(double)used.tv_nsec < 0.7; k++) {
        if (tobi_script_place(s, k, &pose, &err)) fail_msg("%s", err.text);
        assert_int_equal(clock_gettime(clock, &used), 0);
    }
    tobi_script_free(s);
}

static void memory_has_a_limit(void **state)
{
    (void)state;
    static const char full[] = "needs more memory than a script may have, 64 MiB";
    tobi_script *s;
    tobi_error err = { 0 };
    assert_int_equal(load("local s = 'x' for i = 1, 60 do s = s .. s end", 20, &s, &err), TOBI_SCRIPT);
    assert_non_null(strstr(err.text, full));
    assert_int_equal(load("local t = {} for i = 1, 1e12 do t[i] = {} end", 20, &s, &err), TOBI_SCRIPT);
    assert_non_null(strstr(err.text, full));

    /* That is a failure like others: the script goes on answering. */
    tobi_pose pose;
    s = load_good("function place(t)\n"
                  "    local s = 'x'\n"
                  "    for i = 1, t do s = s .. s end\n"
                  "    return #s, 0, 0\nend", 20);
    assert_int_equal(tobi_script_place(s, 26, &pose, &err), TOBI_SCRIPT);
    assert_non_null(strstr(err.text, full));
    assert_non_null(strstr(err.text, "(t = 26 s)"));
    assert_int_equal(tobi_script_place(s, 23, &pose, &err), TOBI_OK);
    assert_true(pose.shift[0] == 1 << 23);
    tobi_script_free(s);
}

/* Points go over in batches of 8192. */
static void points_keep_their_places(void **state)
{
    (void)state;
    enum { N = 20000 };
    static const int counts[] = { 0, 1, 8191, 8192, 8193, 16384, 16385, N };
    static double rest[N][3], p[N][3];
    tobi_error err = { 0 };
    for (int i = 0; i < N; i++) memcpy(rest[i], (double[3]){ i, 2*i, -i }, sizeof rest[i]);
    tobi_script *s = load_good("function deform(x, y, z, t)\n"
                               "    if t > 1 and x == 12500 then return x, 0/0, z end\n"
                               "    if t > 2 and x == 8192 then error('mine\\27[2J') end\n"
                               "    return x + 0.5, y, z*t\nend", 3);
    for (size_t k = 0; k < sizeof counts/sizeof *counts; k++) {
        int n = counts[k];
        memset(p, 0, sizeof p);
        assert_int_equal(tobi_script_deform(s, 1, n, REST(rest), p, &err), TOBI_OK);
        for (int i = 0; i < n; i++) assert_true(p[i][0] == i + 0.5 && p[i][1] == 2*i && p[i][2] == -i);
        if (n < N) assert_true(p[n][0] == 0);
    }
    assert_int_equal(tobi_script_deform(s, 2, N, REST(rest), p, &err), TOBI_SCRIPT);
    assert_non_null(strstr(err.text, "deform returned a number that is not finite (t = 2 s, rest "
                                     "point 12500 25000 "));
    assert_int_equal(tobi_script_deform(s, 3, N, REST(rest), p, &err), TOBI_SCRIPT);
    assert_non_null(strstr(err.text, "mine [2J (t = 3 s, rest point 8192 16384 "));
    tobi_script_free(s);
}

/* What the script can say about itself, by way of an error. */
static void two_runs_see_the_same(void **state)
{
    (void)state;
    static const char text[] =
        "local t, s = {}, {}\n"
        "for _, k in ipairs{'alpha', 'beta', 'gamma', 'delta', 'x', 'y', 'z', 'force', 'torque'} do\n"
        "    t[k] = k end\n"
        "for _, k in ipairs{3, 1.5, -2} do t[k] = k end\n"
        "t[true], t[false] = 1, 2\n"
        "for k, v in pairs(t) do s[#s + 1] = tostring(k) .. '=' .. tostring(v) end\n"
        "for k in pairs({ 7, 8, 9 }) do s[#s + 1] = tostring(k) end\n"
        "s[#s + 1] = tostring({}) .. tostring(print) .. tostring(tostring) .. tostring(nil)\n"
        "s[#s + 1] = string.format('%s %s %5.2f %% %q', {}, math.sin, 1.25, 'q')\n"
        "s[#s + 1] = ('%s'):format(t)\n"
        "error(table.concat(s, ' '), 0)";
    static const char said[] =
        "-2=-2 1.5=1.5 3=3 alpha=alpha beta=beta delta=delta force=force gamma=gamma torque=torque "
        "x=x y=y z=z false=2 true=1 1 2 3 tablenilfunctionnil table function  1.25 % \"q\" table";
    char changed[sizeof text];
    strcpy(changed, text);
    memcpy(strstr(changed, "tostring(print)"), "tostring( nil )", 15);
    for (int k = 0; k < 4; k++) expect(changed, said, "0x");
    expect("error(string.format('100%% %-20p', {}))", "string.format knows no %p", NULL);
    expect("error(('%p'):format('x'))", "string.format knows no %p", NULL);
    expect("for k in pairs({ [{}] = 1 }) do end", ":1: pairs has no order for a key that is a table",
           NULL);
    expect("for k in pairs(3) do end", ":1: pairs needs a table, not number", NULL);
    expect("for k in next, {} do end", "attempt to call a nil value", NULL);
    expect("error({})", "an error without a text", NULL);
}

static void a_process_that_dies_is_told(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_pose pose;
    tobi_script *s = load_good("function place(t) return 1, 2, 3 end", SHORT);
    pid_t child = find_child();
    assert_true(child > 0);
    kill(child, SIGKILL);
    for (int call = 0; call < 2; call++) {
        assert_int_equal(tobi_script_place(s, 1, &pose, &err), TOBI_SCRIPT);
        assert_non_null(strstr(err.text, "its process was ended by signal 9 (Killed) (t = 1 s)"));
    }
    tobi_script_free(s);

    s = load_good("function place(t) return 1, 2, 3 end", 0.05);
    kill(find_child(), SIGSTOP);
    assert_int_equal(tobi_script_place(s, 1, &pose, &err), TOBI_SCRIPT);
    assert_non_null(strstr(err.text, "its process did not answer for 1 s (t = 1 s)"));
    assert_int_equal(find_child(), 0);
    tobi_script_free(s);
}

/* Ctrl-C, a lost terminal and `timeout` reach every process of the group; what follows is the
   loader's business. */
static void signals_are_for_the_loader(void **state)
{
    (void)state;
    static const int signals[] = { SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGALRM, SIGXCPU };
    tobi_error err = { 0 };
    tobi_pose pose;
    tobi_script *s = load_good("function place(t) return t, 2, 3 end", 3);
    pid_t child = find_child();
    for (size_t k = 0; k < sizeof signals/sizeof *signals; k++) {
        kill(child, signals[k]);
        if (tobi_script_place(s, (double)k, &pose, &err)) fail_msg("%s", err.text);
        assert_true(pose.shift[0] == (double)k);
    }
    tobi_script_free(s);
}

static void nothing_can_be_opened(void **state)
{
    (void)state;
    char path[64], line[200];
    int count = 0, limits = 0;
    tobi_script *s = load_good(still, 3);
    pid_t child = find_child();
    snprintf(path, sizeof path, "/proc/%d/fd", (int)child);
    DIR *list = opendir(path);
    for (const struct dirent *entry; list && (entry = readdir(list));) count += entry->d_name[0] != '.';
    closedir(list);
#ifdef __SANITIZE_ADDRESS__
    count--;
#endif
    assert_int_equal(count, 1);
    snprintf(path, sizeof path, "/proc/%d/limits", (int)child);
    FILE *file = fopen(path, "r");
    while (fgets(line, sizeof line, file))
        limits += (strstr(line, "Max open files ") || strstr(line, "Max file size ") ||
                   strstr(line, "Max processes ") || strstr(line, "Max core file size ")) &&
                  strstr(line, " 0                    0 ");
    fclose(file);
    assert_int_equal(limits, 4);
    tobi_script_free(s);
    assert_int_equal(kill(child, 0), -1);
}

static void *load_in_thread(void *user)
{
    *(tobi_script **)user = load_good(still, 3);
    return NULL;
}

/* The thread that loaded a script may end before the script is asked. */
static void threads_may_end(void **state)
{
    (void)state;
    pthread_t thread;
    tobi_script *s;
    tobi_error err = { 0 };
    double rest[1][3] = { { 4, 5, 6 } }, p[1][3];
    assert_int_equal(pthread_create(&thread, NULL, load_in_thread, &s), 0);
    pthread_join(thread, NULL);
    nanosleep(&(struct timespec){ 0, 50000000 }, NULL);
    if (tobi_script_deform(s, 0, 1, REST(rest), p, &err)) fail_msg("%s", err.text);
    assert_memory_equal(p, rest, sizeof p);
    tobi_script_free(s);
}

static void a_copy_of_the_loader_cannot_ask(void **state)
{
    (void)state;
    tobi_error err = { 0 };
    tobi_pose pose;
    int code;
    tobi_script *s = load_good("function place(t) return t, 0, 0 end", 3);
    pid_t copy = fork();
    if (copy == 0) {
        int refused = tobi_script_place(s, 1, &pose, &err) == TOBI_SCRIPT &&
                      strstr(err.text, "only the process that loaded it can ask it");
        tobi_script_free(s);
        _exit(refused ? 0 : 1);
    }
    waitpid(copy, &code, 0);
    assert_int_equal(code, 0);
    if (tobi_script_place(s, 7, &pose, &err)) fail_msg("%s", err.text);
    assert_true(pose.shift[0] == 7);
    tobi_script_free(s);
}

/* Where the loader is killed, no process stays. */
static void no_orphans(void **state)
{
    (void)state;
    int ends[2], code;
    pid_t child = 0;
    find_child();
    assert_int_equal(pipe(ends), 0);
    pid_t loader = fork();
    if (loader == 0) {
        load_good("function place(t) while true do end end", 3);
        child = find_child();
        if (write(ends[1], &child, sizeof child) != sizeof child) _exit(1);
        raise(SIGKILL);
    }
    assert_int_equal(read(ends[0], &child, sizeof child), sizeof child);
    waitpid(loader, &code, 0);
    close(ends[0]);
    close(ends[1]);
    assert_true(child > 0);
    char path[64], stat[64] = "";
    snprintf(path, sizeof path, "/proc/%d/stat", (int)child);
    for (int k = 0; k < 500; k++) {
        FILE *file = fopen(path, "r");
        if (!file) return;
        int zombie = fgets(stat, sizeof stat, file) && strstr(stat, ") Z");      /* nobody may reap it here */
        fclose(file);
        if (zombie) return;
        nanosleep(&(struct timespec){ 0, 10000000 }, NULL);
    }
    fail_msg("process %d is still there: %s", (int)child, stat);
}

static void many_at_once(void **state)
{
    (void)state;
    enum { N = 40 };
    tobi_script *s[N];
    tobi_error err = { 0 };
    tobi_pose pose;
    char text[100];
    for (int k = 0; k < N; k++) {
        snprintf(text, sizeof text, "function place(t) return %d*t, 0, 0 end", k);
        s[k] = load_good(text, 3);
    }
    for (int k = 0; k < N; k++) {
        if (tobi_script_place(s[k], 2, &pose, &err)) fail_msg("%s", err.text);
        assert_true(pose.shift[0] == 2*k);
    }
    for (int k = 0; k < N; k++) tobi_script_free(s[k]);
    assert_int_equal(find_child(), 0);
}

/* Somebody names a file that is no script and shows the message around. */
static void foreign_files_are_not_quoted(void **state)
{
    (void)state;
    expect("x ghp_abcdefghijklmnopqrstuvwxyz0123456789", "'=' expected near 'ghp_abcdefghijkl...'",
           "ijklm");
    expect("x = 'ghp_abcdefghijklmnopqrstuvwxyz0123456789\n",
           "unfinished string near ''ghp_abcdefghijk...'", "ijklm");
    expect("x = y 12345678901234567890123456", "near '1234567890123456...'", "78901234567");
}

static void a_process_that_cannot_start(void **state)
{
    (void)state;
    struct rlimit limit, less;
    tobi_script *s;
    tobi_error err = { 0 };
    char path[] = "/tmp/tobiuo_script_XXXXXX";
    int fd = mkstemp(path), next = dup(fd);
    assert_true(next > 0);
    close(next);
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &limit), 0);
    less = limit;
    less.rlim_cur = (rlim_t)next + 1;      /* one more file, but no pair of sockets */
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &less), 0);
    tobi_status status = tobi_script_load(path, NULL, TOBI_MOTION_SCRIPT, &s, &err);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
    assert_int_equal(status, TOBI_IO);
    assert_non_null(strstr(err.text, "its process cannot start: Too many open files"));
    assert_null(s);
    close(fd);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(endless_loops_end),
        cmocka_unit_test(a_stopped_script_stays_stopped),
        cmocka_unit_test(time_is_counted_anew),
        cmocka_unit_test(memory_has_a_limit),
        cmocka_unit_test(points_keep_their_places),
        cmocka_unit_test(two_runs_see_the_same),
        cmocka_unit_test(a_process_that_dies_is_told),
        cmocka_unit_test(signals_are_for_the_loader),
        cmocka_unit_test(nothing_can_be_opened),
        cmocka_unit_test(threads_may_end),
        cmocka_unit_test(a_copy_of_the_loader_cannot_ask),
        cmocka_unit_test(no_orphans),
        cmocka_unit_test(many_at_once),
        cmocka_unit_test(foreign_files_are_not_quoted),
        cmocka_unit_test(a_process_that_cannot_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
