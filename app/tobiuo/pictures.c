/* The pictures of a run, DIR/frames/NAME_000000.png: which there are, and a row without gaps for ffmpeg, by
   links. Drawback: a file system without links has no movie of pictures with gaps. */
#define _GNU_SOURCE
#include "app.h"
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char *frame_path(const char *dir, const char *view, int64_t number)
{
    char *path = NULL;
    return asprintf(&path, "%s/frames/%s_%06lld.png", dir, view ? view : "frame", (long long)number) < 0
        ? NULL : path;
}

int is_picture(const char *dir, const char *view, int64_t number)
{
    char *path = frame_path(dir, view, number);
    const int there = path && access(path, R_OK) == 0;
    free(path);
    return there;
}

/* The number in NAME_000000.png; -1: another file. */
static long long number_of(const char *file, const char *view)
{
    const size_t length = strlen(view);
    if (strncmp(file, view, length) != 0 || file[length] != '_') return -1;
    const char *digits = file + length + 1;
    const size_t count = strspn(digits, "0123456789");
    if (count < 6 || count > 12 || strcmp(digits + count, ".png") != 0) return -1;
    return strtoll(digits, NULL, 10);
}

pictures find_pictures(const char *dir, const char *view)
{
    pictures p = { 0 };
    char *path = join_path(dir, "frames");
    DIR *folder = opendir(path);
    for (struct dirent *e; folder && (e = readdir(folder));) {
        const long long k = number_of(e->d_name, view ? view : "frame");
        if (k < 0 || !is_picture(dir, view, k)) continue;
        if (p.count == 0 || k < p.first) p.first = k;
        if (k >= p.end) p.end = k + 1;
        p.count++;
    }
    if (folder) closedir(folder);
    free(path);
    return p;
}

int64_t shown_picture(const char *dir, const char *view, const pictures *p, int64_t number)
{
    while (number > p->first && !is_picture(dir, view, number)) number--;
    return number;
}

char *list_gaps(const char *dir, const char *view, const pictures *p)
{
    enum { MOST = 8 };
    char *text = NULL;
    size_t size;
    int gaps = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    for (int64_t k = p->first, last; k < p->end; k = last + 1) {
        last = k;
        if (is_picture(dir, view, k)) continue;
        while (last + 1 < p->end && !is_picture(dir, view, last + 1)) last++;
        if (gaps++ >= MOST) continue;
        fprintf(out, "%s%lld", gaps > 1 ? ", " : "", (long long)k);
        if (last > k) fprintf(out, tr(" to %lld"), (long long)last);
    }
    if (gaps > MOST) fprintf(out, tr(" and %d gaps more"), gaps - MOST);
    if (fclose(out) == 0) return text;
    free(text);
    return NULL;
}

char *find_damaged(const char *dir, const char *view)
{
    const pictures p = find_pictures(dir, view);
    for (int64_t k = p.first; k < p.end; k++) {
        char *path = is_picture(dir, view, k) ? frame_path(dir, view, k) : NULL;
        if (path && is_damaged(path)) return path;
        free(path);
    }
    return NULL;
}

void clear_pictures(const char *folder, const char *view)
{
    const pictures p = find_pictures(folder, view);
    for (int64_t k = p.first; k < p.end; k++) {
        char *path = frame_path(folder, view, k);
        if (path) unlink(path);
        free(path);
    }
    char *frames = join_path(folder, "frames");
    rmdir(frames);
    rmdir(folder);
    free(frames);
}

/* The link of picture k - first in the folder, to what is shown at k. */
static int link_picture(const char *dir, const char *view, const pictures *p, int64_t k, const char *folder)
{
    char *from = frame_path(dir, view, shown_picture(dir, view, p, k));
    char *whole = from ? realpath(from, NULL) : NULL, *to = frame_path(folder, view, k - p->first);
    const int code = !whole || !to ? complain("cannot link %s: %s", from ? from : dir, tr(strerror(errno)))
                   : symlink(whole, to) == 0 ? 0
                   : complain("cannot make the link %s: %s", to, tr(strerror(errno)));
    free(from);
    free(whole);
    free(to);
    return code;
}

int link_pictures(const char *dir, const char *view, const pictures *p, char *folder)
{
    int code = mkdtemp(folder) ? 0 : complain("cannot make a folder %s: %s", folder, tr(strerror(errno)));
    if (code != 0) return code;
    char *frames = join_path(folder, "frames");
    code = make_series_folder(frames);
    for (int64_t k = p->first; code == 0 && k < p->end; k++) code = link_picture(dir, view, p, k, folder);
    if (code != 0) clear_pictures(folder, view);
    free(frames);
    return code;
}
