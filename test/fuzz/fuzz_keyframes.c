/* Keyframes: whatever rows pass give finite shifts and true rotations at any time, between the rows too. */
#include "target.h"
#include "rigid/keyframes.h"
#include <math.h>

static void check_pose(const tobi_keyframes *frames, double t)
{
    double shift[3], turn[3][3];
    tobi_keyframes_pose(frames, t, shift, turn);
    for (int a = 0; a < 3; a++) {
        double length = turn[a][0]*turn[a][0] + turn[a][1]*turn[a][1] + turn[a][2]*turn[a][2];
        PROMISE(isfinite(shift[a]) && fabs(length - 1) < 1e-9);
    }
}

/* Numbers that lines begin with are mostly the rows' times: at them, and next to them. */
static void check_rows(const tobi_keyframes *frames, const char *text)
{
    double last = 0;
    for (int lines = 0; text && lines < 1000; lines++) {
        double t = strtod(text, NULL);
        if (isfinite(t)) {
            check_pose(frames, t);
            for (int k = 1; k < 4; k++) check_pose(frames, last + 0.25*k*(t - last));
            last = t;
        }
        text = strchr(text, '\n');
        if (text) text++;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const double times[] = { -1e300, -1, 0, 0.1, 0.5, 0.77, 1, 2, 1e9, 1e30, 1e300 };
    char path[64], *text = calloc(size + 1, 1);
    int fd = make_file(data, size, path);
    tobi_keyframes *frames = NULL;
    tobi_error err = { 0 };
    PROMISE(text);
    if (size) memcpy(text, data, size);
    if (passed(tobi_keyframes_load(path, &frames, &err), &err)) {
        for (size_t i = 0; i < sizeof times/sizeof *times; i++) check_pose(frames, times[i]);
        check_rows(frames, text);
    } else {
        PROMISE(!frames && strstr(err.text, path));
    }
    tobi_keyframes_free(frames);
    free(text);
    close(fd);
    return 0;
}
