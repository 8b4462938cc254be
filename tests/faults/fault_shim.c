// Makes the n-th call of one kind fail, for files below one folder: LD_PRELOAD for tests/faults.
//
// FAULT_CALL: open, write, fsync, close, rename, mkdir or unlink; FAULT_AT: which call, from 1; 0: none;
// FAULT_ERRNO: its errno; FAULT_FOLDER: absolute; FAULT_COUNT: a file that gets the number of calls.
// FAULT_CALL=clock: from the call FAULT_AT on the wall's clock shows FAULT_JUMP seconds more.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

static int calls;  // several threads write; an approximate order is good enough

static int below(const char* path) {
  const char* folder = getenv("FAULT_FOLDER");
  return folder && path && strncmp(path, folder, strlen(folder)) == 0;
}

static int descriptor_below(int descriptor) {
  char link[64], path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t size = readlink(link, path, sizeof path - 1);
  if (size <= 0) return 0;
  path[size] = '\0';
  return below(path);
}

// Whether this call is the one to fail; errno is set then.
static int fails(const char* call) {
  const char *wanted = getenv("FAULT_CALL"), *at = getenv("FAULT_AT"), *error = getenv("FAULT_ERRNO");
  if (!wanted || strcmp(wanted, call) != 0) return 0;
  if (__atomic_add_fetch(&calls, 1, __ATOMIC_RELAXED) != (at ? atoi(at) : 0)) return 0;
  errno = error ? atoi(error) : EIO;
  return 1;
}

#define REAL(type, name, ...) ((type(*)(__VA_ARGS__))dlsym(RTLD_NEXT, #name))

int open(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(list, mode_t) : 0;
  va_end(list);
  if ((flags & O_ACCMODE) != O_RDONLY && below(path) && fails("open")) return -1;
  return REAL(int, open, const char*, int, ...)(path, flags, mode);
}

ssize_t write(int descriptor, const void* data, size_t size) {
  if (descriptor > 2 && descriptor_below(descriptor) && fails("write")) return -1;
  return REAL(ssize_t, write, int, const void*, size_t)(descriptor, data, size);
}

ssize_t writev(int descriptor, const struct iovec* parts, int count) {
  if (descriptor > 2 && descriptor_below(descriptor) && fails("write")) return -1;
  return REAL(ssize_t, writev, int, const struct iovec*, int)(descriptor, parts, count);
}

// Of the C++ library's streams.
FILE* fopen(const char* path, const char* mode) {
  if (strpbrk(mode, "wa+") && below(path) && fails("open")) return NULL;
  return REAL(FILE*, fopen, const char*, const char*)(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  if (strpbrk(mode, "wa+") && below(path) && fails("open")) return NULL;
  return REAL(FILE*, fopen64, const char*, const char*)(path, mode);
}

ssize_t pwrite(int descriptor, const void* data, size_t size, off_t offset) {
  if (descriptor_below(descriptor) && fails("write")) return -1;
  return REAL(ssize_t, pwrite, int, const void*, size_t, off_t)(descriptor, data, size, offset);
}

int fsync(int descriptor) {
  if (descriptor_below(descriptor) && fails("fsync")) return -1;
  return REAL(int, fsync, int)(descriptor);
}

int syncfs(int descriptor) {
  if (descriptor_below(descriptor) && fails("fsync")) return -1;
  return REAL(int, syncfs, int)(descriptor);
}

// The descriptor is closed all the same, as Linux does it.
int close(int descriptor) {
  const int failed = descriptor > 2 && descriptor_below(descriptor) && fails("close");
  const int error = errno, result = REAL(int, close, int)(descriptor);
  if (failed) errno = error;
  return failed ? -1 : result;
}

int rename(const char* from, const char* to) {
  if (below(to) && fails("rename")) return -1;
  return REAL(int, rename, const char*, const char*)(from, to);
}

int mkdir(const char* path, mode_t mode) {
  if (below(path) && fails("mkdir")) return -1;
  return REAL(int, mkdir, const char*, mode_t)(path, mode);
}

int unlink(const char* path) {
  if (below(path) && fails("unlink")) return -1;
  return REAL(int, unlink, const char*)(path);
}

int remove(const char* path) {
  if (below(path) && fails("unlink")) return -1;
  return REAL(int, remove, const char*)(path);
}

int unlinkat(int folder, const char* path, int flags) {
  if (descriptor_below(folder) && fails("unlink")) return -1;
  return REAL(int, unlinkat, int, const char*, int)(folder, path, flags);
}

// Seconds that the clock has jumped by now.
static time_t jump(void) {
  const char *call = getenv("FAULT_CALL"), *at = getenv("FAULT_AT"), *by = getenv("FAULT_JUMP");
  if (!call || strcmp(call, "clock") != 0) return 0;
  const int now = __atomic_add_fetch(&calls, 1, __ATOMIC_RELAXED), from = at ? atoi(at) : 0;
  return from > 0 && now >= from && by ? atol(by) : 0;
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  const int result = REAL(int, clock_gettime, clockid_t, struct timespec*)(clock, now);
  if (result == 0 && clock == CLOCK_REALTIME) now->tv_sec += jump();
  return result;
}

int gettimeofday(struct timeval* restrict now, void* restrict zone) {
  const int result = REAL(int, gettimeofday, struct timeval*, void*)(now, zone);
  if (result == 0 && now) now->tv_sec += jump();
  return result;
}

time_t time(time_t* to) {
  const time_t now = REAL(time_t, time, time_t*)(NULL) + jump();
  if (to) *to = now;
  return now;
}

__attribute__((destructor)) static void note_calls(void) {
  const char* path = getenv("FAULT_COUNT");
  if (!path) return;
  FILE* file = fopen(path, "w");
  if (!file) return;
  fprintf(file, "%d\n", calls);
  fclose(file);
}
