/* tobiuo new FAMILY [--option value ...] [DIR]: a scene of a family. Options are those of the family, so
   they are read here and not by argp: a misspelt one is answered with the nearest. Drawback: the completion
   of words does not know them. */
#define _GNU_SOURCE
#include "app.h"
#include "language.h"
#include "family.h"
#include "tobiuo/params.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const family_option common[] = {
    { "support", TEXT("spacings"), 0, 2, 4, TEXT("support radius of the kernel (CSML); 0: the method's own"),
      0 },
    { "dimension", "1", 3, 2, 3, TEXT("2 or 3"), 0 },
    { 0 } };

const family_option *family_common(void) { return common; }

const family_option *family_option_at(const family *f, int index)
{
    int k = 0;
    for (const family_option *o = f->options; o->name; o++)
        if (k++ == index) return o;
    return index - k < (int)(sizeof common/sizeof *common) - 1 ? &common[index - k] : NULL;
}

static const family *find_family(const char *name)
{
    const family *f;
    for (int k = 0; (f = family_at(k)); k++)
        if (strcmp(f->name, name) == 0) return f;
    return NULL;
}

const char *near_family(const char *name)
{
    enum { MOST = 32 };
    const char *names[MOST];
    size_t count = 0;
    for (; count < MOST && family_at((int)count); count++) names[count] = family_at((int)count)->name;
    return tobi_suggest(name, names, count);
}

static int is_option(const char *text) { return strncmp(text, "--", 2) == 0 && text[2]; }

static int asks_help(const char *text)
{
    static const char *const words[] = { "--help", "-h", "-?", "--usage" };
    for (int k = 0; k < 4; k++)
        if (strcmp(text, words[k]) == 0) return 1;
    return 0;
}

static int is_shipped(const char *name)
{
    char file[128];
    snprintf(file, sizeof file, "%.100s/scene.json", name);
    char *shipped = tobi_scene_shipped(file);
    free(shipped);
    return shipped != NULL;
}

int wants_family(int argc, char **argv)
{
    int options = 0;
    const char *name = NULL;
    for (int k = 1; k < argc; k++) {
        if (asks_help(argv[k])) return 0;
        options += is_option(argv[k]);
        if (!name && !is_option(argv[k])) name = argv[k];
    }
    if (options || !name || !find_family(name)) return options > 0;
    return !is_shipped(name);
}

/* --- the list ------------------------------------------------------------------------------ */

static void print_option(const family_option *o)
{
    char name[32];
    snprintf(name, sizeof name, "--%s", o->name);
    printf("      %-16s %s", name, tr(o->doc));
    if (o->def != 0 || o->min == 0) printf(" (%.10g%s%s)", o->def, strcmp(o->unit, "1") ? " " : "",
                                           strcmp(o->unit, "1") ? tr(o->unit) : "");
    putchar('\n');
}

int list_families(void)
{
    const family *f;
    printf(tr("Families of scenes, their options and defaults:\n"));
    for (int k = 0; (f = family_at(k)); k++) {
        printf("  %s%-17s%s%s\n", colour(stdout, BOLD), f->name, colour(stdout, PLAIN), tr(f->doc));
        for (const family_option *o = f->options; o->name; o++) print_option(o);
    }
    printf(tr("  of all\n"));
    for (const family_option *o = common; o->name; o++) print_option(o);
    printf(tr("      --method         isph, eisph, dfsph or wcsph (isph)\n"));
    printf(tr("\nWrite one and run it:\n  tobiuo new static_pressure --spacing 0.0125 --support 2.4\n"
           "  tobiuo run static_pressure_PS0d0125_CSML2d4_RK2\n"
           "\"tobiuo scenes\" lists the shipped scenes; \"tobiuo new NAME\" copies one.\n"));
    return 0;
}

/* --- the options --------------------------------------------------------------------------- */

static int complain_usage(const char *what)
{
    complain("%s", tr(what));
    return EXIT_USAGE;
}

static int complain_option(const family *f, const char *name)
{
    const char *names[FAMILY_OPTIONS + 1];
    const family_option *o;
    size_t count = 0;
    for (; (o = family_option_at(f, (int)count)) && count < FAMILY_OPTIONS; count++) names[count] = o->name;
    names[count++] = "method";
    const char *near = tobi_suggest(name, names, count);
    complain("%s has no option --%s%s%s%s; \"tobiuo new\" lists all", f->name, name,
             near ? tr("; did you mean --") : "", near ? near : "", near ? "?" : "");
    return EXIT_USAGE;
}

static int set_method(family_choice *c, const char *value)
{
    enum { MOST = 16 };
    const char *names[MOST];
    size_t count = 0;
    tobi_method_info info;
    for (int k = 0; tobi_method_name(k) && count < MOST; k++)
        if (tobi_method_describe(tobi_method_name(k), &info) && !info.solids) names[count++] = info.name;
    for (size_t k = 0; k < count; k++)
        if (strcmp(names[k], value) == 0) {
            c->method = names[k];
            return 0;
        }
    const char *near = tobi_suggest(value, names, count);
    complain("--method: '%s' is no method of liquids%s%s%s", value, near ? tr("; did you mean ") : "",
             near ? near : "", near ? "?" : "");
    return EXIT_USAGE;
}

static int set_option(family_choice *c, const char *name, const char *value)
{
    const family_option *o;
    char *end;
    if (strcmp(name, "method") == 0) return set_method(c, value);
    for (int k = 0; (o = family_option_at(c->family, k)); k++) {
        if (strcmp(o->name, name) != 0) continue;
        c->value[k] = strtod(value, &end);
        c->given[k] = 1;
        const int plain = strcmp(o->unit, "1") == 0;         /* a choice: 2-D or 3-D, which post */
        const int whole = !plain || c->value[k] == floor(c->value[k]);
        const int own = o->def == 0 && c->value[k] == 0;         /* as its sentence says */
        if (end != value && !*end && whole && (own || c->value[k] >= o->min)
            && c->value[k] <= o->max) return 0;
        complain("--%s: '%s' is not a %snumber from %g to %g%s%s", name, value, plain ? tr("whole ") : "",
                 o->min, o->max, plain ? "" : " ", plain ? "" : o->unit);
        return EXIT_USAGE;
    }
    return complain_option(c->family, name);
}

/* A 2-D scene would take the option and never use it. */
static int object_across(const family_choice *c)
{
    const family_option *o;
    for (int k = 0; c->dimension == 2 && (o = family_option_at(c->family, k)); k++) {
        if (!o->across || !c->given[k]) continue;
        complain("--%s: a 2-D scene has no width; leave it out, or set --dimension 3", o->name);
        return EXIT_USAGE;
    }
    return 0;
}

/* "--name value" or "--name=value" at argv[*at]. */
static int read_option(family_choice *c, int argc, char **argv, int *at)
{
    char name[64];
    const char *text = argv[*at] + 2, *equals = strchr(text, '=');
    snprintf(name, sizeof name, "%.*s", equals ? (int)(equals - text) : 60, text);
    if (equals) return set_option(c, name, equals + 1);
    if (*at + 1 < argc) return set_option(c, name, argv[++*at]);
    complain("--%s wants a value", name);
    return EXIT_USAGE;
}

static int read_arguments(family_choice *c, int argc, char **argv, const char **dir)
{
    int code = 0, name = 0;
    const family_option *o;
    while (++name < argc && is_option(argv[name])) name += !strchr(argv[name], '=');
    c->family = name < argc ? find_family(argv[name]) : NULL;
    if (!c->family) {
        const char *given = name < argc ? argv[name] : "", *near = near_family(given);
        if (name < argc && is_shipped(given)) {
            complain("%s is a shipped scene: it takes no options; copy it, then change its scene.json, or "
                     "give \"tobiuo run\" --set", given);
            return EXIT_USAGE;
        }
        complain("there is no family '%s'%s%s%s; \"tobiuo new\" lists them", given,
                 near ? tr("; did you mean ") : "", near ? near : "", near ? "?" : "");
        return EXIT_USAGE;
    }
    for (int k = 0; (o = family_option_at(c->family, k)); k++) c->value[k] = o->def;
    for (int k = 1; k < argc && !code; k++) {
        if (is_option(argv[k])) code = read_option(c, argc, argv, &k);
        else if (k != name && *dir) code = complain_usage(TEXT("one FAMILY and one DIR only"));
        else if (k != name) *dir = argv[k];
    }
    c->dimension = (int)chosen(c, "dimension");
    return code ? code : object_across(c);
}

/* --- the scene ----------------------------------------------------------------------------- */

/* "0.0125" becomes "0d0125". */
static void put_number(FILE *out, const char *head, double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.10g", value);
    for (char *p = text; *p; p++)
        if (*p == '.') *p = 'd';
    fprintf(out, "_%s%s", head, text);
}

int is_given(const family_choice *c, const char *option)
{
    const family_option *o;
    for (int k = 0; (o = family_option_at(c->family, k)); k++)
        if (strcmp(o->name, option) == 0) return c->given[k];
    return 0;
}

/* As users of the tank program name their runs: static_pressure_PS0d0125_CSML2d4_RK2. */
static char *name_choice(const family_choice *c)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) exit(complain("out of memory"));
    const int isph = strcmp(c->method, "isph") == 0;
    fputs(c->family->name, out);
    if (c->dimension == 2) fputs("_2d", out);
    if (is_given(c, "spacing")) put_number(out, "PS", chosen(c, "spacing"));
    if (is_given(c, "support")) put_number(out, "CSML", chosen(c, "support"));
    if (isph && (is_given(c, "spacing") || is_given(c, "support")))
        fprintf(out, "_RK%d", tobi_default_isph_def().time_order);
    if (!isph) fprintf(out, "_%s", c->method);
    if (fclose(out) != 0) exit(complain("out of memory"));
    return text;
}

/* Without the place in front, which is one in a file that nobody will see. */
static void complain_line(const family_choice *c, const char *line)
{
    const size_t head = strlen(c->family->name);
    if (strncmp(line, c->family->name, head) == 0 && line[head] == ':')
        line += head + strspn(line + head, ":0123456789 ");
    complain("%s: %s", c->family->name, line);
}

static int complain_choice(const family_choice *c, tobi_report *report, const tobi_error *err)
{
    const family_option *o;
    const int count = tobi_report_count(report);
    for (int k = 0; k < count; k++) complain_line(c, tobi_report_line(report, k));
    if (count == 0) complain_line(c, err->text);
    char *given = NULL;
    size_t size;
    FILE *out = open_memstream(&given, &size);
    if (!out) exit(complain("out of memory"));
    for (int k = 0; (o = family_option_at(c->family, k)); k++)
        if (c->given[k]) fprintf(out, " --%s %.10g", o->name, c->value[k]);
    if (fclose(out) != 0) exit(complain("out of memory"));
    complain("no scene is written; given:%s", given);
    free(given);
    return EXIT_ERROR;
}

/* What `tobiuo check` would refuse is not written: a family knows its dimensions, not all rules of scenes. */
static int prove(const family_choice *c, const char *text, size_t size)
{
    tobi_scene *scene = NULL;
    tobi_report *report = NULL;
    tobi_error err = { 0 };
    tobi_status status = tobi_scene_parse(c->family->name, text, size, NULL, &scene, &report, &err);
    if (status == TOBI_OK) status = try_scene(scene, &err);
    const int code = status == TOBI_OK ? 0 : complain_choice(c, report, &err);
    tobi_report_free(report);
    tobi_scene_free(scene);
    return code;
}

static int write_folder(const char *dir, const char *text, size_t size)
{
    char *path = NULL;
    if (asprintf(&path, "%s/scene.json", dir) < 0) return complain("out of memory");
    int code = mkdir(dir, 0777) == 0 ? 0
             : errno == EEXIST ? complain("%s is there already; name another folder", dir)
                               : complain("cannot make the folder '%s': %s", dir, tr(strerror(errno)));
    if (!code && (code = write_new(path, text, size)) != 0) rmdir(dir);
    free(path);
    return code;
}

static int write_scene(const family_choice *c, const char *dir)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) return complain("out of memory");
    c->family->write(c, out);
    int code = fclose(out) == 0 ? prove(c, text, size) : complain("out of memory");
    if (!code) code = write_folder(dir, text, size);
    free(text);
    return code;
}

int write_family(int argc, char **argv)
{
    family_choice c = { .method = "isph" };
    const char *dir = NULL;
    int code = read_arguments(&c, argc, argv, &dir);
    if (code) return code;
    if (c.dimension == 2 && !c.family->flat) return complain("%s is 3-D only", c.family->name);
    const char *object = c.family->object ? c.family->object(&c) : NULL;
    if (object) return complain("%s: %s", c.family->name, tr(object));
    char *own = dir ? NULL : name_choice(&c);
    if (!dir) dir = own;
    code = write_scene(&c, dir);
    char quoted[SHELL_WORD];
    if (!code)
        printf(tr("%s/scene.json is a scene of %s. Run it: tobiuo run %s\n"), dir, c.family->name,
               shell_word(dir, quoted));
    free(own);
    return code;
}
