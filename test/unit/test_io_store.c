/* The checkpoint container: what is put is got, and a file cut or damaged anywhere is refused. */
#define _GNU_SOURCE 1
#include "io/store.h"
#include <float.h>
#include <hdf5.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#include <cmocka.h>

enum { N = 70001, SMALL = 700 };

static char folder[] = "/tmp/tobi_io_store_XXXXXX";
static char store_path[64], hurt_path[64];
static double position[N][3];
static float pressure[N];
static int64_t id[N];
static int32_t object[N];
static uint8_t flag[N];

static void fill(void)
{
    unsigned long long x = 88172645463325252ull;
    for (int i = 0; i < N; i++) {
        for (int k = 0; k < 3; k++) {
            x ^= x << 13, x ^= x >> 7, x ^= x << 17;
            position[i][k] = (double)(int64_t)x*1e-19;
        }
        pressure[i] = (float)(x%100000)*0.37f;
        id[i] = (int64_t)(x >> 3);
        object[i] = -i;
        flag[i] = (uint8_t)x;
    }
    position[1][1] = DBL_MIN/3;      /* subnormal, signed zero, the largest: all bits must survive */
    position[2][0] = -0.0;
    position[3][0] = DBL_MAX;
}

static tobi_status write_store(const char *path, int64_t n, tobi_error *err)
{
    tobi_store *s;
    TOBI_TRY(tobi_store_create(path, &s, err));
    tobi_status status = tobi_store_put(s, "position", TOBI_F64, n, 3, position, err);
    if (!status) status = tobi_store_put(s, "pressure", TOBI_F32, n, 1, pressure, err);
    if (!status) status = tobi_store_put(s, "bodies/0/id", TOBI_I64, n, 1, id, err);
    if (!status) status = tobi_store_put(s, "object", TOBI_I32, n, 1, object, err);
    if (!status) status = tobi_store_put(s, "flag", TOBI_U8, n, 1, flag, err);
    if (!status) status = tobi_store_put(s, "empty", TOBI_F64, 0, 3, NULL, err);
    if (!status) status = tobi_store_put_real(s, "time", 0.1, err);
    if (!status) status = tobi_store_put_int(s, "step", INT64_MIN, err);
    if (!status) status = tobi_store_put_text(s, "scene", "{ \"name\": \"\xe9\xa3\x9b\xe9\xad\x9a\" }", err);
    if (!status) return tobi_store_commit(s, err);
    tobi_store_close(s);
    return status;
}

/* Reads everything and compares: an error status, or TOBI_OK; wrong data fails the test. */
static tobi_status read_store(const char *path, int64_t n, tobi_error *err)
{
    static double p[N][3];
    static float f[N];
    static int64_t l[N];
    tobi_store *s;
    double time = 0;
    char *text = NULL;
    TOBI_TRY(tobi_store_open(path, &s, err));
    tobi_status status = tobi_store_get(s, "position", TOBI_F64, n, 3, p, err);
    if (!status) assert_memory_equal(p, position, (size_t)n*sizeof *p);
    if (!status) status = tobi_store_get(s, "pressure", TOBI_F32, n, 1, f, err);
    if (!status) assert_memory_equal(f, pressure, (size_t)n*sizeof *f);
    if (!status) status = tobi_store_get(s, "bodies/0/id", TOBI_I64, n, 1, l, err);
    if (!status) assert_memory_equal(l, id, (size_t)n*sizeof *l);
    if (!status) status = tobi_store_get_real(s, "time", &time, err);
    if (!status) assert_true(time == 0.1);
    if (!status) status = tobi_store_get_text(s, "scene", &text, err);
    if (!status) assert_string_equal(text, "{ \"name\": \"\xe9\xa3\x9b\xe9\xad\x9a\" }");
    free(text);
    tobi_store_close(s);
    return status;
}

/* Nothing but the content is in the file: no time of day, no byte that happened to stand in memory. */
static void equal_content_makes_equal_files(void **state)
{
    (void)state;
    tobi_error err;
    assert_int_equal(write_store(store_path, N, &err), 0);
    sleep(1);                                            /* HDF5 counts times in seconds */
    enum { ROOM = 1 << 22 };
    void *dirt = malloc(ROOM);
    memset(dirt, 0xa5, ROOM);
    free(dirt);
    assert_int_equal(write_store(hurt_path, N, &err), 0);
    char *content[2];
    size_t bytes[2];
    for (int k = 0; k < 2; k++) {
        FILE *file = fopen(k ? hurt_path : store_path, "rb");
        content[k] = malloc(ROOM);
        bytes[k] = fread(content[k], 1, ROOM, file);
        fclose(file);
    }
    assert_true(bytes[0] > 1000000 && bytes[0] < ROOM);
    assert_int_equal(bytes[0], bytes[1]);
    assert_memory_equal(content[0], content[1], bytes[0]);
    free(content[0]);
    free(content[1]);
}

static void what_is_put_is_got(void **state)
{
    (void)state;
    tobi_error err;
    assert_int_equal(write_store(store_path, N, &err), 0);
    assert_int_equal(read_store(store_path, N, &err), 0);
    tobi_store *s;
    static int32_t o[N];
    static uint8_t u[N];
    int64_t step = 0, n = -1;
    assert_int_equal(tobi_store_open(store_path, &s, &err), 0);
    assert_int_equal(tobi_store_get(s, "object", TOBI_I32, N, 1, o, &err), 0);
    assert_memory_equal(o, object, sizeof o);
    assert_int_equal(tobi_store_get(s, "flag", TOBI_U8, N, 1, u, &err), 0);
    assert_memory_equal(u, flag, sizeof u);
    assert_int_equal(tobi_store_get(s, "empty", TOBI_F64, 0, 3, NULL, &err), 0);
    assert_int_equal(tobi_store_rows(s, "empty", &n, &err), 0);
    assert_int_equal(n, 0);
    assert_int_equal(tobi_store_rows(s, "position", &n, &err), 0);
    assert_int_equal(n, N);
    assert_int_equal(tobi_store_get_int(s, "step", &step, &err), 0);
    assert_true(step == INT64_MIN);
    assert_true(tobi_store_has(s, "bodies/0/id") && !tobi_store_has(s, "bodies/1/id")
                && !tobi_store_has(s, "nothing"));
    tobi_store_close(s);
    assert_true(H5Fis_hdf5(store_path) > 0);      /* other HDF5 programs can open it */
    char part[80];
    snprintf(part, sizeof part, "%s.part", store_path);
    assert_int_not_equal(access(part, F_OK), 0);
}

static void long_texts_are_kept(void **state)
{
    (void)state;
    tobi_error err;
    tobi_store *s;
    size_t bytes = 300000;
    char *text = malloc(bytes + 1), *back;
    for (size_t i = 0; i < bytes; i++) text[i] = (char)('a' + i%26);
    text[bytes] = '\0';
    assert_int_equal(tobi_store_create(hurt_path, &s, &err), 0);
    assert_int_equal(tobi_store_put_text(s, "long", text, &err), 0);
    assert_int_equal(tobi_store_put_text(s, "none", "", &err), 0);
    for (int i = 0; i < 40; i++) {
        char name[24];
        snprintf(name, sizeof name, "value%d", i);
        assert_int_equal(tobi_store_put_real(s, name, i, &err), 0);
    }
    assert_int_equal(tobi_store_commit(s, &err), 0);
    assert_int_equal(tobi_store_open(hurt_path, &s, &err), 0);
    assert_int_equal(tobi_store_get_text(s, "long", &back, &err), 0);
    assert_string_equal(back, text);
    free(back);
    assert_int_equal(tobi_store_get_text(s, "none", &back, &err), 0);
    assert_string_equal(back, "");
    free(back);
    double value;
    assert_int_equal(tobi_store_get_real(s, "value39", &value, &err), 0);
    assert_true(value == 39);
    tobi_store_close(s);
    free(text);
}

static void mismatches_say_what_is_wrong(void **state)
{
    (void)state;
    tobi_error err;
    tobi_store *s;
    double d;
    char *text;
    static double buffer[N*3];
    assert_int_equal(write_store(store_path, SMALL, &err), 0);
    assert_int_equal(tobi_store_open(store_path, &s, &err), 0);
    assert_int_equal(tobi_store_get(s, "position", TOBI_F64, SMALL + 1, 3, buffer, &err), TOBI_DAMAGED);
    assert_non_null(strstr(err.text, "'position' has 700 x 3 numbers, expected 701 x 3"));
    assert_int_equal(tobi_store_get(s, "position", TOBI_F64, SMALL, 1, buffer, &err), TOBI_DAMAGED);
    assert_int_equal(tobi_store_get(s, "pressure", TOBI_I32, SMALL, 1, buffer, &err), TOBI_DAMAGED);
    assert_int_equal(tobi_store_get(s, "velocity", TOBI_F64, SMALL, 3, buffer, &err), TOBI_DAMAGED);
    assert_non_null(strstr(err.text, "has no array 'velocity'"));
    assert_int_equal(tobi_store_get(s, "bodies", TOBI_F64, SMALL, 3, buffer, &err), TOBI_DAMAGED);
    assert_int_equal(tobi_store_get(s, "bodies/7/id", TOBI_F64, SMALL, 3, buffer, &err), TOBI_DAMAGED);
    assert_int_equal(tobi_store_get_real(s, "step", &d, &err), TOBI_DAMAGED);
    assert_int_equal(tobi_store_get_real(s, "mass", &d, &err), TOBI_DAMAGED);
    assert_int_equal(tobi_store_get_text(s, "time", &text, &err), TOBI_DAMAGED);
    assert_null(text);
    tobi_store_close(s);
    assert_int_equal(tobi_store_open("/no/such/file", &s, &err), TOBI_NOT_FOUND);
    assert_null(s);
    assert_int_equal(tobi_store_open(folder, &s, &err), TOBI_IO);
    assert_int_equal(tobi_store_create("/no/such/file", &s, &err), TOBI_IO);
    assert_string_equal(err.text, "cannot write /no/such/file: No such file or directory");
    tobi_store_close(NULL);
}

static unsigned char *read_file(const char *path, size_t *bytes)
{
    FILE *in = fopen(path, "rb");
    fseek(in, 0, SEEK_END);
    *bytes = (size_t)ftell(in);
    rewind(in);
    unsigned char *data = malloc(*bytes);
    assert_int_equal(fread(data, 1, *bytes, in), *bytes);
    fclose(in);
    return data;
}

static void write_file(const char *path, const void *data, size_t bytes)
{
    FILE *out = fopen(path, "wb");
    assert_int_equal(fwrite(data, 1, bytes, out), bytes);
    fclose(out);
}

static void cut_files_are_refused(void **state)
{
    (void)state;
    tobi_error err;
    size_t bytes;
    assert_int_equal(write_store(store_path, SMALL, &err), 0);
    unsigned char *data = read_file(store_path, &bytes);
    size_t step = bytes/400 | 1;
    for (size_t n = 0; n < bytes; n += n < 600 || n + 40 > bytes ? 1 : step) {
        write_file(hurt_path, data, n);
        assert_int_equal(read_store(hurt_path, SMALL, &err), TOBI_DAMAGED);
    }
    unsigned char *longer = calloc(1, bytes + 100);
    memcpy(longer, data, bytes);
    write_file(hurt_path, longer, bytes + 100);
    assert_int_equal(read_store(hurt_path, SMALL, &err), TOBI_DAMAGED);
    write_file(hurt_path, data, bytes);
    assert_int_equal(read_store(hurt_path, SMALL, &err), 0);
    free(longer);
    free(data);
}

/* Any single bit, bursts, zeroed sectors, and files of noise with and without the right start. */
static void damaged_files_are_refused(void **state)
{
    (void)state;
    tobi_error err;
    size_t bytes;
    assert_int_equal(write_store(store_path, SMALL, &err), 0);
    unsigned char *data = read_file(store_path, &bytes);
    srand(7);
    for (int i = 0; i < 2000; i++) {
        size_t at = i < 512 ? (size_t)i : (size_t)rand()%bytes;
        unsigned char bit = (unsigned char)(1 << rand()%8);
        data[at] ^= bit;
        write_file(hurt_path, data, bytes);
        assert_int_equal(read_store(hurt_path, SMALL, &err), TOBI_DAMAGED);
        data[at] ^= bit;
    }
    for (size_t at = 0; at + 512 < bytes; at += 4096) {
        unsigned char keep[512], zero[512] = { 0 };
        memcpy(keep, data + at, 512);
        if (memcmp(keep, zero, 512) == 0) continue;
        memset(data + at, 0, 512);
        write_file(hurt_path, data, bytes);
        assert_int_equal(read_store(hurt_path, SMALL, &err), TOBI_DAMAGED);
        memcpy(data + at, keep, 512);
    }
    for (int i = 0; i < 200; i++) {
        size_t keep = i%4*256u;
        for (size_t k = keep; k < bytes; k++) data[k] = (unsigned char)rand();
        write_file(hurt_path, data, (size_t)rand()%bytes);
        assert_int_equal(read_store(hurt_path, SMALL, &err), TOBI_DAMAGED);
    }
    free(data);
}

/* The seal is no substitute for care below it: damage to arrays with a recomputed seal meets fletcher32. */
static void array_damage_meets_the_second_sum(void **state)
{
    (void)state;
    tobi_error err;
    assert_int_equal(write_store(store_path, SMALL, &err), 0);
    size_t bytes;
    unsigned char *data = read_file(store_path, &bytes), *at = memmem(data, bytes, position, 64);
    assert_non_null(at);
    at[200] ^= 4;
    write_file(hurt_path, data, bytes);
    hid_t file = H5Fopen(hurt_path, H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(file >= 0);
    static double p[SMALL][3];
    hid_t set = H5Dopen2(file, "position", H5P_DEFAULT);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, p) < 0);
    H5Dclose(set);
    H5Fclose(file);
    free(data);
}

static void full_disk_keeps_the_old_file(void **state)
{
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    tobi_error err;
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(write_store(store_path, SMALL, &err), 0);
    size_t bytes;
    int failed = 0;
    free(read_file(store_path, &bytes));
    for (rlim_t size = 0; size < 5000000; size += size < 1200000 ? 19973 : 300007) {
        struct rlimit limit = { size, before.rlim_max };
        setrlimit(RLIMIT_FSIZE, &limit);
        tobi_status status = write_store(store_path, N, &err);
        setrlimit(RLIMIT_FSIZE, &before);
        if (status == TOBI_OK) break;
        failed++;
        assert_int_equal(status, TOBI_IO);
        if (!strstr(err.text, "store.h5: File too large")) fail_msg("limit %ld: %s", (long)size, err.text);
        char part[80];
        snprintf(part, sizeof part, "%s.part", store_path);
        assert_int_not_equal(access(part, F_OK), 0);
        assert_int_equal(read_store(store_path, SMALL, &err), 0);
    }
    assert_true(failed > 30);
    assert_int_equal(write_store(store_path, N, &err), 0);
    assert_int_equal(read_store(store_path, N, &err), 0);
}

static int set_up(void **state)
{
    (void)state;
    fill();
    if (!mkdtemp(folder)) return -1;
    snprintf(store_path, sizeof store_path, "%s/store.h5", folder);
    snprintf(hurt_path, sizeof hurt_path, "%s/hurt.h5", folder);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    char command[300];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_put_is_got), cmocka_unit_test(equal_content_makes_equal_files),
        cmocka_unit_test(long_texts_are_kept),
        cmocka_unit_test(mismatches_say_what_is_wrong), cmocka_unit_test(cut_files_are_refused),
        cmocka_unit_test(damaged_files_are_refused), cmocka_unit_test(array_damage_meets_the_second_sum),
        cmocka_unit_test(full_disk_keeps_the_old_file)
    };
    return cmocka_run_group_tests_name("io/store", tests, set_up, tear_down);
}
