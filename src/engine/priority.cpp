#include "freqsynth/engine/priority.inl"
