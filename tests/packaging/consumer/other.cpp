#include "freqsynth/freqsynth.h"

const char* version_of_other_unit();

const char* version_of_other_unit() { return FREQSYNTH_VERSION; }
