#include <cstdio>
#include <cstring>

#include "freqsynth/freqsynth.h"

const char* version_of_other_unit();

int main() {
  std::puts(FREQSYNTH_VERSION);
  return std::strcmp(FREQSYNTH_VERSION, version_of_other_unit()) == 0 ? 0 : 1;
}
