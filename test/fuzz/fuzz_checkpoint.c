/* Checkpoints, of four tiny scenes. A state that is accepted must let the world step or fail in words.

   The first byte says how the rest is taken: bits 1 and 2 are the scene, bit 0 alone is
   0: the rest is a file as it is, so that checksums stop nearly every mutation;
   1: a file whose seal is written anew, so that HDF5's own structures are tested;
   bit 3: the rest are edits of values in a good file, so that the checks behind HDF5's checksums are.
   The seeds whole_* are made by one command, which also says when they are of another format:
   FUZZ_WRITE=test/fuzz/corpus/checkpoint build/release/test/fuzz_checkpoint CMakeLists.txt
   With FUZZ_WHOLE set, each input is a seed that must load. */
#include "target.h"
#include "io/store.h"
#include "tobiuo/scene.h"
#include <hdf5.h>
#include <math.h>
#include <sys/stat.h>
#include <zlib.h>

enum { SEAL = 512, CRC_AT = 24, SEAL_CRC_AT = SEAL - 4, RESEALED = 1, EDITS = 8, SCENES = 4, ITEMS = 256 };

static const char *const scenes[SCENES][2] = {
    { "dfsph", "{ \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [0.6, 0.6] }, \"spacing\": 0.1,"
      " \"threads\": 1, \"end_time\": 1, \"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\":"
      " { \"min\": [0, 0], \"max\": [0.6, 0.3] } } ] } ],"
      " \"inlets\": [ { \"name\": \"in\", \"centre\": [0.3, 0.45], \"normal\": [1, 0], \"width\": 0.2,"
      " \"speed\": 0.5 } ] }" },
    { "isph", "{ \"method\": \"isph\", \"dimension\": 2,"
      " \"domain\": { \"min\": [0, 0], \"max\": [0.6, 0.6] }, \"spacing\": 0.1, \"threads\": 1,"
      " \"end_time\": 1, \"fluids\": [ { \"name\": \"water\", \"fill\": [ { \"box\":"
      " { \"min\": [0, 0], \"max\": [0.6, 0.3] } } ] } ],"
      " \"bodies\": [ { \"name\": \"paddle\", \"box\": { \"min\": [0.2, 0.2], \"max\": [0.4, 0.5] },"
      " \"motion\": { \"translation\": { \"velocity\": [0.1, 0] } } } ] }" },
    { "mlsmpm", "{ \"method\": \"mlsmpm\", \"dimension\": 2,"
      " \"domain\": { \"min\": [0, 0], \"max\": [1, 1] },"
      " \"spacing\": 0.1, \"threads\": 1, \"end_time\": 1, \"solids\": [ { \"name\": \"foam\","
      " \"density\": 200, \"youngs_modulus\": 2e4, \"clamped_to\": \"raft\", \"fill\": [ { \"box\":"
      " { \"min\": [0.3, 0.3], \"max\": [0.6, 0.5] } } ] } ], \"bodies\": [ { \"name\": \"raft\","
      " \"box\": { \"min\": [0.3, 0.45], \"max\": [0.6, 0.7] }, \"dynamics\": \"free\" } ] }" },
    { "rigid", "{ \"method\": \"mlsmpm\", \"dimension\": 2, \"domain\": { \"min\": [0, 0], \"max\": [1, 1] },"
      " \"spacing\": 0.1, \"threads\": 1, \"time_step\": 0.002, \"end_time\": 1, \"bodies\": ["
      " { \"name\": \"low\", \"box\": { \"min\": [0.3, 0.0001], \"max\": [0.6, 0.2] },"
      " \"dynamics\": \"free\" },"
      " { \"name\": \"high\", \"box\": { \"min\": [0.4, 0.2001], \"max\": [0.7, 0.4] },"
      " \"dynamics\": \"free\" } ] }" },
};

/* As src/io/store.c writes it: magic, length, sum of the rest; the last four bytes sum the seal. */
static void seal_again(uint8_t *file, uint64_t size)
{
    uint32_t sum = (uint32_t)crc32(0, file + SEAL, (uInt)(size - SEAL));
    memcpy(file, "tobiuo store 1\n", 16);
    memcpy(file + 16, &size, 8);
    memcpy(file + CRC_AT, &sum, 4);
    sum = (uint32_t)crc32(0, file, SEAL_CRC_AT);
    memcpy(file + SEAL_CRC_AT, &sum, 4);
}

/* *scene owns the motions of the world, and is freed after it. */
static tobi_world *make_world(int number, tobi_scene **scene)
{
    const char *text = scenes[number][1];
    tobi_report *report = NULL;
    tobi_world *world = NULL;
    tobi_error err = { 0 };
    tobi_status status = tobi_scene_parse("scene.json", text, strlen(text), NULL, scene, &report, &err);
    for (int k = 0; k < tobi_report_count(report); k++) fprintf(stderr, "%s\n", tobi_report_line(report, k));
    if (status == TOBI_OK) status = tobi_scene_build(*scene, &world, &err);
    if (status == TOBI_OK) status = tobi_world_start(world, &err);
    if (status != TOBI_OK) fprintf(stderr, "%s: %s\n", scenes[number][0], err.text);
    PROMISE(status == TOBI_OK);
    tobi_report_free(report);
    return world;
}

/* A file that has a name, since HDF5 follows links and opens no other. The caller removes it. */
static void write_file(char path[64], const void *data, size_t size)
{
    snprintf(path, 64, "/tmp/fuzz_checkpoint_XXXXXX");
    const int fd = mkstemp(path);
    PROMISE(fd >= 0 && write(fd, data, size) == (ssize_t)size && close(fd) == 0);
}

/* Room for one byte before the content. */
static uint8_t *read_file(const char *path, size_t *size)
{
    struct stat info;
    FILE *file = fopen(path, "rb");
    PROMISE(file && fstat(fileno(file), &info) == 0);
    *size = (size_t)info.st_size;
    uint8_t *data = malloc(*size + 1);
    PROMISE(data && fread(data + 1, 1, *size, file) == *size);
    fclose(file);
    return data;
}

/* A good file, behind a byte that says how it is taken. */
static uint8_t *make_seed(int number, size_t *size)
{
    char path[64];
    tobi_error err = { 0 };
    tobi_scene *scene = NULL;
    write_file(path, "", 0);
    tobi_world *world = make_world(number, &scene);
    for (int k = 0; k < 3; k++) PROMISE(passed(tobi_world_step(world, 1e-3, NULL, &err), &err));
    PROMISE(passed(tobi_world_save(world, path, &err), &err));
    tobi_world_destroy(world);
    tobi_scene_free(scene);
    uint8_t *data = read_file(path, size);
    data[0] = (uint8_t)(RESEALED | number << 1);
    *size += 1;
    unlink(path);
    return data;
}

static void write_seeds(const char *folder)
{
    for (int k = 0; k < SCENES; k++) {
        char path[4096];
        size_t size;
        uint8_t *data = make_seed(k, &size);
        snprintf(path, sizeof path, "%s/whole_%s", folder, scenes[k][0]);
        FILE *file = fopen(path, "wb");
        PROMISE(file && fwrite(data, 1, size, file) == size && fclose(file) == 0);
        free(data);
    }
}

/* The arrays of a file by name. */
typedef struct items { int count; char name[ITEMS][64]; } items;

static herr_t list_item(hid_t file, const char *name, const H5O_info_t *info, void *out)
{
    items *list = out;
    (void)file;
    if (info->type == H5O_TYPE_DATASET && list->count < ITEMS)
        snprintf(list->name[list->count++], sizeof list->name[0], "%s", name);
    return 0;
}

/* Bytes at a place, or a number that is hard to bear. */
static void change_bytes(reader *r, uint8_t *data, size_t bytes, size_t width)
{
    static const double hard[] = { NAN, INFINITY, -INFINITY, -1, 0, 1e300, -1e300, 1e30, 1e-300, 0.5, 1e9,
                                   -1e9, 65536, 4294967296.0, -0.0, 255 };
    uint16_t at;
    const uint8_t kind = take_byte(r);
    take(r, &at, sizeof at);
    const size_t place = at*width%bytes, left = bytes - place;
    const double real = hard[kind%16];
    const float single = (float)real;
    const int64_t whole = fabs(real) <= 1e9 ? (int64_t)real : INT64_MAX;
    if (kind < 64 && left >= 8 && width == 8)
        memcpy(data + place, kind < 48 ? (const void *)&real : &whole, 8);
    else if (kind < 64 && left >= 4 && width == 4) memcpy(data + place, &single, 4);
    else take(r, data + place, (size_t)(kind%8 + 1) < left ? (size_t)(kind%8 + 1) : left);
}

static void edit_array(hid_t file, const char *name, reader *r)
{
    hsize_t size[2] = { 0, 1 };
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(set), space = H5Dget_space(set);
    const int rank = H5Sget_simple_extent_dims(space, size, NULL);
    const size_t width = H5Tget_size(type), bytes = width*size[0]*size[1];
    uint8_t *data = calloc(1, bytes + 1);
    PROMISE(rank >= 1 && data);
    if (bytes > 0) {
        H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
        change_bytes(r, data, bytes, width);
        H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    }
    free(data);
    H5Sclose(space);
    H5Tclose(type);
    H5Dclose(set);
}

/* Another number of rows, all of them 0. */
static void resize_array(hid_t file, const char *name, hsize_t rows)
{
    hsize_t size[2] = { 0, 1 };
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(set), space = H5Dget_space(set);
    const int rank = H5Sget_simple_extent_dims(space, size, NULL);
    H5Sclose(space);
    H5Dclose(set);
    size[0] = rows;
    H5Ldelete(file, name, H5P_DEFAULT);
    const hid_t other = H5Screate_simple(rank, size, NULL);
    H5Dclose(H5Dcreate2(file, name, type, other, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(other);
    H5Tclose(type);
}

static void edit_value(hid_t file, int number, reader *r)
{
    uint8_t data[256] = { 0 };
    const hid_t value = H5Aopen_by_idx(file, ".", H5_INDEX_NAME, H5_ITER_INC, (hsize_t)number, H5P_DEFAULT,
                                       H5P_DEFAULT);
    const hid_t type = H5Aget_type(value);
    const size_t width = H5Tget_size(type);
    PROMISE(width <= sizeof data);
    H5Aread(value, type, data);
    change_bytes(r, data, width, width);
    H5Awrite(value, type, data);
    H5Tclose(type);
    H5Aclose(value);
}

static void edit_file(const char *path, reader *r)
{
    items list = { 0 };
    H5O_info_t info;
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    PROMISE(file >= 0 && H5Oget_info(file, &info) >= 0);
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, list_item, &list);
    const int values = (int)info.num_attrs;
    for (int k = 0; k < 16 && r->left > 0; k++) {
        const int item = take_byte(r)%(list.count + values);
        const uint8_t how = take_byte(r);
        if (item >= list.count) edit_value(file, item - list.count, r);
        else if (how >= 240) resize_array(file, list.name[item], take_byte(r));
        else edit_array(file, list.name[item], r);
    }
    H5Fclose(file);
}

/* A good file with the edits, behind a byte as read_file has it. */
static uint8_t *make_edited(int number, reader *r, size_t *size)
{
    static uint8_t *good[SCENES];         /* made once and kept: the same for all inputs */
    static size_t good_size[SCENES];
    char path[64];
    if (!good[number]) good[number] = make_seed(number, &good_size[number]);
    write_file(path, good[number] + 1, good_size[number] - 1);
    edit_file(path, r);
    uint8_t *data = read_file(path, size);
    unlink(path);
    return data;
}

static void read_store(const char *path)
{
    tobi_store *store;
    tobi_error err = { 0 };
    if (!passed(tobi_store_open(path, &store, &err), &err)) return;
    int64_t rows = 0, number;
    double real, three[3];
    char *text = NULL;
    passed(tobi_store_rows(store, "position", &rows, &err), &err);
    passed(tobi_store_get(store, "clock", TOBI_F64, 1, 3, three, &err), &err);
    passed(tobi_store_get_real(store, "spacing", &real, &err), &err);
    passed(tobi_store_get_int(store, "step", &number, &err), &err);
    if (passed(tobi_store_get_text(store, "method", &text, &err), &err)) PROMISE(text);
    free(text);
    tobi_store_close(store);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 1 || size > 1 << 20) return 0;
    if (getenv("FUZZ_WRITE")) {
        write_seeds(getenv("FUZZ_WRITE"));
        return 0;
    }
    const int number = data[0] >> 1 & 3;
    reader r = { data + 1, size - 1 };
    size_t bytes = size - 1;
    uint8_t *file = data[0] & EDITS ? make_edited(number, &r, &bytes) : malloc(size);
    PROMISE(file);
    if (!(data[0] & EDITS)) memcpy(file, data, size);
    if (data[0] & (EDITS | RESEALED) && bytes > SEAL) seal_again(file + 1, bytes);
    char path[64];
    write_file(path, file + 1, bytes);
    free(file);
    read_store(path);
    tobi_scene *scene = NULL;
    tobi_world *world = make_world(number, &scene);
    tobi_error err = { 0 };
    const int loaded = passed(tobi_world_load(world, path, &err), &err);
    if (getenv("FUZZ_WHOLE") && !loaded) fprintf(stderr, "write the seeds anew: %s\n", err.text);
    PROMISE(loaded || !getenv("FUZZ_WHOLE"));
    if (loaded) {
        passed(tobi_world_step(world, 1e-3, NULL, &err), &err);
        tobi_world_hash(world);
    }
    tobi_world_destroy(world);
    tobi_scene_free(scene);
    unlink(path);
    return 0;
}
