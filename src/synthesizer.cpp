#include "freqsynth/synthesizer.inl"
