/* HDF5 answers a failing disk badly: a file that cannot be closed, and a crash when the program ends.
   So it works in memory only (its core driver), and the finished image goes to the disk like any
   other file. Drawback: while it is written, a checkpoint is in memory once more. */
#define _GNU_SOURCE 1
#include "io/store.h"
#include "base/plain.h"
#include "base/file.h"
#include <errno.h>
#include <hdf5.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

enum { SEAL_BYTES = 512, CHUNK_BYTES = 1 << 18, GROWTH_BYTES = 1 << 22 };

typedef struct seal {
    char     magic[16];
    uint64_t file_bytes;
    uint32_t crc;                  /* of everything after the seal */
    char     unused[SEAL_BYTES - 32];
    uint32_t seal_crc;             /* of the seal up to here */
} seal;
_Static_assert(sizeof(seal) == SEAL_BYTES, "the seal is the HDF5 user block");

static const char magic[16] = "tobiuo store 1\n";

struct tobi_store {
    char *path;
    hid_t file;            /* in memory when writing */
    tobi_file out;         /* where the image will go; unused when reading */
};

/* HDF5 prints its errors unless told otherwise; the caller's setting comes back after each call. */
typedef struct quiet {
    H5E_auto2_t print;
    void       *data;
} quiet;

static quiet begin_quiet(void)
{
    quiet q = { NULL, NULL };
    H5Eget_auto2(H5E_DEFAULT, &q.print, &q.data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return q;
}

static void end_quiet(quiet q) { H5Eset_auto2(H5E_DEFAULT, q.print, q.data); }

/* Keeps the innermost reason HDF5 gives. That of a disk goes on with the time of day, a line break, names and
   addresses, and has the system's own words among them. */
static herr_t keep_reason(unsigned n, const H5E_error2_t *entry, void *out)
{
    static const char words[] = "error message = '";
    if (n != 0 || !entry->desc) return 0;
    const char *rest = strstr(entry->desc, ": time = "), *said = rest ? strstr(rest, words) : NULL;
    const int length = rest ? (int)(rest - entry->desc) : (int)strlen(entry->desc);
    said = said ? said + strlen(words) : "";
    snprintf(out, 256, "%.*s%s%.*s", length, entry->desc, *said ? ": " : "", (int)strcspn(said, "'"), said);
    return 0;
}

static tobi_status fail_hdf5(tobi_error *err, tobi_status status, const tobi_store *store, const char *what,
                             const char *name)
{
    char reason[256];
    snprintf(reason, sizeof reason, "%s", tr("HDF5 gives no reason"));
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_reason, reason);
    return tobi_fail(err, status, "%s: cannot %s '%s': %s", store->path, tr(what), name, reason);
}

/* On disk everything is little-endian. */
static hid_t file_type(tobi_type type)
{
    switch (type) {
    case TOBI_F32: return H5T_IEEE_F32LE;
    case TOBI_F64: return H5T_IEEE_F64LE;
    case TOBI_I32: return H5T_STD_I32LE;
    case TOBI_I64: return H5T_STD_I64LE;
    case TOBI_U8:  return H5T_STD_U8LE;
    }
    return -1;
}

static hid_t memory_type(tobi_type type)
{
    switch (type) {
    case TOBI_F32: return H5T_NATIVE_FLOAT;
    case TOBI_F64: return H5T_NATIVE_DOUBLE;
    case TOBI_I32: return H5T_NATIVE_INT32;
    case TOBI_I64: return H5T_NATIVE_INT64;
    case TOBI_U8:  return H5T_NATIVE_UINT8;
    }
    return -1;
}

static hid_t access_list(void)
{
    hid_t list = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_file_locking(list, 0, 1);
    H5Pset_fclose_degree(list, H5F_CLOSE_STRONG);
    return list;
}

static void release(tobi_store *store)
{
    free(store->path);
    free(store);
}

static tobi_store *allocate(const char *path)
{
    tobi_store *store = calloc(1, sizeof *store);
    if (!store) return NULL;
    store->file = -1;
    store->path = strdup(path);
    if (store->path) return store;
    release(store);
    return NULL;
}

static tobi_status create_image(tobi_store *store, tobi_error *err)
{
    hid_t access = access_list(), create = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(create, SEAL_BYTES);
    H5Pset_obj_track_times(create, 0);
    H5Pset_fapl_core(access, GROWTH_BYTES, 0);
    /* 1.8's format has checksums on metadata, but no mark that the file is open for writing, which
       would stand in an image taken before closing. */
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
    store->file = H5Fcreate(store->path, H5F_ACC_TRUNC, create, access);
    H5Pclose(create);
    H5Pclose(access);
    return store->file < 0 ? fail_hdf5(err, TOBI_NO_MEMORY, store, TR("create"), store->path) : TOBI_OK;
}

tobi_status tobi_store_create(const char *path, tobi_store **store, tobi_error *err)
{
    *store = NULL;
    tobi_store *s = allocate(path);
    if (!s) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to write %s", path);
    /* Opened first: a path that cannot be written should not cost the work. */
    tobi_status status = tobi_file_open(&s->out, path, err);
    quiet q = begin_quiet();
    if (status == TOBI_OK) status = create_image(s, err);
    end_quiet(q);
    if (status == TOBI_OK) *store = s;
    else tobi_store_close(s);
    return status;
}

void tobi_store_close(tobi_store *store)
{
    if (!store) return;
    quiet q = begin_quiet();
    if (store->file >= 0) H5Fclose(store->file);
    end_quiet(q);
    tobi_file_abandon(&store->out);
    release(store);
}

/* CRC-32 of a file from the seal to its end. */
static int sum_file(int fd, uint64_t bytes, uint32_t *crc)
{
    enum { PIECE = 1 << 18 };
    unsigned char *buffer = malloc(PIECE);
    if (!buffer) return ENOMEM;
    uLong sum = crc32(0, NULL, 0);
    int code = 0;
    for (uint64_t at = SEAL_BYTES; at < bytes && !code;) {
        ssize_t n = pread(fd, buffer, PIECE, (off_t)at);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) {
            code = n < 0 ? errno : EIO;
            break;
        }
        sum = crc32(sum, buffer, (uInt)n);
        at += (uint64_t)n;
    }
    free(buffer);
    *crc = (uint32_t)sum;
    return code;
}

static seal make_seal(const unsigned char *image, uint64_t bytes)
{
    seal s = { .file_bytes = bytes };
    memcpy(s.magic, magic, sizeof magic);
    s.crc = (uint32_t)crc32_z(crc32(0, NULL, 0), image + SEAL_BYTES, bytes - SEAL_BYTES);
    s.seal_crc = (uint32_t)crc32(crc32(0, NULL, 0), (const Bytef *)&s, offsetof(seal, seal_crc));
    return s;
}

static tobi_status write_image(tobi_store *store, tobi_error *err)
{
    void *image = NULL;
    if (H5Fflush(store->file, H5F_SCOPE_GLOBAL) < 0 ||
        H5Fget_vfd_handle(store->file, H5P_DEFAULT, &image) < 0)
        return fail_hdf5(err, TOBI_NO_MEMORY, store, TR("finish"), store->path);
    /* What is used of the grown memory, counted from behind the seal. */
    ssize_t used = H5Fget_file_image(store->file, NULL, 0);
    if (used <= 0) return fail_hdf5(err, TOBI_NO_MEMORY, store, TR("finish"), store->path);
    uint64_t bytes = (uint64_t)used + SEAL_BYTES;
    const unsigned char *start = *(unsigned char **)image;
    seal s = make_seal(start, bytes);
    tobi_file_write(&store->out, &s, sizeof s);
    tobi_file_write(&store->out, start + sizeof s, bytes - sizeof s);
    tobi_file_sync(&store->out);
    return tobi_file_commit(&store->out, err);
}

tobi_status tobi_store_commit(tobi_store *store, tobi_error *err)
{
    quiet q = begin_quiet();
    tobi_status status = write_image(store, err);
    end_quiet(q);
    tobi_store_close(store);
    return status;
}

static tobi_status check_seal(const char *path, int fd, int64_t bytes, tobi_error *err)
{
    seal s;
    uint32_t crc = 0;
    ssize_t n = pread(fd, &s, sizeof s, 0);
    if (n < 0)
        return tobi_fail(err, TOBI_IO, "%s cannot be read to its end: %s", path, tobi_reason(errno));
    if (n >= (ssize_t)sizeof magic && memcmp(s.magic, magic, sizeof magic) != 0)
        return tobi_fail(err, TOBI_DAMAGED,
                         "%s is damaged or not a checkpoint: it does not start with '%.14s'", path, magic);
    if (n < (ssize_t)sizeof s)
        return tobi_fail(err, TOBI_DAMAGED, "%s is damaged: it ends after %zd bytes", path, n);
    if (s.seal_crc != crc32(crc32(0, NULL, 0), (const Bytef *)&s, offsetof(seal, seal_crc)))
        return tobi_fail(err, TOBI_DAMAGED, "%s is damaged: its first %d bytes do not match their checksum",
                         path, SEAL_BYTES);
    if (s.file_bytes != (uint64_t)bytes)
        return tobi_fail(err, TOBI_DAMAGED, "%s is damaged: it has %" PRIu64 " bytes of %" PRIu64, path,
                         (uint64_t)bytes, s.file_bytes);
    int code = sum_file(fd, s.file_bytes, &crc);
    if (code)
        return tobi_fail(err, code == ENOMEM ? TOBI_NO_MEMORY : TOBI_IO, "%s cannot be read to its end: %s",
                         path, tobi_reason(code));
    if (crc != s.crc)
        return tobi_fail(err, TOBI_DAMAGED, "%s is damaged: its content does not match its checksum", path);
    return TOBI_OK;
}

tobi_status tobi_store_open(const char *path, tobi_store **store, tobi_error *err)
{
    *store = NULL;
    FILE *file;
    int64_t bytes;
    TOBI_TRY(tobi_plain_open(path, tr("checkpoint"), 0, &file, &bytes, err));
    tobi_status status = check_seal(path, fileno(file), bytes, err);
    fclose(file);
    TOBI_TRY(status);
    tobi_store *s = allocate(path);
    if (!s) return tobi_fail(err, TOBI_NO_MEMORY, "no memory to read %s", path);
    quiet q = begin_quiet();
    hid_t access = access_list();
    s->file = H5Fopen(path, H5F_ACC_RDONLY, access);
    H5Pclose(access);
    if (s->file < 0) status = fail_hdf5(err, TOBI_DAMAGED, s, TR("open"), path);
    end_quiet(q);
    if (status == TOBI_OK) *store = s;
    else tobi_store_close(s);
    return status;
}

/* The groups on the way to an array. HDF5 would make them itself, but with the time of day in them. */
static int make_groups(tobi_store *store, const char *name)
{
    int good = 1;
    char way[512];
    hid_t create = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(create, 0);
    for (const char *p = strchr(name, '/'); p && good; p = strchr(p + 1, '/')) {
        snprintf(way, sizeof way, "%.*s", (int)(p - name), name);
        if (H5Lexists(store->file, way, H5P_DEFAULT) > 0) continue;
        hid_t group = H5Gcreate2(store->file, way, H5P_DEFAULT, create, H5P_DEFAULT);
        good = group >= 0 && H5Gclose(group) >= 0;
    }
    H5Pclose(create);
    return good;
}

/* Chunks of a quarter megabyte with a fletcher32 sum each; an empty array has no chunks. */
static hid_t create_dataset(tobi_store *store, const char *name, tobi_type type, int64_t n,
                            int components)
{
    size_t row = tobi_type_size(type)*(size_t)components;
    hsize_t size[2] = { (hsize_t)n, (hsize_t)components }, chunk[2] = { CHUNK_BYTES/row + 1, size[1] };
    if (chunk[0] > size[0]) chunk[0] = size[0];
    int rank = components == 1 ? 1 : 2;
    if (!make_groups(store, name)) return -1;
    hid_t space = H5Screate_simple(rank, size, NULL), create = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(create, 0);
    if (n > 0) {
        H5Pset_chunk(create, rank, chunk);
        H5Pset_fletcher32(create);
    }
    hid_t set = H5Dcreate2(store->file, name, file_type(type), space, H5P_DEFAULT, create, H5P_DEFAULT);
    H5Pclose(create);
    H5Sclose(space);
    return set;
}

tobi_status tobi_store_put(tobi_store *store, const char *name, tobi_type type, int64_t n,
                           int components, const void *data, tobi_error *err)
{
    size_t row = tobi_type_size(type)*(size_t)(components > 0 ? components : 0);
    if (row == 0 || n < 0 || (n > 0 && !data))
        return tobi_fail(err, TOBI_INVALID, "%s: array '%s' of %" PRId64 " rows x %d, type %d cannot "
                         "be stored", store->path, name, n, components, (int)type);
    quiet q = begin_quiet();
    tobi_status status = TOBI_OK;
    hid_t set = create_dataset(store, name, type, n, components);
    if (set < 0 || (n > 0 && H5Dwrite(set, memory_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0))
        status = fail_hdf5(err, TOBI_NO_MEMORY, store, TR("store"), name);
    if (set >= 0 && H5Dclose(set) < 0 && status == TOBI_OK)
        status = fail_hdf5(err, TOBI_NO_MEMORY, store, TR("store"), name);
    end_quiet(q);
    return status;
}

static tobi_status put_value(tobi_store *store, const char *name, hid_t on_disk, hid_t in_memory,
                             const void *value,
                             tobi_error *err)
{
    tobi_status status = TOBI_OK;
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(store->file, name, on_disk, space, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0 || H5Awrite(attribute, in_memory, value) < 0)
        status = fail_hdf5(err, TOBI_NO_MEMORY, store, TR("store"), name);
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return status;
}

tobi_status tobi_store_put_real(tobi_store *store, const char *name, double value, tobi_error *err)
{
    quiet q = begin_quiet();
    tobi_status status = put_value(store, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value, err);
    end_quiet(q);
    return status;
}

tobi_status tobi_store_put_int(tobi_store *store, const char *name, int64_t value, tobi_error *err)
{
    quiet q = begin_quiet();
    tobi_status status = put_value(store, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value, err);
    end_quiet(q);
    return status;
}

static hid_t text_type(size_t bytes)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, bytes);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

tobi_status tobi_store_put_text(tobi_store *store, const char *name, const char *value, tobi_error *err)
{
    quiet q = begin_quiet();
    hid_t type = text_type(strlen(value) + 1);
    tobi_status status = put_value(store, name, type, type, value, err);
    H5Tclose(type);
    end_quiet(q);
    return status;
}

/* H5Lexists wants every group on the way to exist. */
static int find_array(const tobi_store *store, const char *name)
{
    char way[512];
    size_t length = strlen(name);
    if (length == 0 || length >= sizeof way) return 0;
    for (size_t i = 1; i <= length; i++) {
        if (name[i] != '/' && name[i] != '\0') continue;
        memcpy(way, name, i);
        way[i] = '\0';
        if (H5Lexists(store->file, way, H5P_DEFAULT) <= 0) return 0;
    }
    return 1;
}

int tobi_store_has(tobi_store *store, const char *name)
{
    quiet q = begin_quiet();
    int found = find_array(store, name);
    end_quiet(q);
    return found;
}

/* Opens an array and reads its rows and components. */
static tobi_status open_array(tobi_store *store, const char *name, hid_t *set, hsize_t size[2],
                              tobi_error *err)
{
    if (!find_array(store, name))
        return tobi_fail(err, TOBI_DAMAGED, "%s has no array '%s'", store->path, name);
    *set = H5Dopen2(store->file, name, H5P_DEFAULT);
    if (*set < 0) return fail_hdf5(err, TOBI_DAMAGED, store, TR("open"), name);
    hid_t space = H5Dget_space(*set);
    int rank = space < 0 ? -1 : H5Sget_simple_extent_ndims(space);
    size[0] = size[1] = 1;
    if (rank == 1 || rank == 2) H5Sget_simple_extent_dims(space, size, NULL);
    if (space >= 0) H5Sclose(space);
    if (rank == 1 || rank == 2) return TOBI_OK;
    H5Dclose(*set);
    return tobi_fail(err, TOBI_DAMAGED, "%s: array '%s' has %d dimensions, expected 1 or 2", store->path,
                     name, rank);
}

tobi_status tobi_store_rows(tobi_store *store, const char *name, int64_t *n, tobi_error *err)
{
    quiet q = begin_quiet();
    hid_t set = -1;
    hsize_t size[2] = {0, 0};
    tobi_status status = open_array(store, name, &set, size, err);
    if (status == TOBI_OK) {
        *n = (int64_t)size[0];
        H5Dclose(set);
    }
    end_quiet(q);
    return status;
}

static tobi_status read_array(tobi_store *store, const char *name, tobi_type type, int64_t n,
                              int components,
                              void *data, tobi_error *err)
{
    hid_t set = -1;
    hsize_t size[2] = {0, 0};
    TOBI_TRY(open_array(store, name, &set, size, err));
    hid_t stored = H5Dget_type(set);
    tobi_status status = TOBI_OK;
    if (size[0] != (hsize_t)n || size[1] != (hsize_t)components)
        status = tobi_fail(err, TOBI_DAMAGED,
                           "%s: array '%s' has %" PRIu64 " x %" PRIu64 " numbers, expected %" PRId64
                           " x %d",
                           store->path, name, (uint64_t)size[0], (uint64_t)size[1], n, components);
    else if (stored < 0 || H5Tequal(stored, file_type(type)) <= 0)
        status = tobi_fail(err, TOBI_DAMAGED, "%s: array '%s' has another number type than expected",
                           store->path, name);
    else if (n > 0 && H5Dread(set, memory_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
        status = fail_hdf5(err, TOBI_DAMAGED, store, TR("read"), name);
    if (stored >= 0) H5Tclose(stored);
    H5Dclose(set);
    return status;
}

tobi_status tobi_store_get(tobi_store *store, const char *name, tobi_type type, int64_t n,
                           int components, void *data, tobi_error *err)
{
    quiet q = begin_quiet();
    tobi_status status = read_array(store, name, type, n, components, data, err);
    end_quiet(q);
    return status;
}

/* Opens a value of the wanted class; its bytes come back for texts. */
static tobi_status open_value(tobi_store *store, const char *name, H5T_class_t class, hid_t *attribute,
                              size_t *bytes, tobi_error *err)
{
    if (H5Aexists(store->file, name) <= 0)
        return tobi_fail(err, TOBI_DAMAGED, "%s has no value '%s'", store->path, name);
    *attribute = H5Aopen(store->file, name, H5P_DEFAULT);
    if (*attribute < 0) return fail_hdf5(err, TOBI_DAMAGED, store, TR("open"), name);
    hid_t type = H5Aget_type(*attribute), space = H5Aget_space(*attribute);
    int fits = type >= 0 && space >= 0 && H5Tget_class(type) == class &&
               H5Sget_simple_extent_npoints(space) == 1 && H5Tis_variable_str(type) <= 0;
    *bytes = type >= 0 ? H5Tget_size(type) : 0;
    if (type >= 0) H5Tclose(type);
    if (space >= 0) H5Sclose(space);
    if (fits) return TOBI_OK;
    H5Aclose(*attribute);
    return tobi_fail(err, TOBI_DAMAGED, "%s: value '%s' has another type than expected", store->path, name);
}

static tobi_status get_number(tobi_store *store, const char *name, H5T_class_t class, hid_t type,
                              void *value, tobi_error *err)
{
    quiet q = begin_quiet();
    hid_t attribute;
    size_t bytes;
    tobi_status status = open_value(store, name, class, &attribute, &bytes, err);
    if (status == TOBI_OK) {
        if (H5Aread(attribute, type, value) < 0) status = fail_hdf5(err, TOBI_DAMAGED, store, TR("read"),
                                                                    name);
        H5Aclose(attribute);
    }
    end_quiet(q);
    return status;
}

tobi_status tobi_store_get_real(tobi_store *store, const char *name, double *value, tobi_error *err)
{
    return get_number(store, name, H5T_FLOAT, H5T_NATIVE_DOUBLE, value, err);
}

tobi_status tobi_store_get_int(tobi_store *store, const char *name, int64_t *value, tobi_error *err)
{
    return get_number(store, name, H5T_INTEGER, H5T_NATIVE_INT64, value, err);
}

static tobi_status read_text(tobi_store *store, const char *name, char **value, tobi_error *err)
{
    hid_t attribute;
    size_t bytes;
    TOBI_TRY(open_value(store, name, H5T_STRING, &attribute, &bytes, err));
    hid_t type = text_type(bytes ? bytes : 1);
    char *text = calloc(bytes + 1, 1);
    tobi_status status = TOBI_OK;
    if (!text) status = tobi_fail(err, TOBI_NO_MEMORY, "no memory to read %s", store->path);
    else if (H5Aread(attribute, type, text) < 0) status = fail_hdf5(err, TOBI_DAMAGED, store, TR("read"),
                                                                    name);
    H5Tclose(type);
    H5Aclose(attribute);
    if (status == TOBI_OK) *value = text;
    else free(text);
    return status;
}

tobi_status tobi_store_get_text(tobi_store *store, const char *name, char **value, tobi_error *err)
{
    *value = NULL;
    quiet q = begin_quiet();
    tobi_status status = read_text(store, name, value, err);
    end_quiet(q);
    return status;
}
