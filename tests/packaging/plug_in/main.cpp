// SPDX-License-Identifier: MIT
#include <dlfcn.h>

#include <cstdio>

// Prints the version that the plug-in tells, and only that.
int main() {
  void* plug_in = dlopen(PLUG_IN, RTLD_NOW | RTLD_LOCAL);
  if (!plug_in) {
    std::puts(dlerror());
    return 1;
  }
  const auto synthesize = reinterpret_cast<const char* (*)()>(dlsym(plug_in, "synthesize"));
  const char* const version = synthesize ? synthesize() : nullptr;
  if (!version) return 1;
  std::puts(version);
}
