// Linked into executables that draw, under AddressSanitizer alone. Graphics drivers keep some of
// what they allocate until the process ends, and are unloaded before the leak check, which then can
// say neither whose a block is nor find the stacks of their threads. So nothing is unloaded, and
// what the drivers keep is left out by the name of their library; kerf's own leaks are still found.

#include <dlfcn.h>

extern "C" {

int dlclose(void*) { return 0; }

const char* __lsan_default_suppressions();
const char* __lsan_default_suppressions() {
  return "leak:_dri.so\n"
         "leak:libEGL\n"
         "leak:libGL\n"
         "leak:libLLVM\n";
}
}
