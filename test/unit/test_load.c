/* A load that fails leaves the world as it was: files cut, hurt and sealed anew with every array missing or
   senseless, and every allocation failing. */
#include "calls.h"
#include "failing_memory.h"
#include "io/store.h"
#include "tobiuo/tobiuo.h"
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include <zlib.h>

enum { SEAL = 512, CRC_AT = 24, SEAL_CRC_AT = SEAL - 4, NAMES = 64 };
static const double WIDTH = 0.1;
static char folder[] = "/tmp/tobiuo_load_XXXXXX";

/* --- worlds ----------------------------------------------------------------------------------- */

static int broken;       /* the motion has no answer */

static tobi_status swing(void *user, double t, int64_t n, const double (*rest)[3], double (*to)[3],
                         tobi_error *err)
{
    const double down = user ? 0.3*t : 0;
    if (broken) return tobi_fail(err, TOBI_SCRIPT, "no answer");
    for (int64_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) to[i][a] = rest[i][a] + (a == 0 ? 0.01*sin(20*t) : a == 1 ? -down : 0);
    return TOBI_OK;
}

static void add_body(tobi_world *world, const char *name, double x, double y, int dynamics, int blade)
{
    tobi_body_def b = tobi_default_body_def();
    b.name = name;
    b.dynamics = dynamics;
    b.blade = blade;
    b.motion = dynamics == TOBI_PRESCRIBED ? swing : NULL;
    b.motion_user = blade ? &broken : NULL;      /* sinks into the solid */
    b.motion_rigid = 1;
    for (int a = 0; a < 2; a++) {
        b.box_min[a] = a ? y : x;
        b.box_max[a] = b.box_min[a] + 0.012;
        b.edge_start[a] = b.edge_end[a] = 0;
    }
    if (blade) {
        b.edge_start[0] = b.edge_end[0] = x;
        b.edge_start[1] = b.edge_end[1] = y;
    }
    OK(tobi_world_add_body(world, &b, &err));
}

static tobi_world *make_world(const char *method)
{
    const int mpm = strcmp(method, "mlsmpm") == 0;
    tobi_world_def w = tobi_default_world_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_solid_def solid = tobi_default_solid_def();
    tobi_world *world;
    w.method = method;
    w.dimension = 2;
    w.domain_max[0] = w.domain_max[1] = WIDTH;
    w.domain_max[2] = w.gravity[2] = 0;
    w.gravity[1] = -9.81;
    w.spacing = 0.005;
    w.threads = 1;
    fill.box_max[0] = WIDTH;
    fill.box_max[1] = 0.05;
    OK(tobi_world_create(&w, NULL, &world, &err));
    if (mpm) OK(tobi_world_add_solid(world, &solid, &fill, 1, &err));
    else OK(tobi_world_add_fluid(world, &fluid, &fill, 1, &err));
    add_body(world, "swinging", 0.02, mpm ? 0.055 : 0.03, TOBI_PRESCRIBED, mpm);
    add_body(world, "left", 0.06, 0.06, TOBI_FREE, 0);
    add_body(world, "right", 0.0725, 0.062, TOBI_FREE, 0);
    return world;
}

static const char *at(const char *name)
{
    static char path[4][80];
    static int turn;
    snprintf(path[turn = (turn + 1)%4], sizeof path[0], "%s/%s", folder, name);
    return path[turn];
}

static unsigned char *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *data = malloc(*size + 1);
    assert_non_null(data);
    assert_int_equal(fread(data, 1, *size, file), *size);
    fclose(file);
    return data;
}

static void write_file(const char *path, const unsigned char *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    fclose(file);
}

/* All that a checkpoint holds is what it was. */
static void assert_as_before(tobi_world *world, uint64_t hash, const char *what)
{
    size_t a, b;
    assert_true(tobi_world_hash(world) == hash);
    OK(tobi_world_save(world, at("after.h5"), &err));
    unsigned char *before = read_file(at("before.h5"), &a), *after = read_file(at("after.h5"), &b);
    if (a != b || memcmp(before, after, a) != 0) fail_msg("changed by a load that failed: %s", what);
    free(before);
    free(after);
}

/* --- damage ----------------------------------------------------------------------------------- */

static void seal_again(const char *path)
{
    size_t size;
    unsigned char *file = read_file(path, &size);
    const uint64_t bytes = size;
    uint32_t sum = (uint32_t)crc32(0, file + SEAL, (uInt)(size - SEAL));
    memcpy(file + 16, &bytes, 8);
    memcpy(file + CRC_AT, &sum, 4);
    sum = (uint32_t)crc32(0, file, SEAL_CRC_AT);
    memcpy(file + SEAL_CRC_AT, &sum, 4);
    write_file(path, file, size);
    free(file);
}

typedef struct list { char name[NAMES][64]; int count; } list;

static herr_t note_array(hid_t file, const char *name, const H5L_info_t *info, void *user)
{
    list *l = user;
    (void)file, (void)info;
    assert_true(l->count < NAMES);
    snprintf(l->name[l->count++], sizeof l->name[0], "%s", name);
    return 0;
}

static herr_t note_value(hid_t file, const char *name, const H5A_info_t *info, void *user)
{
    return note_array(file, name, (const H5L_info_t *)(const void *)info, user);
}

static hid_t open_copy(void)
{
    size_t size;
    unsigned char *good = read_file(at("good.h5"), &size);
    write_file(at("hurt.h5"), good, size);
    free(good);
    const hid_t file = H5Fopen(at("hurt.h5"), H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(file >= 0);
    return file;
}

static void close_copy(hid_t file)
{
    assert_true(H5Fclose(file) >= 0);
    seal_again(at("hurt.h5"));
}

/* Overwrites the last row of an array; 0 if it has none. How: 0 no numbers, 1 huge, 2 negative ones. */
static int spoil(hid_t file, const char *name, int how)
{
    hsize_t size[2] = { 1, 1 };
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(set), type = H5Dget_type(set);
    H5Sget_simple_extent_dims(space, size, NULL);
    const size_t row = (size_t)size[1], count = (size_t)(size[0]*size[1]);
    const int real = H5Tget_class(type) == H5T_FLOAT, any = count > 0;
    const hid_t as = real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
    double *data = calloc(count + 1, sizeof *data);
    assert_non_null(data);
    if (any) {
        assert_true(H5Dread(set, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
        for (size_t k = count - row; k < count; k++)
            if (real) data[k] = how == 0 ? NAN : how == 1 ? 1e300 : -data[k] - 1;
            else ((int64_t *)(void *)data)[k] = how == 1 ? INT64_C(1) << 40 : how == 0 ? 255 : -1;
        assert_true(H5Dwrite(set, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
    }
    free(data);
    H5Tclose(type);
    H5Sclose(space);
    H5Dclose(set);
    return any;
}

/* Loads what is in hurt.h5. One that is accepted is one that steps or fails in words; then the state from
   before comes back. Returns whether it was refused. */
static int try_load(tobi_world *world, uint64_t hash, const char *what)
{
    tobi_error why = { 0 };
    const tobi_status status = tobi_world_load(world, at("hurt.h5"), &why);
    if (status != TOBI_OK) {
        assert_true(why.text[0] != '\0');
        assert_as_before(world, hash, what);
        return 1;
    }
    tobi_world_step(world, 1e-4, NULL, NULL);
    OK(tobi_world_load(world, at("before.h5"), &err));
    assert_as_before(world, hash, what);
    return 0;
}

static void take_out_each(tobi_world *world, uint64_t hash)
{
    list arrays = { .count = 0 }, values = { .count = 0 };
    hid_t file = open_copy();
    H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, NULL, note_array, &arrays);
    H5Aiterate2(file, H5_INDEX_NAME, H5_ITER_INC, NULL, note_value, &values);
    close_copy(file);
    assert_true(arrays.count >= 12 && values.count >= 5);
    for (int k = 0; k < arrays.count; k++) {
        file = open_copy();
        assert_true(H5Ldelete(file, arrays.name[k], H5P_DEFAULT) >= 0);
        close_copy(file);
        if (!try_load(world, hash, arrays.name[k])) fail_msg("loaded without '%s'", arrays.name[k]);
    }
    for (int k = 0; k < values.count; k++) {
        file = open_copy();
        assert_true(H5Adelete(file, values.name[k]) >= 0);
        close_copy(file);
        if (!try_load(world, hash, values.name[k])) fail_msg("loaded without '%s'", values.name[k]);
    }
    int refused = 0;
    for (int k = 0; k < 3*arrays.count; k++) {
        const char *name = arrays.name[k/3];
        file = open_copy();
        const int any = spoil(file, name, k%3);
        close_copy(file);
        const int no = any && try_load(world, hash, name);
        refused += no;
        const int must = strstr("position velocity pressure strain affine clock gravity memory", name) ||
                         strstr(name, "_state") || strstr(name, "_load") || strstr(name, "_vertex");
        if (any && k%3 == 0 && must && !no) fail_msg("loaded with no number in '%s'", name);
        if (strcmp(name, "id") == 0 && k%3 && !no) fail_msg("loaded with an id that no particle has");
        if (strcmp(name, "fluid") == 0 && !k%3 && !no) fail_msg("loaded with a fluid that is not there");
    }
    assert_true(refused >= 10);
}

/* Cut, or with a bit turned: the seal stops it. */
static void hurt_each(tobi_world *world, uint64_t hash)
{
    size_t size;
    unsigned char *good = read_file(at("good.h5"), &size);
    for (size_t cut = 0; cut < size; cut += size/7 + 1) {
        write_file(at("hurt.h5"), good, cut);
        assert_true(try_load(world, hash, "cut"));
    }
    for (size_t where = 3; where < size; where += size/11 + 1) {
        good[where] ^= 4;
        write_file(at("hurt.h5"), good, size);
        good[where] ^= 4;
        assert_true(try_load(world, hash, "turned bit"));
    }
    free(good);
    unlink(at("hurt.h5"));
    assert_true(try_load(world, hash, "no file"));
}

static void fail_each_allocation(tobi_world *world, uint64_t hash)
{
    for (long n = 1;; n++) {
        tobi_error why = { 0 };
        allocations = 0;
        fail_at = n;
        const tobi_status status = tobi_world_load(world, at("good.h5"), &why);
        fail_at = 0;
        if (status == TOBI_OK) {
            assert_true(n > 8);
            break;
        }
        assert_int_equal(status, TOBI_NO_MEMORY);
        assert_as_before(world, hash, why.text);
    }
    OK(tobi_world_load(world, at("before.h5"), &err));
}

/* A world that meets all of it goes on like one that met none. */
static void meet_damage(const char *method)
{
    tobi_world *world = make_world(method), *other = make_world(method);
    for (int k = 0; k < 2; k++) {
        tobi_world *w = k ? other : world;
        OK(tobi_world_advance(w, 0.02, NULL, &err));
        OK(tobi_world_save(w, at("good.h5"), &err));
        OK(tobi_world_advance(w, 0.04, NULL, &err));
    }
    const uint64_t hash = tobi_world_hash(world);
    assert_true(tobi_world_hash(other) == hash);
    OK(tobi_world_save(world, at("before.h5"), &err));
    hurt_each(world, hash);
    take_out_each(world, hash);
    fail_each_allocation(world, hash);
    broken = 1;            /* the motion is not asked */
    OK(tobi_world_load(world, at("before.h5"), &err));
    broken = 0;
    for (int k = 0; k < 5; k++) {
        OK(tobi_world_step(world, 0, NULL, &err));
        OK(tobi_world_step(other, 0, NULL, &err));
    }
    assert_true(tobi_world_hash(world) == tobi_world_hash(other));
    tobi_world_destroy(world);
    tobi_world_destroy(other);
}

static void dfsph_as_before(void **state) { (void)state; meet_damage("dfsph"); }
static void wcsph_as_before(void **state) { (void)state; meet_damage("wcsph"); }
static void mlsmpm_as_before(void **state) { (void)state; meet_damage("mlsmpm"); }

static void other_methods_are_refused(void **state)
{
    (void)state;
    tobi_world *dfsph = make_world("dfsph"), *wcsph = make_world("wcsph");
    OK(tobi_world_save(dfsph, at("other.h5"), &err));
    REFUSED(tobi_world_load(wcsph, at("other.h5"), &err), TOBI_INVALID,
            "its method is dfsph, that of the scene wcsph");
    tobi_world_destroy(dfsph);
    tobi_world_destroy(wcsph);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dfsph_as_before),
        cmocka_unit_test(wcsph_as_before),
        cmocka_unit_test(mlsmpm_as_before),
        cmocka_unit_test(other_methods_are_refused),
    };
    if (!mkdtemp(folder)) return 1;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    static const char *const names[] = { "good.h5", "before.h5", "after.h5", "hurt.h5", "other.h5" };
    for (int k = 0; k < 5; k++) unlink(at(names[k]));
    rmdir(folder);
    return failed;
}
