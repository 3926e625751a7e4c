/* Screenshots and movies of the window, in the folder of the results: window_1.png, window_2.mp4. A movie
   has the pictures in the order in which they were seen, without what is written over them; steps of the
   camera and outputs alike. Drawback: it is encoded at its end, while the window waits. */
#define _GNU_SOURCE 1
#include "viewer.h"
#include "../tobiuo/app.h"
#include <errno.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const double RATE = 30;         /* pictures per second of a movie */

/* DIR/window_N and the ending, the first that is free; owned by the caller. */
static char *free_name(const viewer *v, const char *ending)
{
    for (int n = 1;; n++) {
        char *path = NULL;
        if (asprintf(&path, "%s/window_%d%s", v->def.dir, n, ending) < 0) return NULL;
        if (access(path, F_OK) != 0) return path;
        free(path);
    }
}

static int write_png(const char *path, const unsigned char *rgb, int width, int height)
{
    png_image image = { .version = PNG_IMAGE_VERSION, .format = PNG_FORMAT_RGB, .width = (png_uint_32)width,
                        .height = (png_uint_32)height };
    return png_image_write_to_file(&image, path, 0, rgb, 0, NULL) ? 0 : -1;
}

void take_shot(viewer *v)
{
    char *path = free_name(v, ".png");
    v->wants_shot = 0;
    if (path && write_png(path, v->pixels, v->width, v->height) == 0) viewer_note(v, "%.280s", path);
    else viewer_note(v, TEXT("cannot write %.260s"), path ? path : window_text(v, TEXT("a screenshot")));
    free(path);
}

static char *picture_path(const viewer *v, int64_t number)
{
    char *path = NULL;
    return asprintf(&path, "%s/frames/frame_%06lld.png", v->recording, (long long)number) < 0 ? NULL : path;
}

void record_picture(viewer *v)
{
    if (v->kept == v->painted) return;
    char *path = picture_path(v, v->recorded);
    if (path && write_png(path, v->painting.rgb, v->width, v->height) == 0) {
        v->recorded++;
        v->kept = v->painted;
    } else {
        viewer_note(v, TEXT("cannot write %.260s"), path ? path : window_text(v, TEXT("a picture")));
    }
    free(path);
}

static void begin(viewer *v)
{
    char *frames = NULL;
    v->recording = free_name(v, "_pictures");
    v->recorded = 0;
    v->kept = -1;
    if (!v->recording || asprintf(&frames, "%s/frames", v->recording) < 0) return;
    if (mkdir(v->recording, 0777) != 0 || mkdir(frames, 0777) != 0) {
        viewer_note(v, TEXT("cannot make %.200s: %s"), frames, tr(strerror(errno)));
        free(v->recording);
        v->recording = NULL;
    } else {
        viewer_note(v, TEXT("recording; m ends it"));
    }
    free(frames);
    v->dirty = 1;
}

static void remove_pictures(viewer *v)
{
    char *path;
    for (int64_t k = 0; k < v->recorded && (path = picture_path(v, k)); k++) {
        unlink(path);
        free(path);
    }
    if (asprintf(&path, "%s/frames", v->recording) < 0) return;
    rmdir(path);
    rmdir(v->recording);
    free(path);
}

/* Without ffmpeg the pictures stay. */
static void end(viewer *v)
{
    char *movie = free_name(v, ".mp4");
    if (v->recorded == 0) {
        remove_pictures(v);
        viewer_note(v, TEXT("nothing was recorded"));
    } else if (movie && prepare_movie(movie, 0) == 0 && encode_pictures(v->recording, movie, RATE) == 0) {
        remove_pictures(v);
        viewer_note(v, "%.280s", movie);
    } else {
        viewer_note(v, TEXT("no movie: it needs ffmpeg. The pictures are in %.240s"), v->recording);
    }
    free(movie);
    free(v->recording);
    v->recording = NULL;
}

void toggle_recording(viewer *v)
{
    if (v->recording) end(v);
    else begin(v);
}
