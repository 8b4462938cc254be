/* A libEGL that breaks where FAKE_EGL says, for the tests of messages: no_devices, no_display,
   no_initialize, no_surfaceless, no_desktop_gl, no_context, no_current, no_function, old_gl, no_extension,
   small.
   With any other value everything works up to the first drawing. */
#include <stdlib.h>
#include <string.h>

static int breaks_at(const char* stage) {
  const char* wanted = getenv("FAKE_EGL");
  return wanted && !strcmp(wanted, stage);
}
static long nothing(void) { return 0; }
static int some_handle;

/* EGL: its types are pointers and 32-bit integers. */
int eglGetError(void) { return 0x3001; } /* EGL_NOT_INITIALIZED */
/* Not by way of eglGetDisplay, for which the loader might take a real one. */
static void* find_display(void) {
  return breaks_at("no_display") || breaks_at("no_devices") ? 0 : &some_handle;
}
void* eglGetDisplay(void* native) {
  (void)native;
  return find_display();
}
unsigned eglInitialize(void* display, int* major, int* minor) {
  (void)display;
  *major = 1, *minor = 5;
  return !breaks_at("no_initialize");
}
unsigned eglBindAPI(unsigned api) {
  (void)api;
  return !breaks_at("no_desktop_gl");
}
void* eglCreateContext(void* display, void* config, void* share, const int* attributes) {
  (void)display, (void)config, (void)share, (void)attributes;
  return breaks_at("no_context") ? 0 : &some_handle;
}
unsigned eglDestroyContext(void* display, void* context) {
  (void)display, (void)context;
  return 1;
}
unsigned eglMakeCurrent(void* display, void* draw, void* read, void* context) {
  (void)display, (void)draw, (void)read;
  return !context || !breaks_at("no_current");
}
const char* eglQueryString(void* display, int name) {
  (void)display, (void)name;
  return breaks_at("no_surfaceless") ? "EGL_KHR_surfaceless_context_not"
                                     : "EGL_KHR_surfaceless_context";
}
static void* get_platform_display(unsigned platform, void* native, const int* attributes) {
  (void)platform, (void)native, (void)attributes;
  return find_display();
}
static unsigned query_devices(int most, void** devices, int* count) {
  (void)most;
  *count = breaks_at("no_devices") ? 0 : 1;
  devices[0] = &some_handle;
  return 1;
}
static const char* query_device_string(void* device, int name) {
  (void)device, (void)name;
  return "EGL_EXT_device_base";
}

/* GL */
static const unsigned char* get_string(unsigned name) {
  if (name == 0x1F02) /* GL_VERSION */
    return (const unsigned char*)(breaks_at("old_gl") ? "3.3 fake" : "4.5 fake");
  return (const unsigned char*)"fake";
}
static const unsigned char* get_string_i(unsigned name, unsigned number) {
  (void)name, (void)number;
  return (const unsigned char*)(breaks_at("no_extension") ? "GL_fake" : "GL_ARB_indirect_parameters");
}
static void get_integer(unsigned name, int* value) {
  *value = 65536;
  if (name == 0x821B) *value = breaks_at("old_gl") ? 3 : 4; /* GL_MAJOR_VERSION */
  if (name == 0x821C) *value = breaks_at("old_gl") ? 3 : 5; /* GL_MINOR_VERSION */
  if (name == 0x0D33 && breaks_at("small")) *value = 1024;  /* GL_MAX_TEXTURE_SIZE */
}
void* eglGetProcAddress(const char* name) {
  if (!strcmp(name, "eglGetPlatformDisplayEXT")) return (void*)get_platform_display;
  if (!strcmp(name, "eglQueryDevicesEXT")) return (void*)query_devices;
  if (!strcmp(name, "eglQueryDeviceStringEXT")) return (void*)query_device_string;
  if (!strcmp(name, "glGetString")) return (void*)get_string;
  if (!strcmp(name, "glGetStringi")) return (void*)get_string_i;
  if (!strcmp(name, "glGetIntegerv")) return (void*)get_integer;
  if (!strcmp(name, "glClipControl") && breaks_at("no_function")) return 0;
  return (void*)nothing;
}
