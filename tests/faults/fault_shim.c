// Makes the n-th call of one kind fail, for files below one folder: LD_PRELOAD for tests/faults.
//
// FAULT_CALL: open, write, fsync, close, rename, mkdir or unlink; FAULT_AT: which call, from 1; 0: none;
// FAULT_ERRNO: its errno; FAULT_FOLDER: absolute; FAULT_COUNT: a file that gets the number of calls.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
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

__attribute__((destructor)) static void note_calls(void) {
  const char* path = getenv("FAULT_COUNT");
  if (!path) return;
  FILE* file = fopen(path, "w");
  if (!file) return;
  fprintf(file, "%d\n", calls);
  fclose(file);
}
