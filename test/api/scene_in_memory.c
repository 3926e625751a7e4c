/* A scene that a user's program writes itself: its mistakes, a run, gravity that changes between steps, and
   particles known by their ids. Build: cc scene_in_memory.c $(pkg-config --cflags --libs tobiuo) */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tobiuo/scene.h>

static const char text[] =
    "{ \"domain\": { \"min\": [0, 0], \"max\": [0.2, 0.2] }, \"dimension\": 2, \"spacing\": 0.01,   # m\n"
    "  \"end_time\": 1,\n"
    "  \"fluids\": [ { \"name\": \"water\", \"density\": 1000, \"viscosity\": 0.001,\n"
    "                \"fill\": [ { \"box\": { \"min\": [0, 0], \"max\": [0.2, 0.1] } } ] } ] }";

static int fail(const char *what, const tobi_error *err)
{
    fprintf(stderr, "scene_in_memory: %s: %s\n", what, err->text);
    return 1;
}

/* The report names file, line, column and key of every mistake. */
static int tell_mistakes(void)
{
    tobi_scene *scene;
    tobi_report *report;
    tobi_error err = { 0 };
    const char *const wrong[] = { "spacing=-1", "fluids.water.density=thick", NULL };
    if (tobi_scene_parse("tank.json", text, strlen(text), wrong, &scene, &report, &err) != TOBI_INVALID)
        return fail("two mistakes were not found", &err);
    const int count = tobi_report_count(report);
    for (int k = 0; k < count; k++) printf("%s\n", tobi_report_line(report, k));
    tobi_report_free(report);
    return count != 2;
}

/* The bowl is tilted to and fro; returns the mean height of the particles that began on the left, m. */
static tobi_status tilt(tobi_world *world, double *height, tobi_error *err)
{
    tobi_status status = tobi_world_start(world, err);
    const int64_t n = tobi_world_count(world, TOBI_FLUID);
    int64_t *id = malloc((size_t)(n + 1)*sizeof *id), left = 0;
    double (*place)[3] = malloc((size_t)(n + 1)*sizeof *place), sum = 0;
    char *mine = calloc((size_t)(n + 1), 1);
    if (!id || !place || !mine) abort();
    if (status == TOBI_OK) status = tobi_world_read(world, TOBI_FLUID, "position", place[0], n, err);
    if (status == TOBI_OK) status = tobi_world_read_ids(world, TOBI_FLUID, id, n, err);
    for (int64_t i = 0; status == TOBI_OK && i < n; i++) mine[id[i]] = place[i][0] < 0.1;
    for (int k = 0; status == TOBI_OK && k < 20; k++) {
        const double gravity[3] = { k%10 < 5 ? 5 : -5, -8.4, 0 };
        status = tobi_world_set_gravity(world, gravity, err);
        if (status == TOBI_OK) status = tobi_world_advance(world, 0.01*(k + 1), NULL, err);
    }
    if (status == TOBI_OK) status = tobi_world_read(world, TOBI_FLUID, "position", place[0], n, err);
    if (status == TOBI_OK) status = tobi_world_read_ids(world, TOBI_FLUID, id, n, err);
    for (int64_t i = 0; status == TOBI_OK && i < n; i++) {
        sum += mine[id[i]] ? place[i][1] : 0;
        left += mine[id[i]];
    }
    *height = sum/(double)left;
    free(id);
    free(place);
    free(mine);
    return status;
}

int main(void)
{
    tobi_scene *scene;
    tobi_world *world = NULL;
    tobi_error err = { 0 };
    double height = 0;
    if (tell_mistakes()) return 1;
    if (tobi_scene_parse("tank.json", text, strlen(text), NULL, &scene, NULL, &err) != TOBI_OK)
        return fail("the scene", &err);
    tobi_status status = tobi_scene_build(scene, &world, &err);
    if (status == TOBI_OK) status = tilt(world, &height, &err);
    if (status == TOBI_OK)
        printf("%s: %" PRId64 " particles, t = %g s, those from the left are %.4f m high; state hash %016"
               PRIx64 "\n", tobi_scene_name(scene), tobi_world_count(world, TOBI_FLUID),
               tobi_world_time(world), height, tobi_world_hash(world));
    tobi_world_destroy(world);       /* before the scene, which owns its motions */
    tobi_scene_free(scene);
    if (status != TOBI_OK) return fail(tobi_status_text(status), &err);
    return height > 0.02 && height < 0.1 ? 0 : 1;
}
