/* Faults of the disk: between a program and libc, every call that changes a file is counted and the n-th one fails.
   Loaded by LD_PRELOAD; idle until faults_arm(). */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum { ONCE, FULL, KILL, INTERRUPT }; /* FULL: from the n-th call on there is no space left on the disk */
static long count, wanted;
static int armed, does, fired, watching, store; /* store: in SQLite, which is not to be forked in */
static void (*before)(long, int); /* told of each call before it, and of the files that are open for writing */
static char kind[16], watched[65536];

void faults_tell(void (*function)(long, int)) { before = function; }
void faults_begin(void) { count = 0, fired = 0, wanted = 0, armed = 1; }
void faults_want(long at, int what) { wanted = at, does = what; }
int faults_fired(void) { return fired; }
const char *faults_kind(void) { return kind; }
void faults_rest(void) { armed = 0; }

static int fails(const char *what, int error)
{
    if (!armed)
        return 0;
    ++count;
    if (before) {
        armed = 0; /* what is done there does not count */
        before(count, watching + store);
        armed = 1;
    }
    store = 0;
    if (does == FULL && fired) {
        errno = ENOSPC;
        return error == ENOSPC;
    }
    if (count != wanted)
        return 0;
    if (does == FULL && error != ENOSPC)
        return 0;
    fired = 1;
    strncpy(kind, what, sizeof kind - 1);
    if (does == KILL)
        kill(getpid(), SIGKILL);
    if (does == INTERRUPT) {
        kill(getpid(), SIGINT);
        return 0;
    }
    errno = error;
    return 1;
}

int faults_ask(const char *what) { return fails(what, EAGAIN); }

static int counts(const char *path)
{
    store = strstr(path, ".db") != NULL;
    return strncmp(path, "/dev/", 5) && strncmp(path, "/proc/", 6) && !strstr(path, ".pyc");
}

#define REAL(type, name, ...) static type (*real)(__VA_ARGS__); if (!real) real = dlsym(RTLD_NEXT, #name)
#define WRITES(flags) ((flags) & (O_WRONLY | O_RDWR | O_CREAT | O_TRUNC))
#define MODE(flags) mode_t mode = 0; if ((flags) & (O_CREAT | __O_TMPFILE)) \
    { va_list more; va_start(more, flags); mode = va_arg(more, mode_t); va_end(more); }

static int opened(int file, int flags, const char *path)
{
    if (file >= 0 && file < (int) sizeof watched)
        watching += watched[file] = WRITES(flags) && counts(path);
    store = 0;
    return file;
}
#define OPEN(name) int name(const char *path, int flags, ...) { MODE(flags) REAL(int, name, const char *, int, ...); \
    return WRITES(flags) && counts(path) && fails("open", ENOSPC) ? -1 : opened(real(path, flags, mode), flags, path); }
#define OPENAT(name) int name(int at, const char *path, int flags, ...) { MODE(flags) \
    REAL(int, name, int, const char *, int, ...); \
    return WRITES(flags) && counts(path) && fails("open", ENOSPC) ? -1 : opened(real(at, path, flags, mode), flags, path); }
OPEN(open) OPEN(open64) OPENAT(openat) OPENAT(openat64)

int close(int file)
{
    REAL(int, close, int);
    if (file >= 0 && file < (int) sizeof watched)
        watching -= watched[file], watched[file] = 0;
    return real(file);
}

#define OF_FILE(type, name, word, error, arguments, ...) type name(__VA_ARGS__) { REAL(type, name, __VA_ARGS__); \
    return file >= 0 && file < (int) sizeof watched && watched[file] && fails(word, error) ? -1 : real arguments; }
OF_FILE(ssize_t, write, "write", ENOSPC, (file, data, size), int file, const void *data, size_t size)
OF_FILE(ssize_t, writev, "write", ENOSPC, (file, parts, n), int file, const struct iovec *parts, int n)
OF_FILE(ssize_t, pwrite, "write", ENOSPC, (file, data, size, at), int file, const void *data, size_t size, off_t at)
OF_FILE(ssize_t, pwrite64, "write", ENOSPC, (file, data, size, at), int file, const void *data, size_t size, off64_t at)
OF_FILE(int, ftruncate, "truncate", EIO, (file, size), int file, off_t size)
OF_FILE(int, ftruncate64, "truncate", EIO, (file, size), int file, off64_t size)
OF_FILE(int, fsync, "fsync", EIO, (file), int file)
OF_FILE(int, fdatasync, "fsync", EIO, (file), int file)

#define OF_PATH(name, word, error, arguments, ...) int name(__VA_ARGS__) { REAL(int, name, __VA_ARGS__); \
    return counts(path) && fails(word, error) ? -1 : real arguments; }
OF_PATH(rename, "rename", EIO, (path, to), const char *path, const char *to)
OF_PATH(renameat, "rename", EIO, (from, path, at, to), int from, const char *path, int at, const char *to)
OF_PATH(link, "link", EIO, (path, to), const char *path, const char *to)
OF_PATH(linkat, "link", EIO, (from, path, at, to, flags), int from, const char *path, int at, const char *to, int flags)
OF_PATH(unlink, "unlink", EIO, (path), const char *path)
OF_PATH(unlinkat, "unlink", EIO, (at, path, flags), int at, const char *path, int flags)
OF_PATH(mkdir, "mkdir", ENOSPC, (path, mode), const char *path, mode_t mode)
OF_PATH(mkdirat, "mkdir", ENOSPC, (at, path, mode), int at, const char *path, mode_t mode)
OF_PATH(rmdir, "rmdir", EIO, (path), const char *path)
