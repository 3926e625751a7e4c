/* Checkpoints. The checksums stop accidents, so nearly every mutation would end there: unless the
   first byte is 0, the target writes the seal anew, and what is behind it (HDF5's own structures,
   sizes, types, values) is what gets tested. The world is a tiny one; a state that it accepts must
   let it step or fail in words. */
#include "target.h"
#include "io/store.h"
#include "tobiuo/tobiuo.h"
#include <zlib.h>

enum { SEAL = 512, CRC_AT = 24, SEAL_CRC_AT = SEAL - 4 };

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

static tobi_world *make_world(void)
{
    tobi_world_def def = tobi_default_world_def();
    tobi_fluid_def fluid = tobi_default_fluid_def();
    tobi_fill_def fill = tobi_default_fill_def();
    tobi_world *world;
    tobi_error err = { 0 };
    def.dimension = 2;
    def.threads = 1;
    def.spacing = 0.1;
    for (int a = 0; a < 2; a++) {
        def.domain_max[a] = 0.6;
        fill.box_max[a] = a ? 0.3 : 0.6;
    }
    def.domain_max[2] = def.gravity[0] = def.gravity[2] = 0;
    def.gravity[1] = -9.81;
    fluid.name = "water";
    tobi_status status = tobi_world_create(&def, NULL, &world, &err);
    if (status == TOBI_OK) status = tobi_world_add_fluid(world, &fluid, &fill, 1, &err);
    if (status == TOBI_OK) status = tobi_world_start(world, &err);
    if (status != TOBI_OK) fprintf(stderr, "%s\n", err.text);
    PROMISE(status == TOBI_OK);
    return world;
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
    if (getenv("FUZZ_WRITE")) {       /* writes a seed */
        tobi_error err = { 0 };
        tobi_world *w = make_world();
        PROMISE(passed(tobi_world_step(w, 1e-3, NULL, &err), &err));
        PROMISE(passed(tobi_world_save(w, getenv("FUZZ_WRITE"), &err), &err));
        tobi_world_destroy(w);
        return 0;
    }
    uint8_t *file = malloc(size);
    PROMISE(file);
    memcpy(file, data + 1, size - 1);
    if (data[0] && size - 1 > SEAL) seal_again(file, size - 1);
    char path[64];
    int fd = make_file(file, size - 1, path);
    free(file);
    read_store(path);
    tobi_world *world = make_world();
    tobi_error err = { 0 };
    if (passed(tobi_world_load(world, path, &err), &err)) {
        passed(tobi_world_step(world, 1e-3, NULL, &err), &err);
        tobi_world_hash(world);
    }
    tobi_world_destroy(world);
    close(fd);
    return 0;
}
