/* Reading a mesh file through assimp in a child process.

   The child imports, merges all meshes of the file and writes raw arrays into a pipe; the parent
   checks every byte of meaning again. So a crash, a hang or an endless allocation of the importer
   ends the child only. Drawback: the arrays are copied once through the pipe, and a host that
   reaps all children itself loses the exit cause (the text then says only that it ended).

   Binary STL is read without it (file_checks.h): large scans come so, and its records hold nothing that
   could surprise.

   assimp holds coordinates as float. Each is replaced by the shortest decimal that reads back as the
   same float, so that 0.1 in a text file arrives as the double 0.1. */
#define _GNU_SOURCE
#include "base/limit.h"
#include "base/plain.h"
#include "geom/file_checks.h"
#include "geom/import_io.h"
#include "geom/mesh.h"
#include "geom/obj_scan.h"
#include "geom/texture.h"
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* What an import may use, by the size of the file: measured needs are below 30 bytes and 0.2 us per
   byte of OBJ text; files that claim more than they hold would go on for ever. */
#define SECONDS_BASE 10
#define SECONDS_PER_BYTE 1e-6
#define BYTES_BASE ((rlim_t)1 << 30)      /* beyond what the parent has mapped already */
#define BYTES_PER_BYTE 200
#define MAX_NODE_DEPTH 1000
#define FILE_LIMIT ((int64_t)4 << 30)

typedef struct allowance {
    double seconds;
    rlim_t bytes;
    int64_t size;                         /* of the file */
} allowance;

typedef struct import_header {
    char magic[8];
    int64_t vertex_count, triangle_count;
    int64_t textured;                     /* 1: coordinates of all corners follow, NAN where there are none */
    char text[1024];                      /* the importer's complaint, empty if none */
} import_header;

typedef struct collector {
    const struct aiScene *scene;
    int64_t vertex_count, triangle_count; /* counted first, then written           */
    double  (*vertices)[3];
    int32_t (*triangles)[3];
    float   (*uv)[3][2];                  /* per triangle; NULL if no part has a texture */
    int fill, depth, textured;
} collector;

/* --- in the child ------------------------------------------------------------------------- */

static void collect_texture(collector *c, const struct aiMesh *m, const unsigned *corners)
{
    const struct aiVector3D *given = m->mTextureCoords[0];
    c->textured |= given != NULL;
    for (int k = 0; c->fill && c->uv && k < 3; k++) {
        int has = given && corners[k] < m->mNumVertices;
        c->uv[c->triangle_count][k][0] = has ? given[corners[k]].x : NAN;
        c->uv[c->triangle_count][k][1] = has ? given[corners[k]].y : NAN;
    }
}

static void collect_mesh(collector *c, const struct aiMesh *m, const struct aiMatrix4x4 *x)
{
    int64_t first = c->vertex_count;
    int identity = aiMatrix4AreEqual(x, &(struct aiMatrix4x4){1, 0, 0, 0, 0, 1, 0, 0,
                                                             0, 0, 1, 0, 0, 0, 0, 1});
    for (unsigned i = 0; c->fill && i < m->mNumVertices; i++) {
        struct aiVector3D v = m->mVertices[i];
        if (!identity) aiTransformVecByMatrix4(&v, x);
        double *out = c->vertices[first + i];
        out[0] = tobi_shortest_decimal(v.x);
        out[1] = tobi_shortest_decimal(v.y);
        out[2] = tobi_shortest_decimal(v.z);
    }
    c->vertex_count += m->mNumVertices;
    for (unsigned i = 0; i < m->mNumFaces; i++) {
        if (m->mFaces[i].mNumIndices != 3) continue;
        collect_texture(c, m, m->mFaces[i].mIndices);
        for (int k = 0; c->fill && k < 3; k++) {
            unsigned index = m->mFaces[i].mIndices[k];
            /* an index outside its own part must not land in the next part */
            c->triangles[c->triangle_count][k] = index < m->mNumVertices ? (int32_t)(first + index)
                                                                         : INT32_MAX;
        }
        c->triangle_count++;
    }
}

static void collect_node(collector *c, const struct aiNode *node, const struct aiMatrix4x4 *parent)
{
    struct aiMatrix4x4 here = *parent;
    if (!node || ++c->depth > MAX_NODE_DEPTH) return;
    aiMultiplyMatrix4(&here, &node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        if (node->mMeshes[i] < c->scene->mNumMeshes)
            collect_mesh(c, c->scene->mMeshes[node->mMeshes[i]], &here);
    for (unsigned i = 0; i < node->mNumChildren; i++) collect_node(c, node->mChildren[i], &here);
    c->depth--;
}

static int write_all(int fd, const void *data, size_t size)
{
    for (const char *p = data; size;) {
        ssize_t n = write(fd, p, size);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return 0;
        p += n;
        size -= (size_t)n;
    }
    return 1;
}

/* NULL with a text in the header if that did not work. */
static const struct aiScene *import(const char *path, import_header *header)
{
    const unsigned flags = aiProcess_ValidateDataStructure | aiProcess_Triangulate;
    const char *dot = strrchr(path, '.');
    char *text = NULL;
    size_t size = 0;
    int changed = dot && !strcasecmp(dot, ".obj") ? tobi_obj_add_zeros(path, &text, &size) : 0;
    FILE *file = changed > 0 ? fmemopen(text, size, "rb") : changed == 0 ? fopen(path, "rb") : NULL;
    const struct aiScene *scene = NULL;
    tobi_import_io io;
    tobi_import_io_init(&io, path, file);
    if (file) scene = aiImportFileEx(path, flags, &io.io);
    if (file) fclose(file);
    free(text);
    if (scene) return scene;
    snprintf(header->text, sizeof header->text, "%s",
             changed < 0 ? tr("it cannot be held in memory") : aiGetErrorString());
    if (!header->text[0]) strcpy(header->text, tr("the importer gave up without a reason"));
    return NULL;
}

static _Noreturn void run_child(const char *path, int fd, const allowance *allowed)
{
    static const int reset[] = {SIGINT, SIGTERM, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM};
    for (size_t i = 0; i < sizeof reset/sizeof *reset; i++) signal(reset[i], SIG_DFL);
    rlim_t seconds = (rlim_t)allowed->seconds + 1;
    setrlimit(RLIMIT_CPU, &(struct rlimit){seconds, seconds});
    tobi_limit_memory(allowed->bytes);
    /* The importer must not print either. Where a host closed them, the pipe is one of the three. */
    int out = fcntl(fd, F_DUPFD_CLOEXEC, STDERR_FILENO + 1), null = open("/dev/null", O_RDWR);
    if (out < 0) _exit(1);
    for (int k = STDIN_FILENO; null >= 0 && k <= STDERR_FILENO; k++) dup2(null, k);
    fd = out;
    import_header header = {.magic = "tobimesh"};
    struct aiMatrix4x4 identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    collector c = {.scene = import(path, &header)};
    if (!c.scene) {
        write_all(fd, &header, sizeof header);
        _exit(0);
    }
    collect_node(&c, c.scene->mRootNode, &identity);
    c.vertices = malloc((size_t)(c.vertex_count + 1)*sizeof *c.vertices);
    c.triangles = malloc((size_t)(c.triangle_count + 1)*sizeof *c.triangles);
    if (c.textured) c.uv = malloc((size_t)(c.triangle_count + 1)*sizeof *c.uv);
    if (!c.vertices || !c.triangles || (c.textured && !c.uv) || c.vertex_count > INT32_MAX - 1) {
        strcpy(header.text, tr("too large to import"));
        write_all(fd, &header, sizeof header);
        _exit(0);
    }
    c.fill = 1;
    c.vertex_count = c.triangle_count = c.depth = 0;
    collect_node(&c, c.scene->mRootNode, &identity);
    header.vertex_count = c.vertex_count;
    header.triangle_count = c.triangle_count;
    header.textured = c.textured;
    _exit(!(write_all(fd, &header, sizeof header) &&
            write_all(fd, c.vertices, (size_t)c.vertex_count*sizeof *c.vertices) &&
            write_all(fd, c.triangles, (size_t)c.triangle_count*sizeof *c.triangles) &&
            (!c.uv || write_all(fd, c.uv, (size_t)c.triangle_count*sizeof *c.uv))));
}

/* --- in the parent ------------------------------------------------------------------------ */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

/* Reads size bytes before the deadline: 1 done, 0 the pipe ended, -1 out of time. */
static int read_all(int fd, void *data, size_t size, double deadline)
{
    for (char *p = data; size;) {
        double left = deadline - now();
        struct pollfd wait = {.fd = fd, .events = POLLIN};
        if (left <= 0) return -1;
        int ready = poll(&wait, 1, (int)(left*1000) + 1);
        if (ready < 0 && errno != EINTR) return 0;
        if (ready <= 0) continue;
        ssize_t n = read(fd, p, size);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return 0;
        p += n;
        size -= (size_t)n;
    }
    return 1;
}

/* The importer's own complaint, made clearer where it says too little. */
static tobi_status fail_refused(const char *path, const char *text, tobi_error *err)
{
    tobi_obj_fault fault;
    const char *dot = strrchr(path, '.');
    if (strstr(text, "bad_alloc"))
        text = tr("it claims to hold far more than its size allows, or needs too much memory");
    if (dot && !strcasecmp(dot, ".obj") && tobi_obj_scan(path, &fault))
        return tobi_fail(err, TOBI_INVALID, "mesh '%s', line %lld: a face uses vertex index %lld, out of "
                         "range; allowed are 1 to %lld, or -1 and below counted back", path,
                         (long long)fault.line, (long long)fault.index, (long long)fault.vertices);
    return tobi_fail(err, TOBI_INVALID, "mesh '%s' cannot be read: %s", path, text);
}

static tobi_status receive_mesh(const char *path, int fd, double deadline, tobi_mesh *out, int *finished,
                                tobi_error *err)
{
    import_header header;
    tobi_mesh raw = {0};
    *finished = read_all(fd, &header, sizeof header, deadline);
    if (*finished != 1) return TOBI_INVALID;
    header.text[sizeof header.text - 1] = 0;
    if (memcmp(header.magic, "tobimesh", 8) || header.vertex_count < 0 || header.triangle_count < 0 ||
        header.vertex_count > INT32_MAX || header.triangle_count > INT32_MAX) {
        *finished = 0;
        return TOBI_INVALID;
    }
    if (header.text[0]) return fail_refused(path, header.text, err);
    raw.vertices = malloc((size_t)(header.vertex_count + 1)*sizeof *raw.vertices);
    raw.triangles = malloc((size_t)(header.triangle_count + 1)*sizeof *raw.triangles);
    float (*uv)[3][2] = header.textured ? malloc((size_t)(header.triangle_count + 1)*sizeof *uv) : NULL;
    tobi_status status;
    if (!raw.vertices || !raw.triangles || (header.textured && !uv))
        status = tobi_fail(err, TOBI_NO_MEMORY, "mesh '%s': no memory for %lld triangles", path,
                           (long long)header.triangle_count);
    else if ((*finished = read_all(fd, raw.vertices, (size_t)header.vertex_count*sizeof *raw.vertices,
                                   deadline)) != 1 ||
             (*finished = read_all(fd, raw.triangles,
                                   (size_t)header.triangle_count*sizeof *raw.triangles, deadline)) != 1 ||
             (uv && (*finished = read_all(fd, uv, (size_t)header.triangle_count*sizeof *uv, deadline)) != 1))
        status = TOBI_INVALID;
    else
        status = tobi_mesh_build(path, header.vertex_count, (const double (*)[3])raw.vertices,
                                 header.triangle_count, (const int32_t (*)[3])raw.triangles, out, err);
    raw.vertex_count = header.vertex_count;
    raw.triangle_count = header.triangle_count;
    if (status == TOBI_OK && uv) {
        status = tobi_texture_create(&raw, (const float (*)[3][2])uv, &out->texture, err);
        if (status != TOBI_OK) tobi_mesh_free(out);
    }
    free(uv);
    tobi_mesh_free(&raw);
    return status;
}

static tobi_status fail_import(const char *path, int finished, const allowance *allowed, const int *state,
                               tobi_error *err)
{
    if (finished < 0)
        return tobi_fail(err, TOBI_INVALID, "mesh '%s' cannot be read: the importer took more than "
                         "%.0f s; the file is damaged", path, allowed->seconds);
    if (state && WIFSIGNALED(*state))
        return tobi_fail(err, TOBI_INVALID, "mesh '%s' cannot be read: the importer crashed (signal %d: "
                         "%s); the file is damaged", path, WTERMSIG(*state), strsignal(WTERMSIG(*state)));
    return tobi_fail(err, TOBI_INVALID, "mesh '%s' cannot be read: the importer ended early; the file is "
                     "damaged", path);
}

static tobi_status import_apart(const char *path, const allowance *allowed, tobi_mesh *out,
                                tobi_error *err)
{
    int ends[2], finished = 0, state = 0;
    if (pipe2(ends, O_CLOEXEC))
        return tobi_fail(err, TOBI_IO, "mesh '%s': no pipe for the importer: %s", path, tobi_reason(errno));
    pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        run_child(path, ends[1], allowed);
    }
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        return tobi_fail(err, TOBI_IO, "mesh '%s': the importer cannot start: %s", path, tobi_reason(errno));
    }
    tobi_status status = receive_mesh(path, ends[0], now() + allowed->seconds, out, &finished, err);
    close(ends[0]);
    if (finished < 0) kill(child, SIGKILL);
    pid_t reaped;
    do reaped = waitpid(child, &state, 0);
    while (reaped < 0 && errno == EINTR);
    if (finished != 1) return fail_import(path, finished, allowed, reaped == child ? &state : NULL, err);
    return status;
}

static tobi_status check_file(const char *path, allowance *allowed, tobi_error *err)
{
    static const char *const formats[] = {".obj", ".stl", ".ply"};
    const char *dot = strrchr(path, '.');
    FILE *file;
    int known = 0;
    TOBI_TRY(tobi_plain_open(path, tr("mesh"), FILE_LIMIT, &file, &allowed->size, err));
    fclose(file);
    for (int i = 0; dot && i < 3; i++) known |= !strcasecmp(dot, formats[i]);
    if (!known)
        return tobi_fail(err, TOBI_INVALID, "mesh '%s': unknown format; allowed are .obj, .stl and .ply",
                         path);
    if (allowed->size == 0) return tobi_fail(err, TOBI_INVALID, "mesh '%s' is an empty file", path);
    allowed->seconds = SECONDS_BASE + SECONDS_PER_BYTE*(double)allowed->size;
    allowed->bytes = BYTES_BASE + BYTES_PER_BYTE*(rlim_t)allowed->size;
    return TOBI_OK;
}

tobi_status tobi_mesh_read(const char *path, tobi_mesh *out, tobi_error *err)
{
    *out = (tobi_mesh){0};
    allowance allowed = {0};
    TOBI_TRY(check_file(path, &allowed, err));
    const char *dot = strrchr(path, '.');
    if (!strcasecmp(dot, ".ply")) TOBI_TRY(tobi_ply_check(path, allowed.size, err));
    if (!strcasecmp(dot, ".stl")) {
        tobi_mesh raw = {0};
        tobi_status status;
        int found = tobi_stl_read_binary(path, allowed.size, &raw, &status, err);
        if (found > 0)
            status = tobi_mesh_build(path, raw.vertex_count, (const double (*)[3])raw.vertices,
                                     raw.triangle_count, (const int32_t (*)[3])raw.triangles, out, err);
        tobi_mesh_free(&raw);
        if (found) return status;
    }
    return import_apart(path, &allowed, out, err);
}
