/* tobiuo scenes, tobiuo new NAME [DIR]: the shipped scenes, listed and copied (families: new.c). A copy
   stands alone: files that the scene takes from other folders ("../") are copied too, and the scene names
   the copies. Drawback:
   that is done on the text, so a comment that quotes such a path is changed as well. */
#define _GNU_SOURCE
#include "app.h"
#include "language.h"
#include <dirent.h>
#include <errno.h>
#include <ftw.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char *join(const char *folder, const char *name)
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", folder, name) < 0) exit(complain("out of memory"));
    return path;
}

/* The whole of a file, ended by 0; NULL after a complaint. */
static char *read_text(const char *path, size_t *size)
{
    struct stat st;
    FILE *file = fopen(path, "rb");
    char *text = file && fstat(fileno(file), &st) == 0 ? malloc((size_t)st.st_size + 1) : NULL;
    *size = text ? fread(text, 1, (size_t)st.st_size, file) : 0;
    if (text) text[*size] = '\0';
    else complain("%s: %s", path, tr(strerror(errno)));
    if (file) fclose(file);
    return text;
}

int write_new(const char *path, const char *text, size_t size)
{
    FILE *file = fopen(path, "wbx");
    if (!file) return complain("%s: %s", path, tr(strerror(errno)));
    int failed = fwrite(text, 1, size, file) == size ? 0 : errno;
    if (fclose(file) != 0 && !failed) failed = errno;
    if (!failed) return 0;
    unlink(path);
    return complain("%s: %s", path, tr(strerror(failed)));
}

static int copy_file(const char *from, const char *to)
{
    size_t size;
    char *text = read_text(from, &size);
    int code = !text ? EXIT_ERROR : access(to, F_OK) == 0 ? 0 : write_new(to, text, size);
    free(text);
    return code;
}

static int make_folder(const char *path)
{
    if (mkdir(path, 0777) == 0 || errno == EEXIST) return 0;
    return complain("cannot make the folder '%s': %s", path, tr(strerror(errno)));
}

/* --- the list ----------------------------------------------------------------------------- */

/* The first sentence of the comments that a scene begins with. */
static void print_purpose(const char *text)
{
    char sentence[400];
    size_t length = 0;
    int ended = 0;
    for (const char *p = text; p[0] == '/' && p[1] == '/' && !ended;) {
        for (p += 2; *p && *p != '\n' && !ended; p++) {
            if (length < sizeof sentence - 1) sentence[length++] = *p;
            ended = *p == '.' && (p[1] == '\n' || p[1] == ' ');
        }
        if (*p) p++;
    }
    sentence[length] = '\0';
    printf(" %s", tr(sentence + strspn(sentence, " ")));
}

int tobiuo_scenes(int argc, char **argv)
{
    size_t count, size;
    parse_arguments(&scenes_argp, argc, argv, NULL);
    char *folder = tobi_scene_shipped(".");
    if (!folder) return complain("the shipped scenes are not there");
    char **names = list_scenes(folder, &count), *shown = relative_path(folder);
    printf(tr("Scenes in %s:\n"), shown);
    for (size_t k = 0; k < count; k++) {
        char *scene = join(folder, names[k]), *path = join(scene, "scene.json");
        char *text = read_text(path, &size);
        printf("  %s%-17s%s", colour(stdout, BOLD), names[k], colour(stdout, PLAIN));
        if (text) print_purpose(text);
        putchar('\n');
        free(text);
        free(path);
        free(scene);
    }
    printf(tr("\nCopy one, change it and run it:\n  tobiuo new dam_break my_dam\n  tobiuo run my_dam\n"));
    free_names(names, count);
    free(folder);
    free(shown);
    return 0;
}
const struct argp scenes_argp = { .doc = "List the shipped scenes. \"tobiuo new\" copies one." };

/* --- the copy ----------------------------------------------------------------------------- */

/* All but what describes the original. */
static int copy_folder(const char *from, const char *to)
{
    int code = make_folder(to);
    DIR *dir = opendir(from);
    for (struct dirent *entry; dir && !code && (entry = readdir(dir));) {
        const char *name = entry->d_name;
        struct stat st;
        if (name[0] == '.' || strcmp(name, "README.md") == 0 || strcmp(name, "picture.png") == 0 ||
            strcmp(name, "scene.json") == 0)
            continue;
        char *source = join(from, name), *target = join(to, name);
        if (stat(source, &st) == 0)
            code = S_ISDIR(st.st_mode) ? copy_folder(source, target) : copy_file(source, target);
        free(source);
        free(target);
    }
    if (dir) closedir(dir);
    return code;
}

/* A file from beside the scene's folder: into the copy, which then calls it `name`. */
static int fetch_file(const char *from, const char *path, const char *to, char *name, size_t room)
{
    const char *base = strrchr(path, '/') + 1, *dot = strrchr(base, '.');
    const int script = dot && (strcmp(dot, ".lua") == 0 || strcmp(dot, ".csv") == 0);
    char *source = join(from, path), *meshes = join(to, "meshes");
    snprintf(name, room, "%s%s", script ? "" : "meshes/", base);
    char *target = join(to, name);
    int code = script ? 0 : make_folder(meshes);
    if (!code) code = copy_file(source, target);
    free(source);
    free(meshes);
    free(target);
    return code;
}

static int copy_scene(const char *from, const char *to)
{
    size_t size, room = 0;
    char *path = join(from, "scene.json"), *text = read_text(path, &size), *copy = NULL, name[256];
    free(path);
    FILE *out = text ? open_memstream(&copy, &room) : NULL;
    int code = out ? 0 : EXIT_ERROR;
    for (const char *p = text, *end; !code && *p; p++) {
        fputc(*p, out);
        if (strncmp(p, "\"../", 4) != 0 || !(end = strchr(p + 1, '"'))) continue;
        char *outside = strndup(p + 1, (size_t)(end - p) - 1);
        code = outside ? fetch_file(from, outside, to, name, sizeof name) : complain("out of memory");
        if (!code) fprintf(out, "%s\"", name);
        free(outside);
        p = end;
    }
    if (out) fclose(out);
    path = join(to, "scene.json");
    if (!code) code = write_new(path, copy, room);
    free(path);
    free(copy);
    free(text);
    return code;
}

static int remove_entry(const char *path, const struct stat *st, int type, struct FTW *place)
{
    (void)st, (void)type, (void)place;
    return remove(path);
}

/* A copy is whole or not at all. The folder is not there before, so all in it is of this copy. */
static int copy_whole(const char *from, const char *to)
{
    struct stat st;
    if (lstat(to, &st) == 0) return complain("%s is there already; name another folder", to);
    int code = copy_folder(from, to);
    if (!code) code = copy_scene(from, to);
    if (code) nftw(to, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    return code;
}

typedef struct new_options { const char *name, *dir; } new_options;

static error_t parse(int key, char *value, struct argp_state *state)
{
    new_options *o = state->input;
    if (key != ARGP_KEY_ARG) return key == ARGP_KEY_END ? 0 : ARGP_ERR_UNKNOWN;
    if (o->dir) usage_error(state, tr("one NAME and one DIR only"));
    if (o->name) o->dir = value;
    else o->name = value;
    return 0;
}
const struct argp new_argp = { .parser = parse, .args_doc = "NAME [DIR]",
    .doc = "Write a scene of a family, with --option VALUE for its dimensions, or copy a shipped scene to "
           "DIR (NAME in the current folder), with all files that it needs. Without NAME: list families." };

int tobiuo_new(int argc, char **argv)
{
    new_options o = { 0 };
    for (int k = 0; k < argc - 1; k++) {              /* not an option of a family */
        const int taken = take_language(argc - k, argv + k);
        if (taken < 0) return EXIT_USAGE;
        memmove(argv + k + 1, argv + k + 1 + taken, (size_t)(argc - k - taken)*sizeof *argv);
        argc -= taken;
    }
    if (wants_family(argc, argv)) return write_family(argc, argv);
    parse_arguments(&new_argp, argc, argv, &o);
    if (!o.name) return list_families();
    const char *slash = strrchr(o.name, '/'), *name = slash ? slash + 1 : o.name;
    const char *dir = o.dir ? o.dir : name;
    char *file = join(name, "scene.json"), *path = *name && *name != '.' ? tobi_scene_shipped(file) : NULL;
    free(file);
    if (!path) {
        char *near = near_scene(name);
        const char *word = near && strrchr(near, '/') ? strrchr(near, '/') + 1 : near_family(name);
        complain("there is no shipped scene or family '%s'%s%s%s; \"tobiuo scenes\" and \"tobiuo new\" "
                 "list them", o.name, word ? tr("; did you mean ") : "", word ? word : "", word ? "?" : "");
        free(near);
        return EXIT_ERROR;
    }
    *strrchr(path, '/') = '\0';
    const int code = copy_whole(path, dir);
    char quoted[SHELL_WORD];
    if (!code)
        printf(tr("%s is a copy of %s. Change %s/scene.json, then: tobiuo run %s\n"), dir, name, dir,
               shell_word(dir, quoted));
    free(path);
    return code;
}
