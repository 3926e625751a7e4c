/* A preload library that makes one call of a program fail: the n-th allocation, opening, writing or
   reading, counted from 1 over the whole run.

   FAIL_KIND  own: allocations asked for by the program's own code (library linked in)
              libraries: all other allocations of the process (HDF5, jansson, LuaJIT, libpng, libc)
              child: allocations in forked children (the mesh importer, scripts)
              open, write, read: calls on files, with FAIL_ERRNO; open stands for starting a child, too
   FAIL_AT    n; 0 only counts
   FAIL_ON    1: every call from the n-th on fails, as on a disk that stays full
   FAIL_SHORT 1: the n-th write or read does half of its work instead
   FAIL_LOG   file that receives the count and, for a failed call, its name

   stdin, stdout and stderr are left alone. Calls that libc makes inside itself are not seen, so fopen,
   fwrite and fclose fail at their own door. */
#define _GNU_SOURCE 1
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);

typedef enum kind { NONE, OWN, LIBRARIES, CHILD, OPEN, WRITE, READ } kind;
static const char *const kinds[] = { "none", "own", "libraries", "child", "open", "write", "read" };

static kind wanted;
static long *count, fail_at;      /* count is shared with the child, which leaves without a word */
static int fail_on, fail_short, fail_errno = ENOSPC, in_child;
static uintptr_t own_begin, own_end;
static char failed[32], log_path[4096];

static int find_program(struct dl_phdr_info *info, size_t size, void *user)
{
    (void)size, (void)user;
    for (int k = 0; k < info->dlpi_phnum; k++) {       /* the first object is the program */
        const ElfW(Phdr) *p = &info->dlpi_phdr[k];
        if (p->p_type != PT_LOAD || !(p->p_flags & PF_X)) continue;
        own_begin = info->dlpi_addr + p->p_vaddr;
        own_end = own_begin + p->p_memsz;
    }
    return 1;
}

static void enter_child(void)
{
    in_child = 1;
}

__attribute__((constructor)) static void begin(void)
{
    const char *name = getenv("FAIL_KIND"), *at = getenv("FAIL_AT"), *code = getenv("FAIL_ERRNO");
    const char *log = getenv("FAIL_LOG");
    count = mmap(NULL, sizeof *count, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    dl_iterate_phdr(find_program, NULL);
    fail_at = at ? atol(at) : 0;
    fail_on = getenv("FAIL_ON") != NULL;
    fail_short = getenv("FAIL_SHORT") != NULL;
    if (code) fail_errno = atoi(code);
    if (log) snprintf(log_path, sizeof log_path, "%s", log);
    pthread_atfork(NULL, NULL, enter_child);
    for (int k = OWN; name && k <= READ; k++)
        if (strcmp(name, kinds[k]) == 0) wanted = (kind)k;
}

__attribute__((destructor)) static void end(void)
{
    wanted = NONE;
    if (!log_path[0] || in_child) return;
    FILE *log = fopen(log_path, "w");
    if (!log) return;
    fprintf(log, "%ld %s\n", *count, failed);
    fclose(log);
}

/* Whether this call is the one. */
static int hit(kind k, const char *name)
{
    if (k != wanted || in_child != (wanted == CHILD)) return 0;
    long now = __atomic_add_fetch(count, 1, __ATOMIC_RELAXED);
    if (fail_at == 0 || (fail_on ? now < fail_at : now != fail_at)) return 0;
    if (!failed[0]) snprintf(failed, sizeof failed, "%s", name);
    return 1;
}

static int fails_allocation(const void *caller, const char *name)
{
    uintptr_t at = (uintptr_t)caller;
    int own = at >= own_begin && at < own_end;
    if (!hit(in_child ? CHILD : own ? OWN : LIBRARIES, name)) return 0;
    errno = ENOMEM;
    return 1;
}

static int fails_call(kind k, const char *name)
{
    if (!hit(k, name)) return 0;
    errno = fail_errno;
    return 1;
}

#define ALLOCATION(name) fails_allocation(__builtin_return_address(0), name)
#define NEXT(function) ((__typeof__(&function))dlsym(RTLD_NEXT, #function))

/* --- memory ------------------------------------------------------------------------------- */

void *malloc(size_t n) { return ALLOCATION("malloc") ? NULL : __libc_malloc(n); }
void *calloc(size_t n, size_t size) { return ALLOCATION("calloc") ? NULL : __libc_calloc(n, size); }
void *realloc(void *p, size_t n) { return ALLOCATION("realloc") ? NULL : __libc_realloc(p, n); }

void *aligned_alloc(size_t align, size_t n)
{
    return ALLOCATION("aligned_alloc") ? NULL : __libc_memalign(align, n);
}

int posix_memalign(void **p, size_t align, size_t n)
{
    if (ALLOCATION("posix_memalign")) return ENOMEM;
    *p = __libc_memalign(align, n);
    return *p ? 0 : ENOMEM;
}

static char *copy(const char *text, size_t n)
{
    char *p = __libc_malloc(n + 1);
    if (!p) return NULL;
    memcpy(p, text, n);
    p[n] = '\0';
    return p;
}

char *strdup(const char *s) { return ALLOCATION("strdup") ? NULL : copy(s, strlen(s)); }
char *strndup(const char *s, size_t n) { return ALLOCATION("strndup") ? NULL : copy(s, strnlen(s, n)); }

/* --- files -------------------------------------------------------------------------------- */

static int open_checked(const char *path, int flags, va_list args)
{
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(args, mode_t) : 0;
    if (fails_call(OPEN, "open")) return -1;
    return NEXT(open)(path, flags, mode);
}

int open(const char *path, int flags, ...)
{
    va_list args;
    va_start(args, flags);
    int fd = open_checked(path, flags, args);
    va_end(args);
    return fd;
}

int open64(const char *path, int flags, ...)
{
    va_list args;
    va_start(args, flags);
    int fd = open_checked(path, flags, args);
    va_end(args);
    return fd;
}

FILE *fopen(const char *path, const char *mode)
{
    return fails_call(OPEN, "fopen") ? NULL : NEXT(fopen)(path, mode);
}

FILE *fopen64(const char *path, const char *mode)
{
    return fails_call(OPEN, "fopen64") ? NULL : NEXT(fopen)(path, mode);
}

int socketpair(int domain, int type, int protocol, int ends[2])
{
    return fails_call(OPEN, "socketpair") ? -1 : NEXT(socketpair)(domain, type, protocol, ends);
}

pid_t fork(void) { return fails_call(OPEN, "fork") ? -1 : NEXT(fork)(); }

int mkdir(const char *path, mode_t mode) { return fails_call(OPEN, "mkdir") ? -1 : NEXT(mkdir)(path, mode); }

static int is_terminal(FILE *f) { return f == stdin || f == stdout || f == stderr; }

size_t fwrite(const void *data, size_t size, size_t n, FILE *f)
{
    size_t part = fail_short ? n/2 : 0;
    if (is_terminal(f) || !fails_call(WRITE, "fwrite")) return NEXT(fwrite)(data, size, n, f);
    part = part ? NEXT(fwrite)(data, size, part, f) : 0;
    errno = fail_errno;
    return part;
}

int vfprintf(FILE *f, const char *format, va_list args)
{
    return !is_terminal(f) && fails_call(WRITE, "vfprintf") ? -1 : NEXT(vfprintf)(f, format, args);
}

int fclose(FILE *f)
{
    int code = NEXT(fclose)(f);
    return fails_call(WRITE, "fclose") ? EOF : code;
}

int fseeko(FILE *f, off_t at, int from)
{
    return fails_call(WRITE, "fseeko") ? -1 : NEXT(fseeko)(f, at, from);
}

static size_t some(size_t n) { return fail_short && n > 1 ? n/2 : 0; }

ssize_t write(int fd, const void *data, size_t n)
{
    if (fd <= 2 || !fails_call(WRITE, "write")) return NEXT(write)(fd, data, n);
    return some(n) ? NEXT(write)(fd, data, some(n)) : -1;
}

ssize_t pwrite(int fd, const void *data, size_t n, off_t at)
{
    if (!fails_call(WRITE, "pwrite")) return NEXT(pwrite)(fd, data, n, at);
    return some(n) ? NEXT(pwrite)(fd, data, some(n), at) : -1;
}

ssize_t pwrite64(int fd, const void *data, size_t n, off_t at) { return pwrite(fd, data, n, at); }

int ftruncate(int fd, off_t n) { return fails_call(WRITE, "ftruncate") ? -1 : NEXT(ftruncate)(fd, n); }
int ftruncate64(int fd, off_t n) { return ftruncate(fd, n); }
int fsync(int fd) { return fails_call(WRITE, "fsync") ? -1 : NEXT(fsync)(fd); }
int syncfs(int fd) { return fails_call(WRITE, "syncfs") ? -1 : NEXT(syncfs)(fd); }

int posix_fallocate(int fd, off_t at, off_t n)
{
    return fails_call(WRITE, "posix_fallocate") ? fail_errno : NEXT(posix_fallocate)(fd, at, n);
}

int posix_fallocate64(int fd, off_t at, off_t n) { return posix_fallocate(fd, at, n); }

int rename(const char *from, const char *to)
{
    return fails_call(WRITE, "rename") ? -1 : NEXT(rename)(from, to);
}

size_t fread(void *data, size_t size, size_t n, FILE *f)
{
    if (is_terminal(f) || !fails_call(READ, "fread")) return NEXT(fread)(data, size, n, f);
    if (n/2 && fail_short) return NEXT(fread)(data, size, n/2, f);
    f->_flags |= 0x20;      /* glibc's error flag, what ferror() looks at */
    return 0;
}

ssize_t read(int fd, void *data, size_t n)
{
    if (fd <= 2 || !fails_call(READ, "read")) return NEXT(read)(fd, data, n);
    return some(n) ? NEXT(read)(fd, data, some(n)) : -1;
}

ssize_t pread(int fd, void *data, size_t n, off_t at)
{
    if (!fails_call(READ, "pread")) return NEXT(pread)(fd, data, n, at);
    return some(n) ? NEXT(pread)(fd, data, some(n), at) : -1;
}

ssize_t pread64(int fd, void *data, size_t n, off_t at) { return pread(fd, data, n, at); }
